"""Awkward geometry: mounts at angles whose sines are roots, axes that are nearly parallel, massless links, parameters
that are zero, platforms on more cranks than necessary."""

from .driven import Driven
from .expressions import PI, STILL, Mat, Vec, call, lift, rotation, rpy
from .loops import Loops
from .trees import AXES, Forest

ANGLES = [PI / 6, PI / 4, PI / 3, -(PI / 3), PI * 2 / 3, PI / 2, PI, lift("1e-7"), lift(0)]
NEARLY = [[0, 0, 1], [0, "1e-7", 1], ["-1e-7", 0, 1], ["1e-7", "1e-7", -1], [1, 0, "1e-7"], [1, 1, 1]]


class Awkward:
    """Mixin for a kind of mechanism."""

    def __init__(self, random, size, **more):
        self.nearly = random.random() < 0.5
        super().__init__(random, size, **more)

    def pick(self, list_):
        if list_ is AXES and self.nearly:
            list_ = NEARLY
        return super().pick(list_)

    def mount(self, moving=False):
        r = self.r
        _, place = super().mount(moving)
        angle = lambda: self.pick(ANGLES)  # noqa: E731
        turned = self.pick([lambda: rpy(angle(), angle(), angle()), lambda: rotation(self.pick("xyz"), angle()) * rotation(self.pick("xyz"), angle()), lambda: STILL])()
        # A position among the numbers of the same angles.
        if r.random() < 0.3:
            a = angle()
            place = Vec.of([call("cos", a), call("sin", a), 0])
        return turned, place

    def value(self):
        """A positive number or a parameter, possibly with a term whose parameter is zero."""
        value = super().value()
        if self.r.random() < 0.3:
            if not hasattr(self, "zero"):
                self.zero = self.m.parameter("nothing", 0)
            value = value + self.zero * self.number()
        return value

    def body(self, frame):
        """Adds a body, sometimes without mass or extension."""
        m, r = self.m, self.r
        if r.random() < 0.6:
            return super().body(frame)
        com, zero = self.vector(0.4), lift(0)
        big = self.inertia() if r.random() < 0.5 else Mat.of([[0] * 3] * 3)
        mass = zero if r.random() < 0.6 else self.value()
        m.bodies.append((frame, mass, com, big, "com"))
        m.say(f"body on {frame} {{ mass {mass.text}; com {com.text}; inertia {big.text} about com; }}")
        return None


class AwkwardTrees(Awkward, Forest):
    """Trees with awkward geometry."""


class Platforms(Loops):
    """A platform on three parallel cranks of the same length: one row is redundant, but only in closed configurations.
    There, slopes have half of the digits, or a third of them in `float`."""

    def tree(self, size, free):
        zero, z, length = Vec.of([0, 0, 0]), Vec.of([0, 0, 1]), self.length()
        self.m.frame("ground", "world", rotation("x", PI / 6), self.vector(0.5))
        feet = [zero, Vec.of([self.length(), "0.1", 0]), Vec.of(["0.3", self.length(), 0])]
        cranks = [self.link(f"a{k}", "revolute", z, "ground", (STILL, foot)) for k, foot in enumerate(feet)]
        end = Vec.of([length, 0, 0])
        top = self.link("top", "revolute", z, cranks[0], (STILL, end))
        for crank, foot in list(zip(cranks, feet))[1:]:
            self.ends.append(("pin", (top, foot), (crank, end)))
        angle = self.r.uniform(-1.5, 1.5)
        self.guess = [angle] * 3

    def nearby(self):
        s = super().nearby()
        x = list(s.x)
        places = {name: place for name, _, place in self.m.coordinates}
        x[places["top"]] = -x[places["a0"]]
        self.near = s = s.but(x=x)
        return s


class DrivenPlatforms(Platforms, Driven):
    """Platforms in which the rate of a crank is prescribed: the only unique multiplier is the force of its drive."""

    def constraints(self):
        Loops.constraints(self)
        self.rate(next(place for name, _, place in self.m.velocities if name == "a0_dot"))


class AwkwardLoops(Awkward, Loops):
    """Loops with awkward geometry."""


class AwkwardDriven(Awkward, Driven):
    """Prescribed motions with awkward geometry."""


__all__ = ["AwkwardTrees", "AwkwardLoops", "AwkwardDriven", "DrivenPlatforms", "Platforms"]
