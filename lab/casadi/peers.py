"""Writes the inputs of the comparison to a folder: C by CasADi, descriptions of the robots, a list of cases.

    python peers.py FOLDER

Every function takes (x, ξ, τ) or (x, ξ, ξ̇), like the generated Rust of the same model.
"""

import json
import sys
from pathlib import Path

import casadi as ca
import numpy as np

import robots
from textbook import Body, articulated, newton_euler, places


def offset_body(kind):
    """The parameters of tests/models/free_body.eom and heavy_top.eom."""
    theta = np.array([[2.1, 0.1, -0.2], [0.1, 1.7, 0.15], [-0.2, 0.15, 1.2]])
    m, s = 1.3, np.array([0.1, -0.2, 0.3])
    body = Body("hull", -1, np.eye(3), np.zeros(3), kind)
    body.mass, body.com = m, s
    body.inertia = theta - m * (s @ s * np.eye(3) - np.outer(s, s))
    return [body]


def point(body, mass, com):
    body.mass, body.com = mass, np.array(com, dtype=float)
    return body


def cart_pole():
    x, y = np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
    cart = point(Body("p", -1, np.eye(3), np.zeros(3), "prismatic", x), 1.0, [0, 0, 0])
    return [cart, point(Body("th", 0, np.eye(3), np.zeros(3), "revolute", y), 0.1, [0, 0, 0.5])]


def double_pendulum():
    """Angles increase towards x: the axis is −y."""
    y = np.array([0, -1.0, 0])
    first = point(Body("th1", -1, np.eye(3), np.zeros(3), "revolute", y), 1.0, [0, 0, -1])
    return [first, point(Body("th2", 0, np.eye(3), np.array([0, 0, -1.0]), "revolute", y), 1.0, [0, 0, -1])]


def small(name):
    """Functions in the coordinates and inputs of the models in tests/models."""
    if name == "free_body":
        bodies = offset_body("free")
        return bodies, 12, 6, lambda x, v, u: articulated(bodies, x, v, u), 6
    if name == "heavy_top":
        bodies = offset_body("ball")
        return bodies, 9, 3, lambda x, v, _: articulated(bodies, x, v, ca.SX(3, 1)), 0
    if name == "cart_pole":
        bodies = cart_pole()
        return bodies, 2, 2, lambda x, v, u: articulated(bodies, x, v, ca.vertcat(u, 0)), 1
    bodies = double_pendulum()

    def absolute(x, v, _):
        relative = lambda a: ca.vertcat(a[0], a[1] - a[0])
        rates = articulated(bodies, relative(x), relative(v), ca.SX(2, 1))
        return ca.vertcat(rates[0], rates[0] + rates[1])

    return bodies, 2, 2, absolute, 0


def write(folder, name, expression, widths):
    arguments = [ca.SX.sym(letter, width) for letter, width in zip("xvu", widths)]
    result = ca.densify(expression(*arguments))
    # `cse` keeps the cheapest form; the count is that of CasADi's instructions without moves.
    function = ca.Function(name, arguments, [ca.cse(result)])
    function.generate(f"{name}.c", {"with_header": False})
    Path(f"{name}.c").rename(folder / f"{name}.c")
    counted = {ca.OP_ADD, ca.OP_SUB, ca.OP_MUL, ca.OP_DIV, ca.OP_SQ, ca.OP_TWICE}
    return sum(function.instruction_id(k) in counted for k in range(function.n_instructions()))


def main():
    folder = Path(sys.argv[1])
    (folder / "models").mkdir(parents=True, exist_ok=True)
    cases = []

    def case(model, kind, expression, widths):
        name = f"{model}_{kind}"
        operations = write(folder, name, expression, widths)
        cases.append({"model": model, "kind": kind, "symbol": name, "widths": widths, "operations": operations})

    for model in ("free_body", "heavy_top", "cart_pole", "double_pendulum"):
        _, width, freedoms, expression, inputs = small(model)
        case(model, "accel", expression, [width, freedoms, inputs])
    trees = [("chain6", robots.chain(6))]
    for name, path, locked, floating in robots.ROBOTS:
        trees.append((name, robots.read(robots.folder() / path, locked, floating)))
    for name, bodies in trees:
        at_x, at_v = places(bodies)
        widths = [int(at_x[-1]), int(at_v[-1]), int(at_v[-1])]
        case(name, "accel", lambda x, v, u: articulated(bodies, x, v, u), widths)
        case(name, "inverse", lambda x, v, a: newton_euler(bodies, x, v, a), widths)
        (folder / "models" / f"{name}.eom").write_text(robots.description(name, bodies))
    (folder / "cases.json").write_text(json.dumps(cases, indent=1) + "\n")


main()
