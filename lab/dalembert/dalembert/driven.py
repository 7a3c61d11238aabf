"""Random mechanisms with prescribed motions: coordinates and velocities as functions of time, and rates of velocities
as any expressions; the forces of their drives follow."""

from . import loops
from .expressions import Ex, Vec, call, lift
from .loops import Loops
from .vectors import mp, mpf


class Driven(Loops):
    """Trees, and mechanisms with loops, with up to two drives."""

    def __init__(self, random, size, hard=False):
        self.looped = random.random() < 0.4
        super().__init__(random, size, hard=hard, time=1)

    def tree(self, size, free):
        if not self.looped:
            self.kind = "tree"
        super().tree(size, free)

    def constraints(self):
        if self.looped:
            super().constraints()
        else:
            self.nearby()
        m, r = self.m, self.r
        # Velocities that drives may prescribe: all of a tree, all but one with loops.
        left = m.n - len(m.closures) - len(m.kept) - (1 if self.looped else r.random() < 0.9)
        groups = list(m.velocities)
        r.shuffle(groups)
        for _, size, place in groups[: 1 + r.randrange(2)]:
            if size <= left:
                left -= r.choice([self.coordinate, self.velocity, self.rate])(place)

    def law(self, now):
        """A function of time with a value near `now`."""
        moving = call("sin", self.t * self.positive()) * self.number() + self.t * self.number() * "0.3"
        return lift(f"{float(now - moving.at(self.near)):.3f}") + moving

    def of(self, place):
        """The velocity with the entry at this index: its name, its entries as expressions, its first index."""
        for name, size, first in self.m.velocities:
            if first <= place < first + size:
                texts = [name] if size == 1 else [f"{name}[{k + 1}]" for k in range(size)]
                return name, [Ex(text, (lambda k: lambda s: s.xi[first + k])(k)) for k, text in enumerate(texts)], first
        raise IndexError

    def coordinate(self, place):
        """Prescribes coordinates; returns the number of degrees of freedom that it takes."""
        m = self.m
        name, entries, _ = self.of(place)
        for coordinate, kind, at in m.coordinates:
            if f"{coordinate}_dot" == name and kind in ("real", "S1") and len(entries) == 1:
                break
        else:
            return self.velocity(place)
        now = self.near.x[at] if kind == "real" else mp.atan2(self.near.x[at + 1], self.near.x[at])
        law = self.law(now)
        m.say(f"prescribe {coordinate} = {law.text};")
        m.driven.append((at, kind, law))
        if kind == "real":
            m.closures.append(Ex("", lambda s: s.x[at] - law.at(s)))
        else:
            m.closures.append(Ex("", lambda s: mp.sin(mp.atan2(s.x[at + 1], s.x[at]) - law.at(s))))
        m.stabilized.append(None)
        return 1

    def velocity(self, place):
        name, entries, _ = self.of(place)
        laws = [self.law(mpf(self.number())) for _ in entries]
        self.m.say(f"prescribe {name} = {self.whole(laws)};")
        self.m.kept += [v - law for v, law in zip(entries, laws)]
        return len(entries)

    def rate(self, place):
        name, entries, first = self.of(place)
        laws = [self.effort() for _ in entries]
        self.m.say(f"prescribe rate({name}) = {self.whole(laws)};")
        self.m.accelerated += [(first + k, law) for k, law in enumerate(laws)]
        return len(entries)

    @staticmethod
    def whole(laws):
        return laws[0].text if len(laws) == 1 else Vec.of(laws).text

    def configuration(self):
        if self.m.closures:
            return super().configuration()
        return loops.allowed_velocities(self.m, self.complete())


__all__ = ["Driven"]
