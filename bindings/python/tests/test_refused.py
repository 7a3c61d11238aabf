"""Invalid arguments raise exceptions that name all errors, and never crash Python."""

import pickle

import numpy as np
import pytest

import hamel
from known import XI


@pytest.fixture
def cart(models):
    return hamel.System.from_file(models / "cart_pole.eom")


def test_arrays_of_any_layout_and_of_any_real_type(top):
    x = top.start().x
    expected = top.accel(x, XI)
    many = np.tile(XI, (8, 1))
    for found in (
        top.accel(np.tile(x, (16, 1))[::2], many[::-1]),
        top.accel(np.asfortranarray(np.tile(x, (8, 1))), np.asfortranarray(many)),
        top.accel(np.broadcast_to(x, (8, 9)), many),
        top.accel(x.astype(">f8"), many.astype(object)),
        top.accel(x.astype(np.float32), many.tolist()),
        top.accel(x.astype(int), many.astype(np.longdouble)),
    ):
        assert found.dtype == np.float64 and np.array_equal(found, np.tile(expected, (8, 1)))
    assert top.accel(np.zeros((5, 0, 9)), XI).shape == (5, 0, 3)
    assert top.mass_matrix(np.ones((0, 9))).shape == (0, 3, 3)
    assert np.isnan(top.accel(x, XI * np.nan)).all()
    end = top.step(np.zeros((0, 9)), np.zeros((0, 3)), h=0.1)
    assert [part.shape for part in end] == [(0, 9), (0, 3)]


def test_numbers_that_are_not_real_are_refused(top):
    x = top.start().x
    for wrong in (x.astype(complex), x.astype("datetime64[s]"), x.astype(str)):
        with pytest.raises(TypeError, match="`x` of accel.* needs real numbers, this array has the dtype"):
            top.accel(wrong, XI)
        with pytest.raises(TypeError, match="`x` needs real numbers"):
            top.step(wrong, XI, h=0.1)
    with pytest.raises(TypeError, match="`x` of accel.*needs real numbers"):
        top.accel("abc", XI)
    # NumPy would silently drop imaginary parts of lists, or convert None to NaN.
    for wrong in ([np.complex128(1 + 2j), 0, 1], [None, 0, 1], np.array([None, 0, 1]), np.array([1j, 0, 1], object), None):
        with pytest.raises(TypeError, match="`xi` of accel.* needs real numbers"):
            top.accel(x, wrong)
    with pytest.raises(ValueError, match="`xi` of accel.* has masked entries"):
        top.accel(x, np.ma.masked_array(XI, mask=[False, True, False]))
    assert np.array_equal(top.accel(x, np.ma.masked_array(XI)), top.accel(x, XI))
    with pytest.raises(TypeError, match="`x` of a state needs real numbers"):
        top.linearize(hamel.State(x * 1j, XI, [], top.parameter_values))
    with pytest.raises(hamel.HamelError, match=r"state.velocity.w: a number, a list"):
        top.state(velocity={"w": XI * 1j})


def test_all_arrays_that_are_wrong_are_named(top):
    with pytest.raises(ValueError, match=r"(?s)`x` of accel.*\[2\].*`xi` of accel.*\[1\]"):
        top.accel(np.zeros(2), np.zeros(1))
    with pytest.raises(TypeError, match="(?s)`x` of accel.*complex128.*without `xi`"):
        top.accel(np.zeros(9, complex))
    with pytest.raises(ValueError, match="(?s)`x` needs 9 entries.*`xi` needs 3 entries"):
        top.step(np.zeros(2), np.zeros(1), h=0.1)
    with pytest.raises(ValueError, match="(?s)`x` of a state needs 9 entries.*`xi` of a state needs 3 entries.*`parameters`"):
        top.simulate(0.1, at=hamel.State([1.0], [1.0, 2.0], [], []))


def test_results_that_are_too_large_leave_python_alive(top):
    x = top.start().x
    with pytest.raises(MemoryError, match=r"3 numbers at each state of an array of the shape \[1000000000000\]"):
        top.accel(np.broadcast_to(x, (10**12, 9)), XI)
    with pytest.raises(MemoryError):
        top.accel(np.broadcast_to(x, (2**40, 1, 9)), np.broadcast_to(XI, (2**40, 3)))
    with pytest.raises(MemoryError):
        top.step(np.broadcast_to(x, (10**12, 9)), XI, h=0.1)
    with pytest.raises(ValueError, match="at most 32 axes, this array has 61"):
        top.accel(np.ones((1,) * 60 + (9,)), XI)
    assert top.mass_matrix(np.ones((1,) * 31 + (9,))).shape == (1,) * 31 + (3, 3)


