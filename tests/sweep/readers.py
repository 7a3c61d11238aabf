"""Reads a sweep by Polars, DuckDB and pandas: the same table for all readers, with the requested columns."""

import json
import math
import subprocess
import sys

import duckdb
import pandas
import polars
import pyarrow.parquet

HAMEL, FOLDER = sys.argv[1:]
RUNS = f"{FOLDER}/runs"
MODEL = "tests/models/free_body.eom"
MEMBERS = 200
VARY = "m = grid(-0.5, 1.5, 5); start w = uniform([-1, -1, -1], [1, 1, 1]); start v[3] = normal(2, 0.1)"
KEEP = "end; max(norm(w)); event(r[3] < 0)"
STEPS = ["--until", "0.5", "--method", "rkmk4", "--step", "0.05"]


def run(*arguments):
    return subprocess.run([HAMEL, *arguments], check=True, capture_output=True, text=True).stdout


run("sweep", MODEL, "--vary", VARY, "--members", str(MEMBERS), "--keep", KEEP, "--out", RUNS, "--seed", "7", *STEPS)

# Runs the examples of the chapter on ensembles.
with open("docs/book/src/ensembles.md") as page:
    [shown] = [rest.split("```")[0].replace("runs", RUNS) for rest in page.read().split("```python\n")[1:]]
names = {"polars": polars, "duckdb": duckdb, "pandas": pandas}
by_polars, mean, by_pandas = (eval(line, names) for line in shown.splitlines())
by_duckdb = duckdb.sql(f"SELECT * FROM '{RUNS}/*.parquet'")
assert math.isclose(mean.fetchall()[0][0], by_polars["max(norm(w))"].mean(), rel_tol=1e-12)

matrix = [f"end R[{i},{j}]" for i in (1, 2, 3) for j in (1, 2, 3)]
vector = lambda name: [f"{name}[{i}]" for i in (1, 2, 3)]
columns = ["index", "m", *vector("start w"), "start v[3]", "end t", *vector("end r"), *matrix]
columns += [*vector("end v"), *vector("end w"), "max(norm(w))", "event(r[3] < 0)", "error"]
assert by_polars.columns == columns, by_polars.columns
assert by_duckdb.columns == columns, by_duckdb.columns
assert list(by_pandas.columns) == columns, list(by_pandas.columns)


def rows(values):
    """Rows by their index, with None for missing values."""
    missing = lambda value: value is None or isinstance(value, float) and math.isnan(value)
    return sorted([None if missing(value) else value for value in row] for row in values)


table = rows(by_polars.rows())
assert table == rows(by_duckdb.fetchall())
assert table == rows(by_pandas.itertuples(index=False, name=None))
assert [row[0] for row in table] == list(range(MEMBERS))

# Failures are rows: a mass that is not positive is refused.
place = {name: number for number, name in enumerate(columns)}
for row in table:
    fails = row[place["m"]] <= 0
    assert (row[place["error"]] is not None) == fails, row
    assert (row[place["end t"]] is None) == fails, row
    if fails:
        assert row[place["error"]].startswith("singular: "), row
failed = sum(row[place["error"]] is not None for row in table)
assert 0 < failed < MEMBERS

# A member agrees with `hamel simulate`.
row = table[-1]
value = lambda names: [row[place[name]] for name in names]
start = value(vector("start w"))
state = {"param": {"m": row[place["m"]]}, "velocity": {"v": [0, 0, row[place["start v[3]"]]], "w": start}}
with open(f"{FOLDER}/state.json", "w") as file:
    json.dump(state, file)
run("simulate", MODEL, "--at", f"{FOLDER}/state.json", "--out", f"{FOLDER}/run.csv", *STEPS)
with open(f"{FOLDER}/run.csv") as file:
    last = [float(number) for number in file.read().splitlines()[-1].split(",")]
assert last == value(["end t", *vector("end r"), *matrix, *vector("end v"), *vector("end w")])

# Files contain metadata about their origin.
metadata = pyarrow.parquet.read_metadata(f"{RUNS}/shard-000000.parquet")
about = {key.decode(): text.decode() for key, text in metadata.metadata.items()}
sweep = json.loads(about["hamel.sweep"])
assert (sweep["vary"], sweep["keep"], sweep["seed"], sweep["members"]) == (VARY, KEEP, 7, MEMBERS)
with open(MODEL) as file:
    assert sweep["description"] == file.read()
assert metadata.created_by == f"hamel {sweep['hamel']}"
assert json.loads(about["hamel.operations"])["accel"] > 0
print(f"{MEMBERS} members, {failed} of which fail, by Polars, DuckDB and pandas")
