//! Generates the robots below `HAMEL_ROBOTS` of the folder `HAMEL_CONTROL_REFERENCE`, with their
//! linearisation, and writes the samples of their discrete steps as constants.

#[path = "../../../cli/tests/common/pinocchio.rs"]
mod pinocchio;

use hamel_codegen::Builder;
use hamel_codegen::generate::from_text;
use hamel_codegen::urdf::{Options, import};
use pinocchio::{control, coordinates, list, velocities};
use serde_json::Value;
use std::error::Error;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-env-changed=HAMEL_CONTROL_REFERENCE");
    println!("cargo:rerun-if-env-changed=HAMEL_ROBOTS");
    let robots = std::env::var_os("HAMEL_ROBOTS").map(PathBuf::from);
    let robots = robots.ok_or("HAMEL_ROBOTS is not set: start this by tests/robots/steps.sh")?;
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

/// The description of a robot without damping, and its samples.
fn robot(folder: &Path, reference: &Value) -> Result<(String, String), Box<dyn Error>> {
    let urdf = folder.join(reference["urdf"].as_str().ok_or("no path")?);
    let options = Options {
        floating: reference["floating_base"] == true,
        tolerance: 0.0,
        ..Options::default()
    };
    let urdf = std::fs::read_to_string(urdf)?;
    let imported = import(&urdf, &options, "robot.urdf", false)?;
    let statements = imported.text.split(';');
    let kept: Vec<&str> = statements
        .filter(|part| !part.trim().starts_with("damping"))
        .collect();
    let text = kept.join(";");
    let (text, _) = text.rsplit_once('}').ok_or("no end")?;
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
            numbers(coordinates(model, sample, &imported.joints)),
            numbers(velocities(model, sample, &imported.joints)),
            numbers(list(&sample["force"])),
            numbers(coordinates(model, end, &imported.joints)),
            numbers(velocities(model, end, &imported.joints)),
            numbers(list(&end["A"])),
            numbers(list(&end["B"])),
        )
    });
    Ok((text, samples.collect::<Vec<_>>().join(", ")))
}
