"""Random mechanisms with explicit coordinates, constraints and rates: circles of any radius, quaternions of any length,
matrices rotated from either side, curves; velocities are mixtures of the natural rates, or are defined by rates."""

from mpmath import cos, mp, mpf, sin

from . import vectors
from .expressions import Ex, Mat, Vec, call, lift
from .mechanism import WORLD
from .tied import allowed_velocities
from .trees import Forest, random_state
from .vectors import ONE, cross, hat, scale, solve, times, transposed, unit

KINDS = ["circle", "S1", "SO3", "world SO3", "S3", "quaternion", "columns", "real", "real", "curve"]
SIZES = {"SO3": 3, "world SO3": 3, "S3": 3, "quaternion": 3, "columns": 3}


def qmul(p, q):
    a, b, c, d = p
    w, x, y, z = q
    return [a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w]


class Written(Forest):
    """Groups of coordinates, each with natural rates ν; ν = G(x) ξ + g(t), or ξ = H(x) ν."""

    def __init__(self, random, size, hard=False):
        self.groups, self.starts = [], []
        super().__init__(random, size, free=0, time=0.2, hard=hard)

    # Groups: coordinates, their motion by ν, and the bodies that they rotate or shift.

    def tree(self, size, free):
        r, m = self.r, self.m
        kinds = [r.choice(KINDS)]
        while sum(SIZES.get(kind, 1) for kind in kinds) < 1 + size:
            kinds.append(r.choice(KINDS))
        # Indices of ν, once velocities are known.
        self.by_rows = self.t is None and r.random() < 0.35 and not {"world SO3", "S3"} & set(kinds)
        count, made = 0, []
        for k, kind in enumerate(kinds):
            made.append(getattr(self, "group_" + kind.replace(" ", "_"))(f"q{k}", count))
            count += SIZES.get(kind, 1)
        self.mixture(count)
        for line in (line for group in made for line in group["rates"](self.nu)):
            m.say(line)
        parent = WORLD
        for k, group in enumerate(made):
            frame = f"f{k}"
            if r.random() < 0.2:
                parent = WORLD
            place = self.vector(0.5)
            if "shift" in group:
                place = place + group["shift"]
            turned = group.get("turn", lambda: self.mount()[0])()
            m.frame(frame, parent, turned, place)
            self.frames.append(frame)
            parent = frame
            self.body(frame)
        # Every group moves a body.
        heavy = Mat.of([["0.5", "0.05", "0.02"], ["0.05", "0.6", "0.03"], ["0.02", "0.03", "0.7"]])
        for frame in self.frames[1:]:
            m.bodies.append((frame, lift("0.7"), Vec.of([0, "0.1", "0.2"]), heavy, "com"))
            m.say(f"body on {frame} {{ mass 0.7; com [0, 0.1, 0.2]; inertia {heavy.text} about com; }}")

    def mixture(self, n):
        """ξ, and ν as text and numbers: with factors, some of them varying, whose determinant does not vanish."""
        r, m = self.r, self.m
        triples = n >= 3 and r.random() < 0.5
        self.natural = n
        names = []
        if not self.by_rows:
            if triples:
                w = m.velocity("w", 3)
                names += [w[i] for i in range(3)]
            names += [m.velocity(f"v{k}") for k in range(n - len(names))]
            self.velocities += names
        # L U with ones on the diagonal of L, in the entries that vary.
        lower = [[lift(self.number()) if i > j and r.random() < 0.4 else None for j in range(n)] for i in range(n)]
        for i in range(n):
            for j in range(i):
                if lower[i][j] and self.plain and r.random() < 0.5:
                    lower[i][j] = lower[i][j] + call("sin", self.pick(self.plain))
        upper = [[lift(self.number()) if i < j and r.random() < 0.4 else None for j in range(n)] for i in range(n)]
        for i in range(n):
            upper[i][i] = lift(self.pick(["1", "1", "2", "-0.7", "1.3"]))
        turned = r.sample(range(n), n)
        entries = [[None] * n for _ in range(n)]
        for i in range(n):
            for j in range(n):
                parts = [upper[i][j]] if upper[i][j] else []
                parts += [lower[i][k] * upper[k][j] for k in range(min(i, j + 1)) if lower[i][k] and upper[k][j]]
                for part in parts:
                    entries[i][turned[j]] = part if entries[i][turned[j]] is None else entries[i][turned[j]] + part
        self.entries = entries
        if self.by_rows:
            self.said(n)
            return

        def mixed(i):
            total = None
            for entry, v in zip(entries[i], names):
                if entry is not None:
                    total = entry * v if total is None else total + entry * v
            if self.t is not None and r.random() < 0.4:
                total = total + call("cos", self.t) * self.number()
            return total

        self.nu = [mixed(i) for i in range(n)]
        self.value_of = lambda s: [e.at(s) for e in self.nu]

    def said(self, n):
        """ξ = H ν, where ν are given by rates: hamel derives A from this; here a system is solved."""
        m = self.m
        rates = [text for group in self.groups for text in group]
        places = []
        for k in range(n):
            parts = [f"{e.text} * {rates[j]}" for j, e in enumerate(self.entries[k]) if e is not None]
            name = f"v{k}"
            place = m.n
            m.velocities.append((name, 1, place))
            m.n += 1
            m.say(f"velocity {name} = {' + '.join(parts)};")
            self.velocities.append(Ex(name, (lambda place: lambda s: s.xi[place])(place)))
            places.append(place)

        def value(s):
            h = [[e.at(s) if e is not None else mpf(0) for e in row] for row in self.entries]
            return solve(h, [s.xi[p] for p in places])

        self.nu = [Ex("", (lambda i: lambda s: value(s)[i])(i)) for i in range(n)]
        self.value_of = value

    def line(self, text):
        """A rate statement, unless velocities define the rates."""
        return [] if self.by_rows else [text]

    def plain_coordinate(self, name, at):
        place = self.m.nu
        return self.m.coordinate(name, "real", at), place

    def group_real(self, name, k):
        q, place = self.plain_coordinate(name, lambda s: [self.value_of(s)[k]])
        self.plain.append(q)
        self.groups.append([f"rate({name})"])
        axis = [0, 0, 0]
        axis[self.r.randrange(3)] = 1
        shift = Vec.of([q if a else 0 for a in axis])
        return {"rates": lambda nu: self.line(f"rate {name} = {nu[k].text};"), "shift": shift}

    def group_curve(self, name, k):
        """A point on a parabola."""
        a = self.number()
        x, px = self.plain_coordinate(f"{name}x", lambda s: [self.value_of(s)[k]])
        y, _ = self.plain_coordinate(f"{name}y", lambda s: [2 * mpf(a) * s.x[px] * self.value_of(s)[k]])
        self.plain += [x, y]
        self.m.say(f"constraint {name}y = ({a}) * {name}x^2;")
        self.starts.append((px, lambda r: (lambda v: [v, mpf(a) * v * v])(mpf(r.uniform(-1, 1)))))
        self.m.onto.append((px, 2, lambda q: [q[0], mpf(a) * q[0] ** 2]))
        self.groups.append([f"rate({name}x)"])
        rates = lambda nu: self.line(f"rate {name}x = {nu[k].text}, {name}y = 2 * ({a}) * {name}x * ({nu[k].text});")  # noqa: E731
        return {"rates": rates, "shift": Vec.of([x, 0, y])}

    def group_circle(self, name, k):
        """A circle of any radius in two plain coordinates."""
        radius = self.positive()
        big = mpf(radius)
        c, pc = self.plain_coordinate(f"{name}c", lambda s: [-s.x[pc_ + 1] * self.value_of(s)[k]])
        pc_ = pc
        s_, _ = self.plain_coordinate(f"{name}s", lambda s: [s.x[pc_] * self.value_of(s)[k]])
        self.plain += [c, s_]
        self.m.say(f"constraint {name}c^2 + {name}s^2 = {radius}^2;")
        self.starts.append((pc, lambda r: (lambda a: [big * cos(a), big * sin(a)])(mpf(r.uniform(-3, 3)))))
        self.m.onto.append((pc, 2, lambda q: scale(big, unit(q))))
        self.groups.append([f"(({name}c * rate({name}s) - {name}s * rate({name}c)) / {radius}^2)"])
        rates = lambda nu: self.line(f"rate {name}c = -{name}s * ({nu[k].text}), {name}s = {name}c * ({nu[k].text});")  # noqa: E731
        c, s_ = c / radius, s_ / radius
        return {"rates": rates, "turn": lambda: Mat.of([[c, -s_, 0], [s_, c, 0], [0, 0, 1]])}

    def group_S1(self, name, k):
        place = self.m.nu
        self.m.coordinate(name, "S1", lambda s: [-s.x[place + 1] * self.value_of(s)[k], s.x[place] * self.value_of(s)[k]])
        c, s_ = Ex(f"{name}.c", lambda s: s.x[place]), Ex(f"{name}.s", lambda s: s.x[place + 1])
        self.plain += [c, s_]
        self.groups.append([f"rate({name})"])
        turned = Mat(f"roty({name})", lambda s: [[s.x[place], mpf(0), s.x[place + 1]], [mpf(0), ONE, mpf(0)], [-s.x[place + 1], mpf(0), s.x[place]]])
        return {"rates": lambda nu: self.line(f"rate {name} = {nu[k].text};"), "turn": lambda: turned}

    def matrix(self, name, k, world):
        place = self.m.nu

        def rate(s):
            big = [s.x[place + 3 * i : place + 3 * i + 3] for i in range(3)]
            w = hat(self.value_of(s)[k : k + 3])
            return [e for row in (times(w, big) if world else times(big, w)) for e in row]

        self.m.coordinate(name, "SO3", rate)
        self.plain.append(Ex(f"{name}[1, 2]", lambda s: s.x[place + 1]))
        self.plain.append(Ex(f"{name}[3, 1]", lambda s: s.x[place + 6]))
        self.groups.append([f"vee({name}.T * rate({name}))[{i + 1}]" for i in range(3)])
        turned = Mat(name, lambda s: [list(s.x[place + 3 * i : place + 3 * i + 3]) for i in range(3)])

        def rates(nu):
            w = f"hat([{', '.join(e.text for e in nu[k : k + 3])}])"
            return self.line(f"rate {name} = {f'{w} * {name}' if world else f'{name} * {w}'};")

        return {"rates": rates, "turn": lambda: turned}

    def group_SO3(self, name, k):
        return self.matrix(name, k, False)

    def group_world_SO3(self, name, k):
        return self.matrix(name, k, True)

    def quaternion(self, name, k, length, kind):
        """A quaternion of any length, with any factor; `kind` is its coordinate, or none for four plain ones."""
        factor, world = self.pick(["0.5", "0.7", "-1.1"]), self.r.random() < 0.3
        place = self.m.nu

        def rate(s):
            w = [mpf(0), *self.value_of(s)[k : k + 3]]
            q = s.x[place : place + 4]
            return scale(mpf(factor), qmul(w, q) if world else qmul(q, w))

        if kind:
            self.m.coordinate(name, kind, rate)
            entries = [Ex(f"{name}[{i + 1}]", (lambda i: lambda s: s.x[place + i])(i)) for i in range(4)]
            whole = name
        else:
            entries = [self.m.coordinate(f"{name}{i}", "real", (lambda i: lambda s: [rate(s)[i]])(i)) for i in range(4)]
            whole = f"[{', '.join(e.text for e in entries)}]"
            self.m.say(f"constraint dot({whole}, {whole}) = {length}^2;")
            self.m.onto.append((place, 4, lambda q: scale(mpf(length), unit(q))))
            self.starts.append((place, lambda r: scale(mpf(length), unit([mpf(r.gauss(0, 1)) for _ in range(4)]))))
        self.plain += entries
        # ν = 2 times the vector part of q* q̇, up to the factor.
        back = f"[{entries[0].text}, -{entries[1].text}, -{entries[2].text}, -{entries[3].text}]"
        moved = f"rate({name})" if kind else f"[{', '.join(f'rate({e.text})' for e in entries)}]"
        product = f"qmul({moved}, {back})" if world else f"qmul({back}, {moved})"
        self.groups.append([f"({product}[{i + 2}] / (({factor}) * {length}^2))" for i in range(3)])

        def rates(nu):
            w = f"[0, {', '.join(e.text for e in nu[k : k + 3])}]"
            turned = f"({factor}) * qmul({w}, {whole})" if world else f"({factor}) * qmul({whole}, {w})"
            if kind:
                return self.line(f"rate {name} = {turned};")
            return [line for i in range(4) for line in self.line(f"rate {entries[i].text} = ({turned})[{i + 1}];")]

        turned = Mat(f"rot({whole} / {length})", lambda s: vectors.quaternion(scale(1 / mpf(length), s.x[place : place + 4])))
        return {"rates": rates, "turn": lambda: turned}

    def group_S3(self, name, k):
        return self.quaternion(name, k, "1", "S3")

    def group_quaternion(self, name, k):
        return self.quaternion(name, k, self.positive(), None)

    def group_columns(self, name, k):
        """A rotation given by its columns, each of which is a vector."""
        place = self.m.nu

        def rate(i):
            def at(s):
                big = transposed([s.x[place + 3 * j : place + 3 * j + 3] for j in range(3)])
                return [row[i] for row in times(big, hat(self.value_of(s)[k : k + 3]))]

            return at

        columns = [self.m.coordinate(f"{name}{'abc'[i]}", "R3", rate(i)) for i in range(3)]
        self.plain += [columns[0][1], columns[2][0]]
        text = f"transpose([{', '.join(c.text for c in columns)}])"
        self.m.say(f"constraint {text}.T * {text} = identity(3);")
        self.m.say(f"constraint dot({name}a, cross({name}b, {name}c)) = 1;")

        def start(r):
            big = vectors.quaternion(unit([mpf(r.gauss(0, 1)) for _ in range(4)]))
            return [e for column in transposed(big) for e in column]

        self.starts.append((place, start))

        def onto(q):
            first = unit(q[0:3])
            third = unit(cross(first, q[3:6]))
            return [*first, *cross(third, first), *third]

        m = self.m
        m.onto.append((place, 9, onto))
        moved = f"transpose([{', '.join(f'rate({c.text})' for c in columns)}])"
        self.groups.append([f"vee({text}.T * {moved})[{i + 1}]" for i in range(3)])

        def rates(nu):
            w = f"hat([{', '.join(e.text for e in nu[k : k + 3])}])"
            return [line for i in range(3) for line in self.line(f"rate {columns[i].text} = ({text} * {w}) * {[[1, 0, 0], [0, 1, 0], [0, 0, 1]][i]};")]

        turned = Mat(text, lambda s: transposed([list(s.x[place + 3 * j : place + 3 * j + 3]) for j in range(3)]))
        return {"rates": rates, "turn": lambda: turned}

    def configuration(self):
        s = random_state(self.m, self.r)
        x = list(s.x)
        for place, start in self.starts:
            values = start(self.r)
            x[place : place + len(values)] = [mpf(float(e)) for e in values]
        return allowed_velocities(self.m, s.but(x=x))

    def asked(self):
        """With a start on X."""
        m, r = self.m, self.r
        for place, start in self.starts:
            values, k = start(r), 0
            for name, kind, at in m.coordinates:
                size = {"R3": 3}.get(kind, 1)
                if place <= at < place + len(values):
                    text = [mp.nstr(v, 20) for v in values[k : k + size]]
                    m.say(f"start {name} = {text[0] if size == 1 else '[' + ', '.join(text) + ']'};")
                    k += size
        super().asked()


__all__ = ["Written"]
