"""Fixtures: folders of descriptions and robots, a pendulum, a heavy top."""

import os
from pathlib import Path

import pytest
from known import PENDULUM

import hamel

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def models() -> Path:
    return ROOT / "tests" / "models"


@pytest.fixture
def reference() -> Path:
    return ROOT / "tests" / "reference"


@pytest.fixture
def robots() -> Path:
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    found = list(target.glob("robots/**/example-robot-data/robots"))
    assert found, "run tests/robots/install.sh"
    return found[0]


@pytest.fixture
def top(models):
    return hamel.System.from_file(models / "heavy_top.eom")


@pytest.fixture
def pendulum():
    return hamel.System.from_text(PENDULUM)
