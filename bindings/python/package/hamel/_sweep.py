"""Parameter sweeps: many runs of one system, on one machine or several."""

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
    """Run a system many times, and write a table of the results to a folder.

    The function is equivalent to the command `hamel sweep`. The table consists of Parquet files, which Polars, DuckDB
    and pandas read. If a sweep is interrupted, calling it again computes the missing runs.

    Parameters
    ----------
    description : str or path
        File of the description.
    vary : str
        Varied parameters and initial values, in the syntax of the command.
    out : str or path
        Folder of the table.
    until : float
        Length of each run (s).
    keep : str, optional
        Kept quantities, in the syntax of the command.
    shard : (int, int), optional
        ``(i, n)`` computes only part i of n, with 1 ≤ i ≤ n; all parts write to the same folder.
    **options
        Other options of the command, such as ``members=1000, seed=7, threads=4``.

    Raises
    ------
    HamelError
        If the sweep cannot be run. A run that fails is a row of the table.

    Examples
    --------
    Distribute the parts with Dask::

        futures = [client.submit(hamel.sweep, "top.eom", vary=..., out=..., until=10.0, shard=(i, 16))
                   for i in range(1, 17)]
    """
    if options.get("submit") is not None:
        raise HamelError("`submit` is an option of the command alone: use `hamel sweep --submit`")
    for name, text in {"vary": vary, "keep": keep}.items():
        if not isinstance(text, str | None):
            raise HamelError(f"`{name}` is a string in the syntax of the command, not {text!r}")
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
