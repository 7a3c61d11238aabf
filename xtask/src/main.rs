//! Tasks of contributors: `cargo xtask quick`, `ci`, `attack`, `book`, `gallery` and `bless`; `shape`, the size and the
//! layout of the repository; `names FOLDER SEED`, for `docs/names.md`; and `record FOLDER`, `compare BEFORE AFTER`
//! around changes that should change no result.
//!
//! Each task is a list of commands, run in order from the root of the repository until one fails.

mod names;
mod record;
mod shape;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

/// Commands, each preceded by variables of its environment: `NAME=value program arguments …`.
type Task = &'static [&'static str];

/// Takes seconds once everything is built: format, and the tests of the stages.
const QUICK_TASKS: Task = &[
    "cargo fmt --all --check",
    "cargo test --locked -p hamel-codegen-tests --test algebra --test language",
    "cargo test --locked -p hamel-tests --test layers --test wrong",
];

/// All checks that must pass before a change is merged.
const CI_TASKS: Task = &[
    "cargo fmt --all --check",
    "cargo fmt --manifest-path lab/Cargo.toml --all --check",
    // Clippy, as configured by `.ci/rustc`.
    "HAMEL_LINT=1 cargo check --workspace --all-targets --locked",
    // `--all-targets` leaves out the tests that `cargo test --workspace` leaves out.
    "HAMEL_LINT=1 cargo check --workspace --locked --test commands --test complete --test counts --test gallery --test built",
    "HAMEL_LINT=1 cargo check --workspace --locked --bins --profile test",
    // As on docs.rs. With examples requested, features are those of the tests, and nothing is checked again.
    "RUSTDOC=.ci/rustdoc cargo doc --workspace --no-deps --lib --bins --examples --locked",
    // The runtime without std, and generated code in a crate without std.
    "HAMEL_LINT=1 cargo check -p hamel --no-default-features --locked",
    "HAMEL_LINT=1 cargo check -p hamel --no-default-features --features wide --locked",
    "HAMEL_LINT=1 cargo check --manifest-path tests/nostd/Cargo.toml --locked",
    // The command as README builds it: without sweeps.
    "HAMEL_LINT=1 cargo check -p hamel-cli --locked",
    // Licences of all that is depended on, and notices of what is shipped.
    "bash tests/licences/run.sh",
    // The URDF files of the robots in tests/reference/robots.
    "bash tests/robots/install.sh",
    // C compilers other than gcc.
    "bash tests/emitted/install.sh",
    // The README's test command.
    "cargo test --workspace --locked",
    // Tests without mathematics: the book, the gallery, Python's module; and the control examples.
    "cargo test --workspace --locked --bins --test commands --test complete --test counts --test gallery --test built",
    // The size and the layout of the repository.
    "cargo xtask shape",
    // The packages as published; `attack` also builds them.
    "CARGO_TARGET_DIR=target/publish cargo publish --workspace --dry-run --no-verify --allow-dirty --locked",
    // Random mechanisms against their definitions, in numbers of many digits.
    "HAMEL_BUILT=1 bash lab/dalembert/run.sh",
    // Tables of sweeps in the programs that read them.
    "HAMEL_BUILT=1 bash tests/sweep/run.sh",
    // The Python package against Pinocchio and SciPy, its types, examples and notebooks.
    "HAMEL_BUILT=1 bash tests/python/run.sh",
    // The book, by the program that its tests were built with; its links are looked at once it is built.
    "bash docs/book/install.sh",
    "target/debug/hamel-book build",
    "target/tools/bin/mdbook build target/book-pages --dest-dir ../book",
    "target/debug/hamel-book check target/book",
    // The page, built for browsers, in Chromium.
    "HAMEL_BUILT=1 bash tests/page/run.sh",
    // A controller on microcontrollers, in QEMU.
    "HAMEL_BUILT=1 bash lab/cortex/run.sh",
];

