"""Robots from URDF files as trees of bodies, and trees as descriptions for hamel."""

import xml.etree.ElementTree as xml
from pathlib import Path

import numpy as np

from textbook import Body, clean

# Name, file below `example-robot-data/robots`, joints locked at zero, floating base.
ROBOTS = [
    ("ur5", "ur_description/urdf/ur5_robot.urdf", [], False),
    ("panda", "panda_description/urdf/panda.urdf", ["panda_finger_joint1", "panda_finger_joint2"], False),
    ("solo12", "solo_description/robots/solo12.urdf", [], True),
]


def folder():
    """Returns the folder in which the wheel of example-robot-data installs its files."""
    import sys

    for base in map(Path, sys.path):
        found = base / "cmeel.prefix/share/example-robot-data/robots"
        if found.is_dir():
            return found
    raise SystemExit("example-robot-data is not installed: run lab/casadi/run.sh")


def rpy(text):
    a, b, c = ([float(v) for v in text.split()] if text else [0.0, 0.0, 0.0])
    # Angles close to quarter turns are rounded to them.
    a, b, c = (round(v / (np.pi / 2)) * np.pi / 2 if abs(v / (np.pi / 2) - round(v / (np.pi / 2))) < 1e-6 else v for v in (a, b, c))
    x = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    y = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    z = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    return clean(z @ y @ x)


def numbers(element, key, default):
    text = element.get(key) if element is not None else None
    return np.array([float(v) for v in text.split()]) if text else np.array(default, dtype=float)


def read(path, locked, floating):
    """Returns the tree in the order of the file, with fixed joints merged."""
    root = xml.parse(path).getroot()
    links = {link.get("name"): link for link in root.findall("link")}
    joints = root.findall("joint")
    moved = {joint.find("child").get("link") for joint in joints}
    base = next(name for name in links if name not in moved)
    bodies = []

    def load(body, link, rotation, offset):
        part = link.find("inertial")
        if part is None:
            return
        origin, i = part.find("origin"), part.find("inertia")
        turn = rotation @ rpy(origin.get("rpy") if origin is not None else None)
        xx, xy, xz, yy, yz, zz = (float(i.get(k)) for k in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
        inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        com = offset + rotation @ numbers(origin, "xyz", [0, 0, 0])
        body.add(float(part.find("mass").get("value")), com, turn @ inertia @ turn.T)

    def visit(name, carrier, rotation, offset):
        if carrier >= 0:
            load(bodies[carrier], links[name], rotation, offset)
        for joint in (j for j in joints if j.find("parent").get("link") == name):
            origin = joint.find("origin")
            turn = rotation @ rpy(origin.get("rpy") if origin is not None else None)
            place = offset + rotation @ numbers(origin, "xyz", [0, 0, 0])
            child, kind = joint.find("child").get("link"), joint.get("type")
            if kind == "fixed" or joint.get("name") in locked:
                visit(child, carrier, turn, place)
                continue
            kind = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic"}[kind]
            axis = numbers(joint.find("axis"), "xyz", [1, 0, 0])
            bodies.append(Body(joint.get("name"), carrier, clean(turn), clean(place), kind, axis))
            visit(child, len(bodies) - 1, np.eye(3), np.zeros(3))

    if floating:
        bodies.append(Body("base", -1, np.eye(3), np.zeros(3), "free"))
    visit(base, 0 if floating else -1, np.eye(3), np.zeros(3))
    return bodies


def rotation_text(matrix):
    """A quarter turn as a matrix; other rotations as roll, pitch and yaw."""
    matrix = clean(matrix)
    if np.array_equal(matrix, np.round(matrix)):
        rows = ", ".join("[" + ", ".join(str(int(v)) for v in row) + "]" for row in matrix)
        return f"[{rows}]"
    b = -np.arcsin(np.clip(matrix[2, 0], -1, 1))
    a, c = np.arctan2(matrix[2, 1], matrix[2, 2]), np.arctan2(matrix[1, 0], matrix[0, 0])
    return f"rpy({number(a)}, {number(b)}, {number(c)})"


def number(value):
    return np.format_float_positional(clean(value), trim="-")


def vector(values):
    return "[" + ", ".join(number(v) for v in values) + "]"


def description(name, bodies):
    """The description of a tree, in the form of `hamel import`, with an input for every degree of freedom."""
    lines = [f"/// {name}, from its tree of joints.", f"pub system {name.title().replace('_', '')} {{"]
    total = sum(body.freedoms for body in bodies)
    for i, body in enumerate(bodies):
        if body.kind == "free":
            lines += [f"    coord r{i}: R3, R{i}: SO3;", f"    velocity v{i}: vec3, w{i}: vec3;"]
            lines += [f"    rate r{i} = R{i} * v{i};", f"    rate R{i} = R{i} * hat(w{i});"]
            lines.append(f"    frame f{i} = pose(R{i}, r{i});")
        else:
            on = "" if body.parent < 0 else f" on f{body.parent}"
            lines += [f"    coord q{i};", f"    velocity u{i};", f"    rate q{i} = u{i};"]
            fixed, offset = rotation_text(body.rotation), vector(body.offset)
            axis = clean(body.axis)
            if body.kind == "prismatic":
                lines.append(f"    frame f{i}{on} = pose({fixed}, {offset} + {fixed} * {vector(axis)} * q{i});")
            else:
                along = int(np.argmax(np.abs(axis)))
                sign = "-" if axis[along] < 0 else ""
                plain = np.count_nonzero(axis) == 1
                turn = f"rot{'xyz'[along]}({sign}q{i})" if plain else f"axis_angle({vector(axis)}, q{i})"
                whole = turn if np.array_equal(clean(body.rotation), np.eye(3)) else f"{fixed} * {turn}"
                lines.append(f"    frame f{i}{on} = pose({whole}, {offset});")
        if body.mass > 0:
            j = body.inertia
            rows = ", ".join(vector(row) for row in (j + j.T) / 2)
            lines.append(
                f"    body on f{i} {{ mass {number(body.mass)}; com {vector(body.com)}; inertia [{rows}] about com; }}"
            )
    lines += ["    gravity [0, 0, -9.81];", f"    input tau: vec{total};"]
    at = 0
    for i, body in enumerate(bodies):
        for velocity in [f"v{i}", f"w{i}"] if body.kind == "free" else []:
            entries = ", ".join(f"tau[{at + k}]" for k in (1, 2, 3))
            lines.append(f"    generalized force {velocity} = [{entries}];")
            at += 3
        if body.kind != "free":
            at += 1
            lines.append(f"    generalized force u{i} = tau[{at}];")
    lines += ["}", ""]
    return "\n".join(lines)


def chain(count):
    """A generic chain: only the axes contain zeros."""
    bodies = []
    for i in range(count):
        inertia = np.array([[0.02, 0.001, 0.002], [0.001, 0.03, 0.003], [0.002, 0.003, 0.04]])
        body = Body(f"q{i}", i - 1, np.eye(3), np.array([0.1, -0.05, -0.6]), "revolute", np.eye(3)[(i + 1) % 3])
        body.mass, body.com, body.inertia = 1.0 + 0.1 * i, np.array([0.1, 0.02, -0.3]), inertia
        bodies.append(body)
    return bodies
