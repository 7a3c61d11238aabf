"""Frames, momenta, outputs and parameters from their definitions."""

from .definitions import STEP, Definitions, difference
from .vectors import NIL, add, cross, dot, on, scale, sub, times, transposed, vee


def frame(d: Definitions, s, name, own):
    """Pose, twist, Jacobian and bias acceleration, in world axes or in the frame's axes."""
    of = d.of
    r, p = of.pose(s, name)
    back = transposed(r) if own else None

    def spoken(v, w):
        return (on(back, v) + on(back, w)) if own else (v + w)

    pose = [r[i] + [p[i]] for i in range(3)]
    rate = of.rate(s)
    dr, dp = d.along(lambda q: of.pose(q, name), s, rate)
    w = vee(times(dr, transposed(r)))
    zero = d.wide(s, [NIL] * len(d.active))
    ddr, ddp = d.second(lambda q: of.pose(q, name), s, zero)
    w_dot = vee(times(ddr, transposed(r)))
    jacobian = [d.on_active(row, s) for row in transposed([spoken(v, w_) for v, w_ in d.twists(s, name, [NIL] * 3)])]
    bias = spoken(sub(ddp, cross(w, dp)) if own else ddp, w_dot)
    return {"pose": pose, "twist": spoken(dp, w), "jacobian": jacobian, "bias_acceleration": bias}


def moving(d, s):
    """The masses that move along a velocity or with time: fixed ones do not contribute to the momentum."""
    if "moving" not in s.shape:
        ways = [*d.motions(s), d.along(d.places, s, d.of.rate(s))]
        s.shape["moving"] = [any(e != 0 for r, p in poses for e in [*p, *sum(r, [])]) for poses in zip(*ways)]
    return [mass for mass, moves in zip(d.of.masses(s), s.shape["moving"]) if moves]


def centre(d, s):
    total, first = NIL, [NIL] * 3
    for (r, p), m, h, _ in moving(d, s):
        total += m
        first = add(first, add(scale(m, p), on(r, h)))
    return scale(1 / total, first)


def momentum(d, s):
    """The total momentum, and the angular momentum about the centre of mass."""
    c = centre(d, s)
    rates = d.along(lambda q: [pose for pose, *_ in moving(d, q)], s, d.of.rate(s))
    linear, angular = [NIL] * 3, [NIL] * 3
    for ((r, p), m, h, second), (dr, dp) in zip(moving(d, s), rates):
        arm = sub(p, c)
        rh, drh = on(r, h), on(dr, h)
        linear = add(linear, add(scale(m, dp), drh))
        angular = add(angular, add(scale(m, cross(arm, dp)), add(cross(arm, drh), cross(rh, dp))))
        # Σ (R s) × (Ṙ s) dm by the second moments.
        inner = times(times(r, second), transposed(dr))
        angular = add(angular, [inner[1][2] - inner[2][1], inner[2][0] - inner[0][2], inner[0][1] - inner[1][0]])
    return linear + angular


def centroidal_map(d, s):
    n = d.of.n
    still = momentum(d, s.but(xi=[NIL] * n))
    columns = [sub(momentum(d, s.but(xi=[1 if k == i else NIL for k in range(n)])), still) for i in range(n)]
    return [d.on_active(row, s) for row in transposed(columns)]


def centroidal_bias(d, s):
    return d.first_order_wide(lambda q: momentum(d, q), s, d.wide(s, [NIL] * len(d.active)))


def output_slopes(d, s, output):
    """[C D], along ξ̇ = F if the output depends on accelerations."""

    def value(q):
        if output.accelerations:
            q = q.but(a=d.motion(q)[0])
        return output.at(q)

    return d.slopes(value, s)


def parameter_slopes(d, s):
    columns = []
    for k in range(len(s.p)):
        values = []
        for sign in (1, -1):
            p = list(s.p)
            p[k] += sign * STEP
            values.append(d.accel(d.held(s.but(p=p))))
        columns.append(difference(values[0], values[1], 2 * STEP))
    return transposed(columns)


def kinetic_energy(d, s):
    motion = d.along(d.places, s, d.of.rate(s))
    return d.paired(motion, motion, s) / 2 + d.written_energy(s)


def momenta(d, s):
    """∂T/∂ξ by differences: exact, since T is quadratic."""
    found = []
    for i in range(d.of.n):
        up, down = list(s.xi), list(s.xi)
        up[i] += 1
        down[i] -= 1
        found.append((kinetic_energy(d, s.but(xi=up)) - kinetic_energy(d, s.but(xi=down))) / 2)
    return found


__all__ = ["dot"]
