"""Whether this test can fail: texts that say something else than the data beside them, each by one sign or number."""

import os
import random

from .compare import Comparison, Errors
from .doors import Doors
from .expressions import STILL, Mat, Vec, lift, rotation
from .joints import add_joint
from .mechanism import WORLD, Mechanism
from .trees import Output, random_state

# What is replaced in the text, and by what.
CHANGES = [
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
    """Two links with a little of everything."""
    m = Mechanism("Small")
    u = m.input("u")
    m.gravity = Vec.of([0, 0, "-9.81"])
    m.say(f"gravity {m.gravity.text};")
    inertia = Mat.of([["0.5", "0.05", "0.02"], ["0.05", "0.6", "0.03"], ["0.02", "0.03", "0.7"]])
    axis, place = Vec.of([0, "0.6", "0.8"]), Vec.of(["0.1", 0, "0.2"])
    found = add_joint(m, "a", "revolute", axis, WORLD, (rotation("y", "0.4"), place), "f", "damping 0.3; armature 0.2;")
    a, a_dot = found["a"], found["a_dot"]
    m.generalized.append((0, -(lift("0.3") * a_dot)))
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


def unseen(hamel, folder):
    """Changes that are not found; and what is found where nothing was changed."""
    found = []
    for index, (before, after) in enumerate([("", ""), *CHANGES]):
        m, errors = small(), Errors()
        text = m.text()
        changed = text.replace(before, after) if before else text
        if before and changed == text:
            found.append(f"{before} is not in the text")
            continue
        doors = Doors(hamel, os.path.join(folder, f"wrong{index}"))
        doors.write(changed)
        doors.run("emit", doors.file, "--language", "c", "-o", os.path.join(doors.folder, "double"))
        Comparison(m, doors, errors, "small", slopes=False).run(random_state(m, random.Random(1)))
        if bool(errors.found) != bool(before):
            found.append(f"{before} → {after}" if before else f"the text as it is: {errors.found}")
    return found
