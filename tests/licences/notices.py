"""Notices of the crates in the Python package: `bindings/python/THIRD-PARTY.txt`, which the wheel contains.

Written by `python3 tests/licences/notices.py`; `--check` tells whether it is up to date. Crates with the same text
share it, in the order of their names. Only crates that become part of the extension module count, neither build
tools nor tests. For a crate without a licence file, the text in this repository is used."""

import json
import pathlib
import subprocess
import sys

TARGET = pathlib.Path("bindings/python/THIRD-PARTY.txt")
NAMES = ("licen", "copying", "notice", "unlicense")
HEAD = """The Python package of hamel contains code of the following crates, under the licences below. A crate that may be used under
the MIT licence or another one is used under the MIT licence.
"""
# Platforms with wheels: dependencies of each are listed for all.
PLATFORMS = (
    "x86_64-unknown-linux-gnu",
    "aarch64-unknown-linux-gnu",
    "x86_64-apple-darwin",
    "aarch64-apple-darwin",
    "x86_64-pc-windows-msvc",
)


def shipped() -> list[dict]:
    """Packages in the module, for all platforms."""
    found: dict[str, dict] = {}
    for platform in PLATFORMS:
        command = ["cargo", "metadata", "--format-version", "1", "--locked", "--filter-platform", platform]
        command += ["--manifest-path", "bindings/python/Cargo.toml"]
        metadata = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        packages = {package["id"]: package for package in metadata["packages"]}
        nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
        macros = {id for id, package in packages.items() if any("proc-macro" in t["kind"] for t in package["targets"])}
        open_, seen = [metadata["resolve"]["root"]], set()
        while open_:
            id = open_.pop()
            if id in seen or id in macros:
                continue
            seen.add(id)
            for dependency in nodes[id]["deps"]:
                if any(kind["kind"] is None for kind in dependency["dep_kinds"]):
                    open_.append(dependency["pkg"])
        found |= {id: packages[id] for id in seen if packages[id]["source"] is not None}
    return sorted(found.values(), key=lambda package: (package["name"], package["version"]))


def texts(package: dict) -> list[str]:
    """Licences and notices in a crate; of several to choose from, that of MIT if it is a separate file."""
    folder = pathlib.Path(package["manifest_path"]).parent
    files = sorted(path for path in folder.iterdir() if path.is_file() and path.name.lower().startswith(NAMES))
    if "MIT" in package["license"].replace("/", " OR ").split(" OR "):
        files = [path for path in files if "mit" in path.name.lower()] or files
    if not files:
        own = {"MIT": "LICENSE-MIT", "Apache-2.0": "LICENSE-APACHE"}
        files = [pathlib.Path(file) for name, file in own.items() if name in package["license"]]
        assert files, f"{package['name']} has no text of {package['license']}"
    lines = (path.read_text(encoding="utf-8", errors="replace").splitlines() for path in files)
    return ["\n".join(line.rstrip() for line in text).strip() for text in lines]


def notices() -> str:
    """The contents of the file."""
    shared: dict[str, list[str]] = {}
    for package in shipped():
        name = f"{package['name']} {package['version']} ({package['license']})"
        for text in texts(package):
            owners = shared.setdefault(text, [])
            if name not in owners:
                owners.append(name)
    rule = "\n" + 79 * "-" + "\n"
    parts = (rule + "\n".join(owners) + "\n\n" + text + "\n" for text, owners in shared.items())
    return HEAD + "".join(parts)


def main() -> int:
    text = notices()
    if sys.argv[1:] != ["--check"]:
        TARGET.write_text(text, encoding="utf-8")
        return 0
    if TARGET.read_text(encoding="utf-8") != text:
        print(f"{TARGET} is not that of the lock file: run `python3 tests/licences/notices.py`", file=sys.stderr)
        return 1
    print(f"{TARGET}: up to date")
    return 0


sys.exit(main())
