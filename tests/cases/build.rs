//! Generates the systems of the hard cases from `tests/models/`.

use std::path::PathBuf;

/// The models that the cases use.
const MODELS: [&str; 11] = [
    "double_pendulum_angles",
    "free_body",
    "heavy_top_axis",
    "heavy_top_world",
    "kovalevskaya_top",
    "lagrange_top",
    "principal_axes",
    "rolling_disk",
    "satellite",
    "sleigh",
    "two_bodies",
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut builder = hamel_codegen::Builder::new();
    let mut modules = String::new();
    for stem in MODELS {
        modules.push_str(&format!(
            "/// Generated from `tests/models/{stem}.eom`.\npub mod {stem} {{\n    include!(concat!(env!(\"OUT_DIR\"), \"/{stem}.rs\"));\n}}\n"
        ));
        builder = builder.file(format!("../models/{stem}.eom"));
    }
    builder.generate()?;
    let out_dir = std::env::var("OUT_DIR")?;
    std::fs::write(PathBuf::from(out_dir).join("models.rs"), modules)?;
    Ok(())
}
