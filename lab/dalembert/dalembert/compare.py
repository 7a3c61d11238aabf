"""Compares one mechanism at one state: every function of generated C, and the output of `eval` and `linearize`, with
the definitions."""

from itertools import combinations

from . import further, kinematics, left, tied
from .definitions import Definitions, independent
from .doors import Refused
from .vectors import dot, mpf, on, solve, times, transposed


def flat(value):
    if isinstance(value, (list, tuple)):
        return [entry for part in value for entry in flat(part)]
    return [value]


class Errors:
    """The largest error of each quantity, relative to its largest entry."""

    def __init__(self):
        self.worst = {}
        self.found = []

    def join(self, other):
        self.found += other.found
        for name, worst in other.worst.items():
            self.worst[name] = max(self.worst.get(name, (-1, "")), worst)

    def note(self, name, mine, theirs, tolerance, where, least=1e-3):
        mine, theirs = flat(mine), flat(theirs)
        if len(mine) != len(theirs):
            self.found.append((where, name, f"{len(theirs)} numbers in place of {len(mine)}"))
            return
        size = max([abs(a) for a in mine], default=mpf(0))
        # Numbers close to 0 are compared with `least`.
        error = max([abs(mpf(b) - a) for a, b in zip(mine, theirs)], default=mpf(0)) / max(size, mpf(least))
        if any(b != b for b in theirs):
            error = mpf("inf")
        if error > self.worst.get(name, (-1, ""))[0]:
            self.worst[name] = (error, where)
        if not error < tolerance:
            self.found.append((where, name, f"error {float(error):.3g} of {float(size):.3g}"))


def state_of(m, s, active):
    """A state in the format of `--at`."""
    coordinates = {}
    for name, kind, place in m.coordinates:
        size = {"real": 1, "S1": 2, "S3": 4, "SO3": 9, "R2": 2, "R3": 3}[kind]
        values = [float(e) for e in s.x[place : place + size]]
        if kind == "SO3":
            values = [values[0:3], values[3:6], values[6:9]]
        coordinates[name] = values[0] if kind == "real" else values

    def parts(of, values):
        return {name: float(values[place]) if size == 1 else [float(e) for e in values[place : place + size]] for name, size, place in of}

    velocities = [v for v in m.velocities if all(v[2] + k in active for k in range(v[1]))]

    return {
        "param": parts(m.parameters, s.p),
        "coord": coordinates,
        "velocity": parts(velocities, s.xi),
        "state": parts(m.states, s.z),
        "input": parts(m.inputs, s.u),
    }


