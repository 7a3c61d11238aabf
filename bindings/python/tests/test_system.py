"""Functions of arrays, states, runs, derivatives, tables, controllers and errors."""

import json
import multiprocessing
import pickle
import re
import subprocess
import sys
import threading

import numpy as np
import pytest

import hamel
from known import PENDULUM

def random_states(system, count, seed=1):
    """States on the configuration manifold, after short runs from random velocities."""
    random = np.random.default_rng(seed)
    x, xi = np.array(system.start().x), random.normal(size=(count, len(system.velocities)))
    x = np.repeat(x[None], count, 0)
    for _ in range(3):
        x, xi = system.step(x, xi, h=0.1, method="rkmk4")
    return x, xi


def test_formula_of_a_pendulum(pendulum):
    q, w, tau = np.random.default_rng(3).normal(size=(3, 1000, 1))
    found = pendulum.accel(q, w, tau)
    assert found.shape == (1000, 1)
    expected = tau / (2 * 0.5**2) - 9.81 / 0.5 * np.sin(q)
    assert np.abs(found - expected).max() < 1e-13 * np.abs(expected).max()
    assert np.allclose(pendulum.height(q), -0.5 * np.cos(q)[:, 0], rtol=1e-15)


def test_arrays_are_repeated_along_axes_that_they_do_not_have(pendulum):
    q = np.linspace(-1, 1, 15).reshape(3, 5, 1)
    w = np.array([0.1])
    tau = np.arange(5.0).reshape(5, 1)
    many = pendulum.accel(q, w, tau)
    assert many.shape == (3, 5, 1)
    for i in range(3):
        for j in range(5):
            assert many[i, j] == pendulum.accel(q[i, j], w, tau[j])
    # Other layouts and types.
    assert np.array_equal(many.transpose(1, 0, 2), pendulum.accel(q.transpose(1, 0, 2), w, tau[:, None]))
    assert np.array_equal(pendulum.accel(q[::2], w, tau), many[::2])
    assert pendulum.accel([0], [0], [1]) == pendulum.accel(0.0, 0.0, 1.0)
    # A scalar for one state, and an array for many.
    assert isinstance(pendulum.energy([0.0], [1.0]), float)
    assert pendulum.energy(q, w).shape == (3, 5)
    assert pendulum.accel(np.zeros((0, 1)), w, [0.0]).shape == (0, 1)


def test_arguments_by_name(pendulum):
    assert pendulum.accel.arguments == ["x", "xi", "u"]
    assert pendulum.accel.shape == (1,)
    assert pendulum.accel([0.3], u=[1.0], xi=[0.0]) == pendulum.accel([0.3], [0.0], [1.0])
    assert "Forward dynamics" in pendulum.accel.__doc__
    with pytest.raises(TypeError, match=r"without `u` \(length 1\)"):
        pendulum.accel([0.3], [0.0])
    with pytest.raises(TypeError, match="takes no `v`"):
        pendulum.accel([0.3], [0.0], v=[1.0])
    with pytest.raises(TypeError, match="got `x` twice"):
        pendulum.accel([0.3], [0.0], x=[1.0])
    with pytest.raises(TypeError, match="called with 4 arrays"):
        pendulum.accel([0.3], [0.0], [0.0], [0.0])
    with pytest.raises(ValueError, match="1 entries along its last axis"):
        pendulum.accel([0.3, 0.1], [0.0], [0.0])
    with pytest.raises(ValueError, match="cannot be broadcast together"):
        pendulum.accel(np.zeros((3, 1)), np.zeros((4, 1)), [0.0])
    with pytest.raises(AttributeError, match="no function `acel`"):
        pendulum.acel  # noqa: B018
    with pytest.raises(hamel.HamelError, match="did you mean `accel`"):
        pendulum.function("acel")
    assert "accel" in dir(pendulum)


