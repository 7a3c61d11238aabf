//! Generates two robots below `HAMEL_ROBOTS` with their linearisation.

use hamel_codegen::Builder;
use hamel_codegen::urdf::Options;
use std::error::Error;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-env-changed=HAMEL_ROBOTS");
    let robots = std::env::var_os("HAMEL_ROBOTS").map(PathBuf::from);
    let robots = robots.ok_or("HAMEL_ROBOTS is not set: start this by bench/steps/run.sh")?;
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").ok_or("no folder")?);
    let mut builder = Builder::new();
    for (robot, name, floating) in [
        ("ur_description/urdf/ur5_robot.urdf", "ur5", false),
        ("solo_description/robots/solo12.urdf", "solo12", true),
    ] {
        let file = folder.join(format!("{name}.eom"));
        std::fs::write(&file, described(&robots.join(robot), floating)?)?;
        builder = builder.file(file);
    }
    builder.generate()?;
    Ok(())
}

/// The robot as a description that asks for its linearisation, too.
fn described(robot: &Path, floating: bool) -> Result<String, Box<dyn Error>> {
    let options = Options {
        floating,
        ..Options::default()
    };
    let text = std::fs::read_to_string(robot)?;
    let imported = hamel_codegen::urdf::import(&text, &options, &robot.to_string_lossy(), false)?;
    let body = imported.text.trim_end().strip_suffix('}').ok_or("no end")?;
    Ok(format!("{body}    generate all, linearize;\n}}\n"))
}
