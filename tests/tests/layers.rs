//! Dependencies between crates and modules point in one direction; forbidden ones are searched for in the sources.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Returns all Rust sources below a folder, except for unit tests in separate files or folders.
fn sources(folder: &str) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    let mut open = vec![root().join(folder)];
    while let Some(path) = open.pop() {
        if path.file_stem().is_some_and(|name| name == "tests") || path.ends_with("target") {
            continue;
        } else if path.is_dir() {
            let entries = fs::read_dir(&path).expect("a folder");
            open.extend(entries.map(|entry| entry.expect("an entry").path()));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).expect("readable");
            found.push((path, text));
        }
    }
    assert!(!found.is_empty(), "{folder} has no sources");
    found
}

fn forbid(folder: &str, words: &[&str]) {
    for (path, text) in sources(folder) {
        for word in words {
            let line = text
                .lines()
                .position(|line| !line.trim_start().starts_with("//") && line.contains(word));
            assert!(
                line.is_none(),
                "{}:{}: {folder} must not know `{word}`",
                path.display(),
                line.unwrap_or(0) + 1
            );
        }
    }
}

/// The crates that each crate of the repository may depend on.
const LAYERS: [(&str, &[&str]); 14] = [
    ("codegen/algebra", &[]),
    ("codegen/import", &["language"]),
    ("codegen/files", &[]),
    ("runtime", &["macros"]),
    ("codegen/language", &["algebra"]),
    ("codegen/program", &["algebra", "language"]),
    ("codegen/dynamics", &["algebra", "language", "program"]),
    (
        "codegen/verify",
        &["algebra", "language", "program", "dynamics"],
    ),
    // Emission and derivation are independent.
    ("codegen/emit", &["algebra", "language", "program"]),
    (
        "codegen/tables",
        &["algebra", "language", "program", "dynamics"],
    ),
    ("macros", &["codegen"]),
    ("engine/native", &["", "codegen"]),
    // What runs a mechanism prints nothing.
    ("engine", &["", "codegen", "files", "native"]),
    ("cli/report", &["", "files"]),
];

/// Returns the dependencies of the library on other layers, without those of its tests.
fn layers_below(manifest: &str) -> Vec<&str> {
    let (_, dependencies) = manifest
        .split_once("\n[dependencies]\n")
        .unwrap_or_default();
    let dependencies = dependencies.split("\n[").next().unwrap_or_default();
    let names = dependencies
        .lines()
        .filter_map(|line| line.strip_prefix("hamel"));
    names
        .map(|rest| {
            rest.trim_start_matches('-')
                .split(['.', ' '])
                .next()
                .unwrap_or_default()
        })
        .collect()
}

#[test]
fn dependencies_point_one_way() {
    for (folder, allowed) in LAYERS {
        let manifest = fs::read_to_string(root().join(folder).join("Cargo.toml"));
        for below in layers_below(&manifest.expect("a manifest")) {
            assert!(
                allowed.contains(&below),
                "{folder} must not depend on hamel-{below}"
            );
        }
    }
}

#[test]
fn dependencies_are_found() {
    let manifest = "[package]\n\n[dependencies]\nhamel.workspace = true\nhamel-algebra = { path = \"a\" }\nsyn = \"3\"\n\n[dev-dependencies]\nhamel-codegen = \"1\"\n";
    assert_eq!(layers_below(manifest), ["", "algebra"]);
}

#[test]
fn programs_read_no_text() {
    forbid(
        "codegen/program/src",
        &["hamel_language::lower", "hamel_language::syntax"],
    );
}

#[test]
fn derivation_reads_and_prints_nothing() {
    forbid(
        "codegen/dynamics/src",
        &["hamel_language::lower", "println!"],
    );
}

#[test]
fn emission_does_no_algebra() {
    forbid(
        "codegen/emit/src",
        &[
            "hamel_algebra::poly",
            "hamel_algebra::derivation",
            "hamel_algebra::linear",
            ".rational(",
            ".apply(",
        ],
    );
}

