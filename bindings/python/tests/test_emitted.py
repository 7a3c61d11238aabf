"""`hamel emit --language python`: modules of all models against compiled functions, on arrays of states."""

import ast
import importlib.util
import inspect
import keyword
from pathlib import Path

import numpy as np
import pytest

import hamel
from hamel import _hamel

MODELS = Path(__file__).parents[3] / "tests" / "models"
# Functions in Rust have no Python.
PATHS = sorted(path for path in MODELS.rglob("*.eom") if path.parent.name != "external" and "system " in path.read_text())
STATES = 4

# Everything that a module of arrays has to have.
NEEDED = {
    "abs", "arctan2", "asarray", "broadcast_shapes", "broadcast_to", "cos", "cosh", "exp", "expm1", "fabs", "finfo", "log",
    "log1p", "moveaxis", "reshape", "result_type", "shape", "sign", "sin", "sinh", "sqrt", "stack", "tanh", "where", "zeros",
}  # fmt: skip


class Recorded:
    """NumPy, with the names of what is used of it."""

    def __init__(self):
        self.used = set()

    def __getattr__(self, name):
        self.used.add(name)
        return getattr(np, name)


def emitted(path, folder):
    """Emit a description, and import the module."""
    out = folder / f"{path.stem}_emitted.py"
    assert _hamel.command(["hamel", "emit", "--language", "python", str(path), "-o", str(out)]) == 0
    spec = importlib.util.spec_from_file_location(out.stem, out)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return out.read_text(), module


def the_class(module):
    (found,) = [value for value in vars(module).values() if inspect.isclass(value) and value.__module__ == module.__name__]
    return found


def points(system, seed):
    """Arrays near the start, one state along each row."""
    random = np.random.default_rng(seed)
    start = system.start()
    n = len(start.xi)
    near = lambda given: given + 0.05 * random.standard_normal((STATES, len(given)))
    given = {"x": near(start.x), "xi": near(start.xi), "u": near(start.u)}
    given["xi_dot"] = near(np.zeros(n))
    return given


@pytest.mark.parametrize("path", PATHS, ids=lambda path: path.stem)
def test_functions_of_arrays_agree_with_compiled_ones(path, tmp_path):
    system = hamel.System.from_file(path)
    text, module = emitted(path, tmp_path)
    assert emitted(path, tmp_path)[0] == text
    imports = [node for node in ast.walk(ast.parse(text)) if isinstance(node, (ast.Import, ast.ImportFrom))]
    assert {alias.name for node in imports for alias in node.names} == {"math", "numpy"}
    recorded = Recorded()
    own = the_class(module)(xp=recorded)
    given = points(system, sum(map(ord, path.stem)))
    compared = 0
    for name in system.functions:
        method = getattr(own, f"{name}_" if keyword.iskeyword(name) else name, None)
        # Functions that the description does not request are compiled on demand, and are not in the module.
        if method is None:
            continue
        compiled = system.function(name)
        if "p" in compiled.arguments:
            # One momentum for each velocity, none for states of first order.
            mass = system.function("mass_matrix")
            n = len(mass(*[given[argument][0] for argument in mass.arguments]))
            given["p"] = given["xi"][:, :n]
        arguments = [given[argument] for argument in compiled.arguments]
        with np.errstate(all="ignore"):
            found = method(*arguments)
        for row in range(STATES):
            one = [argument[row] for argument in arguments]
            try:
                expected = compiled(*one)
            except hamel.SingularError:
                assert np.isnan(found[row]).all()
                continue
            scale = 1.0 + np.nanmax(np.abs(expected), initial=0.0)
            assert found.shape == (*((STATES,) if arguments else ()), *np.shape(expected)), name
            value = found[row] if arguments else found
            assert np.allclose(value, expected, rtol=0, atol=1e-9 * scale, equal_nan=True), name
            compared += 1
        with np.errstate(all="ignore"):
            assert np.array_equal(method(*[a[0] for a in arguments]), found[0] if arguments else found, equal_nan=True)
    assert compared > 0
    assert recorded.used <= NEEDED, recorded.used - NEEDED


def test_arguments_and_parameters_broadcast(tmp_path):
    _, module = emitted(MODELS / "cart_pole.eom", tmp_path)
    own = the_class(module)
    x, xi = np.zeros((3, 1, 2)), np.zeros(2)
    forces = np.linspace(-1, 1, 5)[:, None]
    assert own().accel(x, xi, forces).shape == (3, 5, 2)
    masses = np.array([1.0, 2.0, 4.0])
    heavy = own(mc=masses).accel(np.zeros(2), xi, [1.0])
    alone = [own(mc=mass).accel(np.zeros(2), xi, [1.0]) for mass in masses]
    assert heavy.shape == (3, 2) and np.allclose(heavy, alone, rtol=1e-14)


def test_wrong_arguments_say_what_is_needed(tmp_path):
    _, module = emitted(MODELS / "cart_pole.eom", tmp_path)
    own = the_class(module)
    with pytest.raises(ValueError, match=r"`x` needs 2 numbers along its last axis, but its shape is \(3,\)"):
        own().accel(np.zeros(3), np.zeros(2), np.zeros(1))
    with pytest.raises(TypeError, match="unexpected keyword argument 'mass'"):
        own(mass=1.0)


def test_functions_in_rust_are_refused(capfd):
    assert _hamel.command(["hamel", "emit", "--language", "python", str(MODELS / "external" / "glider.eom")]) != 0
    assert "Python cannot call a function that is given in Rust" in capfd.readouterr().err
