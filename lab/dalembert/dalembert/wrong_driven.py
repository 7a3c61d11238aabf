"""A small driven mechanism with elements on scalars and rates, a choice and a table; and replacements in its text."""

from .elements import choice
from .expressions import STILL, Ex, Mat, Vec, call, lift
from .joints import add_joint
from .mechanism import WORLD, Mechanism
from .tied import allowed_velocities, given
from .trees import random_state
from .vectors import mpf

DRIVEN = [
    ("prescribe a = (0.3 + (0.5 * sin(t)))", "prescribe a = (0.3 + (0.51 * sin(t)))"),
    ("prescribe rate(c_dot) = ((b_dot", "prescribe rate(c_dot) = ((-b_dot"),
    ("length 0.3 on", "length -0.3 on"),
    ("damper coefficient 0.4", "damper coefficient -0.4"),
    ("inertance 0.2 on (b_dot - c_dot)", "inertance 0.2 on (b_dot + c_dot)"),
    ("if b <", "if b >"),
    ("(1, 2)] linear", "(1, 2.01)] linear"),
]


def driven_one():
    """Three hinges, one driven, and one with a prescribed rate."""
    m = Mechanism("Driven")
    t = m.clock("t")
    m.gravity = Vec.of([0, 0, "-9.81"])
    m.say(f"gravity {m.gravity.text};")
    inertia = Mat.of([["0.5", "0.05", 0], ["0.05", "0.6", 0], [0, 0, "0.7"]])
    found, parent = {}, WORLD
    for name, axis in (("a", [0, 1, 0]), ("b", [1, 0, 0]), ("c", [0, "0.6", "0.8"])):
        found.update(add_joint(m, name, "revolute", Vec.of(axis), parent, (STILL, Vec.of(["0.4", "0.1", 0])), f"{name}_link"))
        parent = f"{name}_link"
        m.bodies.append((parent, lift("1.2"), Vec.of(["0.1", "0.2", "0.1"]), inertia, "com"))
        m.say(f"body on {parent} {{ mass 1.2; com [0.1, 0.2, 0.1]; inertia {inertia.text} about com; }}")
    b, b_dot, c_dot = found["b"], found["b_dot"], found["c_dot"]
    law = lift("0.3") + lift("0.5") * call("sin", t)
    m.say(f"prescribe a = {law.text};")
    m.driven.append((1, "real", law))
    m.closures.append(found["a"] - law)
    m.stabilized.append(None)
    rate = b_dot * "0.7" + t
    m.say(f"prescribe rate(c_dot) = {rate.text};")
    m.accelerated.append((2, rate))
    scalar, speed = b - found["c"], b_dot - c_dot
    m.say(f"spring stiffness 2 length 0.3 on {scalar.text};")
    m.potential.append(lift("2") * (scalar - "0.3") ** 2 / 2)
    m.say(f"damper coefficient 0.4 on {speed.text};")
    m.dissipation.append(lift("0.4") * speed**2 / 2)
    m.say(f"inerter inertance 0.2 on {speed.text};")
    m.kinetic.append(lift("0.2") * speed**2 / 2)
    m.say("table curve = [(-1, 1), (0, 0), (1, 2)] linear extrapolate linear;")
    curve = Ex("curve(b)", lambda s: b.at(s) * (2 if b.at(s) > 0 else -1))
    force = choice(b, "<", lift("0.1"), b_dot, lift("1.5")) + curve
    m.say(f"generalized force b_dot = {force.text};")
    m.generalized.append((1, force))
    m.say("generate all, linearize;")
    return m


def driven_state(m, random):
    s = random_state(m, random)
    x = [mpf("0.7"), mpf(0), mpf("0.45"), mpf("-0.6")]
    return allowed_velocities(m, s.but(x=[mpf(float(e)) for e in given(m, x)]))