/// The random attacks at full size, and the tests of `lab/`: some three hours. CI on GitHub runs it once a week.
const ATTACK_TASKS: Task = &[
    "bash tests/emitted/install.sh",
    "HAMEL_ATTACK=more cargo test --workspace --locked",
    "HAMEL_ATTACK=more cargo test --workspace --locked --bins --test commands --test complete --test counts --test gallery --test built",
    "HAMEL_ATTACK=full cargo test --release --locked -p hamel-codegen-tests -- claims:: expressions:: massless:: mounts:: tilted:: rounding:: constrained:: prescribed:: trees:: work:: observed:: random_scenes::",
    "HAMEL_ATTACK=full cargo test --release --locked -p hamel-tests --test suite -- functions:: mutations::",
    "HAMEL_ATTACK=full cargo test --release --locked -p hamel-native --test suite random::",
    "HAMEL_ATTACK=full cargo test --release --locked -p hamel --test suite -- free_rotation:: stiff::",
    "HAMEL_ATTACK=full cargo test --release --locked -p hamel-files -p hamel-import",
    "bash tests/robots/install.sh",
    "HAMEL_ATTACK=full cargo test --release --locked -p hamel-engine -p hamel-cli --lib --test suite -- states:: emitted:: shaken:: misspelt:: eigenvalues::",
    "HAMEL_ATTACK=full cargo test --locked -p hamel-tests-emitted --test c",
    // Not optimised, and a fifth at a time: compiling is all of the work.
    "HAMEL_ATTACK=full HAMEL_PART=0 cargo test --locked -p hamel-tests-emitted",
    "HAMEL_ATTACK=full HAMEL_PART=1 cargo test --locked -p hamel-tests-emitted compiled",
    "HAMEL_ATTACK=full HAMEL_PART=2 cargo test --locked -p hamel-tests-emitted compiled",
    "HAMEL_ATTACK=full HAMEL_PART=3 cargo test --locked -p hamel-tests-emitted compiled",
    "HAMEL_ATTACK=full HAMEL_PART=4 cargo test --locked -p hamel-tests-emitted compiled",
    "bash tests/robots/pinocchio.sh",
    // Generated systems in the stiff solvers of another crate, thousands of statements, the table of the report.
    "cargo test --manifest-path lab/Cargo.toml --locked -p hamel-diffsol -p hamel-tests-big",
    "cargo test --manifest-path lab/Cargo.toml --locked -p hamel-bench --test book",
    // Wrong signs in the generator itself.
    "cargo test --manifest-path lab/Cargo.toml --locked -p hamel-mutants",
    // Steps of real robots with their slopes, against Pinocchio's.
    "bash lab/robots/run.sh",
    // Tasks of schedulers of which one is killed.
    "bash tests/sweep/hyperqueue.sh",
    "bash tests/sweep/slurm.sh",
    "bash lab/dalembert/run.sh --what trees --seeds 1000 60 --largest 6",
    "bash lab/dalembert/run.sh --what loops written driven --seeds 1000 60 --largest 5",
    "bash lab/dalembert/run.sh --seeds 2000 40 --largest 5 --hard",
    "bash lab/dalembert/run.sh --what platforms --seeds 0 9",
    // Emitted modules in JAX.
    "bash tests/python/run.sh jax",
    // As a user installs it.
    "bash tests/python/wheel.sh",
    "CARGO_TARGET_DIR=target/publish cargo publish --workspace --dry-run --allow-dirty --locked",
];

/// The book, by mdBook, into `target/book`; every link in it leads somewhere, and nothing comes from the network.
const BOOK_TASKS: Task = &[
    "bash docs/book/install.sh",
    "cargo run --locked -p hamel-book -- build",
    "target/tools/bin/mdbook build target/book-pages --dest-dir ../book",
    "cargo run --locked -p hamel-book -- check target/book",
];

/// The page of the gallery with its pictures, into `target/gallery`.
const GALLERY_TASKS: Task = &["cargo run --locked -p hamel-book -- gallery"];

