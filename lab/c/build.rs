//! Generates Rust for this crate, and C into the folder `HAMEL_C`: a free body, and two robots below `HAMEL_ROBOTS`, each
//! with its linearisation.

use hamel_codegen::Builder;
use hamel_codegen::emit::c::Precision;
use hamel_lab::described::{imported, linearised};
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-env-changed=HAMEL_C");
    println!("cargo:rerun-if-env-changed=HAMEL_ROBOTS");
    let folder = |name: &str| {
        std::env::var_os(name)
            .map(PathBuf::from)
            .ok_or(format!("{name} is not set: start this by lab/c/run.sh"))
    };
    let robots = folder("HAMEL_ROBOTS")?;
    let out = PathBuf::from(std::env::var_os("OUT_DIR").ok_or("no folder")?);
    let free_body = "../../tests/models/free_body.eom";
    println!("cargo:rerun-if-changed={free_body}");
    let mut builder = Builder::new();
    for (name, description) in [
        ("free_body", std::fs::read_to_string(free_body)?),
        (
            "ur5",
            imported(&robots.join("ur_description/urdf/ur5_robot.urdf"), false)?,
        ),
        (
            "solo12",
            imported(&robots.join("solo_description/robots/solo12.urdf"), true)?,
        ),
    ] {
        let file = out.join(format!("{name}.eom"));
        std::fs::write(&file, linearised(&description)?)?;
        builder = builder.file(file);
    }
    builder
        .c_files(folder("HAMEL_C")?, Precision::Double)
        .generate()?;
    Ok(())
}
