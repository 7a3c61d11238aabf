"""The Python programs in the documentation run unchanged."""

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hamel
from hamel import _hamel

ROOT = Path(__file__).resolve().parents[3]

# A thrown ball in place of the chapter's leg: it has a frame `foot` and a velocity `v`.
LEG = """
system Leg {
    coord r: R3;
    velocity v: vec3;
    rate r = v;
    frame foot = pose([[1, 0, 0], [0, 1, 0], [0, 0, 1]], r);
    body on foot { mass 1; }
    gravity [0, 0, -9.81];
    start r = [0, 0, 0.5];
    start v = [0.2, 0, 1];
}
"""


def programs(page: str) -> list[str]:
    text = (ROOT / page).read_text()
    return [rest.split("```", 1)[0] for rest in text.split("```python\n")[1:]]


@pytest.fixture
def names(tmp_path: Path, models: Path, robots: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Names and files that the programs use: robots, a state of a UR5, and a leg."""
    shutil.copy(robots / "ur_description" / "urdf" / "ur5_robot.urdf", tmp_path)
    shutil.copy(models / "heavy_top.eom", tmp_path)
    monkeypatch.chdir(tmp_path)
    x, xi, u = np.random.default_rng(1).uniform(-1, 1, (3, 6))
    return {"hamel": hamel, "x": x, "xi": xi, "u": u, "leg": hamel.System.from_text(LEG)}


@pytest.mark.parametrize("page, count", [("README.md", 1), ("bindings/python/README.md", 1), ("docs/book/src/python.md", 4)])
def test_they_run(page: str, count: int, names: dict[str, Any]):
    found = programs(page)
    assert len(found) == count
    for program in found:
        exec(compile(program, page, "exec"), names)
    assert names["xi_dot"].shape == (6,)


def test_an_emitted_module(names: dict[str, Any], tmp_path: Path, models: Path, monkeypatch: pytest.MonkeyPatch):
    out = tmp_path / "cart_pole.py"
    assert _hamel.command(["hamel", "emit", "--language", "python", str(models / "cart_pole.eom"), "-o", str(out)]) == 0
    monkeypatch.syspath_prepend(tmp_path)
    [program] = programs("docs/book/src/front-ends.md")
    exec(compile(program, "front-ends.md", "exec"), names)
    assert names["xi_dot"].shape == (20, 2)


def test_what_the_chapter_says_of_its_events(names: dict[str, Any]):
    [events] = [program for program in programs("docs/book/src/python.md") if "touchdown" in program]
    exec(compile(events, "events", "exec"), names)
    run = names["run"]
    assert run.stopped_by == "touchdown"
    # Thrown upwards at 1 m/s from half a metre.
    assert np.allclose(run.events["apex"].t, 1 / 9.81)
    assert np.isclose(run.t[-1], (1 + np.sqrt(1 + 9.81)) / 9.81)
