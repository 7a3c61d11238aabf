"""Joints: hamel expands them to coordinates and rates, which are given here as documented in the book."""

from mpmath import cos, sin

from . import vectors
from .expressions import Ex, Vec, lift
from .vectors import IDENTITY, NIL, about, hat, on, quaternion, scale, times, turn, unit


def square(flat):
    return [flat[0:3], flat[3:6], flat[6:9]]


def flat(matrix):
    return [entry for row in matrix for entry in row]


def spin(place, at):
    """Ṙ = R ω̂ for the matrix at an index in x, and ω at an index in ξ."""
    return lambda s: flat(times(square(s.x[place : place + 9]), hat(s.xi[at : at + 3])))


def plane(normal):
    """The two directions of a planar joint about a coordinate axis: the next two in turn."""
    k = next(i for i in range(3) if normal[i] != 0)
    i, j = (k + 1) % 3, (k + 2) % 3
    pair = (i, j) if normal[k] > 0 else (j, i)
    return [[vectors.ONE if row == axis else NIL for row in range(3)] for axis in pair]


def add_joint(m, name, kind, axis, parent, mount, moves, fields="", follows=None):
    """Writes a joint and returns its velocities and plain coordinates as expressions, by name."""
    rotation, place = mount
    head = {"spherical3": "spherical S3", "free": "free", "spherical": "spherical", "fixed": "fixed"}.get(kind)
    if head is None:
        head = f"{kind} " + ", ".join(a.text for a in (axis if kind == "universal" else [axis]))
    more = f" follows {follows.text}" if follows else ""
    m.say(f"joint {name}: {head}{m.on(parent)} at pose({rotation.text}, {place.text}) moves {moves}{more} {{ {fields} }}")
    local, found = motion(m, name, kind, axis, follows)

    def pose(s):
        r0, p0 = rotation.at(s), place.at(s)
        r, p = local(s)
        return times(r0, r), vectors.add(p0, on(r0, p))

    m.frames[moves] = (parent, pose)
    return found


def motion(m, name, kind, axis, follows):
    """The pose that a joint adds, and its plain coordinates and velocities."""
    x, w = m.nu, m.n
    still = [NIL] * 3
    if kind == "fixed":
        return (lambda s: (IDENTITY, still)), {}
    if follows:
        law = {"revolute": lambda s: (about(axis.at(s), follows.at(s)), still), "prismatic": lambda s: (IDENTITY, scale(follows.at(s), unit(axis.at(s))))}
        return law[kind], {name: follows}
    if kind in ("revolute", "prismatic"):
        q = m.coordinate(name, "real", lambda s: [s.xi[w]], declare=False)
        v = m.velocity(f"{name}_dot", declare=False)
        law = {"revolute": lambda s: (about(axis.at(s), s.x[x]), still), "prismatic": lambda s: (IDENTITY, scale(s.x[x], unit(axis.at(s))))}
        return law[kind], {name: q, f"{name}_dot": v}
    if kind == "continuous":
        m.coordinate(name, "S1", lambda s: [-s.x[x + 1] * s.xi[w], s.x[x] * s.xi[w]], declare=False)
        v = m.velocity(f"{name}_dot", declare=False)
        c, s_ = Ex(f"{name}.c", lambda s: s.x[x]), Ex(f"{name}.s", lambda s: s.x[x + 1])
        return (lambda s: (turn(unit(axis.at(s)), s.x[x], s.x[x + 1]), still)), {f"{name}.c": c, f"{name}.s": s_, f"{name}_dot": v}
    if kind == "spherical":
        m.coordinate(name, "SO3", spin(x, w), declare=False)
        v = m.velocity(f"{name}_dot", 3, declare=False)
        return (lambda s: (square(s.x[x : x + 9]), still)), {f"{name}_dot": v}
    if kind == "spherical3":

        def rate(s):
            a, b, c, d = s.x[x : x + 4]
            p, q, r = s.xi[w : w + 3]
            return scale(vectors.ONE / 2, [-b * p - c * q - d * r, a * p + c * r - d * q, a * q + d * p - b * r, a * r + b * q - c * p])

        m.coordinate(name, "S3", rate, declare=False)
        v = m.velocity(f"{name}_dot", 3, declare=False)
        return (lambda s: (quaternion(s.x[x : x + 4]), still)), {f"{name}_dot": v}
    if kind == "free":
        m.coordinate(f"{name}_r", "R3", lambda s: on(square(s.x[x + 3 : x + 12]), s.xi[w : w + 3]), declare=False)
        m.coordinate(f"{name}_R", "SO3", spin(x + 3, w + 3), declare=False)
        v = m.velocity(f"{name}_v", 3, declare=False)
        o = m.velocity(f"{name}_w", 3, declare=False)
        r = Vec(f"{name}_r", lambda s: s.x[x : x + 3])
        return (lambda s: (square(s.x[x + 3 : x + 12]), s.x[x : x + 3])), {f"{name}_v": v, f"{name}_w": o, f"{name}_r": r}
    if kind == "planar":
        m.coordinate(f"{name}_r", "R2", lambda s: list(s.xi[w : w + 2]), declare=False)
        m.coordinate(name, "real", lambda s: [s.xi[w + 2]], declare=False)
        v = m.velocity(f"{name}_r_dot", 2, declare=False)
        o = m.velocity(f"{name}_dot", declare=False)
        q = Ex(name, lambda s: s.x[x + 2])

        def pose(s):
            n = axis.at(s)
            a, b = plane(n)
            return about(n, s.x[x + 2]), vectors.add(scale(s.x[x], a), scale(s.x[x + 1], b))

        return pose, {f"{name}_r_dot": v, f"{name}_dot": o, name: q}
    if kind == "universal":
        a, b = axis
        qs = [m.coordinate(f"{name}_{k + 1}", "real", (lambda k: lambda s: [s.xi[w + k]])(k), declare=False) for k in range(2)]
        vs = [m.velocity(f"{name}_{k + 1}_dot", declare=False) for k in range(2)]
        pose = lambda s: (times(about(a.at(s), s.x[x]), about(b.at(s), s.x[x + 1])), still)  # noqa: E731
        return pose, {f"{name}_1": qs[0], f"{name}_2": qs[1], f"{name}_1_dot": vs[0], f"{name}_2_dot": vs[1]}
    assert kind == "cylindrical", kind
    q = m.coordinate(name, "real", lambda s: [s.xi[w]], declare=False)
    d = m.coordinate(f"{name}_d", "real", lambda s: [s.xi[w + 1]], declare=False)
    v = m.velocity(f"{name}_dot", declare=False)
    u = m.velocity(f"{name}_d_dot", declare=False)
    pose = lambda s: (about(axis.at(s), s.x[x]), scale(s.x[x + 1], unit(axis.at(s))))  # noqa: E731
    return pose, {name: q, f"{name}_d": d, f"{name}_dot": v, f"{name}_d_dot": u}


__all__ = ["cos", "sin", "lift", "add_joint"]
