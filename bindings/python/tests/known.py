"""Systems with equations from textbooks, shared by several tests."""

import numpy as np

# Angular velocity of a heavy top in body axes (rad/s).
XI = np.array([0.3, 0.2, 5.0])

PENDULUM = """
system Pendulum {
    param m = 2, l = 0.5, g = 9.81;
    coord q;
    velocity w;
    rate q = w;
    particle mass m at [l * sin(q), 0, -l * cos(q)];
    gravity [0, 0, -g];
    input tau;
    generalized force w = tau;
    output height = -l * cos(q);
    start q = 0.7;
}
"""


def heavy_top_rates(_, y):
    """Euler's equations of tests/models/heavy_top.eom, a rigid body with a fixed point: y = (R by rows, w)."""
    m, g = 1.3, 9.81
    s = np.array([0.1, -0.2, 0.3])
    inertia = np.array([[2.1, 0.1, -0.2], [0.1, 1.7, 0.15], [-0.2, 0.15, 1.2]])
    rotation, w = y[:9].reshape(3, 3), y[9:]
    hat = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
    torque = np.cross(m * s, rotation.T @ [0, 0, -g])
    return [*(rotation @ hat).ravel(), *np.linalg.solve(inertia, torque - np.cross(w, inertia @ w))]
