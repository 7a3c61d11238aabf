//! `hamel emit` writes valid Rust, or nothing.

use crate::common::{hamel, text};
use crate::installed::installed;
use std::path::PathBuf;

/// Robots for which rows that end in `k[15]` once lost a bracket.
const ROBOTS: &[&str] = &["solo12.urdf", "anymal.urdf", "go1.urdf", "a1.urdf"];

fn emitted(arguments: &[&str], input: &str) -> String {
    let output = hamel(&[&["emit"], arguments].concat(), input);
    assert!(
        output.status.success(),
        "{arguments:?} {}",
        text(&output.stderr)
    );
    text(&output.stdout)
}

fn parsed(code: &str) -> syn::File {
    syn::parse_file(code).unwrap_or_else(|error| panic!("{error}\n{code}"))
}

/// All URDF files of the wheel, if it is installed.
fn robots() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open: Vec<PathBuf> = installed().into_iter().collect();
    while let Some(path) = open.pop() {
        if path.is_dir() {
            let entries = std::fs::read_dir(&path).expect("a folder");
            open.extend(entries.map(|entry| entry.expect("an entry").path()));
        } else if path
            .extension()
            .is_some_and(|extension| extension == "urdf")
        {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The output of `hamel emit` for UR5: frames chosen by the generator, recursions over a tree, folded numbers. Other
/// snapshots of code are in `tests/tests/suite/snapshots.rs`.
#[test]
fn code_of_ur5() {
    let Some(folder) = installed() else {
        eprintln!(
            "the code of UR5 is not tested: its URDF is absent; tests/robots/install.sh installs it"
        );
        return;
    };
    let path = folder.join("ur_description/urdf/ur5_robot.urdf");
    let robot = std::fs::read_to_string(path).expect("UR5");
    // From standard input, so that the text contains no path.
    insta::assert_snapshot!(emitted(&["-"], &robot));
}

/// With `HAMEL_ATTACK=full` all robots, with all options of reading.
#[test]
fn robots_are_rust() {
    let full = std::env::var("HAMEL_ATTACK").is_ok_and(|size| size == "full");
    let ways: [&[&str]; 4] = [
        &["--floating", "--params"],
        &[],
        &["--floating"],
        &["--params"],
    ];
    let mut written = 0;
    for robot in robots() {
        let name = robot
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if !full && !ROBOTS.contains(&name.as_str()) {
            continue;
        }
        for way in &ways[..if full { ways.len() } else { 1 }] {
            let path = robot.display().to_string();
            let output = hamel(&[&["emit", &path], *way].concat(), "");
            if output.status.success() {
                parsed(&text(&output.stdout));
                written += 1;
            } else {
                // Other refusals are tested elsewhere.
                let said = text(&output.stderr);
                assert!(!said.contains("no Rust"), "{name} {way:?} {said}");
            }
        }
    }
    println!("{written} texts");
    assert!(
        written >= ROBOTS.len() || installed().is_none(),
        "{written} texts"
    );
}

/// φ of a joint with the sine and cosine of a number in its mount, which are several nodes.
#[test]
fn constants_that_are_copied_are_computed() {
    let text = "system A { joint j: free at pose(rotx(1), [0, 0, 0]) moves f; body on f { mass 1; inertia diag(1, 1, 1); } }";
    let code = emitted(&["-"], text);
    parsed(&code);
    let (_, constants) = code.split_once("fn constants(").expect("constants");
    let (constants, _) = constants.split_once("\n    }\n").expect("an end");
    assert!(!constants.contains("slots"), "{constants}");
    assert_eq!(constants.matches(".sin_cos()").count(), 1, "{constants}");
}

/// In the weight of a link on a slider ξ̇ occurs but cancels: equal expressions are one node. The function does not
/// take ξ̇ as an argument.
#[test]
fn functions_read_what_they_take() {
    let text = "system A {
        input u1, u2;
        joint a: prismatic [1, 2, 2] at pose(rotz(pi / 2), [0.5, 0, 0.25]) moves f { damping 0.1; force u1; }
        body on f { mass 1.2345678901234567; com [0.1, -0.2, 0.3]; inertia diag(1, 2, 2.5) about com; }
        joint b: revolute [1, 2, 2] on f at pose(identity(3), [0, 0.4, 0]) moves g { damping 0.1; force u2; }
        body on g { mass 3e1; com [0.1, -0.2, 0.3]; inertia diag(1, 2, 2.5) about com; }
        gravity [0, 0, -9.81];
    }";
    let code = emitted(&["-"], text);
    for function in code.split("\n    ///").filter(|text| text.contains(" fn ")) {
        let Some((head, body)) = function.split_once(" {\n") else {
            continue;
        };
        assert!(
            head.contains("xi_dot") || !body.contains("xi_dot["),
            "{function}"
        );
    }
}

/// Keywords are refused at their place; names of primitive types do not shadow those of Rust.
#[test]
fn types_get_names_that_are_free() {
    let named =
        |name: &str| format!("system {name} {{ coord q; velocity v; rate q = v; kinetic v^2; }}");
    for name in ["bool", "str", "u8", "f64", "S"] {
        let code = emitted(&["-"], &named(name));
        let file = parsed(&code);
        let is_named = |item: &syn::Item| matches!(item, syn::Item::Struct(item) if item.ident == format!("{name}_"));
        assert!(file.items.iter().any(is_named), "{code}");
    }
    for name in ["type", "Self", "gen", "dyn", "abstract", "try"] {
        let output = hamel(&["emit", "-"], &named(name));
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{name} {said}");
        let place =
            said.contains("<stdin>:1:8") && said.contains("is a word of Rust and cannot be a name");
        assert!(place, "{name} {said}");
    }
}