class Comparison:
    """The comparison for a mechanism."""

    def __init__(self, m, doors, errors, where, tolerance=1e-9, slopes=True):
        self.slopes = slopes
        self.m, self.d, self.doors, self.errors, self.where, self.tolerance = m, Definitions(m), doors, errors, where, tolerance
        # Slopes that are meaningful only along the ties, if these are redundant.
        self.along = set()

    def note(self, name, mine, theirs, tolerance=None, least=1e-3):
        self.errors.note(name, mine, theirs, tolerance or self.tolerance, self.where, least)

    def quantities(self, s):
        """Yields names, each with a function that evaluates it."""
        d, m = self.d, self.m
        yield "rate", lambda: m.rate(s)
        yield "mass_matrix", lambda: d.mass_active(s, [row[d.first :] for row in d.mass_matrix(s)[d.first :]])
        yield "potential_energy", lambda: [m.potential_energy(s)]
        yield "kinetic_energy", lambda: [kinematics.kinetic_energy(d, s)]
        yield "energy", lambda: [m.potential_energy(s) + kinematics.kinetic_energy(d, s)]
        yield "momentum", lambda: d.on_active(kinematics.momenta(d, s), s)
        yield "potential_force", lambda: d.on_active(d.potential_force(s), s)
        yield "bias", lambda: d.on_active(d.inertia_force(s, d.wide(s, [mpf(0)] * len(d.active))), s)
        yield "generalized_force", lambda: d.on_active(d.generalized_force(s), s)
        yield "inverse_dynamics", lambda: self.needed(s)
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
        yield "inverse_dynamics_slopes", lambda: [row[: m.n + len(d.active)] for row in d.slopes(self.needed, s)]
        yield "parameter_slopes", lambda: kinematics.parameter_slopes(d, s)
        for output in m.outputs:
            yield f"{output.name}_slopes", (lambda o: lambda: kinematics.output_slopes(d, s, o))(output)

    def needed(self, s):
        """The force for the given ξ̇ of active velocities."""
        d = self.d
        return d.on_active(d.inverse_dynamics(s, d.wide(s, [self.given[i] for i in d.active])), s)

    def start(self, c, s, single):
        """Determines the dependent velocities, and returns the state with them."""
        m = self.m
        said = self.doors.eval()
        names = tied.names(m)
        active = [names.index(name) for name in said["velocities"]]
        if [name for name in said["frame"] if m.time is None or name != f"{m.coordinates[0][0]}_dot"] != names:
            self.errors.found.append((self.where, "frame", f"{said['frame']} in place of {names}"))

        def rate(xi):
            return [mpf(e) for e in c.call("rate", m.nu, x=[float(e) for e in s.x], xi=[float(e) for e in [*xi, *s.z]])]

        d = left.found(m, active, rate, s, 1e-4 if single else 1e-10)
        if d is None:
            raise Refused(f"the velocities {said['velocities']} are not what ties leave")
        self.d, self.given = d, s.a
        s = d.held(s)
        return s.but(a=d.wide(s, [s.a[i] for i in d.active]))

    def run(self, s, single=False, c=None, kind=""):
        """Compares all functions of the generated C, or of a substitute, and the printed output."""
        m, kind = self.m, "f32 " if single else kind
        c = c or self.doors.compiled(single)
        if m.default or "set_parameters" in c:
            c.set([float(p) for p in s.p])
        s = self.start(c, s, single)
        d = self.d
        self.rows = len(m.closures) + len(m.kept) + len(m.accelerated)
        self.unique = not self.rows or len(independent(d.bonds(s))) == self.rows
        if not self.unique:
            self.along = {"linearize"} | {f"{o.name}_slopes" for o in m.outputs if o.accelerations}
        if m.driven:
            # A prescribed coordinate is not read, whatever its value.
            self.along = {"linearize", "inverse_dynamics_slopes"} | {f"{o.name}_slopes" for o in m.outputs}
        given = {
            "x": [float(e) for e in s.x],
            "xi": [float(e) for e in [*(s.xi[i] for i in d.active), *s.z]],
            "u": [float(e) for e in s.u],
            "xi_dot": [float(e) for e in [*(self.given[i] for i in d.active), *([0] * m.nz)]],
        }
        mine = {}
        for name, value in self.quantities(s):
            if name not in c or (name == "parameter_slopes" and not self.unique):
                continue
            mine[name] = value()
            if name in self.along:
                basis = tied.allowed(d, s)
                theirs = c.call(name, len(flat(mine[name])), **given)
                self.note(kind + name, self.on_ties(mine[name], basis), self.on_ties(square(theirs, len(mine[name])), basis), **self.of_slopes(single))
            else:
                self.note(kind + name, mine[name], c.call(name, len(flat(mine[name])), **given), 1e-3 if single else None)
        if "momentum_rate" in c and "accel" in mine and not d.solved:
            rate = d.first_order_wide(lambda q: kinematics.momenta(d, q), s, mine["accel"][: m.n])
            self.note(kind + "momentum_rate", rate, c.call("momentum_rate", m.n, **given), 1e-3 if single else None)
        if "velocity_from_momentum" in c:
            p = mine["momentum"]
            self.note(kind + "velocity_from_momentum", [s.xi[i] for i in d.active], c.call("velocity_from_momentum", len(d.active), momentum=[float(e) for e in p], **given), 1e-3 if single else 1e-7)
        further.compare(self, c, s, given, kind, 1e-3 if single else None)
        self.regressor(c, s, given, kind)
        if self.rows:
            self.ties(c, s, given, kind, 1e-3 if single else None)
        if not single and self.slopes:
            self.printed(s, mine)

    def in_text(self, bonds):
        """Rows of closures, of velocity constraints and of prescribed rates, in the order of the text."""
        m = self.m
        rows = {"closure": iter(bonds), "kept": iter(bonds[len(m.closures) :])}
        return [next(rows[name]) for name in m.order] + bonds[len(m.order) :]

    def ties(self, c, s, given, kind, tolerance):
        """Compares constraint forces and projections."""
        d, m = self.d, self.m
        if "constraint_force" not in c:
            self.errors.found.append((self.where, kind + "constraint_force", "is missing"))
        elif self.unique:
            force = c.call("constraint_force", self.rows, **given)
            bonds = self.in_text(d.bonds(s))
            self.note(kind + "constraint_force", d.motion(s)[1], on(transposed(bonds), [mpf(f) for f in force]), tolerance)
        else:
            self.shared(c, s, given, kind)
        # At a state off the ties.
        beside = tied.beside(d, s)
        given = {**given, "x": [float(e) for e in beside.x], "xi": [float(e) for e in [*(beside.xi[i] for i in d.active), *s.z]]}
        closures = [e for k, e in enumerate(m.closures) if k not in d.solved]
        if "constraint" in c and closures and self.unique:
            # After those of the kinds of coordinates.
            own = len(self.doors.eval(self.state(s))["constraint"]) - len(closures)
            said = c.call("constraint", own + len(closures), **given)[own:]
            self.note(kind + "constraint", [e.at(beside) for e in closures], said, tolerance)
        if not self.unique:
            return
        if "accel" in c and not m.driven:
            # Off the loops, violations decay at the stated rate.
            self.note(kind + "accel beside", d.accel(beside), c.call("accel", len(d.active) + m.nz, **given), tolerance)
        if "project_position" in c:
            step = tied.project_position(d, beside)
            # First-order states follow the velocities, and do not move.
            step = [step[i] for i in d.active] + [mpf(0)] * m.nz
            self.note(kind + "project_position", step, c.call("project_position", len(step), **given), tolerance)
        if "project_velocity" in c:
            projected = [tied.project_velocity(d, beside)[i] for i in d.active] + list(s.z)
            self.note(kind + "project_velocity", projected, c.call("project_velocity", len(projected), **given), tolerance)

    def shared(self, c, s, given, kind):
        """Compares λ of redundant rows. Some rows are left out, and their indices are not reported, but the remaining
        ones carry the total force. Multipliers that are reported as unique must be so by elimination, and have its
        values."""
        d = self.d
        bonds, total = self.in_text(d.bonds(s)), d.motion(s)[1]
        said = self.doors.eval(self.state(s))
        free = [row in said.get("undetermined", []) for row in said["constraints"]]
        theirs = [mpf(f) for f in c.call("constraint_force", len(free), **given)]
        mine = multipliers(bonds, total)
        tolerance = 2e-2 if single_of(kind) else 1e-7
        size = max(max(map(abs, total), default=mpf(0)), mpf("1e-3"))

        def misses(rows):
            force = on(transposed([bonds[k] for k in rows]), theirs)
            return max((abs(a - b) for a, b in zip(force, total)), default=mpf(0)) > tolerance * size

        fitting = [rows for rows in combinations(range(len(bonds)), len(free)) if not misses(rows)]
        if not fitting:
            self.errors.found.append((self.where, kind + "constraint_force", f"no choice of {len(free)} rows gives the force"))
            return
        agreeing = [rows for rows in fitting if [mine[k] is None for k in rows] == free]
        if not agreeing:
            self.errors.found.append((self.where, kind + "constraint_force", f"{free} are said to be not determined"))
            return
        unique = [(mine[k], force) for k, force in zip(agreeing[0], theirs) if mine[k] is not None]
        self.note(kind + "constraint_force", [a for a, _ in unique], [b for _, b in unique], tolerance)

    def regressor(self, c, s, given, kind):
        if "regressor" not in c:
            return
        d, n = self.d, self.m.n
        # Limited by the available room, the rest of which is unchanged.
        room = 4096
        try:
            beta = c.call("base_parameters", room, **given)
        except KeyError:
            return
        beta = beta[: next(k for k, b in enumerate(beta) if b == 777.0)]
        y = c.call("regressor", n * len(beta), **given)
        force = [sum(y[i * len(beta) + k] * b for k, b in enumerate(beta)) for i in range(n)]
        # With the force of dampers in joints, which are parameters, too.
        self.note(kind + "regressor", self.m.with_dampers(d, s), force, 1e-3 if single_of(kind) else None)

    def state(self, s):
        return state_of(self.m, s, self.d.active)

    def printed(self, s, mine):
        d, m = self.d, self.m
        said = self.doors.eval(self.state(s))
        self.note("eval accel", mine["accel"], said["accel"])
        self.note("eval A", [list(row) for row in zip(*d.columns(s))], said["A"])
        self.note("eval gamma", d.gamma(s), said["gamma"])
        self.note("eval Gamma", d.connection(s), said["Gamma"])
        matrix = d.mass_matrix(s)
        # The row of the time is not an equation of motion, and is not compared.
        first = d.first
        self.note("eval M", [row[first:] for row in matrix[first:]], [row[first:] for row in said["M"][first:]])
        if not mine.get("linearize"):
            return
        full = mine["linearize"]
        said = whole(self.doors.linearize(self.state(s)))
        if "linearize" in self.along:
            basis = tied.allowed(d, s)
            self.note("printed linearize", self.on_ties(full, basis), self.on_ties(said, basis), **self.of_slopes(False))
        else:
            self.note("printed linearize", full, said)
        if m.closures or m.kept:
            lin = self.doors.linearize(self.state(s), full=False)
            least = tied.minimal(d, s, full, lin["states"])
            if least is None:
                self.errors.found.append((self.where, "minimal linearize", f"{lin['states']} are not the freedoms"))
            else:
                self.note("minimal linearize", least, whole(lin), self.tolerance * (1e2 if self.unique else 1e3))

    def of_slopes(self, single):
        """The tolerance of slopes: half of the digits with redundant rows, a third of them in `float`, also for terms
        that cancel."""
        if self.unique:
            return {"tolerance": 1e-3 if single else None}
        return {"tolerance": 2e-2 if single else 1e-6, "least": 1}

    def on_ties(self, rows, basis):
        """Slopes along displacements that satisfy the ties, and along inputs."""
        size = min(len(basis), len(rows[0]) if rows else 0)
        return [times([row[:size]], basis[:size])[0] + list(row[size:]) for row in rows]


def whole(lin):
    """[A B] in printed form."""
    return [a + b for a, b in zip(lin["A"], lin["B"])]


def multipliers(bonds, total):
    """The multipliers of rows with this total force; `None` where a multiplier is not unique because its row depends on
    the others."""
    rows = independent(bonds)
    b = [bonds[k] for k in rows]
    found = dict(zip(rows, solve([[dot(p, q) for q in b] for p in b], [dot(p, total) for p in b])))

    def depends(k):
        return len(independent(bonds[:k] + bonds[k + 1 :])) == len(rows)

    return [None if depends(k) else found[k] for k in range(len(bonds))]


def square(numbers, rows):
    size = len(numbers) // rows
    return [[mpf(e) for e in numbers[k * size : (k + 1) * size]] for k in range(rows)]


def single_of(kind):
    return kind.startswith("f32")
