"""Textbook recursions over CasADi expressions: the articulated-body and the recursive Newton-Euler algorithm.

R. Featherstone, Rigid Body Dynamics Algorithms (2008), tables 5.1 and 7.1: spatial vectors (angular, linear), link
frames at the joints, all in link axes. Zeros are structural, so that CasADi does not compute with them.
"""

from dataclasses import dataclass, field

import casadi as ca
import numpy as np

CLEAN = 1e-9


def clean(values):
    """Rounds entries within CLEAN of an integer, to remove rounding errors of URDF files."""
    values = np.array(values, dtype=float)
    whole = np.round(values)
    return np.where(np.abs(values - whole) < CLEAN, whole, values)


@dataclass
class Body:
    """A link and the joint that carries it."""

    name: str
    parent: int
    rotation: np.ndarray  # of the joint frame in the parent, at zero
    offset: np.ndarray
    kind: str  # revolute, prismatic, ball, free
    axis: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    mass: float = 0.0
    com: np.ndarray = field(default_factory=lambda: np.zeros(3))
    inertia: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))  # about com, link axes

    @property
    def freedoms(self):
        return {"revolute": 1, "prismatic": 1, "ball": 3, "free": 6}[self.kind]

    def add(self, mass, com, inertia):
        """Adds a rigid part to the link."""
        whole = self.mass + mass
        if whole == 0.0:
            return
        middle = (self.mass * self.com + mass * com) / whole
        about = np.zeros((3, 3))
        for m, c, i in ((self.mass, self.com, self.inertia), (mass, com, inertia)):
            d = c - middle
            about += i + m * (d @ d * np.eye(3) - np.outer(d, d))
        self.mass, self.com, self.inertia = whole, middle, about


def skew(a):
    return ca.vertcat(
        ca.horzcat(0, -a[2], a[1]), ca.horzcat(a[2], 0, -a[0]), ca.horzcat(-a[1], a[0], 0)
    )


def sparse(matrix):
    return ca.sparsify(ca.SX(matrix))


def spatial_inertia(body):
    c = skew(clean(body.com))
    m = body.mass
    about = ca.DM(body.inertia) + m * ca.mtimes(c, c.T)
    return sparse(
        ca.vertcat(ca.horzcat(clean(about), m * c), ca.horzcat(m * c.T, m * np.eye(3)))
    )


def motion(e, r):
    """Motion transform to a frame with rotation rows e and origin r, both relative to the parent."""
    return sparse(ca.vertcat(ca.horzcat(e, ca.SX(3, 3)), ca.horzcat(-ca.mtimes(e, skew(r)), e)))


def cross_motion(v):
    w = skew(v[:3])
    return sparse(ca.vertcat(ca.horzcat(w, ca.SX(3, 3)), ca.horzcat(skew(v[3:]), w)))


def joint(body, q):
    """Motion transform from the parent, and the motion subspace S."""
    fixed = ca.DM(clean(body.rotation))
    offset = sparse(clean(body.offset))
    zero = np.zeros(3)
    if body.kind == "revolute":
        n = clean(body.axis)
        n = n / np.linalg.norm(n)
        s, c = ca.sin(q[0]), ca.cos(q[0])
        k = ca.DM(skew(n))
        turn = ca.DM(np.outer(n, n)) * (1 - c) + ca.DM.eye(3) * c + k * s
        if np.count_nonzero(n) == 1:
            turn = ca.DM(np.outer(n, n)) + ca.DM(np.eye(3) - np.outer(n, n)) * c + k * s
        e = ca.mtimes(sparse(turn).T, sparse(fixed.T))
        return motion(sparse(e), offset), sparse(np.concatenate([n, zero]))
    if body.kind == "prismatic":
        n = clean(body.axis)
        r = offset + ca.mtimes(sparse(fixed), sparse(n)) * q[0]
        return motion(sparse(fixed.T), r), sparse(np.concatenate([zero, n]))
    rotation = ca.reshape(q[-9:], 3, 3)  # rows of R are columns here: the transpose
    e = ca.mtimes(rotation, sparse(fixed.T))
    if body.kind == "ball":
        return motion(e, offset), sparse(np.vstack([np.eye(3), np.zeros((3, 3))]))
    # Velocities (v, ω), in the order of the descriptions. The position does not matter to a root.
    swap = np.vstack([np.hstack([np.zeros((3, 3)), np.eye(3)]), np.hstack([np.eye(3), np.zeros((3, 3))])])
    return motion(e, sparse(np.zeros(3))), sparse(swap)