/// The macro does not bring an XML parser into its users' builds.
#[test]
fn the_macro_reads_no_robots() {
    let manifest = fs::read_to_string(root().join("macros/Cargo.toml")).expect("a manifest");
    assert!(!manifest.contains("urdf") && !manifest.contains("import"));
}

#[test]
fn syntax_resolves_nothing() {
    forbid(
        "codegen/language/src/syntax",
        &[
            "crate::symbols",
            "crate::shapes",
            "crate::lower",
            "crate::model",
            "crate::algebra",
        ],
    );
}

#[test]
fn components_are_written_out_before_anything_is_resolved() {
    forbid(
        "codegen/language/src/reuse",
        &["crate::lower", "crate::model", "crate::algebra"],
    );
}

#[test]
fn names_are_resolved_without_a_graph() {
    forbid(
        "codegen/language/src/symbols",
        &["crate::lower", "crate::model", "algebra::graph"],
    );
}

#[test]
fn shapes_are_inferred_without_a_graph() {
    forbid(
        "codegen/language/src/shapes",
        &["crate::lower", "crate::model", "algebra::graph"],
    );
    // Earlier stages do not use shapes; later ones read a model, whose values have shapes.
    for (path, text) in sources("codegen/language/src") {
        let user = ["shapes", "dimensions", "lower"].iter().any(|folder| {
            let folder = root().join("codegen/language/src").join(folder);
            path.starts_with(folder)
        });
        let uses =
            code_of(&text).any(|line| line.contains("crate::shapes") || line.contains("{shapes,"));
        assert!(user || !uses, "{} must not know shapes", path.display());
    }
}

#[test]
fn dimensions_are_inferred_without_a_graph() {
    forbid(
        "codegen/language/src/dimensions",
        &["crate::lower", "crate::model", "crate::algebra"],
    );
    forbid(
        "codegen/language/src/units",
        &[
            "crate::lower",
            "crate::model",
            "crate::algebra",
            "crate::symbols",
        ],
    );
}

#[test]
fn the_model_knows_no_text() {
    forbid(
        "codegen/language/src/model",
        &["crate::lower", "parse_text"],
    );
}

/// Crates that are compiled into other people's builds contain no machine code generator.
#[test]
fn machine_code_is_for_the_command_line() {
    for folder in [
        "codegen",
        "codegen/algebra",
        "codegen/language",
        "codegen/import",
        "codegen/program",
        "codegen/dynamics",
        "codegen/verify",
        "codegen/emit",
        "codegen/tables",
        "macros",
        "runtime",
    ] {
        let manifest =
            fs::read_to_string(root().join(folder).join("Cargo.toml")).expect("a manifest");
        let word = ["cranelift", "hamel-native"]
            .into_iter()
            .find(|word| manifest.contains(word));
        assert_eq!(word, None, "{folder}");
    }
}

/// Returns the lines of a source that are not comments.
fn code_of(text: &str) -> impl Iterator<Item = &str> {
    let lines = text.lines();
    lines.filter(|line| !line.trim_start().starts_with("//"))
}

/// Only one module contains `unsafe` code.
#[test]
fn nothing_else_is_unsafe() {
    for folder in [
        "engine/src",
        "engine/native/src",
        "cli/src",
        "cli/report/src",
        "codegen/files/src",
        "bindings/page/wasm/src",
    ] {
        for (path, text) in sources(folder) {
            let found = code_of(&text)
                .filter(|line| line.contains("unsafe"))
                .count();
            assert!(
                found == 0
                    || path.ends_with("native/src/code.rs")
                    // Except for attributes that export names.
                    || path.ends_with("bindings/page/wasm/src/exports.rs")
                        && code_of(&text).all(|line| {
                            !line.contains("unsafe")
                                || line == "#[unsafe(no_mangle)]"
                                || line == "#![allow(unsafe_code)]"
                        }),
                "{}",
                path.display()
            );
        }
    }
}

