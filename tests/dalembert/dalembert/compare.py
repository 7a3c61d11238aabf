"""One mechanism at one state: every function of generated C, and what `eval` and `linearize` print, beside the definitions."""

from . import kinematics
from .definitions import Definitions
from .vectors import mpf


def flat(value):
    if isinstance(value, (list, tuple)):
        return [entry for part in value for entry in flat(part)]
    return [value]


class Errors:
    """The largest error of each quantity, as a part of its largest entry."""

    def __init__(self):
        self.worst = {}
        self.found = []

    def join(self, other):
        self.found += other.found
        for name, worst in other.worst.items():
            self.worst[name] = max(self.worst.get(name, (-1, "")), worst)

    def note(self, name, mine, theirs, tolerance, where):
        mine, theirs = flat(mine), flat(theirs)
        if len(mine) != len(theirs):
            self.found.append((where, name, f"{len(theirs)} numbers in place of {len(mine)}"))
            return
        size = max([abs(a) for a in mine], default=mpf(0))
        # Numbers that are not there at all are compared with 1.
        error = max([abs(mpf(b) - a) for a, b in zip(mine, theirs)], default=mpf(0)) / max(size, mpf(10) ** -3)
        if any(b != b for b in theirs):
            error = mpf("inf")
        if error > self.worst.get(name, (-1, ""))[0]:
            self.worst[name] = (error, where)
        if not error < tolerance:
            self.found.append((where, name, f"error {float(error):.3g} of {float(size):.3g}"))


def state_of(m, s):
    """A state as `--at` takes it."""
    coordinates = {}
    for name, kind, place in m.coordinates:
        size = {"real": 1, "S1": 2, "S3": 4, "SO3": 9, "R2": 2, "R3": 3}[kind]
        values = [float(e) for e in s.x[place : place + size]]
        if kind == "SO3":
            values = [values[0:3], values[3:6], values[6:9]]
        coordinates[name] = values[0] if kind == "real" else values

    def parts(of, values):
        return {name: float(values[place]) if size == 1 else [float(e) for e in values[place : place + size]] for name, size, place in of}

    return {
        "param": parts(m.parameters, s.p),
        "coord": coordinates,
        "velocity": parts(m.velocities, s.xi),
        "state": parts(m.states, s.z),
        "input": parts(m.inputs, s.u),
    }


