"""A small mechanism with explicit coordinates, constraint and rates, and the replacements in its text."""

from mpmath import cos, sin

from .expressions import Ex, Mat, Vec, lift
from .mechanism import WORLD, Mechanism
from .trees import random_state
from .vectors import NIL, ONE, hat, mpf, scale, times, unit

WRITTEN = [
    ("rate c = -s * (u + (0.3 * w[1])), s = c * (u + (0.3 * w[1]))", "rate c = -s * (u - (0.3 * w[1])), s = c * (u - (0.3 * w[1]))"),
    ("rate R = hat(w) * R", "rate R = R * hat(w)"),
    ("rate a = ((w[2] - u) + (v / 2))", "rate a = ((w[2] - u) - (v / 2))"),
    ("(y / 2)], [(y / 2)", "-(y / 2)], [-(y / 2)"),
    ("-(x / 2)], [0, 1, 0]", "(x / 2)], [0, -1, 0]"),
    ("mass 0.4", "mass 0.41"),
    ("in body;", "in world;"),
    ("potential (a * s)", "potential (a * c)"),
]


def written_one():
    """A circle of radius 2 in two numbers, a matrix rotated from the left, and a shift; ξ are mixtures."""
    m = Mechanism("Written")
    u_of = lambda s: s.xi[0] + mpf("0.3") * s.xi[1]  # noqa: E731
    m.coordinate("c", "real", lambda s: [-s.x[1] * u_of(s)])
    s_ = m.coordinate("s", "real", lambda s: [s.x[0] * u_of(s)])
    big = lambda s: [list(s.x[2 + 3 * i : 5 + 3 * i]) for i in range(3)]  # noqa: E731
    m.coordinate("R", "SO3", lambda s: [e for row in times(hat(s.xi[1:4]), big(s)) for e in row])
    a = m.coordinate("a", "real", lambda s: [s.xi[2] - s.xi[0] + s.xi[4] / 2])
    u, w, v = m.velocity("u"), m.velocity("w", 3), m.velocity("v")
    m.say("constraint c^2 + s^2 = 4;")
    m.onto.append((0, 2, lambda q: scale(mpf(2), unit(q))))
    mixed = u + lift("0.3") * w[0]
    m.say(f"rate c = -s * {mixed.text}, s = c * {mixed.text};")
    m.say("rate R = hat(w) * R;")
    m.say(f"rate a = {(w[1] - u + v / 2).text};")
    m.say("let x = c, y = s;")
    half = [Ex("(x / 2)", lambda s: s.x[0] / 2), Ex("(y / 2)", lambda s: s.x[1] / 2)]
    ring = Mat(
        "[[(x / 2), 0, (y / 2)], [(y / 2), 0, -(x / 2)], [0, 1, 0]]",
        lambda s: [[half[0].at(s), NIL, half[1].at(s)], [half[1].at(s), NIL, -half[0].at(s)], [NIL, ONE, NIL]],
    )
    m.frame("ring", WORLD, ring, Vec.of([0, 0, a]))
    m.frame("hull", "ring", Mat("R", big), Vec.of(["0.4", "0.1", 0]))
    inertia = Mat.of([["0.5", "0.05", 0], ["0.05", "0.6", 0], [0, 0, "0.7"]])
    for frame, mass in (("ring", "1.3"), ("hull", "0.9")):
        m.bodies.append((frame, lift(mass), Vec.of(["0.1", "0.2", "0.1"]), inertia, "com"))
        m.say(f"body on {frame} {{ mass {mass}; com [0.1, 0.2, 0.1]; inertia {inertia.text} about com; }}")
    tip = Vec.of([0, "0.3", "0.5"])
    m.particles.append(("hull", lift("0.4"), tip))
    m.say(f"particle mass 0.4 at {tip.text} on hull;")
    force, zero = Vec.of([u, "0.2", 1]), Vec.of([0, 0, 0])
    m.say(f"force {force.text} at {tip.text} on hull in body;")
    m.wrenches.append(("hull", tip, force, zero, "body", None))
    m.say(f"potential {(a * s_).text};")
    m.potential.append(a * s_)
    m.say("start c = 2;")
    m.say("generate all, linearize;")
    return m


def written_state(m, random):
    s = random_state(m, random)
    return s.but(x=[mpf(float(2 * cos(mpf("0.8")))), mpf(float(2 * sin(mpf("0.8")))), *s.x[2:]])
