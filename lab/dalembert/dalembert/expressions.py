"""Expressions that are both text of the language and numbers at a state, each built from its parts."""

import mpmath
from mpmath import mpf

from . import vectors


class State:
    """The arguments of expressions and poses: coordinates, velocities, inputs, first-order states, parameters,
    accelerations."""

    __slots__ = ("x", "xi", "u", "z", "p", "a", "shape", "kept")

    def __init__(self, x, xi=(), u=(), z=(), p=(), a=()):
        self.x, self.xi, self.u, self.z, self.p, self.a = x, xi, u, z, p, a
        # Cached values: those of x and parameters only, and those of everything.
        self.shape, self.kept = {}, {}

    def but(self, **changed):
        """The state with other values."""
        values = {name: changed.get(name, getattr(self, name)) for name in ("x", "xi", "u", "z", "p", "a")}
        made = State(**values)
        if not {"x", "p"} & changed.keys():
            made.shape = self.shape
        return made


def once(at, still):
    if not still:
        return at
    value = at(None)
    return lambda s: value


class Ex:
    """A scalar. It is computed once if it is the same at every state."""

    __slots__ = ("text", "at", "still")

    def __init__(self, text, at, still=False):
        self.text, self.at, self.still = text, once(at, still), still

    def __add__(self, other):
        other = lift(other)
        return Ex(f"({self.text} + {other.text})", lambda s: self.at(s) + other.at(s), self.still and other.still)

    def __sub__(self, other):
        other = lift(other)
        return Ex(f"({self.text} - {other.text})", lambda s: self.at(s) - other.at(s), self.still and other.still)

    def __mul__(self, other):
        other = lift(other)
        return Ex(f"({self.text} * {other.text})", lambda s: self.at(s) * other.at(s), self.still and other.still)

    def __truediv__(self, other):
        other = lift(other)
        return Ex(f"({self.text} / {other.text})", lambda s: self.at(s) / other.at(s), self.still and other.still)

    def __neg__(self):
        return Ex(f"(-{self.text})", lambda s: -self.at(s), self.still)

    def __pow__(self, n):
        return Ex(f"{self.text}^{n}", lambda s: self.at(s) ** n, self.still)

    __radd__ = __add__

    def __rmul__(self, other):
        return lift(other) * self

    def __rsub__(self, other):
        return lift(other) - self


def lift(value):
    """A number from its decimals, which hamel reads exactly."""
    if isinstance(value, Ex):
        return value
    text = str(value)
    number = mpf(text)
    return Ex(f"({text})" if text.startswith("-") else text, lambda s: number, True)


PI = Ex("pi", lambda s: +mpmath.pi, True)


def call(name, *arguments):
    """A function of the language that mpmath has under the same name, or a table below."""
    arguments = [lift(a) for a in arguments]
    function = OWN.get(name) or getattr(mpmath, name)
    text = ", ".join(a.text for a in arguments)
    return Ex(f"{name}({text})", lambda s: function(*(a.at(s) for a in arguments)), all(a.still for a in arguments))


OWN = {
    "log": mpmath.ln,
    "abs": abs,
    "min": min,
    "max": max,
    "sign": mpmath.sign,
    "clamp": lambda a, low, high: min(max(a, low), high),
    "hypot": lambda a, b: mpmath.sqrt(a * a + b * b),
}


class Vec:
    """A vector of any length: text, and a list of numbers."""

    __slots__ = ("text", "at", "still")

    def __init__(self, text, at, still=False):
        self.text, self.at, self.still = text, once(at, still), still

    @staticmethod
    def of(entries):
        entries = [lift(e) for e in entries]
        text = "[" + ", ".join(e.text for e in entries) + "]"
        return Vec(text, lambda s: [e.at(s) for e in entries], all(e.still for e in entries))

    def __getitem__(self, index):
        return Ex(f"{self.text}[{index + 1}]", lambda s: self.at(s)[index])

    def __add__(self, other):
        return Vec(f"({self.text} + {other.text})", lambda s: vectors.add(self.at(s), other.at(s)), self.still and other.still)

    def __sub__(self, other):
        return Vec(f"({self.text} - {other.text})", lambda s: vectors.sub(self.at(s), other.at(s)), self.still and other.still)

    def __rmul__(self, factor):
        factor = lift(factor)
        return Vec(f"({factor.text} * {self.text})", lambda s: vectors.scale(factor.at(s), self.at(s)), self.still and factor.still)


class Mat:
    """A matrix of three rows and columns."""

    __slots__ = ("text", "at", "still")

    def __init__(self, text, at, still=False):
        self.text, self.at, self.still = text, once(at, still), still

    @staticmethod
    def of(rows):
        rows = [Vec.of(row) for row in rows]
        text = "[" + ", ".join(row.text for row in rows) + "]"
        return Mat(text, lambda s: [row.at(s) for row in rows], all(row.still for row in rows))

    def __mul__(self, other):
        text = f"{self.text} * {other.text}"
        if isinstance(other, Vec):
            return Vec(f"({text})", lambda s: vectors.on(self.at(s), other.at(s)), self.still and other.still)
        return Mat(f"({text})", lambda s: vectors.times(self.at(s), other.at(s)), self.still and other.still)


STILL = Mat("identity(3)", lambda s: vectors.IDENTITY, True)


def rotation(axis, angle):
    """`rotx`, `roty` or `rotz` of an expression."""
    n = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]["xyz".index(axis)]
    angle = lift(angle)
    return Mat(f"rot{axis}({angle.text})", lambda s: vectors.about([mpf(c) for c in n], angle.at(s)), angle.still)


def rpy(roll, pitch, yaw):
    """Roll, pitch and yaw in URDF's order."""
    roll, pitch, yaw = lift(roll), lift(pitch), lift(yaw)
    parts = rotation("z", yaw), rotation("y", pitch), rotation("x", roll)

    def at(s):
        return vectors.times(vectors.times(parts[0].at(s), parts[1].at(s)), parts[2].at(s))

    return Mat(f"rpy({roll.text}, {pitch.text}, {yaw.text})", at, roll.still and pitch.still and yaw.still)


def axis_angle(axis, angle):
    """The rotation about a vector, which is normalised."""
    angle = lift(angle)
    return Mat(f"axis_angle({axis.text}, {angle.text})", lambda s: vectors.about(axis.at(s), angle.at(s)), axis.still and angle.still)
