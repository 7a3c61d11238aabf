//! Descriptions of the robots of `tests/reference/control`, which are without damping.

use hamel_codegen::urdf::{Options, import};
use serde_json::Value;
use std::path::Path;

/// The description of a robot without damping, without its last bracket, and its joints.
pub fn undamped(folder: &Path, reference: &Value) -> (String, Vec<(String, String)>) {
    let urdf = folder.join(reference["urdf"].as_str().expect("a path"));
    let urdf = std::fs::read_to_string(urdf).expect("a URDF");
    let options = Options {
        floating: reference["floating_base"] == true,
        tolerance: 0.0,
        ..Options::default()
    };
    let imported = import(&urdf, &options).expect("a robot");
    let text = imported.text();
    let statements = text.split(';');
    let kept: Vec<&str> = statements
        .filter(|part| !part.trim().starts_with("damping"))
        .collect();
    let text = kept.join(";");
    let (text, _) = text.rsplit_once('}').expect("a description");
    (text.to_string(), imported.joints)
}
