"""Random mechanisms with closed loops: planar linkages, slider-cranks, rods between points, overconstrained ones,
gears, links with an axis or the whole rotation fixed by equations of vectors and matrices, and trees whose frames
are pinned to one another or to the ground."""

from . import vectors
from .definitions import Definitions, independent
from .expressions import PI, STILL, Ex, Mat, Vec, lift, rotation
from .joints import add_joint
from .mechanism import WORLD
from .tied import allowed_velocities, on_kinds
from .trees import AXES, Forest, random_state
from .vectors import mpf

KINDS = ["planar", "planar", "slider", "two loops", "rod", "rod", "ball", "flat", "bricard", "gears", "axis", "axis", "turned", "turned"]
KINDS += ["tree", "tree", "tree"]
# Mounts of the whole mechanism.
GROUNDS = [lambda: STILL, lambda: rotation("x", PI / 4), lambda: rotation("y", "0.3") * rotation("x", PI / 4), lambda: rotation("z", PI / 4)]


class Open(Exception):
    """Raised if no configuration was found that closes the loops."""


class Loops(Forest):
    """Trees with one or more loops; loads are those of trees."""

    def __init__(self, random, size, hard=False, time=0.2):
        self.kind = random.choice(KINDS)
        # The points connected by pins, with their directions; rods; axes that coincide.
        self.ends, self.guess = [], None
        super().__init__(random, size, free=0.1, time=time, hard=hard)

    def positive(self):
        # Lengths as well: tiny ones make loops that cannot be closed.
        return f"{self.r.uniform(0.2, 2):.3f}"

    # Parts of loops.

    def link(self, name, kind, axis, parent, mount, body=True):
        """Adds a joint with a body; returns the name of its frame."""
        moves = f"{name}_link"
        fields, later = "", []
        if kind in ("revolute", "continuous", "prismatic"):
            fields, later = self.fields(name, kind, self.m.nu, self.m.n)
        found = add_joint(self.m, name, kind, axis, parent, mount, moves, fields)
        for add in later:
            add()
        self.frames.append(moves)
        for text, ex in found.items():
            moving = text.endswith(("_dot", "_v", "_w"))
            if isinstance(ex, Ex):
                (self.velocities if moving else self.plain).append(ex)
            else:
                (self.velocities if moving else self.plain).extend(ex[i] for i in range(3))
        if body:
            self.body(moves)
            heavy = Mat.of([["0.05", "0.005", "0.002"], ["0.005", "0.06", "0.003"], ["0.002", "0.003", "0.07"]])
            self.m.bodies.append((moves, lift("0.3"), Vec.of([0, 0, 0]), heavy, "com"))
            self.m.say(f"body on {moves} {{ mass 0.3; inertia {heavy.text} about com; }}")
        return moves

    def length(self):
        return f"{self.r.uniform(0.4, 1.2):.2f}"

    def chain(self, name, parent, place, axis, count, kinds=("revolute", "continuous"), light=False):
        """A chain of links about parallel axes; returns the last frame, and the position of its end. The last link may
        be massless."""
        mount = (STILL, place)
        for k in range(count):
            parent = self.link(f"{name}{k}", self.pick(kinds), axis, parent, mount, not (light and k == count - 1))
            place = Vec.of([self.length(), 0, 0])
            mount = (STILL, place)
        return parent, place

    def tree(self, size, free):
        m, kind = self.m, self.kind
        if kind == "tree":
            super().tree(size, free)
            return
        ground = WORLD
        if self.r.random() < 0.7:
            m.frame("ground", WORLD, self.pick(GROUNDS)(), self.vector(0.5))
            ground = "ground"
        zero, z = Vec.of([0, 0, 0]), Vec.of([0, 0, 1])
        base = Vec.of([f"{self.r.uniform(0.5, 1.2):.2f}", self.number(0.3), 0])
        if self.hard and self.r.random() < 0.5:
            z = Vec.of([0, "1e-7", 1])
        # Links whose inertia comes only from the loop.
        light = self.r.random() < 0.3
        if kind == "planar":
            a = self.chain("a", ground, zero, z, 2, light=light)
            b = self.chain("b", ground, base, z, 1 + self.r.randrange(2))
            self.ends.append(("pin", a, b))
        elif kind == "slider":
            a = self.chain("a", ground, zero, z, 2, light=light)
            b = self.link("b", "prismatic", Vec.of(["0.6", "0.8", 0]), ground, (STILL, base)), zero
            self.ends.append(("pin", a, b))
        elif kind == "two loops":
            a = self.chain("a", ground, zero, z, 2)
            b = self.chain("b", ground, base, z, 1)
            c = self.chain("c", b[0], Vec.of([self.length(), "0.1", 0]), z, 1)
            far = Vec.of([f"{self.r.uniform(1.3, 2):.2f}", "0.2", 0])
            d = self.chain("d", ground, far, z, 1 + self.r.randrange(2))
            self.ends += [("pin", a, b), ("pin", c, d)]
        elif kind == "rod":
            # A crank and a rocker about axes in space, with a massless rod between ball joints.
            a = self.chain("a", ground, zero, Vec.of(self.pick(AXES)), 1)
            b = self.chain("b", ground, base + Vec.of([0, 0, self.number()]), Vec.of(self.pick(AXES)), 1 + self.r.randrange(2), light=light)
            self.ends.append(("rod", a, b))
        elif kind == "ball":
            # The rod has mass and hangs on a ball joint; its other end is pinned.
            a = self.chain("a", ground, zero, Vec.of(self.pick(AXES)), 1)
            rod = self.link("rod", self.pick(["spherical", "spherical3"]), None, a[0], (STILL, a[1]))
            b = self.chain("b", ground, base, Vec.of(self.pick(AXES)), 1)
            self.ends.append(("ball", (rod, Vec.of([self.length(), 0, "0.1"])), b))
        elif kind == "flat":
            # Parallel axes, and a ball joint as a pin: one redundant row.
            m.frame("tilted", ground, rotation("x", "0.4"), zero)
            a = self.chain("a", "tilted", zero, Vec.of([0, 0, 1]), 2, light=light)
            b = self.chain("b", "tilted", base, Vec.of([0, 0, 1]), 1 + self.r.randrange(2))
            self.ends.append(("ball", a, b))
        elif kind == "axis":
            # Three rows for a direction, one of them redundant; with parallel axes two of them.
            if self.r.random() < 0.5:
                last = self.chain("a", ground, zero, z, 2 + self.r.randrange(2))[0]
                along = Vec.of(self.pick([[1, 0, 0], ["0.6", "0.8", 0]]))
            else:
                a = self.chain("a", ground, zero, Vec.of(self.pick(AXES)), 1)
                last = self.link("ball", self.pick(["spherical", "spherical3"]), None, a[0], (STILL, a[1]))
                along = Vec.of(self.pick(AXES))
            self.ends.append(("axis", (last, along), (ground, along)))
        elif kind == "turned":
            # Nine rows for a rotation, at most three of them independent.
            if self.r.random() < 0.5:
                last = self.chain("a", ground, zero, z, 2 + self.r.randrange(2))[0]
            else:
                a = self.chain("a", ground, zero, Vec.of(self.pick(AXES)), 1 + self.r.randrange(2))
                last = self.link("ball", self.pick(["spherical", "spherical3"]), None, a[0], (STILL, a[1]))
            self.ends.append(("turned", (last, zero), (ground, zero)))
        elif kind == "gears":
            # Linear loops: velocities are dependent. In addition, if there is room, a rod.
            a = self.chain("a", ground, zero, Vec.of(self.pick(AXES)), 2, ("revolute",))
            b = self.chain("b", ground, base, Vec.of(self.pick(AXES)), 2, ("revolute", "prismatic"))
            self.ends.append(("gear", None, None))
            if self.r.random() < 0.5:
                self.ends.append(("rod", a, b))
        elif kind == "bricard":
            self.bricard(ground)
        if self.r.random() < 0.3:
            self.link("more", self.pick(["revolute", "prismatic", "continuous"]), Vec.of(self.pick(AXES)), self.pick(self.frames[1:]), self.mount())

    def bricard(self, ground):
        """Six hinges at right angles, with rods of the same length: overconstrained, one degree of freedom."""
        length, right = self.length(), PI / 2
        z, frame, mount = Vec.of([0, 0, 1]), ground, (STILL, Vec.of([0, 0, 0]))
        for k in range(5):
            frame = self.link(f"a{k}", "revolute", z, frame, mount)
            turned = rotation("x", right if k % 2 == 0 else -right)
            mount = (turned, Vec.of([length, 0, 0]))
        m = self.m
        m.frame("last", frame, *mount)
        self.frames.append("last")
        pin = (ground, Vec.of([f"-{length}", 0, 0]))
        self.ends.append(("ball", ("last", Vec.of([0, 0, 0])), pin))
        self.ends.append(("across", ("last", z), (ground, Vec.of([1, 0, 0]))))
        self.ends.append(("across", ("last", z), (ground, z)))
        self.guess = [1.5707963267948966] * 5

    # The equations.

    def constraints(self):
        m, r = self.m, self.r
        if self.kind == "tree":
            left = m.n - 1
            while left > 0 and (not self.ends or r.random() < 0.4):
                kind = self.pick([k for k, rows in (("rod", 1), ("plane", 1), ("ball", 3)) if rows <= left])
                a, b = self.end(), (WORLD, None) if r.random() < 0.5 else self.end()
                if a[0] == b[0]:
                    b = (WORLD, None)
                self.ends.append((kind, a, b))
                left -= 3 if kind == "ball" else 1
        s = self.nearby()
        for kind, a, b in self.ends:
            if kind == "gear":
                self.gear(s)
                continue
            (f, p), (g, q) = a, b
            if q is None:
                # The current position of the point, with few digits: Newton's method does the rest.
                q = Vec.of([f"{float(e):.2f}" for e in m.point(s, f, p.at(s))])
            self.close(kind, f, p, g, q, s)
        if self.kind != "tree" and r.random() < 0.2:
            super().constraints()

    def nearby(self):
        """A state near which to close the loops."""
        s = random_state(self.m, self.r)
        if self.guess:
            x = list(s.x)
            for (name, _, place), value in zip([c for c in self.m.coordinates if c[0].startswith("a")], self.guess):
                x[place] = mpf(value)
            s = s.but(x=x)
        if self.m.time is not None:
            x = list(s.x)
            x[self.m.time] = mpf(f"{float(x[self.m.time]):.2f}")
            s = s.but(x=x)
        self.near = s
        return s

    def gear(self, s):
        a, b, c = self.r.sample([q for q in self.plain if q.text in ("a0", "a1", "b0", "b1")], 3)
        ratio, other = self.number(), self.number()
        tie = a - b * ratio - c * other
        self.m.say(f"loop {tie.text} = {float(tie.at(s)):.2f};")
        at = lift(f"{float(tie.at(s)):.2f}")
        self.m.closures.append(tie - at)
        self.m.stabilized.append(None)

    def close(self, kind, f, p, g, q, s):
        m = self.m
        a, b = f"position({f}, {p.text})", q.text if g == WORLD else f"position({g}, {q.text})"
        left, right = (lambda s: m.point(s, f, p.at(s))), (lambda s: m.point(s, g, q.at(s)))
        decay = lift(self.positive()) if self.r.random() < 0.2 else None
        tail = f" stabilized {decay.text}" if decay else ""
        apart = lambda s: vectors.sub(left(s), right(s))  # noqa: E731

        def entry(k):
            return Ex("", lambda s: apart(s)[k])

        if kind == "ball":
            m.say(f"loop {a} = {b}{tail};")
            m.closures += [entry(k) for k in range(3)]
        elif kind == "pin":
            # In the plane of the ground, whose axes may be rotated.
            frame = "ground" if "ground" in m.frames else WORLD
            for k in range(2):
                n = Vec.of([[1, 0, 0], [0, 1, 0]][k])
                direction = n.text if frame == WORLD else f"(ground.R * {n.text})"
                m.say(f"loop dot({a} - {b}, {direction}) = 0{tail};")
                m.closures.append(Ex("", (lambda n: lambda s: vectors.dot(apart(s), vectors.on(m.pose(s, frame)[0], n.at(s))))(n)))
        elif kind == "plane":
            n = Vec.of([self.number(), self.number(), "0.7"])
            m.say(f"loop dot({a} - {b}, {n.text}) = 0{tail};")
            m.closures.append(Ex("", lambda s: vectors.dot(apart(s), n.at(s))))
        elif kind == "rod":
            length = lift(f"{float(vectors.norm(apart(s))) + self.r.uniform(-0.05, 0.3):.2f}")
            if self.r.random() < 0.5:
                m.say(f"loop norm({a} - {b}) = {length.text}{tail};")
                m.closures.append(Ex("", lambda s: vectors.norm(apart(s)) - length.at(s)))
            else:
                m.say(f"loop {length.text}^2 = dot({a} - {b}, {a} - {b}){tail};")
                m.closures.append(Ex("", lambda s: length.at(s) ** 2 - vectors.dot(apart(s), apart(s))))
        elif kind == "axis":
            m.say(f"loop {f}.R * {p.text} = {q.text if g == WORLD else f'{g}.R * {q.text}'}{tail};")
            turned = lambda s: vectors.sub(vectors.on(m.pose(s, f)[0], p.at(s)), vectors.on(m.pose(s, g)[0], q.at(s)))  # noqa: E731
            m.closures += self.varying([Ex("", (lambda k: lambda s: turned(s)[k])(k)) for k in range(3)])
        elif kind == "turned":
            m.say(f"loop {f}.R = {'identity(3)' if g == WORLD else f'{g}.R'}{tail};")
            rows = lambda s: vectors.sub(sum(m.pose(s, f)[0], []), sum(m.pose(s, g)[0], []))  # noqa: E731
            m.closures += self.varying([Ex("", (lambda k: lambda s: rows(s)[k])(k)) for k in range(9)])
        elif kind == "across":
            m.say(f"loop dot({f}.R * {p.text}, {q.text if g == WORLD else f'{g}.R * {q.text}'}) = 0{tail};")
            m.closures.append(Ex("", lambda s: vectors.dot(vectors.on(m.pose(s, f)[0], p.at(s)), vectors.on(m.pose(s, g)[0], q.at(s)))))
        m.stabilized += [decay] * (len(m.closures) - len(m.stabilized))

    def varying(self, entries):
        """The closures that are not identities, which would not be equations."""
        states = [random_state(self.m, self.r) for _ in range(2)]
        return [e for e in entries if abs(e.at(states[0]) - e.at(states[1])) > mpf(10) ** -30]

    # The closed configuration.

    def asked(self):
        """With guesses for the start, so that a run could begin."""
        s, m = self.near, self.m
        for name, kind, place in m.coordinates:
            if place == m.time:
                m.say(f"start {name} = {float(s.x[place])};")
            elif kind in ("real", "S1") and place not in [driven for driven, *_ in m.driven]:
                value = s.x[place] if kind == "real" else vectors.mp.atan2(s.x[place + 1], s.x[place])
                m.say(f"start {name} {'~' if self.ends else '='} {float(value):.4f};")
        super().asked()

    def complete(self):
        """The state nearby, with parameters that were added later."""
        return self.near.but(p=list(self.m.default))

    def configuration(self):
        s = closed(self.m, self.complete())
        return allowed_velocities(self.m, s)


