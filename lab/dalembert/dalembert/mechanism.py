"""A mechanism as its text and its data: coordinates with their rates, frames with their poses, bodies, energies, loads."""

from . import vectors
from .expressions import Ex, Mat, State, Vec
from .vectors import NIL, ONE, add, cross, dot, hat, norm, on, sub, times

WORLD = "world"
SIZES = {"real": 1, "S1": 2, "S3": 4, "SO3": 9, "R2": 2, "R3": 3}


class Listed(list):
    """A list that records its appended items in another, shared list."""

    def __init__(self, order, name):
        super().__init__()
        self.order, self.name = order, name

    def append(self, entry):
        self.order.append(self.name)
        super().append(entry)

    def __iadd__(self, entries):
        for entry in entries:
            self.append(entry)
        return self


class Mechanism:
    """Filled by a generator; its meaning is in `definitions`."""

    def __init__(self, name):
        self.name = name
        self.lines = []
        self.coordinates = []  # name, kind, place in x
        self.velocities = []  # name, size, place in ξ
        self.inputs, self.states, self.parameters = [], [], []  # name, size, place
        self.default = []  # values of parameters
        self.nu = self.n = self.m = self.nz = 0
        self.rates = []  # functions of a state: entries of ẋ, in the order of x
        self.state_rates = []
        self.frames = {}  # name: (parent, state -> (R, p))
        self.bodies = []  # frame, mass, com, inertia, about
        self.particles = []  # frame, mass, place
        self.kinetic, self.potential, self.joint_springs = [], [], []
        self.gravity = None
        self.wrenches = []  # frame, point, force, torque, in, from
        self.lines_of_force = []  # (frame, point) twice, scalar of (state, ℓ, ℓ̇)
        self.springs = []  # stiffness, length, ends
        self.inerters = []  # inertance, ends
        self.generalized = []  # place of the velocity, expression
        self.dampers = []  # place of the velocity, its force
        self.line_dampers = []  # coefficient, ends; their force stands in lines_of_force
        self.dissipation = []  # expressions
        self.onto = []  # place in x, size, what leads these numbers back to the constraints that are written of them
        self.order = []  # which of the two that follow, as they stand in the text
        self.closures = Listed(self.order, "closure")  # scalars of the configuration that are zero
        self.stabilized = []  # of each closure, how fast it decays, or None
        self.kept = Listed(self.order, "kept")  # scalars linear in the velocities that are zero
        self.accelerated = []  # place of a velocity, its rate
        self.driven = []  # place of a coordinate that is given, kind, its value
        self.outputs = []  # name, expression or vector
        self.jacobians = []  # frame, own
        self.externals = []  # functions in Rust, which C does not have
        self.time = None

    # The lines of the text, and their meaning.

    def say(self, line):
        self.lines.append("    " + line)

    def text(self, extra=()):
        return "pub system " + self.name + " {\n" + "\n".join([*self.lines, *extra]) + "\n}\n"

    def coordinate(self, name, kind, rate, declare=True):
        """A coordinate; `rate` gives its entries of ẋ at a state."""
        place, size = self.nu, SIZES[kind]
        self.coordinates.append((name, kind, place))
        self.rates.append(rate)
        self.nu += size
        if declare:
            self.say(f"coord {name};" if kind == "real" else f"coord {name}: {kind};")
        if kind == "real":
            return Ex(name, lambda s: s.x[place])
        return Vec(name, lambda s: s.x[place : place + size])

    def velocity(self, name, size=1, declare=True):
        place = self.n
        self.velocities.append((name, size, place))
        self.n += size
        if declare:
            self.say(f"velocity {name};" if size == 1 else f"velocity {name}: vec{size};")
        if size == 1:
            return Ex(name, lambda s: s.xi[place])
        return Vec(name, lambda s: list(s.xi[place : place + size]))

    def clock(self, name):
        self.time = self.nu
        self.say(f"time {name};")
        place = self.nu
        self.coordinates.append((name, "real", place))
        self.rates.append(lambda s: [ONE])
        self.nu += 1
        return Ex(name, lambda s: s.x[place])

    def input(self, name, size=1):
        place = self.m
        self.inputs.append((name, size, place))
        self.m += size
        self.say(f"input {name};" if size == 1 else f"input {name}: vec{size};")
        if size == 1:
            return Ex(name, lambda s: s.u[place])
        return Vec(name, lambda s: list(s.u[place : place + size]))

    def parameter(self, name, value):
        place = len(self.default)
        self.parameters.append((name, 1, place))
        self.default.append(vectors.mpf(str(value)))
        self.say(f"param {name} = {value};")
        return Ex(name, lambda s: s.p[place])

    def state(self, name, value, rate):
        place = self.nz
        self.states.append((name, 1, place))
        self.nz += 1
        ex = Ex(name, lambda s: s.z[place])
        rate = rate(ex)
        self.state_rates.append(rate)
        self.say(f"state {name} = {value};")
        self.say(f"rate {name} = {rate.text};")
        return ex

    def frame(self, name, parent, rotation, place, declare=True):
        self.frames[name] = (parent, lambda s: (rotation.at(s), place.at(s)))
        if declare:
            self.say(f"frame {name}{self.on(parent)} = pose({rotation.text}, {place.text});")

    @staticmethod
    def on(frame):
        return "" if frame == WORLD else f" on {frame}"

    # Poses.

    def pose(self, s, name):
        """Rotation and origin of a frame in the world."""
        if name == WORLD:
            return vectors.IDENTITY, [NIL] * 3
        found = s.shape.get(name)
        if found is None:
            parent, local = self.frames[name]
            (rp, pp), (r, p) = self.pose(s, parent), local(s)
            found = s.shape[name] = (times(rp, r), add(pp, on(rp, p)))
        return found

    def point(self, s, frame, place):
        r, p = self.pose(s, frame)
        return add(p, on(r, place))

    def rate(self, s):
        """ẋ at a state."""
        return [entry for rate in self.rates for entry in rate(s)]

    def distance(self, s, ends):
        (f, p), (g, q) = ends
        return norm(sub(self.point(s, f, p.at(s)), self.point(s, g, q.at(s))))

    def potential_energy(self, s):
        v = self.gravity_energy(s) + sum((e.at(s) for e in self.potential + self.joint_springs), NIL)
        for stiffness, length, ends in self.springs:
            v += stiffness.at(s) * (self.distance(s, ends) - length.at(s)) ** 2 / 2
        return v

    def gravity_energy(self, s):
        v = NIL
        if self.gravity is not None:
            g = self.gravity.at(s)
            for frame, mass, com, *_ in self.bodies:
                v -= mass.at(s) * dot(g, self.point(s, frame, com.at(s)))
            for frame, mass, place in self.particles:
                v -= mass.at(s) * dot(g, self.point(s, frame, place.at(s)))
        return v

    def with_dampers(self, d, s):
        """The quantity that the regressor describes: inertia, gravity, springs and dampers of joints, without other
        springs and potentials."""
        force = vectors.add(d.inertia_force(s, list(s.a)), d.potential_force(s, lambda q: self.gravity_energy(q) + sum(e.at(q) for e in self.joint_springs)))
        for place, damping in self.dampers:
            force[place] += damping.at(s)
        return force

    def masses(self, s):
        """The positions of masses: pose, mass, first and second moments of bodies; positions of particles."""
        found = []
        for frame, mass, com, inertia, where in self.bodies:
            m, c, j = mass.at(s), com.at(s), inertia.at(s)
            half = (j[0][0] + j[1][1] + j[2][2]) / 2
            second = [[(half if a == b else NIL) - j[a][b] for b in range(3)] for a in range(3)]
            if where == "com":
                second = [[second[a][b] + m * c[a] * c[b] for b in range(3)] for a in range(3)]
            found.append((self.pose(s, frame), m, vectors.scale(m, c), second))
        for frame, mass, place in self.particles:
            point = self.point(s, frame, place.at(s))
            zero = [[NIL] * 3] * 3
            found.append(((zero, point), mass.at(s), [NIL] * 3, zero))
        return found


__all__ = ["Mechanism", "State", "WORLD", "Mat", "cross", "hat"]
