"""Attacks random mechanisms by their kinds and seeds:

    python -m dalembert.attack HAMEL FOLDER [--what KIND …] [--seeds FIRST COUNT] [--largest N] [--hard]
        [--rust FIRST COUNT] [--jobs N]

Ends with status 1 if hamel's results differ from the definitions, if it refuses a mechanism without a reason known
here, or if a text with a wrong sign is not detected."""

import argparse
import multiprocessing
import os
import random
import sys
import time

from . import wrong
from .awkward import AwkwardDriven, AwkwardLoops, AwkwardTrees, DrivenPlatforms, Platforms
from .compare import Comparison, Errors
from .definitions import Definitions, independent
from .doors import Doors, Refused
from .driven import Driven
from .loops import Loops, Open
from .rust import Crate
from .spoken import External, Spoken
from .trees import Forest
from .written import Written

# Limitations that hamel reports, each with the functions that are then left out of `generate`.
LEFT_OUT = {
    "has no regressor": ", regressor",
    "`centroidal_map` is not known": ", centroidal_map",
    "`parameter_slopes` is not known: the constraints": ", parameter_slopes",
}
# Messages for random mechanisms that are degenerate.
MEANINGLESS = ["can coincide", "the distance between its endpoints never changes", "the velocity by others", "already determine it"]


def settled(doors, text, language="c"):
    """Removes the functions that hamel reports as unavailable; returns whether there is anything to compare."""
    while True:
        try:
            doors.write(text)
            doors.run("emit", doors.file, "--language", language, "-o", os.path.join(doors.folder, "double"))
            return True
        except Refused as why:
            known = next((wanted for said, wanted in LEFT_OUT.items() if said in str(why)), None)
            if any(said in str(why) for said in MEANINGLESS):
                return False
            if known is None or known not in text:
                raise
            text = text.replace(known, "")


def tree(seed, largest, hard, kind=Forest):
    """A random tree, neither too large nor trivial."""
    r = random.Random(seed)
    while True:
        made = kind(r, 1 + r.randrange(5), hard=hard)
        if 2 <= made.m.n <= largest:
            made.state = made.configuration()
            return made


def loop(seed, largest, hard, kind=Loops):
    """A random mechanism with closed loops, and a state that closes them."""
    r = random.Random(seed)
    while True:
        try:
            made = kind(r, 2 + r.randrange(3), hard=hard)
            if 2 <= made.m.n <= largest:
                made.state = made.configuration()
                if any(v != 0 for v in made.state.xi) and moves(made):
                    return made
        except (Open, ZeroDivisionError):
            pass


def moves(made):
    """Whether the ties leave any motion."""
    ties = Definitions(made.m).conditions(made.state)
    return bool(made.m.driven or made.m.accelerated) or len(independent(ties, 1e-9)) < made.m.n


def driven(seed, largest, hard):
    """A mechanism with prescribed motions."""
    return loop(seed, largest, hard, Driven)


def written(seed, largest, hard):
    """A mechanism with explicit rates and constraints."""
    r = random.Random(seed)
    while True:
        made = Written(r, 1 + r.randrange(4), hard=hard)
        if made.m.n <= largest:
            made.state = made.configuration()
            return made


def awkward(seed, largest, hard):
    """A tree, loops or a prescribed motion with awkward geometry."""
    if seed % 3 == 0:
        return tree(seed, largest, hard, AwkwardTrees)
    return loop(seed, largest, hard, (AwkwardLoops, AwkwardDriven)[seed % 3 - 1])


def platform(seed, largest, hard):
    """A platform on more cranks than necessary, with or without prescribed motion."""
    return loop(seed, largest, hard, (Platforms, DrivenPlatforms)[seed % 2])


def spoken(seed, largest, hard):
    """A tree in other forms of the language."""
    return tree(seed, largest, hard, Spoken)


def external(seed, largest, hard):
    """Such a tree, sometimes with a function in Rust."""
    return tree(seed, largest, hard, External)


# The comparisons, by name.
WHAT = {"trees": tree, "loops": loop, "written": written, "driven": driven, "awkward": awkward, "spoken": spoken}
# Further ones on request.
ASKED = WHAT | {"platforms": platform}


def one(job):
    """Compares the mechanism of a seed; returns the errors, and whether there was anything to compare."""
    asked, what, seed = job
    begin, errors, where = time.time(), Errors(), f"{what} {seed}"
    made = ASKED[what](seed, asked.largest, asked.hard)
    doors = Doors(asked.hamel, os.path.join(asked.folder, f"{what}{seed}"))
    compared = False
    try:
        compared = settled(doors, made.m.text())
        if compared:
            state, comparison = made.state, Comparison(made.m, doors, errors, where)
            comparison.run(state)
            if seed % 4 == 0:
                comparison.run(state, single=True)
    except Refused as why:
        errors.found.append((where, "refused", str(why)))
    print(f"{where}: {made.m.n} velocities, {time.time() - begin:.1f} s", *errors.found, flush=True)
    return errors, compared


def emitted(asked, first, count):
    """Compares several small mechanisms of three kinds as Rust, in one crate; returns the errors."""
    errors, made = Errors(), []
    crate = Crate(asked.hamel, os.path.join(asked.folder, "rust"), asked.root)
    makers = [("spoken", external), ("written", written), ("loops", loop)]
    for seed in range(first, first + count):
        name, maker = makers[seed % 3]
        one, doors = maker(seed, 3, asked.hard), Doors(asked.hamel, os.path.join(asked.folder, f"rust_{name}{seed}"))
        try:
            if settled(doors, one.m.text(), "rust"):
                made.append((f"rust {name} {seed}", one, doors, crate.add(doors, one.m.externals)))
        except Refused as why:
            errors.found.append((f"rust {name} {seed}", "refused", str(why)))
    try:
        if made:
            crate.build()
        for where, one, doors, system in made:
            Comparison(one.m, doors, errors, where).run(one.state, c=system, kind="rust ")
            print(where, flush=True)
    except Refused as why:
        errors.found.append(("rust", "refused", str(why)))
    crate.close()
    print(*errors.found, sep="\n")
    return errors


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("hamel")
    parser.add_argument("folder")
    parser.add_argument("--what", nargs="+", choices=ASKED, default=list(WHAT))
    parser.add_argument("--seeds", nargs=2, type=int, default=(0, 12))
    parser.add_argument("--largest", type=int, default=6)
    parser.add_argument("--hard", action="store_true")
    parser.add_argument("--rust", nargs=2, type=int, default=(0, 0))
    parser.add_argument("--root", default=".")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    asked = parser.parse_args()
    unseen = wrong.unseen(asked.hamel, asked.folder)
    for text in unseen:
        print("not found to be wrong:", text)
    errors, compared = Errors(), 0
    first, count = asked.seeds
    jobs = [(asked, what, seed) for seed in range(first, first + count) for what in asked.what]
    with multiprocessing.Pool(asked.jobs) as pool:
        for found, done in pool.imap(one, jobs, chunksize=1):
            errors.join(found)
            compared += done
    errors.join(emitted(asked, *asked.rust) if asked.rust[1] else Errors())
    for name, (error, where) in sorted(errors.worst.items(), key=lambda e: -e[1][0]):
        print(f"{name:34} {float(error):9.2g}   {where}")
    print(f"{compared} mechanisms of {len(jobs)} compared, {len(errors.found)} differences")
    return 1 if errors.found or unseen or 2 * compared < len(jobs) else 0


if __name__ == "__main__":
    sys.exit(main())
