"""Random trees in forms of the language that the other kinds do not use: constants, named expressions, functions,
vector parameters and states, particles, components and parts, repetition, functions in Rust, inactive velocities or
velocities that depend on others by constant factors, and functions of expressions."""

from . import vectors
from .expressions import Ex, Mat, Vec, call, lift, rotation
from .joints import add_joint
from .mechanism import WORLD
from .trees import AXES, Forest, Output
from .vectors import dot, mpf


class Spoken(Forest):
    """Trees equivalent to others, in other forms."""

    rust = False

    def __init__(self, random, size, hard=False):
        self.count = 0
        super().__init__(random, size, free=0.3, time=0.3, hard=hard)

    def name(self, of):
        self.count += 1
        return f"{of}{self.count}"

    # Expressions.

    def value(self):
        value = super().value()
        if value.still and self.r.random() < 0.4:
            name = self.name("k")
            self.m.say(f"const {name} = {value.text};")
            return Ex(name, value.at, True)
        return value

    def smooth(self, moving=True):
        total = super().smooth(moving)
        if not (moving and self.plain):
            return total
        q, a = self.pick(self.plain), self.number()
        curved = [
            lambda: call("sqrt", q**2 + "0.7"),
            lambda: call("exp", call("sin", q) * a),
            lambda: call("log", call("cos", q) + "2.5"),
            lambda: call("atan2", call("sin", q) + "0.3", q**2 + "1.2"),
            lambda: call("sinh", call("cos", q)) - call("cosh", q * "0.3"),
            lambda: call("asin", call("sin", q) * "0.5") * call("acos", call("cos", q) * "0.4") + call("atan", q * "1.3"),
            lambda: call("tan", call("sin", q) * "0.6"),
            lambda: call("hypot", q, "0.7") / (q**2 + "1.5"),
            lambda: q ** self.pick([3, 4]) * "0.1",
        ]
        total = total + self.pick(curved)() * self.number()
        return self.named(total) if self.r.random() < 0.5 else total

    def named(self, ex):
        """The expression under a name, or as the value of a function."""
        m, name = self.m, self.name("e")
        if self.r.random() < 0.5:
            m.say(f"let {name} = {ex.text};")
            return Ex(name, ex.at)
        factor, q = self.number(), self.pick(self.plain)
        m.say(f"fn {name}(a, b) = a - ({factor}) * sin(b) + {ex.text};")
        return Ex(f"{name}({q.text}, 2 * {q.text})", lambda s: q.at(s) - mpf(factor) * vectors.mp.sin(2 * q.at(s)) + ex.at(s))

    def effort(self):
        total = super().effort()
        if self.velocities and self.r.random() < 0.2:
            v, q = self.pick(self.velocities), self.pick(self.velocities)
            pair = Vec.of([v, q])
            total = total - Ex(f"(norm({pair.text}) * {v.text})", lambda s: vectors.norm(pair.at(s)) * v.at(s)) * "0.2"
        return total

    # Bodies.

    def parameter(self, shape, rows):
        """A parameter that is a vector or a symmetric matrix, with its entries."""
        m, name, numbers = self.m, self.name("P"), [e for row in rows for e in row]
        at = len(m.default)
        m.parameters.append((name, len(numbers), at))
        m.default += [mpf(e) for e in numbers]
        text = "[" + ", ".join("[" + ", ".join(row) + "]" for row in rows) + "]" if len(rows) > 1 else "[" + ", ".join(rows[0]) + "]"
        m.say(f"param {name}: {shape} = {text};")
        if len(rows) == 1:
            return Vec(name, lambda s: list(s.p[at : at + 3]))
        return Mat(name, lambda s: [list(s.p[at + 3 * i : at + 3 * i + 3]) for i in range(3)])

    def body(self, frame):
        m, r = self.m, self.r
        super().body(frame)
        if r.random() < 0.3:
            com = self.parameter("vec3", [[self.number(0.4) for _ in range(3)]])
            inertia = Mat.of([["0.5", "0.05", "0.02"], ["0.05", "0.6", "0.03"], ["0.02", "0.03", "0.7"]])
            mass = self.value()
            m.bodies.append((frame, mass, com, inertia, "com"))
            m.say(f"body on {frame} {{ inertia {inertia.text} about com; com {com.text}; mass {mass.text}; }}")
        if r.random() < 0.3:
            mass, place = self.value(), self.vector()
            if self.plain and r.random() < 0.5:
                place = place + Vec.of([call("sin", self.pick(self.plain)), 0, self.pick(self.plain) * "0.3"])
            where = WORLD if r.random() < 0.2 and not place.still else frame
            m.particles.append((where, mass, place))
            m.say(f"particle mass {mass.text} at {place.text}{m.on(where)};")

    def tree(self, size, free):
        super().tree(size, free)
        if self.r.random() < 0.6:
            self.parts()

    def parts(self):
        """A hinge with a body as a component, and two parts of it; or the equivalent repetition."""
        m, r = self.m, self.r
        axis, damping, com, mount = Vec.of(self.pick(AXES)), self.positive(), self.vector(0.4), self.pick(self.frames)
        inertia = Mat.of([["0.4", "0.02", 0], ["0.02", "0.5", 0], [0, 0, "0.6"]])
        single = "prismatic" if r.random() < 0.5 else "revolute"
        component = r.random() < 0.5
        joint = "joint q: {kind} {axis} on {on} at pose(rotx(k / 3), [0, k / 5, 0.1]) moves link {{ damping {d} * k; }}"
        body = f"mass k / 2; com {com.text}; inertia k * {inertia.text} about com;"
        on = mount
        if component:
            hold = joint.format(kind=single, axis=axis.text, on="mount", d=damping)
            m.say(f"component Limb(mount: frame, k = 2) {{ {hold} body on link {{ {body} }} }}")
            m.say(f"part limb[i in 1..2] = Limb({on}, k = i);" if r.random() < 0.5 else f"part limb[2] = Limb({on}), limb[1] = Limb({on}, k = 1);".replace(", limb[1]", "; part limb[1]"))
        else:
            hold = joint.format(kind=single, axis=axis.text, on=on, d=damping).replace(" q:", " limb[k]:").replace("moves link", "moves limb_link[k]")
            m.say(f"for k in 1..2 {{ {hold} body on limb_link[k] {{ {body} }} }}")
        order = (1, 2)
        if m.lines[-1].strip().startswith("part limb[2]"):
            order = (2, 1)
        for k in order:
            printed = f"limb_{k}_q" if component else f"limb_{k}"
            written = f"limb[{k}].q" if component else f"limb[{k}]"
            said, place = len(m.lines), m.n
            text = on if on != WORLD else WORLD
            found = add_joint(m, printed, single, axis, text, (rotation("x", lift(k) / 3), Vec.of([0, lift(k) / 5, "0.1"])), f"link_{k}")
            del m.lines[said:]
            q, v = found[printed], found[f"{printed}_dot"]
            q.text, v.text = written, f"{written}_dot"
            drag = lift(damping) * k * v
            m.generalized.append((place, -drag))
            m.dampers.append((place, drag))
            big = Mat("", (lambda k: lambda s: [[k * e for e in row] for row in inertia.at(s)])(k))
            m.bodies.append((f"link_{k}", lift(k) / 2, com, big, "com"))
            self.plain.append(q)
            self.velocities.append(v)

    # Loads and states.

    def loads(self):
        super().loads()
        m, r = self.m, self.r
        single = [(name, place) for name, size, place in m.velocities if size == 1 and not name.startswith("limb")]
        if r.random() < 0.3:
            at = m.m
            u = m.input("U", 3)
            self.inputs += [u[i] for i in range(3)]
            frame, zero = self.pick(self.frames[1:]), Vec.of([0, 0, 0])
            m.say(f"wrench (U, {zero.text}) on {frame} in world;")
            m.wrenches.append((frame, zero, Vec("U", lambda s: list(s.u[at : at + 3])), zero, "world", None))
        if r.random() < 0.4 and single:
            self.vector_state(single)
        if self.rust and single:
            self.external(single)

    def vector_state(self, single):
        """A state of two numbers, whose rates may depend on an acceleration."""
        m, at = self.m, self.m.nz
        m.states.append(("zz", 2, at))
        m.nz += 2
        z = [Ex(f"zz[{k + 1}]", (lambda k: lambda s: s.z[at + k])(k)) for k in range(2)]
        frame, p = self.end()
        from .definitions import Definitions

        d = Definitions(m)
        felt = Ex(f"acceleration({frame}, {p.text})[2]", lambda s: d.second(lambda q: m.point(q, frame, p.at(q)), s, list(s.a))[1])
        one, two = z[1] * "0.5" - z[0] + self.effort(), felt * "0.1" - z[1] * z[0]
        m.state_rates += [one, two]
        m.say("state zz: vec2 = [0.1, 0.2];" if self.r.random() < 0.5 else "state zz: vec2 = [0, -0.3];")
        m.say(f"rate zz = {Vec.of([one, two]).text};")
        name, place = self.pick(single)
        m.say(f"generalized force {name} = zz[1] - zz[2];")
        m.generalized.append((place, z[0] - z[1]))

    def external(self, single):
        """A function in Rust, with an equivalent substitute."""
        m, v, q = self.m, self.pick(self.velocities), self.pick(self.plain)
        m.say("extern fn polar(a, b) -> 2 = [sin(a) * b, 0.1 * a - 0.2 * b^2];")
        m.externals.append(POLAR)
        name, place = self.pick(single)
        m.say(f"generalized force {name} = polar({q.text}, {v.text})[2] - polar({q.text}, 0.3)[1];")
        law = lambda s: mpf("0.1") * q.at(s) - mpf("0.2") * v.at(s) ** 2 - vectors.mp.sin(q.at(s)) * mpf("0.3")  # noqa: E731
        m.generalized.append((place, Ex("", law)))

    def constraints(self):
        """Velocities that stay zero, and velocities that depend on others by constant factors."""
        m, r = self.m, self.r
        single = [v for v in self.velocities if v.text.endswith("_dot")]
        if len(single) < 2 or m.n < 3 or r.random() < 0.4:
            return super().constraints()
        r.shuffle(single)
        if r.random() < 0.5:
            m.say(f"inactive {single[0].text};")
            m.kept.append(single[0])
        if len(single) > 2 and r.random() < 0.6:
            a, b, c = single[-3:] if len(single) > 3 else (single[1], single[2], single[1])
            tie = a * self.number() - b * "1.3" + (c * "0.4" if len(single) > 3 else lift(0) * a)
            if self.t is not None and r.random() < 0.5:
                tie = tie + call("sin", self.t)
            m.say(f"nonholonomic {tie.text} = 0;")
            m.kept.append(tie)
            if r.random() < 0.5:
                m.say(f"independent {b.text};")
        return None

    def outputs(self):
        super().outputs()
        m, frame = self.m, self.frames[-1]
        p, n = self.vector(), self.vector()
        if self.r.random() < 0.5:
            m.say(f"output frame_axes = {frame}.R.T, scalars = [dot({p.text}, {frame}.R * {n.text}), trace(outer({p.text}, {n.text}) * {frame}.R)];")
            m.outputs.append(Output("frame_axes", lambda s: [e for row in vectors.transposed(m.pose(s, frame)[0]) for e in row]))

            def scalars(s):
                big = m.pose(s, frame)[0]
                value = dot(p.at(s), vectors.on(big, n.at(s)))
                turned = vectors.on(vectors.transposed(big), n.at(s))
                return [value, dot(turned, p.at(s))]

            m.outputs.append(Output("scalars", scalars))


POLAR = """
impl crate::MODULE::TreeFunctions<f64> for crate::Polar {
    fn polar(&self, a: f64, b: f64) -> [f64; 2] {
        [a.sin() * b, 0.1 * a - 0.2 * b * b]
    }
    fn polar_jacobian(&self, a: f64, b: f64) -> [[f64; 2]; 2] {
        [[a.cos() * b, a.sin()], [0.1, -0.4 * b]]
    }
}
"""


class External(Spoken):
    """Trees with a function in Rust, which C does not support."""

    rust = True


__all__ = ["Spoken", "External"]
