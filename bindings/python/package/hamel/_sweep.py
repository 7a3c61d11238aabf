"""Many runs of one system, here or on many machines."""

from __future__ import annotations

import os
from typing import Any

from ._hamel import HamelError, asked


def sweep(
    description: str | os.PathLike[str],
    *,
    vary: str,
    out: str | os.PathLike[str],
    until: float,
    keep: str | None = None,
    shard: tuple[int, int] | None = None,
    **options: Any,
) -> None:
    """Runs a system many times and writes a table of the runs into a folder, as `hamel sweep` does.

    `vary` and `keep` are written as for the command, and so are the other options: ``members=1000, seed=7, threads=4``.
    ``shard=(i, n)`` computes the i-th of n parts and no other, so that any engine can distribute the parts, Dask's for one::

        futures = [client.submit(hamel.sweep, "top.eom", vary=..., out=..., until=10.0, shard=(i, 16))
                   for i in range(1, 17)]

    All parts write files of Parquet into the same folder; read them with Polars, DuckDB or pandas. A part that was interrupted
    computes what is missing when it runs again.

    Raises HamelError where the sweep cannot be run; runs that fail are rows of the table.
    """
    if options.get("submit") is not None:
        raise HamelError("tasks of an engine are commands: submit them with `hamel sweep --submit`")
    for name, text in {"vary": vary, "keep": keep}.items():
        if not isinstance(text, str | None):
            raise HamelError(f"`{name}` is a text, written as for the command, not {text!r}")
    words = ["hamel", "sweep", os.fspath(description), "--vary", vary, "--out", os.fspath(out), "--until", str(until)]
    if keep is not None:
        words += ["--keep", keep]
    if shard is not None:
        if not isinstance(shard, tuple | list) or len(shard) != 2:
            raise HamelError(f"`shard` is (i, n) with 1 ≤ i ≤ n, as in (3, 16), not {shard!r}")
        words += ["--shard", f"{shard[0]}/{shard[1]}"]
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if value is True:
            words.append(option)
        elif value is not None and value is not False:
            words += [option, os.fspath(value) if isinstance(value, os.PathLike) else str(value)]
    asked(words)
