//! Generates three robots below `HAMEL_ROBOTS`, each with its linearisation and regressor; and the Jacobian of a link
//! of each, from a description that requests nothing else.

use hamel_codegen::Builder;
use hamel_codegen::urdf::{self, Options};
use hamel_lab::robots;
use std::error::Error;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-env-changed=HAMEL_ROBOTS");
    let folder = std::env::var_os("HAMEL_ROBOTS").map(PathBuf::from);
    let folder = folder.ok_or("HAMEL_ROBOTS is not set: start this by lab/pinocchio/run.sh")?;
    let out = PathBuf::from(std::env::var_os("OUT_DIR").ok_or("no folder")?);
    let mut builder = Builder::new();
    for (stem, robot) in [
        ("ur5", robots::UR5),
        ("panda", robots::PANDA),
        ("solo12", robots::SOLO12),
    ] {
        let body = imported(&folder, &robot)?;
        let link = robot.link;
        for (name, asked) in [
            (stem.into(), "all, linearize, regressor".into()),
            (
                format!("{stem}_{link}"),
                format!("jacobian {link} in world"),
            ),
        ] {
            let file = out.join(format!("{name}.eom"));
            std::fs::write(&file, format!("{body}    generate {asked};\n}}\n"))?;
            builder = builder.file(file);
        }
    }
    builder.generate()?;
    Ok(())
}

/// The description of a robot without its closing brace. It has no damping, which Pinocchio's algorithms leave out, and
/// no limits, one of which the start of Panda violates.
fn imported(folder: &Path, robot: &robots::Robot) -> Result<String, Box<dyn Error>> {
    let locks = robot.locked.iter();
    let options = Options {
        floating: robot.floating,
        locks: locks.map(|&joint| (joint.into(), "0".into())).collect(),
        ..Options::default()
    };
    let text = std::fs::read_to_string(folder.join(robot.urdf))?;
    let imported = urdf::import(&text, &options)
        .map_err(|problems| urdf::errors(&problems, robot.urdf, &text, false))?;
    let text = imported.text();
    let body = text.trim_end().strip_suffix('}').ok_or("no end")?;
    let lines = body.split_inclusive('\n').filter(|line| {
        !["damping ", "limit "]
            .iter()
            .any(|word| line.trim_start().starts_with(word))
    });
    Ok(lines.collect())
}
