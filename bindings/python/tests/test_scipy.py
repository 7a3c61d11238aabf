"""Runs, compared with SciPy's DOP853 on equations from textbooks."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hamel
from known import heavy_top_rates

TIMES = np.linspace(0.25, 2.0, 8)


def solved(right_hand_side, start):
    found = solve_ivp(
        right_hand_side, (0.0, TIMES[-1]), start, method="DOP853", t_eval=TIMES, rtol=1e-13, atol=1e-13
    )
    assert found.success
    return found.y.T


def run(system, **options):
    return system.simulate(TIMES[-1], times=TIMES, tol=1e-12, **options)


def test_double_pendulum(models):
    """Two point masses on rods, angles from the vertical."""
    m1 = m2 = l1 = l2 = 1.0
    g = 9.81

    def rates(_, y):
        a, b, wa, wb = y
        d = a - b
        mass = [[(m1 + m2) * l1, m2 * l2 * np.cos(d)], [l1 * np.cos(d), l2]]
        force = [
            -m2 * l2 * wb**2 * np.sin(d) - (m1 + m2) * g * np.sin(a),
            l1 * wa**2 * np.sin(d) - g * np.sin(b),
        ]
        return [wa, wb, *np.linalg.solve(mass, force)]

    system = hamel.System.from_file(models / "double_pendulum_angles.eom")
    found = run(system)
    expected = solved(rates, [2.0, 2.5, 0.0, 0.0])
    assert np.abs(np.hstack([found.x, found.xi]) - expected).max() < 1e-9
    bob = [np.sin(expected[:, 0]) + np.sin(expected[:, 1]), -np.cos(expected[:, 0]) - np.cos(expected[:, 1])]
    assert np.abs(found["bob"][:, [0, 2]].T - bob).max() < 1e-9


def test_heavy_top(models):
    system = hamel.System.from_file(models / "heavy_top.eom")
    found = run(system)
    expected = solved(heavy_top_rates, [*np.eye(3).ravel(), 0.3, 0.2, 5.0])
    assert np.abs(np.hstack([found.x, found.xi]) - expected).max() < 1e-9
    assert found.energy_deviation < 1e-10
    rotations = found["R"].reshape(-1, 3, 3)
    assert np.abs(rotations @ rotations.transpose(0, 2, 1) - np.eye(3)).max() < 1e-14


def law(t, p, th, v, w):
    return 3.0 * np.sin(2.0 * t) - 0.5 * p - 1.5 * v + 20.0 * th + 3.0 * w


@pytest.mark.parametrize("form", ["function", "expression"])
def test_cart_and_pole_with_a_controller(models, form):
    """A point mass on a rod on a cart; the angle is from the upright, the force depends on time and state."""
    mc, mp, l, g = 1.0, 0.1, 0.5, 9.81

    def rates(t, y):
        p, th, v, w = y
        force = law(t, *y)
        mass = [[mc + mp, mp * l * np.cos(th)], [np.cos(th), l]]
        return [v, w, *np.linalg.solve(mass, [force + mp * l * w**2 * np.sin(th), g * np.sin(th)])]

    system = hamel.System.from_file(models / "cart_pole.eom")
    inputs = {
        "function": lambda t, x, xi: law(t, *x, *xi),
        "expression": {"F": "3 * sin(2 * t) - p / 2 - 3 / 2 * v + 20 * th + 3 * w"},
    }
    found = run(system, inputs=inputs[form])
    expected = solved(rates, [0.0, 0.1, 0.0, 0.0])
    assert np.abs(np.hstack([found.x, found.xi]) - expected).max() < 1e-8


def test_a_pendulum_whose_pivot_moves(models):
    """Kapitza's pendulum: in the frame of the pivot, gravity is g - a Omega^2 cos(Omega t)."""
    length, g, a, omega = 1.0, 9.81, 0.1, 60.0

    def rates(t, y):
        q, w = y
        return [w, -(g - a * omega**2 * np.cos(omega * t)) / length * np.sin(q)]

    system = hamel.System.from_file(models / "kapitza.eom")
    found = run(system)
    expected = solved(rates, [3.0, 0.0])
    ours = np.stack([found["q"], found["w"]], axis=1)
    assert np.abs(ours - expected).max() < 1e-8
