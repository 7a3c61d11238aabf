//! Wrong signs in the generator, `cases/*.txt`: `hamel check` detects each of them and names an identity that it
//! breaks.
//!
//! A mutant has a title, the `file` to change, a `model` to check, the identity that it `breaks`, and lines of code
//! before (`-`) and after (`+`), compared without indentation. The sources are copied to a workspace below `target`,
//! which keeps its build between runs; every mutant is built there, with the program `check.rs`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folders of the generator.
const FOLDERS: [&str; 1] = ["codegen"];
/// The crates in them.
const CRATES: [&str; 10] = [
    "codegen",
    "codegen/algebra",
    "codegen/language",
    "codegen/import",
    "codegen/program",
    "codegen/dynamics",
    "codegen/verify",
    "codegen/emit",
    "codegen/tables",
    "codegen/files",
];
/// Path of the checking program in the copy, where Cargo finds it without an entry in a manifest.
const CHECK: &str = "codegen/src/bin/check.rs";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

struct Mutant {
    name: String,
    file: String,
    model: String,
    breaks: String,
    old: Vec<String>,
    new: Vec<String>,
}

impl Mutant {
    fn parse(path: &Path) -> Self {
        let text = read(path);
        let field = |name: &str| {
            let line = text.lines().find_map(|line| line.strip_prefix(name));
            let line = line.unwrap_or_else(|| panic!("{}: no `{name}`", path.display()));
            line.trim().to_string()
        };
        let side = |sign: &str| -> Vec<String> {
            let lines = text.lines().filter_map(|line| line.strip_prefix(sign));
            lines.map(|line| line.trim().to_string()).collect()
        };
        Mutant {
            name: path.file_stem().expect("a name").display().to_string(),
            file: field("file "),
            model: field("model "),
            breaks: field("breaks "),
            old: side("- "),
            new: side("+ "),
        }
    }

    /// Applies the mutation to the source, in which the old lines must occur exactly once.
    fn applied(&self, source: &str) -> String {
        assert!(
            !self.old.is_empty() && self.old != self.new,
            "{}",
            self.name
        );
        let lines: Vec<&str> = source.lines().collect();
        let matches = |start: &usize| {
            let window = lines[*start..].iter().zip(&self.old);
            window.clone().count() == self.old.len() && window.clone().all(|(a, b)| a.trim() == b)
        };
        let places: Vec<usize> = (0..lines.len()).filter(matches).collect();
        let [place] = places.as_slice() else {
            panic!(
                "{}: the old lines stand at {} places of {}, not at one",
                self.name,
                places.len(),
                self.file
            );
        };
        let mut mutated: Vec<&str> = lines[..*place].to_vec();
        mutated.extend(self.new.iter().map(String::as_str));
        mutated.extend(&lines[place + self.old.len()..]);
        mutated.join("\n") + "\n"
    }
}

/// A copy of the workspace that contains only the generator.
struct Copy {
    folder: PathBuf,
}

impl Copy {
    fn new() -> Self {
        let copy = Copy {
            folder: Path::new(env!("CARGO_TARGET_TMPDIR")).join("mutants"),
        };
        let members: Vec<String> = CRATES.iter().map(|name| format!("{name:?}")).collect();
        let manifest: String = read(&root().join("Cargo.toml"))
            .lines()
            .filter(|line| !line.starts_with("default-members"))
            .map(|line| match line.starts_with("members") {
                true => format!("members = [{}]\n", members.join(", ")),
                false => format!("{line}\n"),
            })
            .collect();
        copy.write("Cargo.toml", &manifest);
        copy.write("Cargo.lock", &read(&root().join("Cargo.lock")));
        for name in FOLDERS {
            copy.copy(Path::new(name));
        }
        let check = Path::new(env!("CARGO_MANIFEST_DIR")).join("check.rs");
        copy.write(CHECK, &read(&check));
        copy
    }

    fn copy(&self, path: &Path) {
        let from = root().join(path);
        if from.is_dir() {
            self.forget(path);
            for entry in fs::read_dir(from).expect("a folder") {
                self.copy(&path.join(entry.expect("an entry").file_name()));
            }
        } else {
            self.write(path, &read(&from));
        }
    }

    /// Removes copied files that no longer exist in the workspace.
    fn forget(&self, path: &Path) {
        let Ok(known) = fs::read_dir(self.folder.join(path)) else {
            return;
        };
        for entry in known {
            let entry = entry.expect("an entry");
            let source = root().join(path).join(entry.file_name());
            let copied = entry.path();
            if source.is_dir() != copied.is_dir() || !source.exists() {
                let removed = match copied.is_dir() {
                    true => fs::remove_dir_all(&copied),
                    false => fs::remove_file(&copied),
                };
                removed.unwrap_or_else(|error| panic!("{}: {error}", copied.display()));
            }
        }
    }

    /// Writes a file only if it has changed, to avoid rebuilding.
    fn write(&self, path: impl AsRef<Path>, text: &str) {
        let path = self.folder.join(path);
        if fs::read_to_string(&path).is_ok_and(|known| known == text) {
            return;
        }
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(&path, text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }

    /// Builds the program without optimisation, and checks a model with it. Incremental compilation pays, since mutants
    /// differ by a line.
    fn check(&self, model: &str) -> Output {
        let target = self.folder.join("target");
        let built = Command::new(env!("CARGO"))
            .args([
                "build",
                "--offline",
                "--quiet",
                "--package",
                "hamel-codegen",
            ])
            .args(["--bin", "check", "--config", "profile.dev.debug=false"])
            .current_dir(&self.folder)
            .env("CARGO_TARGET_DIR", &target)
            .env("CARGO_INCREMENTAL", "1")
            .env_remove("RUSTFLAGS")
            .output()
            .expect("cargo runs");
        let errors = String::from_utf8_lossy(&built.stderr);
        assert!(built.status.success(), "{errors}");
        let binary = format!("check{}", std::env::consts::EXE_SUFFIX);
        Command::new(target.join("debug").join(binary))
            .arg(root().join(format!("tests/models/{model}.eom")))
            .output()
            .expect("the binary runs")
    }
}

fn mutants() -> Vec<Mutant> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let entries = fs::read_dir(folder).expect("mutants");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    assert!(paths.len() >= 7, "the mutants have gone");
    paths.iter().map(|path| Mutant::parse(path)).collect()
}

#[test]
fn every_mutant_is_caught() {
    let mutants = mutants();
    // Finds mutants that cannot be applied before building anything.
    for mutant in &mutants {
        mutant.applied(&read(&root().join(&mutant.file)));
    }
    let copy = Copy::new();
    for mutant in &mutants {
        let sound = copy.check(&mutant.model);
        assert_eq!(sound.status.code(), Some(0), "{} as it is", mutant.model);
    }
    for mutant in &mutants {
        let source = read(&root().join(&mutant.file));
        copy.write(&mutant.file, &mutant.applied(&source));
        let output = copy.check(&mutant.model);
        copy.write(&mutant.file, &source);
        let said = [output.stdout, output.stderr].concat();
        let said = String::from_utf8_lossy(&said);
        // The output lists the identities that hold as well.
        let broken: Vec<&str> = said
            .lines()
            .filter(|line| line.contains("FAILED") || line.contains("does not hold"))
            .collect();
        println!("{}: {}", mutant.name, broken.join("; "));
        assert_eq!(output.status.code(), Some(1), "{}: {said}", mutant.name);
        assert!(
            broken.iter().any(|line| line.contains(&mutant.breaks)),
            "{} does not name {}: {said}",
            mutant.name,
            mutant.breaks
        );
    }
}