#[test]
fn every_file_says_what_it_is() {
    for folder in [
        "codegen", "macros", "engine", "runtime", "cli", "bindings", "lab",
    ] {
        let described = |text: &str| text.starts_with("//!") || text.starts_with("#![");
        for (path, text) in sources(folder) {
            let is_source = path.components().any(|part| part.as_os_str() == "src");
            assert!(!is_source || described(&text), "{}", path.display());
        }
    }
}

/// Returns whether a word in backticks is a path of the repository.
fn is_path(word: &str) -> bool {
    word.contains('/') && !word.contains(' ') && !word.contains("::") && !word.contains('*')
}

/// All folders and files named in ARCHITECTURE.md, the pages it refers to and the walk through the code exist.
#[test]
fn the_architecture_page_is_true() {
    for (name, least) in [
        ("ARCHITECTURE.md", 60),
        ("docs/where-to-look.md", 200),
        ("docs/decisions.md", 5),
        ("docs/book/src/inside.md", 15),
        ("docs/CONTRIBUTING.md", 20),
        ("docs/walks.md", 20),
    ] {
        let page = fs::read_to_string(root().join(name)).expect("a page");
        let paths: Vec<&str> = page.split('`').skip(1).step_by(2).collect();
        let paths: Vec<&str> = paths.into_iter().filter(|word| is_path(word)).collect();
        for path in &paths {
            assert!(
                root().join(path).exists(),
                "{name} names `{path}`, which does not exist"
            );
        }
        assert!(paths.len() > least, "{name} has lost its paths");
    }
}