/// Takes the snapshots as they are now; `git diff` shows what to review.
const BLESS_TASKS: Task = &[
    "INSTA_UPDATE=always INSTA_FORCE_PASS=1 cargo test --workspace --locked --no-fail-fast",
    // Snapshots inside of sources are not renewed by that: what differs there is edited by hand.
    "cargo test --workspace --locked --no-fail-fast",
    "git --no-pager diff --stat -- *.snap tests/wrong",
];

const TASKS: [(&str, Task, &str); 6] = [
    (
        "quick",
        QUICK_TASKS,
        "format, tests of the algebra and the language, and the shape of the repository: seconds once built",
    ),
    (
        "ci",
        CI_TASKS,
        "everything that has to hold before a change lands",
    ),
    (
        "attack",
        ATTACK_TASKS,
        "the random attacks at full size, the tests of lab, and all robots against Pinocchio: some three hours",
    ),
    ("book", BOOK_TASKS, "the book, into target/book"),
    (
        "gallery",
        GALLERY_TASKS,
        "the mechanisms of examples/gallery with their pictures, into target/gallery",
    ),
    ("bless", BLESS_TASKS, "takes the snapshots as they are now"),
];

fn main() -> ExitCode {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let asked: Vec<&str> = asked.iter().map(String::as_str).collect();
    match asked[..] {
        ["names", package, seed] => {
            let Ok(seed) = seed.parse() else {
                eprintln!("the seed `{seed}` is not a whole number");
                return ExitCode::from(2);
            };
            return ended(names::print(package, seed));
        }
        ["shape"] => return ended(shape::print()),
        ["record", folder] => return ended(record::record(Path::new(folder)).map(|()| true)),
        ["compare", before, after] => {
            return ended(record::compare(Path::new(before), Path::new(after)));
        }
        _ => {}
    }
    let found = TASKS.iter().find(|(name, ..)| asked == [*name]);
    let Some((name, commands, _)) = found else {
        eprintln!("cargo xtask TASK, where TASK is one of");
        for (name, _, what) in TASKS {
            eprintln!("  {name:7} {what}");
        }
        eprintln!("  shape: size and layout of the repository beside their bounds");
        eprintln!(
            "  names FOLDER SEED: ten public items of the crate in a folder, as docs/names.md says"
        );
        eprintln!("  record FOLDER: what `hamel` says of every description, into FOLDER");
        eprintln!("  compare BEFORE AFTER: where two records differ");
        return ExitCode::from(2);
    };
    for command in *commands {
        println!("\n== {command}");
        let begin = Instant::now();
        let wrapper =
            (*name == "ci").then(|| ("RUSTC_WORKSPACE_WRAPPER", root().join(".ci/rustc")));
        if !run(command, wrapper) {
            eprintln!("\nfailed: {command}");
            return ExitCode::FAILURE;
        }
        println!("== {:.0} s", begin.elapsed().as_secs_f64());
    }
    ExitCode::SUCCESS
}

/// The exit status of a task that is no list of commands.
fn ended(result: std::io::Result<bool>) -> ExitCode {
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// The root of the repository.
fn root() -> PathBuf {
    let mut folder = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    folder.pop();
    folder
}

/// Runs a command; no argument of these has a space in it.
fn run(command: &str, wrapper: Option<(&str, PathBuf)>) -> bool {
    let words: Vec<&str> = command.split_whitespace().collect();
    let variables = words.iter().take_while(|word| is_variable(word)).count();
    let (variables, words) = words.split_at(variables);
    let Some((program, arguments)) = words.split_first() else {
        return false;
    };
    let variables = variables.iter().filter_map(|word| word.split_once('='));
    let status = Command::new(program)
        .args(arguments)
        .envs(wrapper)
        .envs(variables)
        .current_dir(root())
        .status();
    status.is_ok_and(|status| status.success())
}

fn is_variable(word: &str) -> bool {
    let name = word.split_once('=').map_or("", |(name, _)| name);
    !name.is_empty()
        && name
            .bytes()
            .all(|byte| byte.is_ascii_uppercase() || byte == b'_')
}
