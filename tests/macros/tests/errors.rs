//! Errors of the macro in the compiler: they point into the description.
//!
//! The programs are compiled in this workspace with the crates built for its tests. Cargo reuses these only if the
//! other targets of the command need them with the same features: the test `layers` for the generator, and the program
//! `hamel` for the crates shared by build scripts and programs.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// Returns the messages of rustc for a program, as users see them.
fn messages(program: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(root).args([
        "test",
        "--no-run",
        "--workspace",
        "--locked",
        "--message-format=json",
        "--features=hamel-tests-macros/wrong",
        "--test=layers",
        "--bin=hamel",
        "--bin",
        program,
    ]);
    let output = command.output().expect("cargo runs");
    assert!(!output.status.success(), "{program} compiles");
    let lines = String::from_utf8_lossy(&output.stdout).into_owned();
    let messages = lines.lines().filter_map(|line| {
        let message: Value = serde_json::from_str(line).ok()?;
        let source = message["target"]["name"].as_str()?;
        let text = message["message"]["rendered"].as_str()?;
        (source == program && text.starts_with("error")).then(|| text.to_string())
    });
    let all: String = messages.collect();
    assert!(
        !all.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    all
}

#[test]
fn errors_are_placed_in_the_description() {
    for program in [
        "wrong_inertia",
        "wrong_names",
        "wrong_rates",
        "wrong_shapes",
    ] {
        insta::assert_snapshot!(program, messages(program));
    }
}