def test_what_a_run_cannot_be(top, cart):
    for options, why in (
        ({"at": 3}, "a dictionary of arguments of `System.state`"),
        ({"every": 2, "times": [0.05]}, "`every` and `times` were given"),
        ({"hold": True}, "requires a file of inputs"),
        ({"rate": 3.0}, "`rate` requires the method rk4"),
        ({"tol": 1e-6, "method": "rkmk4"}, "rkmk54 and rkmk8, which choose their steps"),
        ({"inputs": {"F": 1.0}}, "it has no inputs"),
        ({"inputs": 3}, "a dictionary, a function"),
        ({"events": ["w[1]"]}, "a dictionary is needed"),
        ({"events": {3: "w[1]"}}, "is a string, not 3"),
        ({"events": {"a": hamel.Event("w[1]", direction="up")}}, "is 1, -1 or 0"),
        ({"events": {"a": hamel.Event("w[1]", direction=np.nan)}}, "is 1, -1 or 0"),
        ({"events": {"a": "q[3]", "b": "w[1] +", "c": "zz"}}, r"(?s)called `q`.*expected.*called `zz`.*3 errors"),
    ):
        with pytest.raises(hamel.HamelError, match=why):
            top.simulate(0.1, **options)
    for value in (np.nan, np.inf, None):
        with pytest.raises(hamel.HamelError, match="the input `F` must be finite"):
            cart.simulate(0.1, inputs={"F": value})
    for given in (None, "a", [1.0, 2.0], [[1.0]]):
        with pytest.raises((TypeError, ValueError), match="the input function"):
            cart.simulate(0.1, inputs=lambda t, x, xi: given)
    with pytest.raises(TypeError, match="real numbers"):
        cart.simulate(0.1, inputs=lambda t, x, xi: np.array([1j]))
    for number in (None, XI):
        with pytest.raises(TypeError, match="the event `up` must return a number"):
            top.simulate(0.1, events={"up": lambda t, x, xi: number})
    for options, why in (
        ({"step": "0.1"}, "`step` is a number, '0.1' was given"),
        ({"tol": [1e-6]}, "`tol` is a number"),
        ({"spacing": 1j}, "`spacing` is a number"),
        ({"spacing": 1e-12}, "there would be 1e11 samples"),
        ({"every": 2.0}, "`every` is a number of steps, 1 or greater, 2.0 was given"),
        ({"method": None}, "`method` is the name of a method"),
        ({"rate": -1.0, "method": "rk4"}, "zero or greater"),
        ({"rate": np.nan, "method": "rk4"}, "zero or greater"),
    ):
        with pytest.raises(hamel.HamelError, match=why):
            top.simulate(0.1, **options)
    with pytest.raises(hamel.HamelError, match="`until` is a number"):
        top.simulate("soon")
    assert len(top.simulate(0.1, every=2**70).t) == 2
    with pytest.raises(KeyError, match="no `q` in this run: there are R, w"):
        top.simulate(0.1)["q"]


def test_a_run_that_failed_goes_to_other_processes(cart):
    with pytest.raises(hamel.RunError) as failed:
        cart.simulate(0.1, inputs=lambda t, x, xi: np.nan)
    again = pickle.loads(pickle.dumps(failed.value))
    assert str(again) == str(failed.value) and np.array_equal(again.run.x, failed.value.run.x)


def test_what_a_sweep_cannot_be(models, tmp_path):
    def sweep(**options):
        hamel.sweep(models / "heavy_top.eom", **{"vary": "m = normal(1, 0.1)", "out": tmp_path / "runs", "until": 0.1, **options})

    for options, why in (
        ({"vary": 3}, "`vary` is a string"),
        ({"members": 2, "keep": ["end"]}, "`keep` is a string"),
        ({"members": 2, "shard": 3}, r"`shard` is \(i, n\)"),
        ({"members": 2, "shard": (3, 2)}, "1 ≤ i ≤ N"),
        ({"members": -2}, "a whole number from 1"),
        ({"members": 2.5}, "a whole number from 1"),
        ({"members": 2, "seed": -1}, "a whole number from 0"),
        ({"members": 2, "until": "soon"}, "invalid value 'soon'"),
        ({"members": 2, "keep": "max(q)", "vary": "n = normal(1, -1)"}, "(?s)called `q`.*called `n`"),
    ):
        with pytest.raises(hamel.HamelError, match=why):
            sweep(**options)
        assert not (tmp_path / "runs").exists()
    # NumPy scalars are accepted as numbers.
    sweep(members=np.int64(2), until=np.float64(0.1), step=np.float64(0.05), seed=np.uint8(3))
    assert (tmp_path / "runs" / "shard-000000.parquet").exists()
