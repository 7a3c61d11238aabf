#!/usr/bin/env bash
# Measures the processor time of first builds, beside that of an earlier revision of this repository:
#
#     lab/door.sh REVISION
#
# Builds three things from nothing, in both: the first command of README, the Python package by `pip install`, and a crate
# with the program of README, which has one `rigid_eom!`. In the files as they are, the package is also built after the
# command, in the same target folder. Prints processor time, the number of packages compiled and the size of the result, with
# the ratios.
#
# The figures of a revision are kept in `target/door`; the files as they are now are measured anew each time.
# Needs cargo, git and Python. Dependencies are downloaded before anything is measured.
set -euo pipefail
cd "$(dirname "$0")/.."

revision=$(git rev-parse --short=8 "${1:?the revision to compare with}^{commit}")
# Settings of a contributor are not those of a newcomer.
unset "${!CARGO_PROFILE_@}" CARGO_INCREMENTAL CARGO_TARGET_DIR RUSTC_WRAPPER RUSTC_WORKSPACE_WRAPPER RUSTFLAGS
mkdir -p target/door

python3 - "$revision" <<'PYTHON'
import json, pathlib, re, resource, shutil, subprocess, sys

revision = sys.argv[1]
here = pathlib.Path.cwd()
folder = here / "target" / "door"
made = folder / "made"
quiet = dict(check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def measured(words, target, where):
    """Processor seconds of a command, and how many packages cargo compiled."""
    def seconds():
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    begin = seconds()
    done = subprocess.run(
        ["env", f"CARGO_TARGET_DIR={target}", *map(str, words)],
        cwd=where, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))} fails in {where}:\n{done.stdout}")
    return {"seconds": seconds() - begin, "packages": len(re.findall(r"^\s*Compiling ", done.stdout, re.M))}


def door(root, results, keep=lambda: None):
    """Measures what `results` lacks, of the files in a folder."""
    readme = (root / "README.md").read_text()
    shutil.rmtree(made, ignore_errors=True)
    made.mkdir()
    subprocess.run(["cargo", "fetch", "--locked"], cwd=root, **quiet)

    def built(name, words, where, target, product):
        if name in results:
            return
        result = measured(words, made / target, where)
        (file,) = (made / target).glob(product)
        results[name] = result | {"size": file.stat().st_size / 1e6}
        print(f"  {name}: {result['seconds']:.0f} s", file=sys.stderr, flush=True)
        keep()

    crate = made / "top"
    (crate / "src").mkdir(parents=True)
    program = re.search(r"^```rust\n(.*?)^```$", readme, re.M | re.S)[1]
    (crate / "src" / "main.rs").write_text(program)
    (crate / "Cargo.toml").write_text(
        '[package]\nname = "top"\nedition = "2024"\n[workspace]\n[dependencies]\n'
        f'hamel = {{ path = "{root / "runtime"}" }}\n'
    )
    shutil.copy(root / "Cargo.lock", crate)
    subprocess.run(["cargo", "fetch"], cwd=crate, **quiet)
    built("crate with `rigid_eom!`", ["cargo", "build"], crate, "crate", "debug/top")

    first = re.search(r"^cargo run --release -- (.*)$", readme, re.M)[1].split()
    first[-1] = made / first[-1]
    built("first command", ["cargo", "run", "--release", "--locked", "--", *first], root, "command", "release/hamel")

    package = re.search(r"^pip install (\./\S+)$", readme, re.M)[1]
    subprocess.run([sys.executable, "-m", "venv", made / "python"], **quiet)
    pip = [made / "python" / "bin" / "pip", "--disable-pip-version-check"]
    # What builds the package is in pip's cache then.
    subprocess.run([*pip, "wheel", "--wheel-dir", made / "wheels", "maturin>=1.9,<2"], **quiet)
    install = [*pip, "install", "--verbose", "--force-reinstall", "--no-deps", package]
    if root == here:
        built("pip install after the first command", install, root, "command", "release/lib_hamel.so")
    built("pip install", install, root, "package", "release/lib_hamel.so")
    shutil.rmtree(made)
    return results


kept = folder / f"{revision}.json"
before = json.loads(kept.read_text()) if kept.exists() else {}
if len(before) < 3:
    print(f"{revision}:", file=sys.stderr, flush=True)
    tree = folder / revision
    subprocess.run(["git", "worktree", "add", "--force", "--detach", tree, revision], **quiet)
    try:
        door(tree, before, lambda: kept.write_text(json.dumps(before)))
    finally:
        subprocess.run(["git", "worktree", "remove", "--force", tree], **quiet)
print("now:", file=sys.stderr, flush=True)
now = door(here, {})

print(f"\n| processor seconds, packages, MB | {revision} | now | ratio of seconds |")
print("|---|---:|---:|---:|")
for name in now:
    old = before.get(name) or before["pip install"]
    cells = ["{seconds:.0f}, {packages}, {size:.1f}".format(**of) for of in (old, now[name])]
    print(f"| {name} | {' | '.join(cells)} | {now[name]['seconds'] / old['seconds']:.2f} |")
PYTHON
