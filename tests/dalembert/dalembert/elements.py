"""Elements on scalars and on rates, choices, tables, and outputs that are made of them."""

from . import vectors
from .expressions import Ex, call, lift
from .vectors import mpf


def hang(forest):
    """A few of them on a mechanism that has coordinates and velocities."""
    r = forest.r
    if not forest.plain or not forest.velocities:
        return
    for make in (spring, damper, inerter, force, outputs):
        if r.random() < 0.3:
            make(forest)


def rate_of(forest):
    """A rate that is linear in the velocities, with a factor that changes."""
    a, b = forest.pick(forest.velocities), forest.pick(forest.velocities)
    return a * (call("sin", forest.pick(forest.plain)) + "1.3") - b * forest.number()


def spring(forest):
    m, k, rest = forest.m, forest.value(), lift(forest.number())
    scalar = forest.smooth() + forest.pick(forest.plain)
    m.say(f"spring stiffness {k.text} length {rest.text} on {scalar.text};")
    m.potential.append(k * (scalar - rest) ** 2 / 2)
    forest.written = True


def damper(forest):
    m, c, rate = forest.m, forest.value(), rate_of(forest)
    m.say(f"damper coefficient {c.text} on {rate.text};")
    m.dissipation.append(c * rate**2 / 2)
    forest.written = True


def inerter(forest):
    m, b, rate = forest.m, forest.value(), rate_of(forest)
    m.say(f"inerter inertance {b.text} on {rate.text};")
    m.kinetic.append(b * rate**2 / 2)
    forest.written = True


def choice(left, sign, right, then, other):
    """`if left < right { then } else { other }`."""
    holds = {"<": lambda a, b: a < b, "<=": lambda a, b: a <= b, ">": lambda a, b: a > b, ">=": lambda a, b: a >= b}[sign]

    def at(s):
        return then.at(s) if holds(left.at(s), right.at(s)) else other.at(s)

    return Ex(f"(if {left.text} {sign} {right.text} {{ {then.text} }} else {{ {other.text} }})", at)


def table(forest, name):
    """Straight lines through points."""
    r = forest.r
    xs = [mpf(k) / 4 - 1 for k in range(5)] if r.random() < 0.5 else [mpf("-0.9"), mpf("-0.2"), mpf("0.15"), mpf("1.1")]
    ys = [mpf(forest.number()) for _ in xs]
    beyond = forest.pick(["hold", "linear"])
    points = ", ".join(f"({vectors.mp.nstr(x, 6)}, {vectors.mp.nstr(y, 6)})" for x, y in zip(xs, ys))
    forest.m.say(f"table {name} = [{points}] linear extrapolate {beyond};")

    def of(argument):
        def at(s):
            x = argument.at(s)
            if beyond == "hold":
                x = min(max(x, xs[0]), xs[-1])
            k = max(j for j in range(len(xs) - 1) if j == 0 or x >= xs[j])
            return ys[k] + (ys[k + 1] - ys[k]) * (x - xs[k]) / (xs[k + 1] - xs[k])

        return Ex(f"{name}({argument.text})", at)

    return of


def value(forest, name):
    """Of a choice or a table."""
    r = forest.r
    if r.random() < 0.5:
        return table(forest, name)(forest.pick(forest.plain + forest.velocities))
    a, b = forest.pick(forest.plain + forest.velocities), lift(forest.number())
    one, other = forest.effort(), call(forest.pick(["max", "min"]), forest.pick(forest.velocities), forest.number())
    return choice(a, forest.pick(["<", "<=", ">", ">="]), b, one, other)


def force(forest):
    m = forest.m
    single = [(name, place) for name, size, place in m.velocities if size == 1]
    if not single:
        return
    name, place = forest.pick(single)
    law = value(forest, "curve") - call("clamp", forest.pick(forest.velocities), "-0.4", "0.5")
    m.say(f"generalized force {name} = {law.text};")
    m.generalized.append((place, law))


def outputs(forest):
    from .definitions import Definitions
    from .trees import Output

    m = forest.m
    level = value(forest, "level_table")
    m.say(f"output level = {level.text};")
    m.outputs.append(Output("level", lambda s: [level.at(s)]))
    frame, p = forest.end()
    d = Definitions(m)
    m.say(f"output growth = rate(norm(position({frame}, {p.text}) - [2, 3, 4]));")
    away = [mpf(2), mpf(3), mpf(4)]
    m.outputs.append(Output("growth", lambda s: d.along(lambda q: [vectors.norm(vectors.sub(m.point(q, frame, p.at(q)), away))], s, m.rate(s))))
