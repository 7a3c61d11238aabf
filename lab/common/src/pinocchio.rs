//! Reads states of robots from the files in `tests/reference`, for imported models.

use hamel_codegen::model::Model;
use hamel_codegen::syntax::ast::CoordKind;
use serde_json::Value;
use std::path::Path;

/// The robots of `tests/reference/control`, or of the folder in `HAMEL_CONTROL_REFERENCE`.
pub fn control() -> Vec<Value> {
    let root = match std::env::var_os("HAMEL_CONTROL_REFERENCE") {
        Some(folder) => folder.into(),
        // This file is part of packages at different depths.
        None => Path::new(env!("CARGO_MANIFEST_DIR"))
            .ancestors()
            .map(|folder| folder.join("tests/reference/control"))
            .find(|folder| folder.is_dir())
            .expect("the folder of references"),
    };
    let mut robots = Vec::new();
    for entry in std::fs::read_dir(root).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|kind| kind == "json") {
            let json = std::fs::read_to_string(&path).expect("a file");
            robots.push(serde_json::from_str(&json).expect("JSON"));
        }
    }
    assert!(robots.len() >= 2);
    robots
}

/// The joint of the URDF file to which a coordinate or velocity belongs; `joints` pairs names of the file with those of
/// the description.
pub fn joint(joints: &[(String, String)], of: &str) -> String {
    let pairs = joints.iter();
    let pair = pairs.filter(|(_, name)| of == name || of.starts_with(&format!("{name}_")));
    let pair = pair.max_by_key(|(_, name)| name.len());
    pair.map_or_else(|| "root_joint".into(), |(file, _)| file.clone())
}

/// x of a sample.
pub fn coordinates(model: &Model, sample: &Value, joints: &[(String, String)]) -> Vec<f64> {
    let mut x = Vec::new();
    for coordinate in &model.coordinates {
        let value = &sample["configuration"][joint(joints, &coordinate.name)];
        match coordinate.kind {
            CoordKind::Euclidean(_) => x.extend(list(&value["position"])),
            CoordKind::SO3 => x.extend(list(&value["rotation"])),
            CoordKind::S1 => {
                let (sin, cos) = value.as_f64().expect("an angle").sin_cos();
                x.extend([cos, sin]);
            }
            _ => x.push(value.as_f64().expect("a number")),
        }
    }
    x
}

/// ξ of a sample.
pub fn velocities(model: &Model, sample: &Value, joints: &[(String, String)]) -> Vec<f64> {
    let groups = model.velocities.iter().flat_map(|group| {
        let value = &sample["velocity"][joint(joints, &group.name)];
        match group.name.as_str() {
            "root_joint_v" => list(&value["linear"]),
            "root_joint_w" => list(&value["angular"]),
            _ => list(value),
        }
    });
    groups.collect()
}

/// All numbers of a value, row by row.
pub fn list(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(entries) => entries.iter().flat_map(list).collect(),
        other => vec![other.as_f64().expect("a number")],
    }
}