def test_parameters(pendulum):
    longer = pendulum.with_parameters(l=2.0)
    assert list(pendulum.parameters) == ["m", "l", "g"]
    assert list(longer.parameter_values) == [2.0, 2.0, 9.81]
    assert list(pendulum.parameter_values) == [2.0, 0.5, 9.81]
    lengths = np.array([[2.0, 0.5, 9.81], [2.0, 2.0, 9.81]])
    both = pendulum.accel([0.3], [0.0], [1.0], parameters=lengths)
    assert both[0] == pendulum.accel([0.3], [0.0], [1.0])
    assert both[1] == longer.accel([0.3], [0.0], [1.0])
    assert longer.state(coord={"q": 0.1}).parameters[1] == 2.0
    again = longer.with_parameters(m=1.0)
    assert list(again.parameter_values) == [1.0, 2.0, 9.81]
    with pytest.raises(hamel.HamelError, match="param"):
        pendulum.with_parameters(length=1.0)


def test_singular_states(models):
    system = hamel.System.from_text(
        "system S { param m = 1; coord q; velocity w; rate q = w; particle mass m at [q^2 / 2, 0, 0]; start q = 1; }"
    )
    q, w = np.array([[1.0], [0.0], [2.0]]), np.array([1.0])
    with pytest.raises(hamel.SingularError, match=r"`w`.*index \[1\]"):
        system.accel(q, w)
    found = system.accel(q, w, singular="nan")
    assert np.isnan(found[1]) and np.isfinite(found[[0, 2]]).all()
    with pytest.raises(hamel.SingularError):
        system.accel([1.0], w, parameters=[0.0])
    with pytest.raises(ValueError, match="singular"):
        system.accel([1.0], w, singular="ignore")


@pytest.mark.parametrize("model", ["heavy_top", "rolling_disk", "sleigh", "free_body", "spherical_bob"])
def test_power_and_momentum(models, model):
    """M xi_dot + bias + potential force = force; T = xi M xi / 2; the rate of the energy is the power."""
    system = hamel.System.from_file(models / f"{model}.eom")
    x, xi = random_states(system, 50)
    u = np.zeros(len(system.inputs))
    xi_dot = system.accel(x, xi, u)
    mass = system.mass_matrix(x)
    left = (mass @ xi_dot[..., None])[..., 0] + system.bias(x, xi) + system.potential_force(x)
    force = system.generalized_force(x, xi, u)
    assert np.abs(left - force).max() < 1e-10 * max(1.0, np.abs(left).max())
    twice = np.einsum("ki,kij,kj->k", xi, mass, xi)
    assert np.allclose(twice, 2 * system.kinetic_energy(x, xi), rtol=1e-12)
    # By central differences along the motion.
    h = 1e-5
    ends = [system.step(x, xi, h=step, method="rkmk8") for step in (h, -h)]
    power = (system.energy(*ends[0]) - system.energy(*ends[1])) / (2 * h)
    assert np.allclose(power, (force * xi).sum(-1), atol=1e-5)


