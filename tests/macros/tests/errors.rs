//! The macro in the compiler: errors stand inside of the description.
//!
//! The programs are compiled in this workspace, with the crates that its tests were built with: Cargo takes these only where
//! what is asked for beside the program needs them in the same way. That are `layers`, tests of the repository, for the
//! generator, and the command `hamel` for what build scripts share with programs.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// What rustc says of a program, message by message as people see them.
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
