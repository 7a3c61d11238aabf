//! MuJoCo, through `lab/peers/mujoco_peer.py`.

use super::ForeignResults;
use serde::Deserialize;
use std::path::Path;
use std::process::Command;

/// The command that installs it.
pub const SETUP_COMMAND: &str =
    "python3 -m venv target/mujoco && target/mujoco/bin/pip install mujoco";

/// Default path of its Python.
pub const PYTHON: &str = "target/mujoco/bin/python";

#[derive(Deserialize)]
struct Output {
    version: String,
    cases: Vec<ForeignResults>,
}

/// Runs the script, and returns its version and results.
///
/// # Errors
/// A message if there is no such Python, the script fails, or its output cannot be read.
pub fn run(python: &Path) -> Result<(String, Vec<ForeignResults>), String> {
    if !python.exists() {
        return Err(format!("no Python with it at {}", python.display()));
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = Command::new(python)
        .arg(root.join("../peers/mujoco_peer.py"))
        .arg(root.join("../../tests/reference"))
        .output()
        .map_err(|error| format!("its script did not start: {error}"))?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        let last = text.lines().last().unwrap_or("no message").to_string();
        return Err(format!("its script failed: {last}"));
    }
    let read: Output = serde_json::from_slice(&output.stdout)
        .map_err(|error| format!("its output cannot be read: {error}"))?;
    Ok((read.version, read.cases))
}
