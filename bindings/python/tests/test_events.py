"""Events of runs: compared with SciPy, and with conservation laws at the events."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hamel
from known import heavy_top_rates

# Adaptive steps, and equal steps of methods whose error is as small.
STEPPINGS = [{"tol": 1e-12}, {"method": "rkmk8", "step": 0.01}, {"method": "gauss6", "step": 0.005}]


def solved(rates, start, until, events):
    return solve_ivp(rates, (0.0, until), start, method="DOP853", rtol=1e-13, atol=1e-13, events=events, max_step=0.02)


def event(of, direction=0, terminal=False):
    """An event function for SciPy's `solve_ivp`."""

    def function(t, y):
        return of(t, y)

    function.direction, function.terminal = direction, terminal
    return function


@pytest.mark.parametrize("stepping", STEPPINGS)
@pytest.mark.parametrize("direction", [-1, 0, 1])
def test_a_pendulum_as_scipy_has_it(pendulum, stepping, direction):
    def rates(_, y):
        return [y[1], -9.81 / 0.5 * np.sin(y[0])]

    wanted = [
        event(lambda t, y: y[0], direction),
        event(lambda t, y: y[1], direction),
        event(lambda t, y: -0.5 * np.cos(y[0]) + 0.45, direction),
        event(lambda t, y: t - 1.25, direction),
    ]
    expected = solved(rates, [0.7, 0.0], 5.0, wanted)
    events = {
        "lowest": hamel.Event("q", direction),
        "turns": hamel.Event("w", direction),
        "height": hamel.Event("height + 0.45", direction),
        "time": hamel.Event(lambda t, x, xi: t - 1.25, direction),
    }
    run = pendulum.simulate(5.0, events=events, **stepping)
    assert run.stopped_by is None and run.t[-1] == 5.0
    for (name, found), t, y in zip(run.events.items(), expected.t_events, expected.y_events):
        # SciPy reports the zero of w at the start.
        t, y = (t[1:], y[1:]) if name == "turns" and t[0] == 0.0 else (t, y)
        assert len(found) == len(t) and len(t) > 0 or direction == -1 and name == "time", (name, found.t, t)
        assert np.abs(found.t - t).max(initial=0.0) < 1e-9, name
        both = np.hstack([found.x, found.xi])
        assert np.abs(both - y.reshape(both.shape)).max(initial=0.0) < 1e-8, name
    assert list(run.outputs) == ["height"]


@pytest.mark.parametrize("method", ["rkmk8", "rkmk4", "auto"])
def test_a_heavy_top_as_scipy_has_it(models, method):
    """The run ends when `x[0]`, an entry of R, first changes its sign."""
    start = [*np.eye(3).ravel(), 0.3, 0.2, 5.0]
    wanted = [event(lambda t, y: y[0], terminal=True), event(lambda t, y: y[10])]
    expected = solved(heavy_top_rates, start, 5.0, wanted)
    system = hamel.System.from_file(models / "heavy_top.eom")
    # A function with the attributes that SciPy uses.
    def first(t, x, xi):
        return x[0]

    first.terminal = True
    run = system.simulate(5.0, method=method, step=1e-3, events={"first": first, "spin": "w[2]"})
    assert run.stopped_by == "first" and len(run.events["first"]) == 1
    assert abs(run.t[-1] - expected.t[-1]) < 1e-8
    assert run.t[-1] == run.events["first"].t[0] and np.array_equal(run.x[-1], run.events["first"].x[0])
    assert np.array_equal(run.xi[-1], run.events["first"].xi[0])
    assert np.abs(np.hstack([run.x[-1], run.xi[-1]]) - expected.y[:, -1]).max() < 1e-7
    assert (run.t < 5.0).all() and np.all(np.diff(run.t) > 0)
    assert np.abs(run.events["spin"].t - expected.t_events[1]).max(initial=0.0) < 1e-8
    rotation = run.x[-1].reshape(3, 3)
    assert np.abs(rotation @ rotation.T - np.eye(3)).max() < 1e-14


@pytest.mark.parametrize("stepping", STEPPINGS)
def test_laws_at_crossings(pendulum, stepping):
    """At crossings the energy is that of the start, and the reversed motion returns to it; crossings are periodic."""
    run = pendulum.simulate(6.0, events={"lowest": "q", "rest": hamel.Event("w", 1)}, **stepping)
    lowest = run.events["lowest"]
    energy = pendulum.energy(lowest.x, lowest.xi)
    assert np.abs(energy - run.energy[0]).max() < 1e-9
    # The speed that follows from the height by energy.
    assert np.allclose(np.abs(lowest.xi), np.sqrt(2 * 9.81 / 0.5 * (1 - np.cos(0.7))), rtol=1e-9)
    periods = np.diff(lowest.t[::2])
    assert len(periods) > 2 and np.ptp(periods) < 1e-8
    assert np.allclose(np.diff(run.events["rest"].t), periods[0], atol=1e-8)
    for t, x, xi in zip(lowest.t, lowest.x, lowest.xi):
        back = hamel.State(x, -xi, np.zeros(1), pendulum.parameter_values)
        there = pendulum.simulate(t, at=back, **stepping)
        assert abs(there["q"][-1] - 0.7) < 1e-8 and abs(there["w"][-1]) < 1e-7


