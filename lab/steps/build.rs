//! Generates two robots below `HAMEL_ROBOTS` with their linearisation.

use hamel_codegen::Builder;
use hamel_lab::described::{imported, linearised};
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-env-changed=HAMEL_ROBOTS");
    let robots = std::env::var_os("HAMEL_ROBOTS").map(PathBuf::from);
    let robots = robots.ok_or("HAMEL_ROBOTS is not set: start this by lab/steps/run.sh")?;
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").ok_or("no folder")?);
    let mut builder = Builder::new();
    for (robot, name, floating) in [
        ("ur_description/urdf/ur5_robot.urdf", "ur5", false),
        ("solo_description/robots/solo12.urdf", "solo12", true),
    ] {
        let file = folder.join(format!("{name}.eom"));
        let description = imported(&robots.join(robot), floating)?;
        std::fs::write(&file, linearised(&description)?)?;
        builder = builder.file(file);
    }
    builder.generate()?;
    Ok(())
}
