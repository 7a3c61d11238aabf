"""Elements on scalars and on rates, choices, tables, and outputs made of them."""

from . import vectors
from .expressions import Ex, call, lift
from .vectors import mpf


def hang(forest):
    """Adds a few of them to a mechanism with coordinates and velocities."""
    r = forest.r
    if not forest.plain or not forest.velocities:
        return
    for make in (spring, damper, inerter, force, outputs):
        if r.random() < 0.3:
            make(forest)


def rate_of(forest):
    """A rate that is linear in the velocities, with a factor that varies."""
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


def butland(xs, ys):
    """The Fritsch-Butland slopes (1984) at points, with those of SciPy at the ends."""
    h = [b - a for a, b in zip(xs, xs[1:])]
    d = [(b - a) / step for a, b, step in zip(ys, ys[1:], h)]

    def end(h0, h1, d0, d1):
        slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1)
        if slope * d0 <= 0:
            return mpf(0)
        return 3 * d0 if d0 * d1 <= 0 and abs(slope) > 3 * abs(d0) else slope

    found = [end(h[0], h[1], d[0], d[1])]
    for k in range(1, len(d)):
        p, q = 2 * h[k] + h[k - 1], h[k] + 2 * h[k - 1]
        found.append((p + q) / (p / d[k - 1] + q / d[k]) if d[k - 1] * d[k] > 0 else mpf(0))
    return found + [end(h[-1], h[-2], d[-1], d[-2])]


def cubic(x, xs, ys, slopes):
    """Hermite's cubic between two points; beyond them the straight line with the slope there."""
    h = xs[1] - xs[0]
    for end, before in ((0, x < xs[0]), (1, x > xs[1])):
        if before:
            return ys[end] + slopes[end] * (x - xs[end])
    t = (x - xs[0]) / h
    one, two = (1 + 2 * t) * (1 - t) ** 2 * ys[0], t**2 * (3 - 2 * t) * ys[1]
    return one + two + h * (t * (1 - t) ** 2 * slopes[0] - t**2 * (1 - t) * slopes[1])


def table(forest, name):
    """A piecewise linear table."""
    r = forest.r
    xs = [mpf(k) / 4 - 1 for k in range(5)] if r.random() < 0.5 else [mpf("-0.9"), mpf("-0.2"), mpf("0.15"), mpf("1.1")]
    ys = [mpf(forest.number()) for _ in xs]
    beyond, between = forest.pick(["hold", "linear"]), forest.pick(["linear", "pchip"])
    points = ", ".join(f"({vectors.mp.nstr(x, 6)}, {vectors.mp.nstr(y, 6)})" for x, y in zip(xs, ys))
    forest.m.say(f"table {name} = [{points}] {between} extrapolate {beyond};")
    slopes = butland(xs, ys)

    def of(argument):
        def at(s):
            x = argument.at(s)
            if beyond == "hold":
                x = min(max(x, xs[0]), xs[-1])
            k = max(j for j in range(len(xs) - 1) if j == 0 or x >= xs[j])
            if between == "pchip":
                return cubic(x, xs[k : k + 2], ys[k : k + 2], slopes[k : k + 2])
            return ys[k] + (ys[k + 1] - ys[k]) * (x - xs[k]) / (xs[k + 1] - xs[k])

        return Ex(f"{name}({argument.text})", at)

    return of


def value(forest, name):
    """The value of a choice or a table."""
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
