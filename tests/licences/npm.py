"""Licences of npm packages: compares every lock file of the repository with the permissive licences of `deny.toml`.

Everything that a page ships must be permissive. Tools that are only used for development may be listed in TOOLS,
each with its licence and the reason."""

import json
import re
import subprocess
import sys
import tomllib

TOOLS: dict[str, tuple[str, str]] = {
    "argparse": ("Python-2.0", "permissive; of the program that cuts fonts to the signs that are needed, while the page is built"),
}


def permitted(expression: str, allowed: set[str]) -> bool:
    """Whether an SPDX expression can be satisfied with the allowed licences only."""
    words = re.findall(r"\(|\)|[^\s()]+(?: WITH [^\s()]+)?", expression)

    def either() -> bool:
        holds = both()
        while words and words[0] == "OR":
            words.pop(0)
            holds |= both()
        return holds

    def both() -> bool:
        holds = one()
        while words and words[0] == "AND":
            words.pop(0)
            holds &= one()
        return holds

    def one() -> bool:
        word = words.pop(0) if words else ""
        if word != "(":
            return word in allowed
        holds = either()
        return bool(words) and words.pop(0) == ")" and holds

    return either() and not words


def main() -> int:
    with open("tests/licences/deny.toml", "rb") as file:
        allowed = set(tomllib.load(file)["licenses"]["allow"])
    assert permitted("(MIT OR GPL-3.0)", allowed) and permitted("MIT AND Zlib", allowed)
    assert not permitted("MIT AND GPL-3.0", allowed) and not permitted("", allowed)
    listed = subprocess.run(["git", "ls-files", "*package-lock.json"], check=True, capture_output=True, text=True)
    wrong = []
    for lock in listed.stdout.split():
        with open(lock, encoding="utf-8") as file:
            packages = json.load(file)["packages"]
        for place, package in packages.items():
            name = place.rpartition("node_modules/")[2]
            # The page, and folders of this repository that it links to.
            if "node_modules/" not in place or package.get("link"):
                continue
            licence = package.get("license", "")
            known = TOOLS.get(name) if package.get("dev") else None
            if not permitted(licence, allowed) and (known is None or known[0] != licence):
                wrong.append(f"{lock}: {name} {package.get('version')}: {licence or 'no licence'}")
        print(f"{lock}: {len(packages)} packages")
    for line in wrong:
        print(line, file=sys.stderr)
    return 1 if wrong else 0


sys.exit(main())
