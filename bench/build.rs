//! The models of the hard cases, generated from their descriptions.

/// Descriptions among those of the tests.
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
    for model in MODELS {
        builder = builder.file(format!("../tests/models/{model}.eom"));
        modules.push_str(&format!(
            "/// Generated from `tests/models/{model}.eom`.\npub mod {model} {{\n    include!(concat!(env!(\"OUT_DIR\"), \"/{model}.rs\"));\n}}\n"
        ));
    }
    builder.generate()?;
    let out = std::path::PathBuf::from(std::env::var("OUT_DIR")?);
    std::fs::write(out.join("models.rs"), modules)?;
    Ok(())
}
