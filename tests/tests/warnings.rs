//! Correct descriptions give no warnings: those of the models, the examples, and what imports write.

use hamel_codegen::lower::build;
use hamel_codegen::model::Model;
use hamel_codegen::render::warnings;
use hamel_codegen::syntax::{parse_text, read_files};
use hamel_codegen::urdf::{Options, import};
use std::path::{Path, PathBuf};

fn read(text: &str, folder: &Path) -> Model {
    let mut system = parse_text(text).expect("a description");
    let open = &mut |name: &str| std::fs::read_to_string(folder.join(name));
    read_files(&mut system, open).expect("files");
    build(&system).expect("a correct description")
}

/// All files below a folder with an ending, but those that others include, in folders `parts`.
fn below(folder: &str, ending: &str) -> Vec<PathBuf> {
    let mut open = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
    let mut found = Vec::new();
    while let Some(path) = open.pop() {
        if path.ends_with("parts") {
            continue;
        } else if path.is_dir() {
            let entries = std::fs::read_dir(path).expect("a folder");
            open.extend(entries.map(|entry| entry.expect("an entry").path()));
        } else if path.extension().is_some_and(|end| end == ending) {
            found.push(path);
        }
    }
    assert!(!found.is_empty(), "{folder} has no {ending}");
    found
}

#[test]
fn models_and_examples_use_what_they_declare() {
    let mut said = String::new();
    for folder in ["models", "../examples"] {
        for path in below(folder, "eom") {
            let text = std::fs::read_to_string(&path).expect("readable");
            let list = read(&text, path.parent().expect("a folder")).warnings;
            said += &warnings(&list, &path.display().to_string(), &text, false);
        }
    }
    assert!(said.is_empty(), "{said}");
}

#[test]
fn imports_use_what_they_declare() {
    for path in below("../urdf/tests/files", "urdf") {
        let text = std::fs::read_to_string(&path).expect("readable");
        for params in [false, true] {
            for floating in [false, true] {
                let options = Options {
                    params,
                    floating,
                    ..Options::default()
                };
                let imported = import(&text, &options, "robot.urdf", false).expect("a robot");
                let list = read(&imported.text, Path::new("")).warnings;
                let said = warnings(&list, "robot.eom", &imported.text, false);
                assert!(said.is_empty(), "{said}");
            }
        }
    }
}

#[test]
fn warnings_are_underlined() {
    let text = "system A {\n    param m = 1, k = 2;\n    coord q;\n    velocity w;\n    rate q = w;\n    kinetic m * w^2 / 2;\n}\n";
    insta::assert_snapshot!(warnings(&read(text, Path::new("")).warnings, "a.eom", text, false), @r"
    warning: the parameter `k` is never used
     --> a.eom:2:18
      |
    2 |     param m = 1, k = 2;
      |                  ^
      |
      = help: remove it, or call it `_k`
    ");
}
