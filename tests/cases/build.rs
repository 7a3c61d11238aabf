//! Generates the systems of the hard cases from `tests/models/`.

use hamel_codegen::derive::structure::choice::choose_method;
use std::path::PathBuf;

/// The models that the cases use.
const MODELS: [&str; 11] = [
    "benchmark_top",
    "double_pendulum_angles",
    "free_body",
    "kovalevskaya_top",
    "lagrange_top",
    "principal_axes",
    "rolling_disk",
    "satellite",
    "sleigh",
    "spherical_bob",
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
    modules.push_str(&choices()?);
    let out_dir = std::env::var("OUT_DIR")?;
    std::fs::write(PathBuf::from(out_dir).join("models.rs"), modules)?;
    Ok(())
}

/// Returns the choice of `--method auto` for each model, with its reason.
fn choices() -> Result<String, Box<dyn std::error::Error>> {
    let mut rows = String::new();
    for stem in MODELS {
        let text = std::fs::read_to_string(format!("../models/{stem}.eom"))?;
        let generated =
            hamel_codegen::generate::from_text(&text).map_err(|errors| format!("{errors:?}"))?;
        let choice = choose_method(&generated.program.structure, None);
        rows.push_str(&format!(
            "({stem:?}, {:?}, {:?}),\n",
            choice.method, choice.reason
        ));
    }
    Ok(format!(
        "/// For every model the method that fits its structure, and why.\npub const CHOICES: &[(&str, &str, &str)] = &[\n{rows}];\n"
    ))
}
