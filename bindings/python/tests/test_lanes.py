"""Functions of many states, computed two at a time: equal to the bit to calls with single states."""

import numpy as np
import pytest

import hamel

# Number of states from which code for two states at a time is compiled.
MANY = 1 << 15

BEAD = """
system Bead {
    param m = 1;
    coord q;
    velocity w;
    rate q = w;
    kinetic m * (1 - q) * w^2 / 2;
    potential m * sin(q);
}
"""


def one_by_one(function, *arrays, **options):
    """Calls with single states, which always use the code for one state."""
    return np.array([function(*row, **options) for row in zip(*arrays)])


def same(a, b):
    return np.array_equal(np.asarray(a).view(np.uint64), np.asarray(b).view(np.uint64))


def moved(system, count):
    """States on the configuration manifold."""
    random = np.random.default_rng(5)
    x = np.repeat(system.start().x[None], count, 0)
    return system.step(x, random.normal(size=(count, len(system.velocities))), h=0.3, method="rkmk4")


@pytest.mark.parametrize("model", ["heavy_top", "double_pendulum_angles", "rolling_disk", "drone"])
def test_many_states_are_each_alone(models, model):
    system = hamel.System.from_file(models / f"{model}.eom")
    x, xi = moved(system, 1001)
    u = np.random.default_rng(6).normal(size=(len(x), len(system.inputs)))
    alone = one_by_one(system.accel, x, xi, u)
    masses = one_by_one(system.mass_matrix, x)
    # Repeated until code for two states is compiled, an odd number in total.
    repeated = [np.tile(array, (MANY // len(x) + 1, 1)) for array in (x, xi, u)]
    assert len(repeated[0]) % 2 == 1
    many = system.accel(*repeated).reshape(-1, *alone.shape)
    assert all(same(part, alone) for part in many)
    system.mass_matrix(repeated[0])
    assert same(system.mass_matrix(x), masses)
    # From now on small numbers of states use it, too: even, odd, one, none.
    for count in (1000, 7, 2, 1, 0):
        assert same(system.accel(x[:count], xi[:count], u[:count]), alone[:count])
    # Several axes, with broadcasting, and in column-major order.
    x, xi, u = x[:15].reshape(3, 5, -1), xi[:5], u[0]
    expected = [[system.accel(x[i, j], xi[j], u) for j in range(5)] for i in range(3)]
    assert same(system.accel(x, xi, u), np.array(expected))
    assert same(system.accel(np.asfortranarray(x), xi, u), np.array(expected))


def test_parameters_of_each_state(models):
    system = hamel.System.from_file(models / "heavy_top.eom")
    x, xi = moved(system, 301)
    parameters = system.parameter_values * np.random.default_rng(7).uniform(0.9, 1.1, size=(len(x), 1))
    system.accel(np.tile(x, (MANY // len(x) + 1, 1)), xi[0])
    alone = [system.accel(*row[:2], parameters=row[2]) for row in zip(x, xi, parameters)]
    assert same(system.accel(x, xi, parameters=parameters), np.array(alone))


@pytest.mark.parametrize("places", [[0], [1], [6], [0, 1], [1, 2], [0, 3, 4, 6], list(range(7)), []])
def test_states_without_a_value_are_told_one_by_one(places):
    """M is not positive definite where q >= 1; all other states have the same results as alone."""
    system = hamel.System.from_text(BEAD)
    system.accel(np.zeros((MANY, 1)), [0.0])
    q = np.linspace(-1.0, 0.5, 7)[:, None]
    w = np.linspace(1.0, 2.0, 7)[:, None]
    expected = one_by_one(system.accel, q, w)
    q[places] = 1.5
    expected[places] = np.nan
    assert np.array_equal(system.accel(q, w, singular="nan"), expected, equal_nan=True)
    if places:
        with pytest.raises(hamel.SingularError, match=rf"`w`.*index \[{places[0]}\]"):
            system.accel(q, w)
    else:
        assert same(system.accel(q, w), expected)


def test_states_that_code_leaves_to_the_interpreter(models):
    """Sines beyond a million radians are left to the interpreter: for one state of a pair, or for both."""
    system = hamel.System.from_file(models / "double_pendulum_angles.eom")
    x, xi = moved(system, MANY)
    system.accel(x, xi)
    x, xi = x[:9], xi[:9]
    x[[1, 4, 5, 8], 0] += 1e7
    assert same(system.accel(x, xi), one_by_one(system.accel, x, xi))
