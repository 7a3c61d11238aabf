"""Functions and runs of random mechanisms against d'Alembert's principle, computed with 80 digits by `lab/dalembert`.

Functions are called with one state, and with many in arrays of unusual layouts. Runs are compared with SciPy's."""

import sys
import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hamel
from conftest import ROOT

sys.path.insert(0, str(ROOT / "lab" / "dalembert"))
pytest.importorskip("mpmath")

from dalembert import attack  # noqa: E402
from dalembert.compare import Comparison, Errors  # noqa: E402
from dalembert.doors import Doors  # noqa: E402

LENGTH = 0.05


def layouts(rows):
    """The same numbers in arrays of other layouts and types."""
    spread = np.zeros((len(rows), 2 * rows.shape[1] + 1))
    spread[:, 1::2] = rows
    packed = np.zeros(len(rows), dtype=[("flag", "i1"), ("row", "f8", rows.shape[1:])])
    packed["row"] = rows
    return [np.asfortranarray(rows), rows[::-1].copy()[::-1], spread[:, 1::2], packed["row"], rows.tolist(), rows.astype(object)]


class Package:
    """Adapter that gives the functions of a system the interface of generated C in the comparison."""

    def __init__(self, system):
        self.system = system
        self.random = np.random.default_rng(1)
        self.parameters = system.parameter_values
        self.calls = 0

    def set(self, values):
        self.parameters = np.array([float(value) for value in values])[: len(self.parameters)]

    def __contains__(self, name):
        # The comparison supports regressors only for trees of bodies.
        return name != "regressor" and hasattr(self.system, name) or name == "set_parameters" and len(self.parameters) > 0

    def call(self, name, count, **given):
        function = self.system.function(name)
        given.setdefault("p", given.get("momentum", []))
        arrays = [np.array(given.get(argument, []), dtype=float) for argument in function.arguments]
        one = function(*arrays, parameters=self.parameters)
        self.calls += 1
        near = [np.tile(array, (6, 1)) + 1e-3 * self.random.normal(size=(6, len(array))) for array in arrays]
        place = int(self.random.integers(6))
        for rows, array in zip(near, arrays):
            rows[place] = array
        if arrays:
            odd = [layouts(rows)[self.random.integers(6)] if rows.size else rows for rows in near]
            many = function(*odd, parameters=self.parameters, singular="nan")
            each = [function(*state, parameters=self.parameters, singular="nan") for state in zip(*near)]
            assert np.array_equal(many, each, equal_nan=True) and np.array_equal(many[place], one, equal_nan=True), name
        flat = np.ravel(one).tolist()
        assert len(flat) == count, name
        return flat


class Asked(Doors):
    """Adapter that gives `evaluate` and `linearize` the interface of the command line in the comparison."""

    def eval(self, state=None):
        said = self.system.evaluate(state)
        return {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in said.items()}

    def linearize(self, state, full=True):
        found = self.system.linearize(state, full=full)
        return {"A": found.A.tolist(), "B": found.B.tolist(), "states": found.states}


@pytest.mark.parametrize("kind, seed", [("trees", 6003), ("loops", 6009), ("written", 6003), ("driven", 6003), ("spoken", 6003)])
def test_a_random_mechanism(tmp_path, kind, seed):
    made = attack.ASKED[kind](seed, 3, False)
    doors, errors = Asked("", str(tmp_path)), Errors()
    doors.write(made.m.text())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        system = doors.system = hamel.System.from_file(doors.file)
    package = Package(system)
    comparison = Comparison(made.m, doors, errors, f"{kind} {seed}")
    comparison.run(made.state, c=package, kind="")
    assert errors.found == [] and package.calls > 20

    # The functions are verified above, so runs can be checked against them.
    state = system.state(**comparison.state(comparison.d.held(made.state)))
    given = {"u": state.u}

    def rates(t, y):
        given["x"], given["xi"] = np.split(y, [len(state.x)])
        functions = (system.rate, system.accel)
        return np.concatenate([f(*[given[name] for name in f.arguments], parameters=state.parameters) for f in functions])

    start = np.concatenate([state.x, state.xi])
    solved = solve_ivp(rates, (0.0, LENGTH), start, method="DOP853", rtol=1e-12, atol=1e-12)
    end = solved.y[:, -1]
    for options in ({"method": "rkmk8", "step": LENGTH / 100}, {"method": "rkmk54", "tol": 1e-11}):
        run = system.simulate(LENGTH, at=state, **options)
        assert np.abs(np.concatenate([run.x[-1], run.xi[-1]]) - end).max() < 1e-8 * (1 + np.abs(end).max()), options
