//! Generates Rust for this crate, and C into the folder `HAMEL_C`: a free body, and two robots below `HAMEL_ROBOTS`.

use hamel_codegen::Builder;
use hamel_codegen::emit::c::Precision;
use hamel_codegen::urdf::Options;
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-env-changed=HAMEL_C");
    println!("cargo:rerun-if-env-changed=HAMEL_ROBOTS");
    let folder = |name: &str| {
        std::env::var_os(name)
            .map(PathBuf::from)
            .ok_or(format!("{name} is not set: start this by bench/c/run.sh"))
    };
    let robots = folder("HAMEL_ROBOTS")?;
    let floating = Options {
        floating: true,
        ..Options::default()
    };
    Builder::new()
        .file("../../tests/models/free_body.eom")
        .urdf(
            robots.join("ur_description/urdf/ur5_robot.urdf"),
            Options::default(),
        )
        .urdf(robots.join("solo_description/robots/solo12.urdf"), floating)
        .c_files(folder("HAMEL_C")?, Precision::Double)
        .generate()?;
    Ok(())
}
