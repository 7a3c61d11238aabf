//! Correct descriptions give no warnings: those of the models, of the examples, and of imports.

use hamel_codegen::derive::reduction::{dropped_row_warnings as redundant, reduce};
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

/// Lists all files below a folder with an extension, except for included ones, in folders `parts`.
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
    for path in below("../codegen/import/tests/files", "urdf") {
        let text = std::fs::read_to_string(&path).expect("readable");
        for params in [false, true] {
            for floating in [false, true] {
                let options = Options {
                    params,
                    floating,
                    ..Options::default()
                };
                let imported = import(&text, &options).expect("a robot");
                let model = read(&imported.text(), Path::new(""));
                let reduction = reduce(&model).expect("a robot that moves");
                let dropped = reduction.map_or(Vec::new(), |reduction| reduction.dropped);
                let mut list = model.warnings;
                list.extend(redundant(&model.constraints, &dropped));
                let said = warnings(&list, "robot.eom", &imported.text(), false);
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

/// Returns the warnings for a cart on a rail with an arm, with further statements.
fn said(statements: &str) -> Vec<String> {
    let text = format!(
        "system A {{
            joint rail: prismatic [1, 0, 0] moves cart;
            joint arm: spherical on cart moves hand;
            body on cart {{ mass 1; }}
            {statements}
            body on hand {{ mass 1; com [0, 0, 1]; inertia diag(1, 1, 1) about com; }}
        }}"
    );
    let list = read(&text, Path::new("")).warnings.into_iter();
    list.map(|warning| {
        let place = warning.span.range().expect("a place");
        format!("{} [{}]", warning.message, &text[place])
    })
    .collect()
}

/// Each statement with a warning has a counterpart that differs in a detail and has none.
#[test]
fn what_cannot_be_meant_is_said() {
    let body =
        |inertia: &str| format!("body on hand {{ mass 1; com [0, 0, 1]; inertia {inertia}; }}");
    for (statement, message, right) in [
        (
            body("diag(1, 1, 2.1) about com"),
            "the inertia of this body violates the triangle inequality [diag(1, 1, 2.1)]",
            body("diag(1, 1, 2) about com"),
        ),
        (
            body("diag(0.5, 1.5, 1) about origin"),
            "the inertia of this body is not positive [diag(0.5, 1.5, 1)]",
            body("diag(1.5, 1.5, 1) about origin"),
        ),
        (
            body("[[1, 0.9, 0], [0.9, 1, 0], [0, 0, 0.05]] about com"),
            "the inertia of this body violates the triangle inequality [[[1, 0.9, 0], [0.9, 1, 0], [0, 0, 0.05]]]",
            body("[[1, 0.9, 0], [0.9, 1, 0], [0, 0, 2]] about com"),
        ),
        (
            "param J: sym3 = [[1, 0, 0], [0, 1, 0], [0, 0, -1]]; body on hand { mass 1; inertia J about com; }".into(),
            "the inertia of this body is not positive, with the default parameters [J]",
            "param J: sym3 = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]; body on hand { mass 1; inertia J about com; }".into(),
        ),
        (
            "body on hand { mass -1; }".into(),
            "the mass of this body is negative: -1 [-1]",
            "body on hand { mass 0; }".into(),
        ),
        (
            "joint turn: revolute [0, 0, 1] moves disk; body on disk { mass 1; inertia diag(0, 0, -2) about com; }".into(),
            "the moment of inertia about the axis that this body turns about is negative [diag(0, 0, -2)]",
            "joint turn: revolute [0, 0, 1] moves disk; body on disk { mass 1; inertia diag(0, 0, 2) about com; }".into(),
        ),
        (
            "force [0, 0, 1] on cart in world;".into(),
            "this load can never do work: no motion of `cart` has a component along it [force [0, 0, 1] on cart in world;]",
            "force [0, 0, 1] at [0, 0, 1] on hand in world; force [1, 0, 0] on cart in world;".into(),
        ),
        (
            "input t; torque [t, 0, 0] on cart in body;".into(),
            "this load can never do work: no motion of `cart` has a component along it [torque [t, 0, 0] on cart in body;]",
            "input t; torque [t, 0, 0] on hand in body;".into(),
        ),
        (
            "joint turn: revolute [0, 0, 1] moves disk { limit 0.5 to 2; } body on disk { mass 1; inertia identity(3) about com; }".into(),
            "the start of `turn` is 0, beyond its limits 0.5 to 2 [turn]",
            "joint turn: revolute [0, 0, 1] moves disk { limit 0.5 to 2; } body on disk { mass 1; inertia identity(3) about com; } start turn = 0.5;".into(),
        ),
        (
            "joint turn: revolute [0, 0, 1] moves disk { limit -1 to 1; } body on disk { mass 1; inertia identity(3) about com; } start turn = 1.1;".into(),
            "the start of `turn` is 1.1, beyond its limits -1 to 1 [start turn = 1.1;]",
            "joint turn: revolute [0, 0, 1] moves disk { limit -1 to 1; } body on disk { mass 1; inertia identity(3) about com; } start turn = -1;".into(),
        ),
    ] {
        assert_eq!(said(&statement), [message], "{statement}");
        assert_eq!(said(&right), [""; 0], "{right}");
    }
}

/// The macro cannot emit warnings directly; its expansion makes the compiler emit them.
#[test]
fn the_macro_hands_warnings_to_the_compiler() {
    let text = |more: &str| {
        format!("system A {{ coord q; velocity w; rate q = w; kinetic w^2 / 2; {more} }}")
    };
    let expanded = |more: &str| {
        let tokens: proc_macro2::TokenStream = text(more).parse().expect("tokens");
        hamel_codegen::expand(tokens).to_string()
    };
    let with = expanded("param k = 2;");
    assert!(
        with.contains("deprecated") && with.contains("the parameter `k` is never used"),
        "{with}"
    );
    assert!(!expanded("").contains("deprecated"));
}