def places(bodies):
    """Slices of x, and of ξ and τ."""
    widths = {"revolute": 1, "prismatic": 1, "ball": 9, "free": 12}
    x = np.cumsum([0] + [widths[b.kind] for b in bodies])
    v = np.cumsum([0] + [b.freedoms for b in bodies])
    return x, v


def kinematics(bodies, x, xi):
    at_x, at_v = places(bodies)
    transforms, spaces, velocities, turns = [], [], [], []
    for i, body in enumerate(bodies):
        xp, s = joint(body, x[at_x[i] : at_x[i + 1]])
        vj = ca.mtimes(s, xi[at_v[i] : at_v[i + 1]])
        v = vj if body.parent < 0 else ca.mtimes(xp, velocities[body.parent]) + vj
        transforms.append(xp)
        spaces.append(s)
        velocities.append(v)
        turns.append(ca.mtimes(cross_motion(v), vj) if body.parent >= 0 else ca.SX(6, 1))
    return at_v, transforms, spaces, velocities, turns


GRAVITY = ca.DM([0, 0, 0, 0, 0, 9.81])


def newton_euler(bodies, x, xi, accel):
    at_v, xp, s, v, c = kinematics(bodies, x, xi)
    forces, accelerations = [], []
    for i, body in enumerate(bodies):
        before = GRAVITY if body.parent < 0 else accelerations[body.parent]
        a = ca.mtimes(xp[i], sparse(before)) + ca.mtimes(s[i], accel[at_v[i] : at_v[i + 1]]) + c[i]
        inertia = spatial_inertia(body)
        accelerations.append(a)
        momentum = ca.mtimes(inertia, v[i])
        forces.append(ca.mtimes(inertia, a) - ca.mtimes(cross_motion(v[i]).T, momentum))
    rows = [None] * len(bodies)
    for i in reversed(range(len(bodies))):
        rows[i] = ca.mtimes(s[i].T, forces[i])
        if bodies[i].parent >= 0:
            forces[bodies[i].parent] += ca.mtimes(xp[i].T, forces[i])
    return ca.vertcat(*rows)


def articulated(bodies, x, xi, tau):
    at_v, xp, s, v, c = kinematics(bodies, x, xi)
    inertia = [spatial_inertia(body) for body in bodies]
    bias = [-ca.mtimes(cross_motion(v[i]).T, ca.mtimes(inertia[i], v[i])) for i in range(len(bodies))]
    kept = [None] * len(bodies)
    for i in reversed(range(len(bodies))):
        u = ca.mtimes(inertia[i], s[i])
        d = factors(ca.mtimes(s[i].T, u))
        rest = tau[at_v[i] : at_v[i + 1]] - ca.mtimes(s[i].T, bias[i])
        kept[i] = (u, d, rest)
        parent = bodies[i].parent
        if parent >= 0:
            left = symmetric(inertia[i] - ca.mtimes(u, solve(d, u.T)))
            pushed = bias[i] + ca.mtimes(left, c[i]) + ca.mtimes(u, solve(d, rest))
            inertia[parent] += symmetric(ca.mtimes(xp[i].T, ca.mtimes(left, xp[i])))
            bias[parent] += ca.mtimes(xp[i].T, pushed)
    accelerations, rows = [], []
    for i, body in enumerate(bodies):
        before = GRAVITY if body.parent < 0 else accelerations[body.parent]
        a = ca.mtimes(xp[i], sparse(before)) + c[i]
        u, d, rest = kept[i]
        row = solve(d, rest - ca.mtimes(u.T, a))
        rows.append(row)
        accelerations.append(a + ca.mtimes(s[i], row))
    return ca.vertcat(*rows)


def symmetric(matrix):
    """Only the upper triangle is computed."""
    return ca.triu2symm(ca.triu(matrix))


def factors(matrix):
    """The reciprocal for a joint of one degree of freedom; otherwise LDLᵀ, unrolled."""
    return 1 / matrix if matrix.shape == (1, 1) else ca.ldl(matrix, False)


def solve(factored, right):
    return right * factored if isinstance(factored, ca.SX) else ca.ldl_solve(right, *factored)