@pytest.mark.parametrize("options", [{"tol": 1e-9}, {"step": 1e-2, "method": "rkmk4"}, {"step": 1e-2, "method": "gauss4"}])
def test_events_that_end_nothing_change_nothing(pendulum, options):
    plain = pendulum.simulate(3.0, **options)
    run = pendulum.simulate(3.0, events={"a": "q", "b": hamel.Event(lambda t, x, xi: xi[0])}, **options)
    for name in ("t", "x", "xi", "energy"):
        assert np.array_equal(getattr(plain, name), getattr(run, name)), name
    assert run.steps == plain.steps


@pytest.mark.parametrize("options", [{"tol": 1e-10}, {"step": 1e-2, "method": "rkmk8"}])
def test_runs_end_at_the_first_terminal_event(pendulum, options):
    events = {
        "later": hamel.Event(lambda t, x, xi: t - 0.505, terminal=True),
        "before": hamel.Event(lambda t, x, xi: t - 0.501),
        "first": hamel.Event(lambda t, x, xi: t - 0.503, terminal=True),
        "behind": hamel.Event(lambda t, x, xi: t - 0.507),
    }
    run = pendulum.simulate(1.0, events=events, **options)
    # Equal steps have all of them within one step.
    assert run.stopped_by == "first"
    assert abs(run.t[-1] - 0.503) < 1e-14
    assert {name: len(found) for name, found in run.events.items()} == {"later": 0, "before": 1, "first": 1, "behind": 0}
    # Requested samples end there, too.
    sampled = pendulum.simulate(1.0, events=events, times=[0.25, 0.5, 0.502, 0.504, 0.9], **options)
    assert list(sampled.t)[:2] == [0.25, 0.5] and (sampled.t <= 0.503).all()
    # The next run begins where the first one stopped: a zero at the start is not an event.
    stopped = pendulum.simulate(2.0, events={"low": hamel.Event("q", terminal=True)}, **options)
    state = hamel.State(stopped.x[-1] * 0.0, stopped.xi[-1], np.zeros(1), pendulum.parameter_values)
    again = pendulum.simulate(2.0, at=state, events={"low": hamel.Event("q", terminal=True)}, **options)
    assert 0.5 < again.t[-1] < 1.0


def test_events_of_runs_with_inputs(pendulum, tmp_path):
    """With inputs that jump, a run after the jump is the same as one that starts there."""
    (tmp_path / "push.csv").write_text("t,tau\n0,0\n0.1,3\n")
    held = hamel.Event("q - 0.2", direction=-1, terminal=True)
    for options in [{"method": "rkmk8", "step": 0.01}, {"tol": 1e-12}]:
        run = pendulum.simulate(2.0, inputs=tmp_path / "push.csv", hold=True, events={"q": held}, **options)
        before = pendulum.simulate(0.1, **options)
        state = hamel.State(before.x[-1], before.xi[-1], np.zeros(1), pendulum.parameter_values)
        for inputs in [{"tau": 3.0}, {"tau": "3"}, lambda t, x, xi: [3.0]]:
            behind = pendulum.simulate(2.0, at=state, inputs=inputs, events={"q": held}, **options)
            assert abs(run.t[-1] - 0.1 - behind.t[-1]) < 1e-10
        free = pendulum.simulate(2.0, events={"q": held}, **options)
        assert run.t[-1] > free.t[-1] + 1e-3


def test_events_of_robots_know_frames(robots):
    arm = hamel.System.from_urdf(robots / "ur_description/urdf/ur5_robot.urdf")
    frame = next(name for name in arm.frames if "wrist_3" in name)
    height = arm.function(f"{frame}_pose")(arm.start().x)
    assert np.ndim(height) >= 1
    event = hamel.Event(f"{frame}.p[3] + 0.1", direction=-1, terminal=True)
    run = arm.simulate(2.0, tol=1e-9, events={"low": event})
    assert run.stopped_by == "low" and 0.0 < run.t[-1] < 2.0


def test_wrong_events_are_told(pendulum):
    for events, why in [
        ({"a": "q +"}, "expected"),
        ({"a": "q", "b": "speed"}, "speed"),
        ({"a": "[q, w]"}, "one number"),
        ({"a": "q; w"}, "one expression"),
        ({"a": ""}, "expected an expression"),
        ({"a": "(q"}, "missing"),
        ({"a": 3.0}, "an expression or a function"),
        ({"a": hamel.Event("q", terminal=2)}, "True or False"),
    ]:
        with pytest.raises(hamel.HamelError, match=why) as wrong:
            pendulum.simulate(1.0, events=events)
        assert "hamel_keep" not in str(wrong.value)
    # The message shows the place within the list of all events.
    with pytest.raises(hamel.HamelError) as wrong:
        pendulum.simulate(1.0, events={"a": "q - 1", "b": "q - spead"})
    assert "q - 1; q - spead" in str(wrong.value) and "^^^^^" in str(wrong.value)


@pytest.mark.parametrize("options", [{"tol": 1e-9}, {"step": 1e-2, "method": "rkmk4"}])
def test_functions_without_a_value(pendulum, options):
    class Broken(Exception):
        pass

    def broken(t, x, xi):
        if t > 0.5:
            raise Broken("at half of the time")
        return 1.0

    with pytest.raises(Broken, match="half"):
        pendulum.simulate(1.0, events={"a": broken}, **options)
    nan = lambda t, x, xi: float("nan") if t > 0.5 else 1.0
    with pytest.raises(hamel.RunError, match="the event `a` has no value there") as failed:
        pendulum.simulate(1.0, events={"a": nan}, **options)
    assert 0.4 < failed.value.run.t[-1] < 1.0
    with pytest.raises(TypeError):
        pendulum.simulate(1.0, events={"a": lambda t, x, xi: "far"}, **options)
