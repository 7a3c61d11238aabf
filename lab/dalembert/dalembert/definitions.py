"""The quantities that hamel computes, from their definitions: poses are differentiated by differences of 80 digits,
forces are balanced by d'Alembert's principle, and γ comes from commutators of the columns of A, independently of
hamel's derivations."""

from mpmath import mpf

from . import vectors
from .vectors import NIL, ONE, add, cross, dot, least_squares, mpf as number, on, scale, solve, sub, times, transposed, vee

STEP = number(10) ** -20
# Tolerance of values that are computed from differences.
WIDE = number(10) ** -13


def unit(n, i):
    return [ONE if k == i else NIL for k in range(n)]


class Definitions:
    """The definitions for a mechanism. With time, everything is extended by the index 0, whose velocity is 1."""

    def __init__(self, mechanism):
        self.of = mechanism
        self.time = mechanism.time is not None
        self.first = 1 if self.time else 0
        # Indices of the independent velocities, and the ties for the others; none here.
        self.active, self.solved = list(range(mechanism.n)), []

    def held(self, s):
        """The state with its dependent velocities."""
        return s

    def wide(self, s, given):
        """ξ̇ of all velocities, from that of the active ones."""
        return list(given)

    def on_active(self, force, s):
        """The force on active velocities."""
        return force

    def mass_active(self, s, m):
        """The inertia of active velocities."""
        return m

    # The columns of A, and displacements along them.

    def columns(self, s):
        """The columns of A at a state; with time, the first is that of the time."""
        n = self.of.n
        if "columns" in s.shape:
            return s.shape["columns"]
        still = self.of.rate(s.but(xi=[NIL] * n))
        found = [still] if self.time else []
        for i in range(n):
            found.append(sub(self.of.rate(s.but(xi=unit(n, i))), still))
        s.shape["columns"] = found
        return found

    def moved(self, s, direction, step):
        return s.but(x=add(s.x, scale(step, direction)))

    def along(self, f, s, direction, step=STEP):
        """The derivative of f, a list of numbers or lists of them, along a direction of ẋ."""
        return difference(f(self.moved(s, direction, step)), f(self.moved(s, direction, -step)), 2 * step)

    def curve(self, s, xi_dot, t):
        """The position of a motion with ξ(t) = ξ + t ξ̇, to second order."""
        rate = self.of.rate(s)
        e = STEP
        ahead = self.of.rate(s.but(x=add(s.x, scale(e, rate)), xi=add(s.xi, scale(e, xi_dot))))
        behind = self.of.rate(s.but(x=sub(s.x, scale(e, rate)), xi=sub(s.xi, scale(e, xi_dot))))
        bend = scale(1 / (2 * e), sub(ahead, behind))
        x = [a + t * b + t * t / 2 * c for a, b, c in zip(s.x, rate, bend)]
        return s.but(x=x, xi=add(s.xi, scale(t, xi_dot)))

    def second(self, f, s, xi_dot):
        """The second derivative of f along the motion of `curve`."""
        e = STEP
        ahead, here, behind = f(self.curve(s, xi_dot, e)), f(s), f(self.curve(s, xi_dot, -e))
        return combine(lambda a, b, c: (a - 2 * b + c) / e**2, ahead, here, behind)

    def first_order(self, f, s, xi_dot):
        """The first derivative of f along the motion of `curve`."""
        e = STEP
        return difference(f(self.curve(s, xi_dot, e)), f(self.curve(s, xi_dot, -e)), 2 * e)

    # Masses.

    def places(self, s):
        return [pose for pose, *_ in self.of.masses(s)]

    def paired(self, a, b, s):
        """∫ ȧ · ḃ dm of two motions of all masses."""
        sum_ = NIL
        for (ra, pa), (rb, pb), (_, m, h, second) in zip(a, b, self.of.masses(s)):
            sum_ += m * dot(pa, pb) + dot(pa, on(rb, h)) + dot(on(ra, h), pb)
            turned = times(ra, second)
            sum_ += sum((dot(turned[i], rb[i]) for i in range(3)), NIL)
        return sum_

    def motions(self, s):
        """∂ᵢ of all poses."""
        if "motions" not in s.shape:
            s.shape["motions"] = [self.along(self.places, s, column) for column in self.columns(s)]
        return s.shape["motions"]

    def written_energy(self, s):
        """Kinetic energies other than those of masses: `kinetic` statements, inerters, armatures."""
        t = sum((e.at(s) for e in self.of.kinetic), NIL)
        w = [ONE] * self.first + list(s.xi)
        for inertance, slopes in zip(self.of.inerters, self.stretches(s)):
            t += inertance[0].at(s) * dot(slopes, w) ** 2 / 2
        return t

    def stretches(self, s):
        """∂ᵢ of the lengths of inerters."""
        if not self.of.inerters:
            return []
        if "stretches" not in s.shape:
            lengths = lambda q: [self.of.distance(q, ends) for _, ends in self.of.inerters]  # noqa: E731
            s.shape["stretches"] = transposed([self.along(lengths, s, column) for column in self.columns(s)])
        return s.shape["stretches"]

    def written_inertia(self, s):
        if "written" not in s.shape:
            s.shape["written"] = self.polarised(s)
        return s.shape["written"]

    def polarised(self, s):
        """The second derivatives of these energies by velocities, exactly, since they are quadratic; index 0 is
        homogeneous."""
        n, first = self.of.n, self.first
        size = n + first
        if not self.of.kinetic and not self.of.inerters:
            return [[NIL] * size for _ in range(size)]

        def t(xi):
            return self.written_energy(s.but(xi=xi))

        zero, units = t([NIL] * n), [unit(n, i) for i in range(n)]
        m = [[NIL] * size for _ in range(size)]
        for i in range(n):
            plus, minus = t(units[i]), t(scale(-ONE, units[i]))
            m[i + first][i + first] = plus + minus - 2 * zero
            if first:
                m[0][i + first] = m[i + first][0] = (plus - minus) / 2
            for j in range(i):
                both = t(add(units[i], units[j])) - t(units[i]) - t(units[j]) + zero
                m[i + first][j + first] = m[j + first][i + first] = both
        if first:
            m[0][0] = 2 * zero
        return m

    def mass_matrix(self, s):
        if "mass" not in s.shape:
            d, m = self.motions(s), [list(row) for row in self.written_inertia(s)]
            for i in range(len(d)):
                for j in range(i + 1):
                    m[i][j] = m[j][i] = m[i][j] + self.paired(d[i], d[j], s)
            s.shape["mass"] = m
        return s.shape["mass"]

    def gamma(self, s):
        if "gamma" not in s.shape:
            s.shape["gamma"] = self.commutators(s)
        return s.shape["gamma"]

    def commutators(self, s):
        """γ[i][j][k] of lower i, j and upper k: [Aᵢ, Aⱼ] = γᵢⱼᵏ Aₖ."""
        a = self.columns(s)
        d = [self.along(self.columns, s, column) for column in a]
        rows = transposed(a)
        size = len(a)
        zero = [NIL] * size
        g = [[zero for _ in range(size)] for _ in range(size)]
        for i in range(size):
            for j in range(i):
                bracket = sub(d[i][j], d[j][i])
                if any(abs(b) > 1e-40 for b in bracket):
                    g[i][j] = least_squares(rows, bracket)
                    g[j][i] = scale(-ONE, g[i][j])
        return g

    def connection(self, s):
        """Γᵢⱼₖ = ∫ ∂ᵢr · ∂ₖ∂ⱼr dm of the masses; for other energies by (23) from their inertia."""
        d = self.motions(s)
        a = self.columns(s)
        size = len(a)
        second = [self.along(self.motions, s, a[k], WIDE / 100) for k in range(size)]
        found = [[[self.paired(d[i], second[k][j], s) for k in range(size)] for j in range(size)] for i in range(size)]
        if self.of.kinetic or self.of.inerters:
            m, g = self.written_inertia(s), self.gamma(s)
            dm = [self.along(self.written_inertia, s, column, WIDE / 100) for column in a]
            for i in range(size):
                for j in range(size):
                    for k in range(size):
                        sum_ = dm[k][i][j] + dm[j][i][k] - dm[i][j][k]
                        for q in range(size):
                            sum_ += g[i][j][q] * m[q][k] + g[i][k][q] * m[q][j] - g[j][k][q] * m[q][i]
                        found[i][j][k] += sum_ / 2
        return found

    # Forces.

    def written_bias(self, s, xi_dot):
        """d/dt ∂T/∂ξ − ∂ᵢT + γ ξ ∂T/∂ξ of the other energies, along a motion, by Lagrange's and Hamel's form."""
        n, first = self.of.n, self.first
        if not self.of.kinetic and not self.of.inerters:
            return [NIL] * n

        def momenta(p):
            m = self.written_inertia(p)
            w = [ONE] * first + list(p.xi)
            return on(m, w)

        p, p_dot = momenta(s), self.first_order_wide(momenta, s, xi_dot)
        g, w = self.gamma(s), [ONE] * first + list(s.xi)
        found = []
        for i, column in enumerate(self.columns(s)[first:]):
            slope = self.along(lambda q: [self.written_energy(q)], s, column, WIDE)[0]
            turned = sum((w[j] * dot(g[i + first][j], p) for j in range(len(w))), NIL)
            found.append(p_dot[i + first] - slope + turned)
        return found

    def first_order_wide(self, f, s, xi_dot):
        e = WIDE
        return difference(f(self.curve(s, xi_dot, e)), f(self.curve(s, xi_dot, -e)), 2 * e)

    def inertia_force(self, s, xi_dot):
        """The force that accelerates the masses, by d'Alembert: ∫ r̈ · ∂ᵢr dm."""
        pull = self.second(self.places, s, xi_dot)
        d = self.motions(s)[self.first :]
        return add([self.paired(pull, di, s) for di in d], self.written_bias(s, xi_dot))

    def potential_force(self, s, energy=None):
        energy = energy or self.of.potential_energy
        return [self.along(lambda q: [energy(q)], s, c)[0] for c in self.columns(s)[self.first :]]

    def twists(self, s, frame, point):
        """∂ᵢ of a point of a frame and of the frame's rotation, in world axes."""
        found = []
        r = transposed(self.of.pose(s, frame)[0])
        for column in self.columns(s)[self.first :]:
            dr, dp = self.along(lambda q: self.of.pose(q, frame), s, column)
            found.append((add(dp, on(dr, point)), vee(times(dr, r))))
        return found

    def generalized_force(self, s):
        """The generalized force of applied loads, by virtual work."""
        of = self.of
        f = [NIL] * of.n
        columns = self.columns(s)[self.first :]
        for frame, point, force, torque, axes, source in of.wrenches:
            turned = of.pose(s, frame if axes == "body" else axes)[0]
            big_f, big_t, place = on(turned, force.at(s)), on(turned, torque.at(s)), point.at(s)
            f = add(f, [dot(big_f, v) + dot(big_t, w) for v, w in self.twists(s, frame, place)])
            if source is not None:
                at = of.point(s, frame, place)
                r, p = of.pose(s, source)
                f = sub(f, [dot(big_f, v) + dot(big_t, w) for v, w in self.twists(s, source, on(transposed(r), sub(at, p)))])
        for ends, law in of.lines_of_force:
            length = of.distance(s, ends)
            rate = self.along(lambda q: [of.distance(q, ends)], s, of.rate(s))[0]
            slopes = [self.along(lambda q: [of.distance(q, ends)], s, c)[0] for c in columns]
            f = add(f, scale(law(s, length, rate), slopes))
        for place, law in of.generalized:
            f[place] += law.at(s)
        for d in of.dissipation:
            for i in range(of.n):
                e = scale(STEP, unit(of.n, i))
                f[i] -= (d.at(s.but(xi=add(s.xi, e))) - d.at(s.but(xi=sub(s.xi, e)))) / (2 * STEP)
        return f

    def inverse_dynamics(self, s, xi_dot):
        return add(self.inertia_force(s, xi_dot), self.potential_force(s))

    # Constraints: of the configuration, and on velocities.

    def kept(self, s):
        """Quantities that vanish at a valid state: the rates of closures, and velocity constraints."""
        rate = self.of.rate(s)
        rows = [self.along(lambda q: [e.at(q) for e in self.of.closures], s, rate)] if self.of.closures else [[]]
        return rows[0] + [e.at(s) for e in self.of.kept]

    def conditions(self, s):
        """B of B ξ + b = 0"""
        still = self.kept(s.but(xi=[NIL] * self.of.n))
        return transposed([sub(self.kept(s.but(xi=unit(self.of.n, i))), still) for i in range(self.of.n)])

    def bonds(self, s):
        """The rows of B, and those of velocities with prescribed rates."""
        ties = self.conditions(s) if self.of.closures or self.of.kept else []
        return ties + [unit(self.of.n, place) for place, _ in self.of.accelerated]

    def decay(self, s):
        """The term added to φ̈ so that (d/dt + λ)² φ = 0."""
        speeds, found = self.kept(s) if any(self.of.stabilized) else [], []
        for k, decay in enumerate(self.of.stabilized):
            rate = decay.at(s) if decay else NIL
            found.append(2 * rate * speeds[k] + rate**2 * self.of.closures[k].at(s) if decay else NIL)
        return found + [NIL] * len(self.of.kept)

    def motion(self, s):
        """ξ̇, and the force of ties and prescribed rates."""
        n = self.of.n
        zero = [NIL] * n
        m = [row[self.first :] for row in self.mass_matrix(s)[self.first :]]
        force = sub(self.generalized_force(s), self.inverse_dynamics(s, zero))
        b, b_dot = self.bonds(s), []
        if not b:
            return solve(m, force), []
        if self.of.closures or self.of.kept:
            b_dot = add(self.first_order_wide(self.kept, s, zero), self.decay(s))
        b_dot += [-rate.at(s) for _, rate in self.of.accelerated]
        rows = independent(b)
        b, b_dot = [b[i] for i in rows], [b_dot[i] for i in rows]
        big = [m[i] + [-b[k][i] for k in range(len(b))] for i in range(n)]
        big += [b[k] + [NIL] * len(b) for k in range(len(b))]
        solution = solve(big, force + scale(-ONE, b_dot))
        return solution[:n], on(transposed(b), solution[n:])

    def accel(self, s):
        """ξ̇ and ż."""
        if "accel" not in s.kept:
            a = self.motion(s)[0]
            full = s.but(a=a)
            s.kept["accel"] = [a[i] for i in self.active] + [rate.at(full) for rate in self.of.state_rates]
        return s.kept["accel"]

    # Slopes.

    def displaced(self, s, k, step):
        """Displaced along h for k < n, then along δξ, δz, and δu."""
        key = ("displaced", k, step > 0)
        if key not in s.kept:
            s.kept[key] = self.beside(s, k, step)
        return s.kept[key]

    def beside(self, s, k, step):
        n = self.of.n
        if k < n:
            return self.held(self.moved(s, self.columns(s)[self.first + k], step))
        k -= n
        if k < len(self.active):
            return self.held(s.but(xi=add(s.xi, scale(step, unit(n, self.active[k])))))
        k -= len(self.active)
        for name, size in (("z", self.of.nz), ("u", self.of.m)):
            if k < size:
                return s.but(**{name: add(getattr(s, name), scale(step, unit(size, k)))})
            k -= size
        raise IndexError

    def count(self):
        """The number of h, δξ, δz and δu."""
        return self.of.n + len(self.active) + self.of.nz + self.of.m

    def slopes(self, f, s):
        """Rows of a list of numbers, columns along h, δξ, δz, δu."""
        count, columns = self.count(), []
        for k in range(count):
            ahead, behind = f(self.displaced(s, k, WIDE)), f(self.displaced(s, k, -WIDE))
            columns.append(scale(1 / (2 * WIDE), sub(ahead, behind)))
        return transposed(columns)

    def displacement_rates(self, s):
        """ḣ along h, δξ, δz, δu: from d/dt (A h) = ∂(A ξ) A h + A δξ."""
        n, count = self.of.n, self.count()
        a = self.columns(s)[self.first :]
        rows = transposed(a)
        turned = self.along(lambda q: self.columns(q)[self.first :], s, self.of.rate(s))
        columns = []
        for k in range(count):
            ahead, behind = self.displaced(s, k, WIDE), self.displaced(s, k, -WIDE)
            change = scale(1 / (2 * WIDE), sub(self.of.rate(ahead), self.of.rate(behind)))
            columns.append(least_squares(rows, sub(change, turned[k]) if k < n else change))
        return transposed(columns)

    def linearize(self, s):
        return self.displacement_rates(s) + self.slopes(self.accel, s)


def combine(op, *values):
    """Applies an operation to numbers in nested lists."""
    if isinstance(values[0], (list, tuple)):
        return [combine(op, *parts) for parts in zip(*values)]
    return op(*values)


def difference(a, b, over):
    return combine(lambda p, q: (p - q) / over, a, b)


def independent(rows, least=mpf(10) ** -10):
    """Indices of rows that are independent of the earlier ones, by elimination: the remaining part is not small. Steps
    of differences are far smaller, so that both sides of a difference have the same rows. Rows that consist only of
    the rounding of a state to doubles, or of a step from it, count as zero."""
    found, reduced = [], []
    rounding = max((abs(e) for row in rows for e in row), default=NIL) * mpf(10) ** -12
    for index, row in enumerate(rows):
        size = max([abs(e) for e in row], default=NIL)
        rest = list(row)
        for pivot, kept in reduced:
            rest = sub(rest, scale(rest[pivot], kept))
        pivot = max(range(len(rest)), key=lambda k: abs(rest[k]))
        if size > rounding and abs(rest[pivot]) > size * least:
            reduced.append((pivot, scale(1 / rest[pivot], rest)))
            found.append(index)
    return found


__all__ = ["Definitions", "cross", "vectors"]