/// A newcomer can read ARCHITECTURE.md in ten minutes.
#[test]
fn the_architecture_page_is_short() {
    let page = fs::read_to_string(root().join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    let words = page.split_whitespace().count();
    assert!(
        words <= 2000,
        "{words} words: single files belong in docs/where-to-look.md, reasons in docs/decisions.md"
    );
}

/// Returns the names in the tables of dependencies of a manifest, without those of build scripts, which may be there
/// for their features.
fn dependencies(manifest: &str) -> Vec<String> {
    let (mut names, mut inside) = (Vec::new(), false);
    for line in manifest.lines() {
        if line.starts_with('[') {
            inside = line.ends_with("dependencies]") && !line.contains("build-");
        } else if let (true, Some((name, _))) = (inside, line.split_once('='))
            && !line.starts_with([' ', '#'])
            && !line.ends_with("# features alone")
        {
            names.push(name.trim().trim_end_matches(".workspace").replace('-', "_"));
        }
    }
    names
}

#[test]
fn every_dependency_is_used() {
    let workspace = fs::read_to_string(root().join("Cargo.toml")).expect("a manifest");
    let members = workspace.lines().find(|line| line.starts_with("members"));
    let members = members.expect("members").split('"').skip(1).step_by(2);
    let mut unused = Vec::new();
    for member in members {
        let manifest = root().join(member).join("Cargo.toml");
        let manifest = fs::read_to_string(manifest).expect("a manifest");
        let mut text = String::new();
        let mut open = vec![root().join(member)];
        while let Some(path) = open.pop() {
            // Nested packages have separate dependencies.
            let other = path.join("Cargo.toml").exists() && path != root().join(member);
            if path.is_dir() && !other && !path.ends_with("target") {
                let entries = fs::read_dir(&path).expect("a folder");
                open.extend(entries.map(|entry| entry.expect("an entry").path()));
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let source = fs::read_to_string(&path).expect("readable");
                // Pages included as documentation contain programs.
                for rest in source.split("#[doc = include_str!(\"").skip(1) {
                    let page = rest.split('"').next().unwrap_or_default();
                    let page = path.parent().expect("a folder").join(page);
                    text += &fs::read_to_string(page).expect("a page");
                }
                // Sources included from the crate's library need its dependencies.
                for rest in source.split("#[path = \"").skip(1) {
                    let file = rest.split('"').next().unwrap_or_default();
                    if file.contains("../src/") {
                        let file = path.parent().expect("a folder").join(file);
                        text += &fs::read_to_string(file).expect("a source");
                    }
                }
                text += &source;
            }
        }
        let words: HashSet<&str> = text
            .split(|letter: char| !letter.is_alphanumeric() && letter != '_')
            .collect();
        // Packages that include sources of another package are not checked.
        let foreign = |line: &str| line.contains("#[path = \"../") && !line.contains("../src/");
        let names = match text.lines().any(foreign) {
            true => Vec::new(),
            false => dependencies(&manifest),
        };
        let idle = names.iter().filter(|name| !words.contains(name.as_str()));
        unused.extend(idle.map(|name| format!("{member}: {name}")));
    }
    assert!(
        unused.is_empty(),
        "dependencies that nothing uses: {unused:?}"
    );
}

/// Returns the lines of `cargo tree`.
fn tree(arguments: &[&str]) -> Vec<String> {
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(root());
    command.args(["tree", "--locked", "--offline", "--prefix", "none"]);
    let output = command.args(arguments).output().expect("cargo runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines()
        .map(|line| line.trim_end_matches(" (*)").to_string())
        .collect()
}

/// The generator runs in tests, build scripts and macros. It is built once for all of them if its dependencies have the
/// same features everywhere: `tests/Cargo.toml` adds the features that other crates request.
#[test]
fn the_generator_is_built_once() {
    let needed = tree(&["-p", "hamel-codegen", "-e", "normal"]);
    let mut twice = tree(&["--workspace", "--duplicates", "--depth", "0"]);
    twice.sort();
    let pairs = twice.windows(2).filter(|pair| pair[0] == pair[1]);
    let mut twice: Vec<&String> = pairs.map(|pair| &pair[0]).collect();
    twice.retain(|package| needed.contains(package));
    assert!(
        twice.is_empty(),
        "built with several sets of features: {twice:?}"
    );
    // Build scripts request the features that the tests of a crate of ours enable.
    let features = |package: &str, edges: &str| {
        let all = tree(&["-p", package, "-e", edges, "-f", "{p}|{f}"]);
        all.into_iter()
            .filter_map(|line| {
                let (name, features) = line.split_once('|')?;
                let name = name.split(' ').next()?.to_string();
                let features = features.split(',').map(String::from);
                Some((name, features.collect::<HashSet<String>>()))
            })
            .filter(|(name, _)| name.starts_with("hamel-"))
    };
    let mut checked = 0;
    for (package, of_scripts) in features("hamel-tests", "build,normal") {
        if !needed
            .iter()
            .any(|line| line.split(' ').next() == Some(&*package))
        {
            continue;
        }
        for (_, own) in features(&package, "normal").filter(|(name, _)| *name == package) {
            let missing: Vec<&String> = own.difference(&of_scripts).collect();
            assert!(missing.is_empty(), "{package} is built twice: {missing:?}");
            checked += 1;
        }
    }
    assert!(checked >= 5, "{checked}");
}

/// Libraries without unit tests are not compiled for them, and `cargo xtask ci` names the tests that
/// `cargo test --workspace` leaves out.
#[test]
fn no_test_is_left_out() {
    let workspace = fs::read_to_string(root().join("Cargo.toml")).expect("a manifest");
    let stages = fs::read_to_string(root().join("xtask/src/main.rs")).expect("the tasks");
    let members = workspace.lines().find(|line| line.starts_with("members"));
    let (mut without, mut later) = (0, 0);
    for folder in members.expect("members").split('"').skip(1).step_by(2) {
        let manifest = fs::read_to_string(root().join(folder).join("Cargo.toml"));
        let manifest = manifest.expect("a manifest");
        for section in manifest.split("\n[").skip(1) {
            let says = |what: &str| section.lines().any(|line| line == what);
            let untested = section.starts_with("lib]") && says("test = false");
            without += usize::from(untested);
            // A package for a test suite has no library.
            let has_sources = root().join(folder).join("src").exists();
            let all = has_sources.then(|| sources(&format!("{folder}/src")));
            // Programs have separate tests.
            let mut all = all.unwrap_or_default();
            all.retain(|(path, _)| {
                !path
                    .parent()
                    .is_some_and(|folder| folder.ends_with("src/bin"))
            });
            for (path, text) in all {
                let mut lines = text.lines().map(str::trim_start);
                let found = lines
                    .find(|line| line.starts_with("#[test]") || line.starts_with("#[cfg(test)]"));
                assert!(
                    !untested || found.is_none(),
                    "{}: {found:?}",
                    path.display()
                );
                // Doc tests, which begin with a fence without a language.
                let fences = text
                    .lines()
                    .filter(|line| line.contains("//") && line.contains(" ```"));
                let program = fences.step_by(2).find(|fence| fence.ends_with("```"));
                let untried = program.filter(|_| says("doctest = false"));
                assert!(untried.is_none(), "{}: {untried:?}", path.display());
            }
            let is_test = section.starts_with("[test]]");
            if (is_test || section.starts_with("[bin]]")) && says("test = false") {
                let name = section.split('"').nth(1).expect("a name");
                let stages = stages.lines().filter(|line| {
                    let mut words = line.split([' ', '"']);
                    words.any(|word| word.starts_with("HAMEL_"))
                        && if is_test {
                            words.any(|word| word == "--test") && words.any(|word| word == name)
                        } else {
                            words.any(|word| word == "--bins")
                        }
                });
                // Once for the lints, once for the run.
                assert_eq!(stages.count(), 2, "{folder}: {name}");
                later += 1;
            }
        }
    }
    assert_eq!((without, later), (9, 14));
}

/// Snapshots stay below 16,000 lines, so that people can review them.
#[test]
fn snapshots_can_be_read() {
    let (mut lines, mut files) = (0, 0);
    let mut open = vec![root()];
    while let Some(path) = open.pop() {
        if path.is_dir() && !path.ends_with("target") && !path.ends_with(".git") {
            let entries = fs::read_dir(&path).expect("a folder");
            open.extend(entries.map(|entry| entry.expect("an entry").path()));
        } else if path
            .extension()
            .is_some_and(|extension| extension == "snap")
        {
            lines += fs::read_to_string(&path).expect("readable").lines().count();
            files += 1;
        }
    }
    assert!(files > 100, "the snapshots have gone");
    assert!(lines < 16_000, "{lines} lines of snapshots");
}

/// Each published crate documents what its features add, and docs.rs marks the items that need one.
#[test]
fn features_are_documented() {
    let manifest = fs::read_to_string(root().join("Cargo.toml")).expect("a manifest");
    let paths = manifest.lines().filter_map(|line| {
        let (name, rest) = line.split_once(" = { path = \"")?;
        name.starts_with("hamel").then_some(rest.split_once('"')?.0)
    });
    let mut missing = Vec::new();
    let mut found = 0;
    for path in paths {
        let read = |file: &str| fs::read_to_string(root().join(path).join(file)).expect("a file");
        let manifest = read("Cargo.toml");
        let Some((_, features)) = manifest.split_once("[features]\n") else {
            continue;
        };
        let features = features.split("\n[").next().unwrap_or_default();
        let names = features
            .lines()
            .filter_map(|line| Some(line.split_once(" = [")?.0));
        let documentation = read("src/lib.rs");
        for name in names.filter(|name| *name != "default") {
            found += 1;
            if !documentation.contains(&format!("//! | `{name}` |")) {
                missing.push(format!(
                    "{path}/src/lib.rs has no row for the feature `{name}`"
                ));
            }
        }
        if !documentation.contains("#![cfg_attr(docsrs, feature(doc_cfg))]") {
            missing.push(format!(
                "{path}/src/lib.rs: docs.rs cannot mark what needs a feature"
            ));
        }
    }
    assert!(found >= 10, "{found} features");
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}
