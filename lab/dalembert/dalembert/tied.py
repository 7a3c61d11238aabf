"""Ties: their forces, the projections onto them, and slopes along displacements that satisfy them."""

from .definitions import Definitions, independent
from .expressions import State
from .mechanism import SIZES
from .vectors import NIL, ONE, add, cross, dot, mp, mpf, on, scale, solve, sub, times, transposed, unit


def names(m):
    """The names of velocities, entry by entry, as in the text."""
    return [name if size == 1 else f"{name}[{k + 1}]" for name, size, _ in m.velocities for k in range(size)]


def nearest(d, s, off):
    """−M⁻¹ Bᵀ S⁻¹ times the violation of the ties, with prescribed rates held: the shortest displacement in the metric
    M."""
    b = d.bonds(s)
    off = off + [NIL] * (len(b) - len(off))
    m = [row[d.first :] for row in d.mass_matrix(s)[d.first :]]
    kept = independent(b)
    b, off = [b[i] for i in kept], [off[i] for i in kept]
    # The shortest displacement that closes the ties is unchanged when BᵀB is added, which makes the matrix regular.
    m = [[entry + sum((row[i] * row[j] for row in b), NIL) for j, entry in enumerate(m_row)] for i, m_row in enumerate(m)]
    ways = [solve(m, row) for row in b]
    inner = solve([[dot(row, way) for way in ways] for row in b], off)
    h = [NIL] * d.of.n
    for factor, way in zip(inner, ways):
        h = sub(h, scale(factor, way))
    return h


def beside(d, s):
    """A state slightly off the ties."""
    x, xi = list(s.x), list(s.xi)
    for k, column in enumerate(d.columns(s)[d.first :]):
        x = add(x, scale(mpf((37 * k + 5) % 11 - 5) / 200, column))
        xi[k] += mpf((23 * k + 3) % 7 - 3) / 10
    x = on_kinds(d.of, x)
    return d.held(s.but(x=[mpf(float(e)) for e in x], xi=[mpf(float(e)) for e in xi]))


def on_kinds(m, x):
    """Normalises circles, quaternions and matrices, and satisfies further coordinate constraints."""
    for _, kind, place in m.coordinates:
        part = x[place : place + SIZES[kind]]
        if kind in ("S1", "S3"):
            part = unit(part)
        elif kind == "SO3":
            first = unit(part[0:3])
            third = unit(cross(first, part[3:6]))
            part = [*first, *cross(third, first), *third]
        x[place : place + len(part)] = part
    for place, size, nearest_to in m.onto:
        x[place : place + size] = nearest_to(x[place : place + size])
    return given(m, x)


def given(m, x):
    """Sets the coordinates prescribed as functions of time."""
    s = State(x)
    for place, kind, value in m.driven:
        value = value.at(s)
        if kind == "S1":
            x[place : place + 2] = [mp.cos(value), mp.sin(value)]
        else:
            x[place] = value
    return x


def allowed_velocities(m, s):
    """The state with the nearest velocities that satisfy the ties, in doubles."""
    if not m.kept and not m.closures:
        return s
    d = Definitions(m)
    b, off = d.conditions(s), d.kept(s)
    rows = independent(b)
    b, off = [b[i] for i in rows], [off[i] for i in rows]
    off = on(transposed(b), solve([[dot(p, q) for q in b] for p in b], off))
    return s.but(xi=[mpf(float(e)) for e in sub(s.xi, off)])


def project_velocity(d, s):
    return add(s.xi, nearest(d, s, d.kept(s)))


def project_position(d, s):
    """The projection onto the loops along displacements that satisfy all other ties; those that determine velocities
    always hold."""
    off = [NIL if k in d.solved else e.at(s) for k, e in enumerate(d.of.closures)]
    return nearest(d, s, off)


def allowed(d, s):
    """A basis of the displacements, velocities and first-order states that satisfy all ties, by columns."""
    of = d.of
    size = of.n + len(d.active) + of.nz
    loops = [row[:size] for row in d.slopes(lambda q: [e.at(q) for e in of.closures], s)] if of.closures else []
    rows = loops + [row[:size] for k, row in enumerate(d.slopes(d.kept, s)) if k not in d.solved]
    return transposed(null_space(rows, size))


def null_space(rows, size):
    """A basis of the kernel of some rows, by elimination with the largest pivots. Parts that come from rounding of the
    state to doubles, or from the elimination, count as zero."""
    reduced = []
    for row in [rows[i] for i in independent(rows, mpf(10) ** -9)]:
        for pivot, other in reduced:
            row = sub(row, scale(row[pivot], other))
        pivot = max(range(size), key=lambda k: abs(row[k]))
        row = scale(1 / row[pivot], row)
        reduced = [(p, sub(other, scale(other[pivot], row))) for p, other in reduced] + [(pivot, row)]
    pivots = {pivot for pivot, _ in reduced}
    found = []
    for free in range(size):
        if free not in pivots:
            vector = [ONE if k == free else NIL for k in range(size)]
            for pivot, row in reduced:
                vector[pivot] = -row[free]
            found.append(vector)
    return found


def minimal(d, s, full, states):
    """The linearisation in some displacements and velocities by name; the others follow from the ties. None if their
    number is not that of the degrees of freedom, or if they do not determine the others."""
    of = d.of
    every = [f"h({v})" for v in names(of)] + [f"d({names(of)[i]})" for i in d.active]
    every += [f"d({name})" if size == 1 else f"d({name}[{k + 1}])" for name, size, _ in of.states for k in range(size)]
    places = [every.index(name) for name in states]
    basis = allowed(d, s)
    if len(places) != len(basis[0]):
        return None
    chosen = [basis[k] for k in places]
    inverse = transposed([solve(chosen, [ONE if k == i else NIL for k in range(len(places))]) for i in range(len(places))])
    size = len(every)
    slopes = times(times([full[k][:size] for k in places], basis), inverse)
    return [row + full[k][size:] for row, k in zip(slopes, places)]


