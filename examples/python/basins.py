"""Maps the time until a double pendulum, released at rest, first turns over: a million runs.

    python basins.py [FOLDER] [--points 1000]

releases it at every pair of angles of a grid, on all cores, and writes basins.png. With `--runs FOLDER`, repeating the
command resumes an interrupted sweep.
"""

import argparse
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import polars as pl
from matplotlib.colors import LogNorm

import hamel

DOUBLE_PENDULUM = """
/// Two point masses on rods of one length, absolute angles from below.
system DoublePendulum {
    param l = 1, g = 9.81;
    coord th1, th2;
    velocity w1, w2;
    rate th1 = w1;
    rate th2 = w2;
    let p1 = [l * sin(th1), 0, -l * cos(th1)];
    particle mass 1 at p1;
    particle mass 1 at p1 + [l * sin(th2), 0, -l * cos(th2)];
    gravity [0, 0, -g];
}
"""
UNTIL = 10.0


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("."))
    parser.add_argument("--points", type=int, default=1000)
    parser.add_argument("--runs", type=Path, help="where runs are kept")
    options = parser.parse_args()
    n = options.points
    with tempfile.TemporaryDirectory() as scratch:
        description = Path(scratch) / "double_pendulum.eom"
        description.write_text(DOUBLE_PENDULUM)
        runs = options.runs or Path(scratch) / "runs"
        # Centres of the cells of a grid from -pi to pi.
        end = np.pi * (1 - 1 / n)
        hamel.sweep(
            description,
            vary=f"start th1 = grid({-end}, {end}, {n}); start th2 = grid({-end}, {end}, {n})",
            keep="event(abs(th1) > pi); event(abs(th2) > pi)",
            until=UNTIL,
            method="rkmk4",
            step=0.01,
            out=runs,
        )
        table = pl.read_parquet(runs / "*.parquet").sort("start th2", "start th1")
    first = table.select(pl.min_horizontal(pl.col("^event.*$"))).to_series().fill_null(np.nan)
    turned = first.to_numpy().reshape(n, n)
    th1, th2 = (table[f"start {name}"].to_numpy().reshape(n, n) for name in ("th1", "th2"))
    # Below the energy of the second rod upright, it cannot turn over.
    low = -2 * np.cos(th1) - np.cos(th2) < -1
    print(f"{n * n} runs: {np.isfinite(turned).mean():.1%} turn over in {UNTIL:g} s; with too little energy none of {low.sum()}")
    assert not np.isfinite(turned[low]).any()
    # Mirrored starts have mirrored motions, until chaos amplifies rounding errors.
    early = turned < 3
    assert np.allclose(turned[early], turned[::-1, ::-1][early], rtol=1e-6)

    figure, axes = plt.subplots(figsize=(6, 5), layout="constrained")
    image = axes.imshow(
        turned, origin="lower", extent=(-np.pi, np.pi, -np.pi, np.pi), norm=LogNorm(0.5, UNTIL), cmap="viridis"
    )
    axes.set(xlabel="first angle (rad)", ylabel="second angle (rad)", facecolor="white")
    figure.colorbar(image, label="first turn (s)")
    figure.savefig(options.folder / "basins.png", dpi=150)


if __name__ == "__main__":
    main()
