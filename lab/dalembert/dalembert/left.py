"""Dependent velocities, ξ = C ξₐ + c, for which ties are solved. Which ones hamel chooses is read from its names and
from its `rate`; that they depend on as many ties, and the consequences, are computed here."""

from itertools import combinations

from .definitions import WIDE, Definitions
from .vectors import NIL, ONE, add, least_squares, on, scale, solve, sub, times, transposed


class Left(Definitions):
    """The definitions for the independent velocities."""

    def __init__(self, mechanism, active, solved):
        super().__init__(mechanism)
        self.active, self.solved = active, solved

    def section(self, s):
        """C and c"""
        if "section" not in s.shape:
            n, rows = self.of.n, self.conditions(s)
            rows = [rows[i] for i in self.solved]
            rest = [self.kept(s.but(xi=[NIL] * n))[i] for i in self.solved]
            s.shape["section"] = section(rows, rest, self.active, n)
        return s.shape["section"]

    def held(self, s):
        c, shift = self.section(s)
        return s.but(xi=add(on(c, [s.xi[i] for i in self.active]), shift))

    def wide(self, s, given):
        c, _ = self.section(s)
        drift = self.along(lambda q: self.held(q).xi, s, self.of.rate(s), WIDE)
        return add(drift, on(c, given))

    def on_active(self, force, s):
        return on(transposed(self.section(s)[0]), force)

    def mass_active(self, s, m):
        c, _ = self.section(s)
        return times(times(transposed(c), m), c)


def section(rows, rest, active, n):
    """C and c of some rows, with their values at rest."""
    others = [i for i in range(n) if i not in active]
    c = [[NIL] * len(active) for _ in range(n)]
    shift = [NIL] * n
    for k, i in enumerate(active):
        c[i][k] = ONE
        for j, entry in zip(others, solve([[row[j] for j in others] for row in rows], [-row[i] for row in rows])):
            c[j][k] = entry
    for j, entry in zip(others, solve([[row[j] for j in others] for row in rows], scale(-ONE, rest))):
        shift[j] = entry
    return c, shift


def found(mechanism, active, rate, s, tolerance):
    """The definitions for the active velocities, from the ties that agree with rates of unit velocities; None if no
    ties do."""
    n = mechanism.n
    if len(active) == n:
        return Definitions(mechanism)
    d = Definitions(mechanism)
    conditions = d.conditions(s)
    rest = d.kept(s.but(xi=[NIL] * n))
    still = rate([NIL] * len(active))
    columns = transposed(d.columns(s)[d.first :])
    theirs = [least_squares(columns, sub(rate([ONE if k == i else NIL for k in range(len(active))]), still)) for i in range(len(active))]
    for rows in combinations(range(len(conditions)), n - len(active)):
        try:
            c, _ = section([conditions[i] for i in rows], [rest[i] for i in rows], active, n)
        except ZeroDivisionError:
            continue
        if all(abs(a - b) < tolerance * (1 + abs(a)) for p, q in zip(transposed(c), theirs) for a, b in zip(p, q)):
            return Left(mechanism, active, list(rows))
    return None