class Comparison:
    """Of a mechanism that moves freely: all its velocities are its own."""

    def __init__(self, m, doors, errors, where, tolerance=1e-9, slopes=True):
        self.slopes = slopes
        self.m, self.d, self.doors, self.errors, self.where, self.tolerance = m, Definitions(m), doors, errors, where, tolerance

    def note(self, name, mine, theirs, tolerance=None):
        self.errors.note(name, mine, theirs, tolerance or self.tolerance, self.where)

    def quantities(self, s):
        """Name, and a function that gives it."""
        d, m = self.d, self.m
        yield "rate", lambda: m.rate(s)
        yield "mass_matrix", lambda: [row[d.first :] for row in d.mass_matrix(s)[d.first :]]
        yield "potential_energy", lambda: [m.potential_energy(s)]
        yield "kinetic_energy", lambda: [kinematics.kinetic_energy(d, s)]
        yield "energy", lambda: [m.potential_energy(s) + kinematics.kinetic_energy(d, s)]
        yield "momentum", lambda: kinematics.momenta(d, s)
        yield "potential_force", lambda: d.potential_force(s)
        yield "bias", lambda: d.inertia_force(s, [mpf(0)] * m.n)
        yield "generalized_force", lambda: d.generalized_force(s)
        yield "inverse_dynamics", lambda: d.inverse_dynamics(s, list(s.a))
        yield "accel", lambda: d.accel(s)
        for output in m.outputs:
            yield output.name, (lambda o: lambda: o.at(s))(output)
        for frame, own in m.jacobians:
            cache = {}

            def part(what, frame=frame, own=own, cache=cache):
                if not cache:
                    cache.update(kinematics.frame(d, s, frame, own))
                return cache[what]

            yield f"{frame}_pose", (lambda p: lambda: p("pose"))(part)
            for what in ("twist", "jacobian", "bias_acceleration"):
                yield f"{frame}_{'body_' if own else ''}{what}", (lambda p, w: lambda: p(w))(part, what)
        yield "centre_of_mass", lambda: kinematics.centre(d, s)
        yield "centroidal_momentum", lambda: kinematics.momentum(d, s)
        yield "centroidal_map", lambda: kinematics.centroidal_map(d, s)
        yield "centroidal_bias", lambda: kinematics.centroidal_bias(d, s)
        if not self.slopes:
            return
        yield "linearize", lambda: d.linearize(s)
        yield "inverse_dynamics_slopes", lambda: [row[: 2 * m.n] for row in d.slopes(lambda q: d.inverse_dynamics(q, list(s.a)), s)]
        yield "parameter_slopes", lambda: kinematics.parameter_slopes(d, s)
        for output in m.outputs:
            yield f"{output.name}_slopes", (lambda o: lambda: kinematics.output_slopes(d, s, o))(output)

    def run(self, s, single=False):
        """All functions of the generated C, and what is printed."""
        m, d = self.m, self.d
        kind = "f32 " if single else ""
        c = self.doors.compiled(single)
        if m.default or "set_parameters" in c:
            c.set([float(p) for p in s.p])
        given = {
            "x": [float(e) for e in s.x],
            "xi": [float(e) for e in [*s.xi, *s.z]],
            "u": [float(e) for e in s.u],
            "xi_dot": [float(e) for e in [*s.a, *([0] * m.nz)]],
        }
        mine = {}
        for name, value in self.quantities(s):
            if name in c:
                mine[name] = value()
                self.note(kind + name, mine[name], c.call(name, len(flat(mine[name])), **given), 1e-3 if single else None)
        if "momentum_rate" in c and "accel" in mine:
            rate = d.first_order_wide(lambda q: kinematics.momenta(d, q), s, mine["accel"][: m.n])
            self.note(kind + "momentum_rate", rate, c.call("momentum_rate", m.n, **given), 1e-3 if single else None)
        if "velocity_from_momentum" in c:
            p = mine["momentum"]
            self.note(kind + "velocity_from_momentum", list(s.xi), c.call("velocity_from_momentum", m.n, momentum=[float(e) for e in p], **given), 1e-3 if single else 1e-7)
        self.regressor(c, s, given, kind)
        if not single and self.slopes:
            self.printed(s, mine)

    def regressor(self, c, s, given, kind):
        if "regressor" not in c:
            return
        d, n = self.d, self.m.n
        # As many as there is room for; the rest of the room is untouched.
        room = 4096
        try:
            beta = c.call("base_parameters", room, **given)
        except KeyError:
            return
        beta = beta[: next(k for k, b in enumerate(beta) if b == 777.0)]
        y = c.call("regressor", n * len(beta), **given)
        force = [sum(y[i * len(beta) + k] * b for k, b in enumerate(beta)) for i in range(n)]
        # With the force of dampers that joints have: they are parameters, too.
        self.note(kind + "regressor", self.m.with_dampers(d, s), force, 1e-3 if single_of(kind) else None)

    def printed(self, s, mine):
        d, m = self.d, self.m
        said = self.doors.eval(state_of(m, s))
        self.note("eval accel", mine["accel"], said["accel"])
        self.note("eval A", [list(row) for row in zip(*d.columns(s))], said["A"])
        self.note("eval gamma", d.gamma(s), said["gamma"])
        self.note("eval Gamma", d.connection(s), said["Gamma"])
        matrix = d.mass_matrix(s)
        # The row of the time is no equation of motion, and is not compared.
        first = d.first
        self.note("eval M", [row[first:] for row in matrix[first:]], [row[first:] for row in said["M"][first:]])
        lin = self.doors.linearize(state_of(m, s))
        rows = len(mine["linearize"]) if "linearize" in mine else 0
        if rows:
            both = [a + b for a, b in zip(lin["A"], lin["B"])] if m.m else lin["A"]
            self.note("printed linearize", mine["linearize"], both)


def single_of(kind):
    return kind.startswith("f32")
