"""Random trees of links, compared with Pinocchio: axes at multiples of 45 degrees, almost parallel axes, and others."""

import numpy as np
import pinocchio as pin
import pytest

import hamel

ROBOTS = 12
STATES = 5
# Relative to the largest entry; almost parallel axes do not lose digits in these quantities.
CLOSE = 1e-9


def rotation(random):
    """Roll, pitch and yaw of a mount: zero, a multiple of 45 degrees about one axis, 1e-7 more, or random angles."""
    kind = random.integers(4)
    if kind == 0:
        return np.zeros(3)
    if kind == 3:
        return random.normal(size=3)
    angles = np.zeros(3)
    angles[random.integers(3)] = random.integers(-3, 5) * np.pi / 4 + (1e-7 if kind == 2 else 0.0)
    return angles


def written(random, count):
    """The URDF text of a random tree."""
    links, joints = ['<link name="link0"/>'], []
    for index in range(1, count + 1):
        spread = random.normal(size=(3, 3))
        inertia = spread @ spread.T + np.eye(3)
        # An inertia from second moments satisfies the triangle inequality.
        inertia = 1e-2 * (np.trace(inertia) * np.eye(3) - inertia)
        pairs = [(a, b) for a in range(3) for b in range(a, 3)]
        entries = " ".join(f'i{"xyz"[a]}{"xyz"[b]}="{float(inertia[a, b])!r}"' for a, b in pairs)
        com = " ".join(repr(float(c)) for c in 0.1 * random.normal(size=3))
        links.append(
            f'<link name="link{index}"><inertial><mass value="{float(random.uniform(0.5, 2.0))!r}"/>'
            f'<origin xyz="{com}"/><inertia {entries}/></inertial></link>'
        )
        axis = np.eye(3)[random.integers(3)] if random.integers(2) else random.normal(size=3)
        kind = "prismatic" if random.integers(4) == 0 else "revolute"
        place = " ".join(repr(float(c)) for c in 0.3 * random.normal(size=3))
        turn = " ".join(repr(float(c)) for c in rotation(random))
        about = " ".join(repr(float(c)) for c in axis)
        joints.append(
            f'<joint name="joint{index}" type="{kind}"><parent link="link{random.integers(index)}"/>'
            f'<child link="link{index}"/><origin xyz="{place}" rpy="{turn}"/><axis xyz="{about}"/>'
            '<limit lower="-9" upper="9" effort="9" velocity="9"/></joint>'
        )
    return '<robot name="tree">' + "\n".join(links + joints) + "</robot>"


@pytest.mark.parametrize("seed", range(ROBOTS))
def test_a_random_tree(tmp_path, seed):
    random = np.random.default_rng(seed)
    text = written(random, 1 + seed % 7)
    path = tmp_path / "tree.urdf"
    path.write_text(text)
    ours = hamel.System.from_urdf(path, rounding=0.0)
    model = pin.buildModelFromUrdf(str(path))
    data = model.createData()
    order = np.concatenate([np.arange(99)[ours.joints[name]] for name in list(model.names)[1:]])
    x, xi, xi_dot, u = random.normal(size=(4, STATES, model.nv))
    mass, force, accel = ours.mass_matrix(x), ours.inverse_dynamics(x, xi, xi_dot), ours.accel(x, xi, u)
    for k in range(STATES):
        q, v, a, tau = (rows[k][order] for rows in (x, xi, xi_dot, u))
        theirs = pin.crba(model, data, q)
        theirs = np.triu(theirs) + np.triu(theirs, 1).T
        for found, expected in [
            (mass[k][np.ix_(order, order)], theirs),
            (force[k][order], pin.rnea(model, data, q, v, a)),
            (accel[k][order], pin.aba(model, data, q, v, tau)),
        ]:
            assert np.abs(found - expected).max() < CLOSE * max(1.0, np.abs(expected).max())
    # A long run, compared with single steps, and its energy.
    at, speed = x[0], 0.1 * xi[0]
    start = hamel.State(at, speed, 0 * u[0], ours.parameter_values)
    free = ours.simulate(0.5, step=2e-4, every=2500, method="rkmk4", at=start)
    for _ in range(2500):
        at, speed = ours.step(at, speed, h=2e-4, method="rkmk4")
    assert np.abs(free.x[-1] - at).max() < 1e-9 * max(1.0, np.abs(at).max())
    assert np.ptp(free.energy) < 1e-7 * max(1.0, np.abs(free.energy).max())
