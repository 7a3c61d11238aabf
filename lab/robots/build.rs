//! Generates the robots below `HAMEL_ROBOTS` that are in the folder `HAMEL_CONTROL_REFERENCE`, with their
//! linearisation, and writes the samples of their discrete steps as constants.

use hamel_codegen::Builder;
use hamel_codegen::generate::from_text;
use hamel_lab::pinocchio::{control, coordinates, list, velocities};
use hamel_lab::undamped::undamped;
use serde_json::Value;
use std::error::Error;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-env-changed=HAMEL_CONTROL_REFERENCE");
    println!("cargo:rerun-if-env-changed=HAMEL_ROBOTS");
    let robots = std::env::var_os("HAMEL_ROBOTS").map(PathBuf::from);
    let robots = robots.ok_or("HAMEL_ROBOTS is not set: start this by lab/robots/run.sh")?;
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").ok_or("no folder")?);
    let mut builder = Builder::new();
    let mut modules = String::new();
    for reference in control() {
        let name = reference["robot"].as_str().ok_or("no name")?;
        let file = folder.join(format!("{name}.eom"));
        let (text, samples) = robot(&robots, &reference)?;
        std::fs::write(&file, text)?;
        builder = builder.file(file);
        modules += &format!(
            "#[test]\nfn {name}() {{\n    mod robot {{\n        include!(concat!(env!(\"OUT_DIR\"), \"/{name}.rs\"));\n    }}\n    \
             check::<robot::Robot<f64>>({}, &[{samples}]);\n}}\n\n",
            reference["floating_base"]
        );
    }
    builder.generate()?;
    std::fs::write(folder.join("robots.rs"), modules)?;
    Ok(())
}

/// Returns the description of a robot without damping, and its samples.
fn robot(folder: &Path, reference: &Value) -> Result<(String, String), Box<dyn Error>> {
    let (text, joints) = undamped(folder, reference);
    let text = format!("{text}    generate all, linearize;\n}}\n");
    let generated = from_text(&text).map_err(|errors| format!("{errors:?}"))?;
    let system = format!("system {}", generated.program.name);
    let text = text.replacen(&system, "system Robot", 1);
    let model = &generated.active;
    let numbers = |values: Vec<f64>| format!("&{values:?}");
    let step = reference["step_size"].as_f64().ok_or("no step")?;
    let samples = reference["samples"].as_array().ok_or("no samples")?;
    let samples = samples.iter().map(|sample| {
        let end = &sample["step"];
        format!(
            "Sample {{ h: {step:?}, x: {}, xi: {}, u: {}, end_x: {}, end_xi: {}, a: {}, b: {} }}",
            numbers(coordinates(model, sample, &joints)),
            numbers(velocities(model, sample, &joints)),
            numbers(list(&sample["force"])),
            numbers(coordinates(model, end, &joints)),
            numbers(velocities(model, end, &joints)),
            numbers(list(&end["A"])),
            numbers(list(&end["B"])),
        )
    });
    Ok((text, samples.collect::<Vec<_>>().join(", ")))
}
