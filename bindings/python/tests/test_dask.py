"""A sweep in parts on Dask workers gives the same table as on one machine."""

import hamel
import polars
from distributed import Client, LocalCluster

from known import PENDULUM

PARTS = 4


def test_parts_of_a_sweep_by_workers(tmp_path):
    description = tmp_path / "pendulum.eom"
    description.write_text(PENDULUM)
    options = {
        "vary": "l = uniform(0.4, 0.6); start q = normal(0.7, 0.1)",
        "until": 1.0,
        "keep": "end; max(q)",
        "members": 200,
        "seed": 3,
        "shard_size": 10,
    }
    hamel.sweep(description, out=tmp_path / "one", **options)
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        parts = [
            client.submit(hamel.sweep, description, out=tmp_path / "many", shard=(part, PARTS), **options)
            for part in range(1, PARTS + 1)
        ]
        client.gather(parts)
    one, many = (polars.read_parquet(tmp_path / folder / "*.parquet").sort("index") for folder in ("one", "many"))
    assert len(one) == 200 and one.equals(many)
