//! The macro in the compiler: errors stand inside of the description.
//!
//! Programs of `tests/programs` are given to rustc with the library `hamel` that the tests were built with.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Lines of JSON that a command prints.
fn lines(text: &[u8]) -> Vec<Value> {
    let text = String::from_utf8_lossy(text);
    let values = text.lines().map(serde_json::from_str);
    values.filter_map(Result::ok).collect()
}

/// The library `hamel` with the features of the tests. Cargo takes what is built already where the whole workspace is
/// asked for: `layers` stands for all of its tests.
fn library() -> PathBuf {
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(root());
    command.args([
        "test",
        "--no-run",
        "--workspace",
        "--locked",
        "--test=layers",
    ]);
    let output = command
        .arg("--message-format=json")
        .output()
        .expect("cargo runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let artifacts = lines(&output.stdout);
    let found = artifacts.iter().rev().find_map(|artifact| {
        let is_library =
            artifact["target"]["name"] == "hamel" && artifact["target"]["kind"][0] == "lib";
        let files = artifact["filenames"].as_array().filter(|_| is_library)?;
        let files = files.iter().filter_map(Value::as_str);
        files
            .map(PathBuf::from)
            .find(|file| file.extension().is_some_and(|ending| ending == "rlib"))
    });
    found.expect("tests depend on the library")
}

/// The errors of a program, message by message as people see them.
fn messages(library: &Path, program: &str) -> String {
    let folder = library.parent().expect("a folder");
    // Besides libraries that were just built, this folder links to them.
    let dependencies = folder.join("deps");
    let output = Command::new("rustc")
        .current_dir(root())
        .args([
            "--edition=2024",
            "--crate-type=bin",
            "--emit=metadata",
            "--error-format=json",
        ])
        .arg("--out-dir")
        .arg(env!("CARGO_TARGET_TMPDIR"))
        .arg("--extern")
        .arg(format!("hamel={}", library.display()))
        .args([folder, &dependencies].map(|folder| format!("-Ldependency={}", folder.display())))
        .arg(format!("tests/programs/{program}.rs"))
        .output()
        .expect("rustc runs");
    assert!(!output.status.success(), "{program} compiles");
    let messages = lines(&output.stderr);
    let errors = messages
        .iter()
        .filter_map(|message| message["rendered"].as_str());
    let all: String = errors
        .filter(|text| text.starts_with("error") && !text.starts_with("error: aborting"))
        .collect();
    assert!(
        !all.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    all
}

#[test]
fn errors_are_placed_in_the_description() {
    let library = library();
    for program in [
        "wrong_inertia",
        "wrong_names",
        "wrong_rates",
        "wrong_shapes",
    ] {
        insta::assert_snapshot!(program, messages(&library, program));
    }
}
