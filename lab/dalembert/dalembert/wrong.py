"""Checks that this test can fail: texts that differ from their data by one sign or number."""

import os
import random

from .compare import Comparison, Errors
from .doors import Doors, Refused
from .expressions import STILL, Ex, Mat, Vec, lift, rotation
from .joints import add_joint
from .loops import closed
from .mechanism import WORLD, Mechanism
from .tied import allowed_velocities
from .trees import Output, random_state
from .vectors import mp, mpf
from .wrong_driven import DRIVEN, driven_one, driven_state
from .wrong_written import WRITTEN, written_one, written_state

# Replacements in the texts.
SMALL = [
    ("[0, 0, (-9.81)]", "[0, 0, 9.81]"),
    ("com [0.1, 0.2, 0.3]", "com [0.1, -0.2, 0.3]"),
    ("[0.5, 0.05, 0.02], [0.05, 0.6", "[0.5, -0.05, 0.02], [-0.05, 0.6"),
    ("about origin", "about com"),
    ("revolute [0, 0.6, 0.8]", "revolute [0, 0.6, -0.8]"),
    ("roty(0.4)", "roty(-0.4)"),
    ("damping 0.3", "damping 0.300001"),
    ("armature 0.2", "armature 0.21"),
    ("stiffness 2.5", "stiffness 2.6"),
    ("in world;", "in body;"),
    ("sin(a)", "cos(a)"),
]


def small():
    """Two links with most kinds of elements."""
    m = Mechanism("Small")
    u = m.input("u")
    m.gravity = Vec.of([0, 0, "-9.81"])
    m.say(f"gravity {m.gravity.text};")
    inertia = Mat.of([["0.5", "0.05", "0.02"], ["0.05", "0.6", "0.03"], ["0.02", "0.03", "0.7"]])
    axis, place = Vec.of([0, "0.6", "0.8"]), Vec.of(["0.1", 0, "0.2"])
    found = add_joint(m, "a", "revolute", axis, WORLD, (rotation("y", "0.4"), place), "f", "damping 0.3; armature 0.2;")
    a, a_dot = found["a"], found["a_dot"]
    m.generalized.append((0, -(lift("0.3") * a_dot)))
    m.dampers.append((0, lift("0.3") * a_dot))
    m.kinetic.append(lift("0.1") * a_dot**2)
    found = add_joint(m, "b", "continuous", Vec.of([1, 0, 0]), "f", (STILL, Vec.of([0, "0.3", 0])), "g")
    m.bodies = [("f", lift("1.2"), Vec.of(["0.1", "0.2", "0.3"]), inertia, "com"), ("g", lift("0.8"), Vec.of(["0.1", 0, "0.1"]), inertia, "origin")]
    for frame, mass, com, big, where in m.bodies:
        m.say(f"body on {frame} {{ mass {mass.text}; com {com.text}; inertia {big.text} about {where}; }}")
    ends = (("g", Vec.of([0, 0, "0.2"])), (WORLD, Vec.of([1, 1, 0])))
    m.say(f"spring stiffness 2.5 length 0.3 from {ends[0][1].text} on g to {ends[1][1].text} on world;")
    m.springs.append((lift("2.5"), lift("0.3"), ends))
    force, zero = Vec.of([u, "0.2", 0]), Vec.of([0, 0, 0])
    m.say(f"force {force.text} on g in world;")
    m.wrenches.append(("g", zero, force, zero, "world", None))
    from mpmath import sin

    m.say("output y = [sin(a)];")
    m.outputs.append(Output("y", lambda s: [sin(a.at(s))]))
    return m


CLOSED = [
    ("[1, 0, 0]) = 0", "[1, 0.001, 0]) = 0"),
    ("stabilized 2", "stabilized 2.001"),
    ("prismatic [1, 0, 0]", "prismatic [-1, 0, 0]"),
    ("(a - (0.5 * d)) = 0.1", "(a - (0.51 * d)) = 0.1"),
]


def closed_one():
    """A slider-crank whose loop is stabilised, and a gear."""
    m = Mechanism("Closed")
    m.gravity = Vec.of([0, "-9.81", 0])
    m.say(f"gravity {m.gravity.text};")
    inertia = Mat.of([["0.5", 0, 0], [0, "0.6", 0], [0, 0, "0.7"]])
    z, still = Vec.of([0, 0, 1]), (STILL, Vec.of([0, 0, 0]))
    found = add_joint(m, "a", "revolute", z, WORLD, still, "f")
    add_joint(m, "b", "continuous", z, "f", (STILL, Vec.of(["0.5", 0, 0])), "g")
    add_joint(m, "c", "prismatic", Vec.of([1, 0, 0]), WORLD, still, "h")
    found.update(add_joint(m, "d", "revolute", z, WORLD, still, "i"))
    m.bodies = [(frame, lift("1.2"), Vec.of(["0.1", "0.2", 0]), inertia, "com") for frame in "fghi"]
    for frame, mass, com, big, where in m.bodies:
        m.say(f"body on {frame} {{ mass {mass.text}; com {com.text}; inertia {big.text} about {where}; }}")
    pin = Vec.of(["0.9", 0, 0])
    for k, n in enumerate(("[1, 0, 0]", "[0, 1, 0]")):
        m.say(f"loop dot(position(g, {pin.text}) - position(h, [0, 0, 0]), {n}) = 0 stabilized 2;")
        m.closures.append(Ex("", (lambda k: lambda s: m.point(s, "g", pin.at(s))[k] - m.point(s, "h", [0, 0, 0])[k])(k)))
    gear = found["a"] - lift("0.5") * found["d"]
    m.say(f"loop {gear.text} = 0.1;")
    m.closures.append(gear - "0.1")
    m.stabilized = [lift("2"), lift("2"), None]
    m.say("start a ~ 0.4, b ~ -1;")
    m.say("generate all, linearize;")
    return m


def on_loops(m, random_):
    s = closed(m, random_state(m, random_).but(x=[mpf("0.4"), mp.cos(-1), mp.sin(-1), mpf(1), mpf(1)]))
    return allowed_velocities(m, s)


# Texts with their replacements, a function that finds a state, and whether slopes are needed.
CASES = [
    (small, SMALL, random_state, False),
    (closed_one, CLOSED, on_loops, True),
    (driven_one, DRIVEN, driven_state, False),
    (written_one, WRITTEN, written_state, False),
]


def unseen(hamel, folder):
    """Changes that are not detected, and errors without a change."""
    found = []
    for make, changes, state, slopes in CASES:
        for index, (before, after) in enumerate([("", ""), *changes]):
            m, errors = make(), Errors()
            text = m.text()
            if before and before not in text:
                found.append(f"{before} is not in the text")
                continue
            doors = Doors(hamel, os.path.join(folder, f"wrong_{m.name}{index}"))
            doors.write(text.replace(before, after) if before else text)
            try:
                doors.run("emit", doors.file, "--language", "c", "-o", os.path.join(doors.folder, "double"))
                Comparison(m, doors, errors, m.name, slopes=slopes).run(state(m, random.Random(1)))
            except Refused as why:
                errors.found.append((m.name, "refused", str(why)))
            if bool(errors.found) != bool(before):
                found.append(f"{before} → {after}" if before else f"the text as it is: {errors.found}")
    return found