def test_threads_share_a_system(models):
    system = hamel.System.from_file(models / "heavy_top.eom")
    x, xi = random_states(system, 20_000)
    alone = system.accel(x, xi)
    results = [None] * 4

    def work(place):
        results[place] = system.accel(x, xi)

    threads = [threading.Thread(target=work, args=(place,)) for place in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for result in results:
        assert np.array_equal(result, alone)


def test_systems_are_pickled(pendulum):
    other = pickle.loads(pickle.dumps(pendulum.with_parameters(l=2.0)))
    assert list(other.parameter_values) == [2.0, 2.0, 9.81]
    assert other.accel([0.3], [0.0], [1.0]) == pendulum.with_parameters(l=2.0).accel([0.3], [0.0], [1.0])


def test_functions_are_pickled(pendulum):
    accel = pendulum.with_parameters(l=2.0).accel
    again = pickle.loads(pickle.dumps(accel))
    assert (again.name, again.shape) == (accel.name, accel.shape)
    assert again([0.3], [0.0], [1.0]) == accel([0.3], [0.0], [1.0]) != pendulum.accel([0.3], [0.0], [1.0])
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.starmap(accel, [([0.3], [0.0], [1.0])]) == [accel([0.3], [0.0], [1.0])]


def test_states_by_names(models, robots):
    system = hamel.System.from_file(models / "heavy_top.eom")
    state = system.state(velocity={"w": np.array([1.0, 2.0, 3.0])})
    assert list(state.xi) == [1.0, 2.0, 3.0] and list(state.x) == list(np.eye(3).ravel())
    assert system.velocities.slice("w") == slice(0, 3) and system.velocities[1] == "w[2]"
    with pytest.raises(hamel.HamelError) as wrong:
        system.state(velocity={"w": [1.0], "v": 2.0}, coord={"R": np.ones((3, 3))})
    # All errors are reported at once.
    assert str(wrong.value).count("error") >= 2
    # Coordinates that are not given close the loop.
    loop = hamel.System.from_file(models / "four_bar_loop.eom")
    moved = loop.state(coord={"q1": 1.2})
    assert moved.x[0] == 1.2
    assert not np.array_equal(moved.x, loop.start().x)
    assert np.abs(loop.constraint(moved.x)).max() < 1e-12


def test_runs(pendulum):
    run = pendulum.simulate(2.0, step=1e-3, every=100, method="rkmk4")
    assert run.t.shape == (21,) and run.x.shape == (21, 1) and run["height"].shape == (21,)
    assert run.steps == 2000 and run.method == "rkmk4" and run.reason is None
    assert np.allclose(run["height"], -0.5 * np.cos(run["q"]), rtol=1e-14)
    assert np.ptp(run.energy) < 1e-9
    assert pendulum.simulate(1.0).reason
    with pytest.raises(KeyError):
        run["nothing"]
    # The observed order is 4.
    ends = [pendulum.simulate(2.0, step=h, method="rkmk4").x[-1, 0] for h in (0.02, 0.01, 0.005)]
    assert abs(np.log2((ends[0] - ends[1]) / (ends[1] - ends[2])) - 4.0) < 0.2
    # From another state, with a constant input.
    state = pendulum.state(coord={"q": 0.0}, input={"tau": 1.0})
    balanced = np.arcsin(1.0 / (2 * 9.81 * 0.5))
    still = pendulum.state(coord={"q": balanced}, input={"tau": 1.0})
    assert abs(pendulum.simulate(1.0, at=still)["q"][-1] - balanced) < 1e-12
    same = pendulum.simulate(1.0, at={"coord": {"q": 0.0}}, inputs={"tau": 1.0}, method="rkmk4")
    assert np.array_equal(same.x, pendulum.simulate(1.0, at=state, method="rkmk4").x)
    mapped = pendulum.state({"coord": {"q": 0.0}}, input={"tau": 1.0})
    assert np.array_equal(mapped.x, state.x) and np.array_equal(mapped.u, state.u)
    with pytest.raises(hamel.HamelError, match="`coord` is given twice"):
        pendulum.state({"coord": {"q": 0.0}}, coord={"q": 1.0})


def test_what_cannot_be_run(pendulum):
    for options, why in [
        ({"step": -1.0}, "greater than zero"),
        ({"step": 1e-3, "tol": 1e-9}, "not both"),
        ({"method": "euler2"}, "no method is called"),
        ({"times": [0.5, 0.4]}, "increase"),
        ({"times": [0.5, 1.5]}, "outside"),
        ({"inputs": {"force": 1.0}}, "no input"),
        ({"inputs": {"tau": "q +"}}, "tau"),
        ({"inputs": "nowhere.csv"}, "nowhere.csv"),
        ({"inputs": {"tau": [1.0, 2.0]}}, "has 1 entries, 2 were given"),
        ({"every": 0}, "1 or greater"),
        ({"every": -2}, "1 or greater"),
        ({"spacing": -0.1}, "greater than zero"),
        ({"at": {"coord": {"q": float("nan")}}}, "state.coord.q: a finite number"),
    ]:
        with pytest.raises(hamel.HamelError, match=why):
            pendulum.simulate(1.0, **options)
    with pytest.raises(hamel.HamelError, match="greater than zero"):
        pendulum.simulate(float("nan"))
    for h in (0.0, float("nan")):
        with pytest.raises(hamel.HamelError, match="is a finite number other than 0"):
            pendulum.step([0.0], [0.0], [0.0], h=h)


def test_exceptions_of_a_controller_come_through(pendulum):
    class Broken(Exception):
        pass

    calls = []

    def law(t, x, xi):
        calls.append(t)
        if t > 0.5:
            raise Broken("at half of the time")
        return [0.0]

    with pytest.raises(Broken, match="half"):
        pendulum.simulate(1.0, inputs=law, method="rkmk4", step=0.01)
    # The controller is not called again.
    assert sum(t > 0.5 for t in calls) == 1
    with pytest.raises(ValueError, match="must return 1 numbers"):
        pendulum.simulate(1.0, inputs=lambda t, x, xi: [1.0, 2.0], method="rkmk4")


def test_a_run_that_ends_early_keeps_what_there_was():
    system = hamel.System.from_text(
        "system S { param m = 1; coord q; velocity w; rate q = w;"
        " particle mass m at [q^2 / 2, 0, 0]; start q = 1; start w = -1; }"
    )
    with pytest.raises(hamel.RunError, match="the run ends at") as failed:
        system.simulate(2.0, step=1e-2, method="rkmk4")
    run = failed.value.run
    assert run.failure and 0.0 < run.t[-1] < 2.0 and len(run.x) == len(run.t)


@pytest.mark.parametrize("robot", ["double_pendulum", "ur5"])
def test_slopes_of_steps(robots, reference, tmp_path, robot):
    """Derivatives of semi-implicit steps, compared with Pinocchio."""
    known = json.loads((reference / "control" / f"{robot}.json").read_text())
    # The reference has no damping.
    urdf = (robots / known["urdf"]).read_text()
    (tmp_path / "robot.urdf").write_text(re.sub(r'(damping|friction)="[^"]*"', r'\1="0"', urdf))
    system = hamel.System.from_urdf(tmp_path / "robot.urdf", rounding=0.0)
    order = np.concatenate([np.arange(10_000)[system.joints[name]] for name in known["velocity_order"]])
    for sample in known["samples"]:
        state = system.state(configuration=sample["configuration"], velocity=sample["velocity"])
        # An input for each joint.
        u = np.zeros(len(order))
        u[order] = sample["force"]
        assert np.array_equal(system.generalized_force(state.x, state.xi, u), u)
        state = hamel.State(state.x, state.xi, u, state.parameters)
        found = system.step_slopes(state, h=known["step_size"], method="semi-implicit-euler")
        both = np.concatenate([order, order + len(order)])
        expected = np.array(sample["step"]["A"], float)
        assert np.abs(found.A[np.ix_(both, both)] - expected).max() < 1e-10 * np.abs(expected).max()


@pytest.mark.parametrize("method", ["rkmk4", "cf4", "rkmk8", "semi-implicit-euler", "backward-euler"])
@pytest.mark.parametrize("model", ["heavy_top", "drone", "rolling_disk"])
def test_slopes_are_those_of_the_step(models, model, method):
    """Derivatives by velocities and inputs, compared with central differences of the step."""
    system = hamel.System.from_file(models / f"{model}.eom")
    x, xi = random_states(system, 1)
    u = np.full(len(system.inputs), 0.3)
    state = hamel.State(x[0], xi[0], u, system.parameter_values)
    h, d = 0.05, 1e-6
    found = system.step_slopes(state, h=h, method=method)
    end = system.step(x[0], xi[0], u, h=h, method=method)
    assert np.abs(found.x - end[0]).max() < 1e-12 and np.abs(found.xi - end[1]).max() < 1e-12
    n = len(xi[0])
    for j in range(n):
        by = d * np.eye(n)[j]
        ahead, behind = (system.step(x[0], xi[0] + s * by, u, h=h, method=method)[1] for s in (1, -1))
        column = found.A[-n:, found.A.shape[1] - n + j]
        assert np.abs((ahead - behind) / (2 * d) - column).max() < 2e-7
    for j in range(len(u)):
        by = d * np.eye(len(u))[j]
        ahead, behind = (system.step(x[0], xi[0], u + s * by, h=h, method=method)[1] for s in (1, -1))
        assert np.abs((ahead - behind) / (2 * d) - found.B[-n:, j]).max() < 2e-7
    with pytest.raises(hamel.HamelError, match="have no slopes"):
        system.step_slopes(state, h=h, method="rk4")


def test_linearization(pendulum):
    at = pendulum.state(coord={"q": 0.0})
    linear = pendulum.linearize(at)
    rate = 9.81 / 0.5
    assert np.allclose(linear.A, [[0, 1], [-rate, 0]], atol=1e-14)
    assert np.allclose(linear.B, [[0], [1 / (2 * 0.25)]])
    assert np.allclose(np.sort(linear.eigenvalues.imag), [-np.sqrt(rate), np.sqrt(rate)])
    assert linear.states == ["h(w)", "d(w)"] and linear.inputs == ["tau"] and linear.outputs == ["height"]
    assert np.allclose(linear.C, [[0, 0]])


def test_trim(pendulum, models):
    found = pendulum.trim({"coord": {"q": 3.0}}, free=["tau"], fix={"q": 0.5})
    # A rod of 2 kg with its centre 0.5 m from the joint.
    assert np.isclose(found.state.u[0], 2 * 9.81 * 0.5 * np.sin(0.5), rtol=0, atol=1e-11)
    assert found.stability == "neutral" and found.rank == found.unknowns and not found.undetermined
    assert np.abs(pendulum.accel(found.state.x, found.state.xi, found.state.u)).max() < 1e-12
    upright = pendulum.trim({"coord": {"q": 3.0}})
    assert upright.stability == "unstable" and np.isclose(upright.state.x[0], np.pi, rtol=0, atol=1e-12)
    assert np.isclose(upright.eigenvalues[0], np.sqrt(9.81 / 0.5))
    aircraft = hamel.System.from_file(models / "navion.eom")
    level = ["speed = 176", "phi = 0", "velocity(hull)[3] = 0", "v[2] = 0"]
    flight = aircraft.trim(steady=True, free=["elevator", "throttle", "aileron", "rudder"], fix=level)
    assert sorted(name for way in flight.undetermined for name in way) == ["psi", "r[1]", "r[2]", "r[3]"]
    run = aircraft.simulate(2.0, at=flight.state, step=0.01)
    assert np.abs(run.xi - run.xi[0]).max() < 1e-9 and flight.residual < 1e-10
    with pytest.raises(hamel.HamelError, match="no solution near this start"):
        aircraft.trim(steady=True, fix={"speed": 176.0, "phi": 0.5, "theta": 1.0})
    with pytest.raises(hamel.HamelError, match="`lift` is unknown"):
        aircraft.trim(free=["lift"])
    with pytest.raises(hamel.HamelError, match="a string was given"):
        aircraft.trim(free="throttle")


def test_regressor(robots, reference):
    """F = Y(x, xi, xi_dot) beta."""
    system = hamel.System.from_urdf(robots / "ur_description/urdf/ur5_robot.urdf")
    random = np.random.default_rng(2)
    x, xi, xi_dot = random.normal(size=(3, 10, 6))
    beta = system.function("base_parameters")()
    force = system.regressor(x, xi, xi_dot) @ beta
    assert np.allclose(force, system.inverse_dynamics(x, xi, xi_dot), atol=1e-10)
    assert len(system.base_parameters().data["base"]) == len(beta)


def test_tables_and_numbers_agree(models):
    system = hamel.System.from_file(models / "heavy_top.eom")
    tables = system.tables("gamma", "M")
    assert "Hamel coefficients" in str(tables) and "\\gamma" in tables.latex
    assert tables.data and tables._repr_markdown_()
    numbers = system.evaluate()
    levi_civita = np.zeros((3, 3, 3))
    for i, j, k in [(0, 1, 2), (1, 2, 0), (2, 0, 1)]:
        levi_civita[i, j, k], levi_civita[j, i, k] = 1.0, -1.0
    assert np.array_equal(numbers["gamma"], levi_civita)
    assert np.array_equal(numbers["M"], system.mass_matrix(system.start().x))
    with pytest.raises(hamel.HamelError, match="nothing"):
        system.tables("nothing")


def test_errors_show_their_place(models, tmp_path):
    with pytest.raises(hamel.HamelError) as wrong:
        hamel.System.from_text("system S {\n  coord q;\n  velocity w;\n  rate q = v;\n  rat q = w;\n}", name="mine")
    text = str(wrong.value)
    assert "mine:" in text and "^" in text and "\x1b" not in text
    with pytest.raises(hamel.HamelError, match="cannot read"):
        hamel.System.from_file(tmp_path / "nothing.eom")
    with pytest.raises(FileNotFoundError):
        hamel.System.from_urdf(tmp_path / "nothing.urdf")
    with pytest.raises(hamel.HamelError, match="is not a robot in URDF"):
        hamel.System.from_urdf(models / "pendulum.eom")
    with pytest.raises(hamel.HamelError, match="no constants"):
        hamel.System.from_text(PENDULUM, constants={"n": 3})


def test_descriptions_made_by_programs():
    """The train of the book, three masses with springs, has the frequencies of K v = omega^2 M v."""
    masses = [1.0, 0.5, 2.0]
    parts = [
        f"coord y_{i}; velocity v_{i}; rate y_{i} = v_{i}; particle mass {mass} at [y_{i}, 0, 0];"
        for i, mass in enumerate(masses)
    ]
    springs = [f"spring stiffness 100 on y_{i + 1} - y_{i};" for i in range(len(masses) - 1)]
    train = hamel.System.from_text("\n".join(["system Train {", *parts, *springs, "}"]))
    stiffness = 100 * np.array([[1, -1, 0], [-1, 2, -1], [0, -1, 1]])
    wanted = np.linalg.eigvals(np.diag(1 / np.array(masses)) @ stiffness).real
    found = train.linearize().eigenvalues
    np.testing.assert_allclose(found.real, 0, atol=1e-6)
    np.testing.assert_allclose(np.sort(found.imag**2)[::2], np.sort(wanted), atol=1e-9)


def test_sweep(tmp_path, pendulum):
    description = tmp_path / "pendulum.eom"
    description.write_text(PENDULUM)
    options = {"vary": "l = uniform(0.4, 0.6)", "until": 1.0, "keep": "end", "members": 20, "seed": 3}
    for part in (1, 2):
        hamel.sweep(description, out=tmp_path / "runs", shard=(part, 2), **options)
    assert list((tmp_path / "runs").glob("*.parquet"))
    with pytest.raises(hamel.HamelError, match="members"):
        hamel.sweep(description, out=tmp_path / "other", vary="l = uniform(0.4, 0.6)", until=1.0, members="many")
    with pytest.raises(hamel.HamelError, match="seed: 3 there, 4 here"):
        hamel.sweep(description, out=tmp_path / "runs", **{**options, "seed": 4})


def test_the_command_line_comes_along(models):
    def said(*words):
        return subprocess.run([sys.executable, "-m", "hamel", *words], capture_output=True, text=True)

    shown = said("tables", str(models / "heavy_top.eom"), "--of", "gamma")
    assert shown.returncode == 0 and "Hamel coefficients" in shown.stdout
    assert said("check", "nothing.eom").returncode == 2
    assert "Usage" in said("--help").stdout