def closed(m, s):
    """The nearest closed configuration, by Newton steps along A, in doubles."""
    d = Definitions(m)
    for _ in range(60):
        off = [e.at(s) for e in m.closures]
        if max((abs(e) for e in off), default=0) < mpf(10) ** -40:
            break
        columns = d.columns(s)[d.first :]
        rows = closing(d, m, s)
        kept = independent(rows, mpf(10) ** -9)
        if not kept:
            # No motion can close them.
            raise Open
        b = [rows[i] for i in kept]
        h = vectors.on(vectors.transposed(b), vectors.solve([[vectors.dot(p, q) for q in b] for p in b], [off[i] for i in kept]))
        size = max(abs(e) for e in h)
        h = vectors.scale(-min(1, mpf("0.3") / size) if size else 0, h)
        x = list(s.x)
        for step, column in zip(h, columns):
            x = vectors.add(x, vectors.scale(step, column))
        s = s.but(x=on_kinds(m, x))
    else:
        raise Open
    if m.closures and any(mpf(10) ** -30 < max(map(abs, row)) < mpf(10) ** -5 for row in closing(d, m, s)):
        # The rod is stretched out: in doubles, the rate of its length is only rounding.
        raise Open
    return s.but(x=[mpf(float(e)) for e in s.x])


def closing(d, m, s):
    """The slopes of the closures along A, by rows."""
    columns = d.columns(s)[d.first :]
    return vectors.transposed([d.along(lambda q: [e.at(q) for e in m.closures], s, column) for column in columns])


__all__ = ["Loops", "Open"]
