"""Random trees of bodies, with all kinds of elements and loads."""

from . import vectors
from .elements import hang
from .expressions import PI, STILL, Ex, Mat, Vec, axis_angle, call, lift, rotation, rpy
from .joints import add_joint
from .mechanism import WORLD, Mechanism
from .tied import allowed_velocities

AXES = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 0], [0, 0, -1], [1, 1, 0], [1, 2, 2], [0, "0.6", "0.8"], [0, "1e-7", 1], ["0.3", "-0.7", "0.2"]]
KINDS = ["revolute"] * 5 + ["continuous"] * 4 + ["prismatic"] * 3 + ["spherical", "spherical3", "planar", "universal", "cylindrical", "fixed", "follows"]


class Output:
    """A named vector of numbers, and whether it depends on accelerations."""

    def __init__(self, name, at, accelerations=False):
        self.name, self.at, self.accelerations = name, at, accelerations


class Forest:
    """A random tree; `random` is Python's."""

    def __init__(self, random, size, free=0.4, time=0.3, hard=False):
        self.r, self.hard = random, hard
        self.m = Mechanism("Tree")
        self.frames = [WORLD]
        self.velocities, self.plain, self.parameters, self.inputs = [], [], [], []
        self.written = False
        self.t = None
        if random.random() < time:
            self.t = self.m.clock("t")
        for k in range(random.randrange(3)):
            self.parameters.append(self.m.parameter(f"p{k}", self.positive()))
        for k in range(random.randrange(4)):
            self.inputs.append(self.m.input(f"u{k}"))
        if random.random() < 0.9:
            self.m.gravity = Vec.of([self.number(), self.number(), "-9.81"] if random.random() < 0.5 else [0, 0, "-9.81"])
            self.m.say(f"gravity {self.m.gravity.text};")
        self.tree(size, free)
        self.loads()
        self.constraints()
        self.outputs()
        hang(self)
        self.asked()

    # Numbers.

    def pick(self, list_):
        return self.r.choice(list_)

    def number(self, size=1.0):
        return f"{self.r.uniform(-size, size):.3f}"

    def positive(self):
        if self.hard and self.r.random() < 0.2:
            return self.pick(["1e-9", "1e3", "0.001", "1e-6"])
        return f"{self.r.uniform(0.2, 2):.3f}"

    def value(self):
        """A positive number or a parameter."""
        if self.parameters and self.r.random() < 0.3:
            return self.pick(self.parameters) + lift("0.3")
        return lift(self.positive())

    def vector(self, size=1.0):
        return Vec.of([self.number(size) if self.r.random() < 0.75 else 0 for _ in range(3)])

    def smooth(self, moving=True):
        """A bounded expression of coordinates, parameters and time."""
        r = self.r
        parts = [lift(self.number())]
        if moving and self.plain:
            q = self.pick(self.plain)
            parts.append(self.pick([call("sin", q), q * self.number(), call("cos", q * 2), q**2 * "0.2"]))
        if self.t is not None and r.random() < 0.6:
            parts.append(call("sin", self.t * self.positive()) * self.number())
        if self.parameters and r.random() < 0.4:
            parts.append(self.pick(self.parameters) * self.number())
        total = parts[0]
        for part in parts[1:]:
            total = total + part
        return total

    def effort(self):
        """Any expression for a load."""
        r = self.r
        total = self.smooth()
        if self.inputs and r.random() < 0.7:
            total = total + self.pick(self.inputs) * self.number()
        if self.velocities and r.random() < 0.7:
            v = self.pick(self.velocities)
            total = total - self.pick([v * self.positive(), call("tanh", v), call("abs", v) * v * "0.1", v**3 * "0.02"])
        return total

    def effort3(self):
        return Vec.of([self.effort() for _ in range(3)])

    # Bodies.

    def mount(self, moving=False):
        r = self.r
        place = self.vector(0.6)
        turned = self.pick(
            [
                lambda: STILL,
                lambda: STILL,
                lambda: rotation(self.pick("xyz"), PI / self.pick([2, 4, 4, -4, 3, 6])),
                lambda: rotation(self.pick("xyz"), PI / 4) * rotation(self.pick("xyz"), PI / self.pick([4, 2])),
                lambda: rotation(self.pick("xyz"), "1e-7" if self.hard else "0.3"),
                lambda: rpy(self.number(), self.number(), self.number()),
                lambda: axis_angle(Vec.of([0, "0.6", "0.8"]), self.number(2)),
                lambda: Mat.of([["0.6", "-0.8", 0], ["0.8", "0.6", 0], [0, 0, 1]]),
                lambda: Mat.of([[0, -1, 0], [1, 0, 0], [0, 0, 1]]),
            ]
        )()
        if moving and self.t is not None and r.random() < 0.5:
            place = place + Vec.of([call("sin", self.t) * "0.1", 0, self.t * "0.2"])
        return turned, place

    def inertia(self):
        r = self.r
        scale = float(self.positive())
        kind = r.randrange(4)
        if kind == 0:
            return Mat.of([[0] * 3] * 3)
        if kind == 1:
            a, b = r.uniform(0.2, 1), r.uniform(0.2, 1)
            return Mat.of([[f"{scale * a:.9f}", 0, 0], [0, f"{scale * b:.9f}", 0], [0, 0, f"{scale * (a + b) * 0.8:.9f}"]])
        # From some particles, so that a body can have it.
        points = [[r.uniform(-1, 1) for _ in range(3)] for _ in range(5)]
        rows = [[0.0] * 3 for _ in range(3)]
        for p in points:
            for i in range(3):
                for j in range(3):
                    rows[i][j] += scale * ((sum(c * c for c in p) if i == j else 0) - p[i] * p[j]) / 5
        return Mat.of([[f"{rows[i][j]:.9f}" for j in range(3)] for i in range(3)])

    def body(self, frame):
        m = self.m
        mass = self.value()
        com = self.vector(0.4) if self.r.random() < 0.8 else Vec.of([0, 0, 0])
        where = "com"
        inertia = self.inertia()
        if self.r.random() < 0.3:
            # About the origin: with Steiner's term, so that it belongs to a body.
            where = "origin"
            c, k, big = [e for e in com.at(None)] if self.fixed(com) else [0, 0, 0], mass.at(_defaults(m)), inertia.at(None)
            square = vectors.dot(c, c)
            rows = [[big[i][j] + k * ((square if i == j else 0) - c[i] * c[j]) for j in range(3)] for i in range(3)]
            inertia = Mat.of([[_decimal(rows[i][j]) for j in range(3)] for i in range(3)])
        m.bodies.append((frame, mass, com, inertia, where))
        m.say(f"body on {frame} {{ mass {mass.text}; com {com.text}; inertia {inertia.text} about {where}; }}")

    @staticmethod
    def fixed(com):
        return all(c in "0123456789.-[], ()" for c in com.text)

    def tree(self, size, free):
        r, m = self.r, self.m
        for k in range(size):
            name, moves = f"j{k}", f"f{k}"
            parent = WORLD if k == 0 else self.pick(self.frames[-3:])
            kind = "free" if k == 0 and r.random() < free else self.pick(KINDS)
            follows = None
            if kind == "follows":
                kind, follows = self.pick(["revolute", "prismatic"]), self.smooth()
            axis = Vec.of(self.pick(AXES))
            fields = ""
            if kind == "planar":
                axis = Vec.of(self.pick([[0, 0, 1], [0, 1, 0], [1, 0, 0], [0, 0, -1], [0, -1, 0]]))
            if kind == "universal":
                axis = [Vec.of(self.pick(AXES[:3])), Vec.of(self.pick(AXES[3:]))]
                if axis[0].text == axis[1].text:
                    axis[1] = Vec.of([1, 1, 1])
            if self.t is not None and r.random() < 0.3:
                # A link that moves by itself is a frame, and a joint is mounted on it.
                m.frame(f"s{k}", parent, *self.mount(moving=True))
                parent = f"s{k}"
            mount = self.mount()
            x = m.nu
            later = []
            if kind in ("revolute", "continuous", "prismatic") and not follows:
                fields, later = self.fields(name, kind, x, m.n)
            elif kind in ("spherical", "spherical3") and r.random() < 0.4:
                fields, later = self.ball(name, m.n)
            elif kind == "universal" and r.random() < 0.4:
                fields, later = self.cross(m.n)
            found = add_joint(m, name, kind, axis, parent, mount, moves, fields, follows)
            for add in later:
                add()
            self.frames.append(moves)
            for text, ex in found.items():
                if follows:
                    continue
                if text.endswith(("_dot", "_v", "_w")):
                    entries = [ex] if isinstance(ex, Ex) else [ex[i] for i in range(2 if text.endswith("_r_dot") else 3)]
                    self.velocities += entries
                elif isinstance(ex, Ex):
                    self.plain.append(ex)
                else:
                    self.plain += [ex[i] for i in range(3)]
            if kind != "fixed" or r.random() < 0.7:
                self.body(moves)
            if r.random() < 0.25:
                more = f"g{k}"
                m.frame(more, moves, *self.mount(moving=True))
                self.frames.append(more)
                if r.random() < 0.5:
                    self.body(more)
        # Velocities without inertia have no accelerations: the last frames get bodies that rotate.
        last = self.frames[-1]
        heavy = Mat.of([["0.5", "0.05", "0.02"], ["0.05", "0.6", "0.03"], ["0.02", "0.03", "0.7"]])
        for frame in sorted({f for f in m.frames} - {p for p, _ in m.frames.values()} | {last}):
            com = self.vector(0.3)
            m.bodies.append((frame, lift("0.7"), com, heavy, "com"))
            m.say(f"body on {frame} {{ mass 0.7; com {com.text}; inertia {heavy.text} about com; }}")

    def fields(self, name, kind, x, w):
        r, m = self.r, self.m
        said, later = [], []
        v = Ex(f"{name}_dot", lambda s: s.xi[w])
        if kind == "continuous":
            from mpmath import atan2

            # The angle from the rest, within half a turn.
            def angle(rest):
                c, s_ = (lambda s: s.x[x]), (lambda s: s.x[x + 1])
                from mpmath import cos, sin

                return Ex("", lambda s: atan2(s_(s) * cos(rest.at(s)) - c(s) * sin(rest.at(s)), c(s) * cos(rest.at(s)) + s_(s) * sin(rest.at(s))))
        else:

            def angle(rest):
                return Ex("", lambda s: s.x[x] - rest.at(s))

        if r.random() < 0.4:
            d = lift(self.positive())
            said.append(f"damping {d.text};")
            later.append(lambda: (m.generalized.append((w, -(d * v))), m.dampers.append((w, d * v))))
        if r.random() < 0.3:
            j = self.value()
            said.append(f"armature {j.text};")
            later.append(lambda: m.kinetic.append(j * v**2 / 2))
        if r.random() < 0.3:
            k, rest = self.value(), lift(self.number() if r.random() < 0.5 else 0)
            said.append(f"stiffness {k.text};" + (f" rest {rest.text};" if rest.text != "0" else ""))
            later.append(lambda: m.joint_springs.append(k * angle(rest) ** 2 / 2))
        if r.random() < 0.5:
            f = self.effort()
            said.append(f"force {f.text};")
            later.append(lambda: m.generalized.append((w, f)))
        return " ".join(said), later

    def ball(self, name, w):
        m = self.m
        d, f = lift(self.positive()), self.effort3()
        v = Vec(f"{name}_dot", lambda s: list(s.xi[w : w + 3]))

        def later():
            for i in range(3):
                m.generalized.append((w + i, Ex("", (lambda i: lambda s: f.at(s)[i] - d.at(s) * v.at(s)[i])(i))))
                m.dampers.append((w + i, Ex("", (lambda i: lambda s: d.at(s) * v.at(s)[i])(i))))

        return f"damping {d.text}; force {f.text};", [later]

    def cross(self, w):
        m, d = self.m, lift(self.positive())

        def later():
            for i in range(2):
                m.generalized.append((w + i, Ex("", (lambda i: lambda s: -d.at(s) * s.xi[w + i])(i))))
                m.dampers.append((w + i, Ex("", (lambda i: lambda s: d.at(s) * s.xi[w + i])(i))))

        return f"damping {d.text};", [later]

    # Loads.

    def end(self):
        frame = self.pick(self.frames[1:])
        return frame, self.vector(0.5)

    def loads(self):
        r, m = self.r, self.m
        zero = Vec.of([0, 0, 0])
        for _ in range(r.randrange(3)):
            frame, point = self.end()
            axes = self.pick(["body", "world", self.pick(self.frames[1:])])
            source = self.pick(self.frames[1:]) if r.random() < 0.3 else None
            if source == frame:
                source = None
            tail = f" on {frame}{f' from {source}' if source else ''} in {axes};"
            kind = r.randrange(3)
            force, torque = self.effort3(), self.effort3()
            if kind == 0:
                m.say(f"force {force.text} at {point.text}{tail}")
                torque = zero
            elif kind == 1:
                m.say(f"torque {torque.text}{tail}")
                force = zero
            else:
                m.say(f"wrench ({force.text}, {torque.text}) at {point.text}{tail}")
            m.wrenches.append((frame, point, force, torque, axes, source))
        for _ in range(r.randrange(3)):
            (f, p), (g, q) = self.end(), (WORLD, self.vector(2)) if r.random() < 0.5 else self.end()
            if f == g:
                continue
            ends = ((f, p), (g, q))
            tail = f"from {p.text} on {f} to {q.text} on {g};"
            k, l = self.value(), lift(self.number())
            kind = r.randrange(4)
            if kind == 0:
                m.say(f"spring stiffness {k.text} length {l.text} {tail}")
                m.springs.append((k, l, ends))
            elif kind == 1:
                m.say(f"damper coefficient {k.text} {tail}")
                m.line_dampers.append((k, ends))
                m.lines_of_force.append((ends, (lambda k: lambda s, length, rate: -k.at(s) * rate)(k)))
            elif kind == 2:
                m.say(f"inerter inertance {k.text} {tail}")
                m.inerters.append((k, ends))
            else:
                e = self.effort()
                m.say(f"force {e.text} {tail}")
                m.lines_of_force.append((ends, (lambda e: lambda s, length, rate: e.at(s))(e)))
        if r.random() < 0.3 and self.plain:
            v = self.smooth()
            m.say(f"potential {v.text};")
            m.potential.append(v)
        if r.random() < 0.3 and self.velocities:
            a, b = self.pick(self.velocities), self.pick(self.velocities)
            if r.random() < 0.5:
                d = (a - b * self.number()) ** 2 * self.value()
                m.say(f"dissipation {d.text};")
                m.dissipation.append(d)
            else:
                e = (a + b * self.number()) ** 2 * self.value() / 2
                m.say(f"kinetic {e.text};")
                m.kinetic.append(e)
                self.written = True
        single = [(name, place) for name, size, place in m.velocities if size == 1]
        if single and r.random() < 0.3:
            m.state("z0", "0.3", lambda z: z * "-0.7" + self.effort() + call("sin", z))
            z = Ex("z0", lambda s: s.z[0])
            name, place = self.pick(single)
            m.say(f"generalized force {name} = {(z * '0.4').text};")
            m.generalized.append((place, z * "0.4"))

    def constraints(self):
        """Velocity constraints with varying factors, which need multipliers."""
        r, m = self.r, self.m
        if not self.plain or m.n < 3 or r.random() > 0.3:
            return
        for _ in range(1 + (m.n > 4 and r.random() < 0.4)):
            parts = [(call(self.pick(["sin", "cos"]), self.pick(self.plain)) + self.number()) * v for v in r.sample(self.velocities, 3)]
            if self.t is not None and r.random() < 0.5:
                parts.append(call("cos", self.t) * self.number())
            tie = parts[0]
            for part in parts[1:]:
                tie = tie + part
            m.say(f"nonholonomic {tie.text} = 0;")
            m.kept.append(tie)

    # Requested functions.

    def outputs(self):
        m = self.m
        frame, p = self.end()
        other = self.pick([f for f in self.frames[1:]])
        self.made = []

        def motion(s, accel):
            raise NotImplementedError

        m.say(f"output place = position({frame}, {p.text});")
        m.outputs.append(Output("place", lambda s: m.point(s, frame, p.at(s))))
        from .definitions import Definitions

        d = Definitions(m)
        m.say(f"output speed = velocity({frame}, {p.text});")
        m.outputs.append(Output("speed", lambda s: d.along(lambda q: m.point(q, frame, p.at(q)), s, m.rate(s))))
        m.say(f"output pull = acceleration({frame}, {p.text});")
        m.outputs.append(Output("pull", lambda s: d.second(lambda q: m.point(q, frame, p.at(q)), s, list(s.a)), True))

        def seen(q):
            big, origin = m.pose(q, other)
            return vectors.on(vectors.transposed(big), vectors.sub(m.point(q, frame, p.at(q)), origin))

        if other != frame:
            m.say(f"output seen = velocity({frame}, {p.text}, {other});")
            m.outputs.append(Output("seen", lambda s: d.along(seen, s, m.rate(s))))
            m.say(f"output felt = acceleration({frame}, {p.text}, {other});")
            m.outputs.append(Output("felt", lambda s: d.second(seen, s, list(s.a)), True))

        def spun(s):
            big = m.pose(s, frame)[0]
            second = d.second(lambda q: m.pose(q, frame)[0], s, list(s.a))
            return vectors.on(vectors.transposed(big), vectors.vee(vectors.times(second, vectors.transposed(big))))

        m.say(f"output spun = angular_acceleration({frame}) in body;")
        m.outputs.append(Output("spun", spun, True))

    def asked(self):
        m, r = self.m, self.r
        frame = self.frames[-1]
        m.jacobians = [(frame, False), (frame, True)] + ([(self.frames[1], True)] if self.frames[1] != frame else [])
        wanted = ["all", "linearize", "inverse_dynamics_slopes", "centroidal_map"]
        wanted += [f"jacobian {f} in {f if own else 'world'}" for f, own in m.jacobians]
        wanted += [f"{o.name}_slopes" for o in m.outputs]
        if m.default:
            wanted.append("parameter_slopes")
        if self.t is None and not m.inerters and not self.written and not m.kept and not m.closures:
            wanted.append("regressor")
        m.say(f"generate {', '.join(wanted)};")

    def configuration(self):
        """A random state of doubles; its velocities are the nearest ones that satisfy the ties."""
        return allowed_velocities(self.m, random_state(self.m, self.r))


