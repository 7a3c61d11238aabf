"""Functions for integrators, and dampers: chart rates, the correction back to X, displacements and their frames."""

from . import tied
from .vectors import NIL, ONE, dot, mpf, sub, times, transposed, vee


def chart_rate(m, s):
    """ẋ, θ̇, the angular velocity in body axes, kind by kind."""
    x, rate, found = s.x, m.rate(s), []
    for _, kind, at in m.coordinates:
        if kind == "S1":
            found.append(x[at] * rate[at + 1] - x[at + 1] * rate[at])
        elif kind == "S3":
            a, b, c, d = x[at : at + 4]
            p, q, r, t = rate[at : at + 4]
            found += [2 * (a * q - b * p - c * t + d * r), 2 * (a * r + b * t - c * p - d * q), 2 * (a * t - b * r + c * q - d * p)]
        elif kind == "SO3":
            big, moved = ([v[at + 3 * i : at + 3 * i + 3] for i in range(3)] for v in (x, rate))
            found += vee(times(transposed(big), moved))
        else:
            found += rate[at : at + {"real": 1, "R2": 2, "R3": 3}[kind]]
    return found


def dissipation(d, s):
    """Half of the power of dampers."""
    m = d.of
    half = sum((e.at(s) for e in m.dissipation), NIL)
    half += sum((force.at(s) * s.xi[place] / 2 for place, force in m.dampers), NIL)
    for k, ends in m.line_dampers:
        half += k.at(s) * d.along(lambda q: [m.distance(q, ends)], s, m.rate(s))[0] ** 2 / 2
    return half


def compare(comparison, c, s, given, kind, tolerance):
    """Compares all of these that exist."""
    d, m, note = comparison.d, comparison.m, comparison.note
    if "chart_rate" in c:
        mine = chart_rate(m, s)
        note(kind + "chart_rate", mine, c.call("chart_rate", len(mine), **given), tolerance)
    if "dissipation" in c:
        note(kind + "dissipation", [dissipation(d, s)], c.call("dissipation", 1, **given), tolerance)
    columns = d.columns(s)[d.first :]
    if "displacement_frame" in c:
        mine = transposed(columns)
        note(kind + "displacement_frame", mine, c.call("displacement_frame", m.nu * m.n, **given), tolerance)
    if "displacement_coframe" in c:
        y = [mpf(e) for e in c.call("displacement_coframe", m.nu * m.n, **given)]
        y = [y[k * m.nu : (k + 1) * m.nu] for k in range(m.n)]
        identity = [[ONE if i == j else NIL for j in range(m.n)] for i in range(m.n)]
        note(kind + "displacement_coframe", identity, [[dot(row, column) for column in columns] for row in y], tolerance)
    if "correction" in c and not m.driven and not kind:
        correction(m, c, s, note)


def correction(m, c, s, note):
    """A correction reduces an error of ε to ε²."""
    off = lambda x: sub(x, tied.on_kinds(m, list(x)))  # noqa: E731
    x = [mpf(float(e * (1 + mpf((29 * k + 3) % 13 - 6) / 10**6))) for k, e in enumerate(s.x)]
    step = c.call("correction", m.nu, x=[float(e) for e in x])
    before, after = max(map(abs, off(x)), default=NIL), max(map(abs, off([a + mpf(b) for a, b in zip(x, step)])), default=NIL)
    if before > 0:
        note("correction", [ONE], [ONE + after / before], 1e-3)
    else:
        note("correction", [NIL] * m.nu, step)


__all__ = ["compare"]