def _defaults(m):
    from .expressions import State

    return State([], p=list(m.default))


def _decimal(value):
    return vectors.mp.nstr(value, 17, min_fixed=-30, max_fixed=30)


def random_state(m, r):
    from .expressions import State

    x = []
    for _, kind, _ in m.coordinates:
        if kind == "S1":
            a = r.uniform(-3, 3)
            x += [vectors.mp.cos(a), vectors.mp.sin(a)]
        elif kind == "S3":
            q = [vectors.mpf(r.gauss(0, 1)) for _ in range(4)]
            x += vectors.unit(q)
        elif kind == "SO3":
            turned = vectors.quaternion(vectors.unit([vectors.mpf(r.gauss(0, 1)) for _ in range(4)]))
            x += [e for row in turned for e in row]
        else:
            x += [vectors.mpf(r.uniform(-1, 1)) for _ in range({"real": 1, "R2": 2, "R3": 3}[kind])]
    # Rounded to doubles: if they are slightly off X, both sides get the same numbers.
    x = [vectors.mpf(float(e)) for e in x]
    draw = lambda n: [vectors.mpf(r.uniform(-1.5, 1.5)) for _ in range(n)]  # noqa: E731
    return State(x, draw(m.n), draw(m.m), draw(m.nz), list(m.default), draw(m.n))


__all__ = ["Forest", "Output", "random_state", "Ex"]
