//! Generates models of the tests and robots below `HAMEL_ROBOTS`, and keeps their descriptions in the build folder.

use hamel_codegen::Builder;
use hamel_codegen::urdf::{self, Options};
use std::error::Error;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-env-changed=HAMEL_ROBOTS");
    let robots = std::env::var_os("HAMEL_ROBOTS").map(PathBuf::from);
    let robots = robots.ok_or("HAMEL_ROBOTS is not set: start this by lab/native/run.sh")?;
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").ok_or("no folder")?);
    let mut builder = Builder::new();
    let models = ["free_body", "heavy_top", "double_pendulum_angles"];
    let models = models.map(|model| format!("../../tests/models/{model}.eom"));
    for model in models
        .into_iter()
        .chain(["../../examples/dzhanibekov.eom".into()])
    {
        println!("cargo:rerun-if-changed={model}");
        builder = builder.file(keep(
            &folder,
            Path::new(&model),
            &std::fs::read_to_string(&model)?,
        )?);
    }
    for (robot, floating, wanted) in [
        (
            "ur_description/urdf/ur5_robot.urdf",
            false,
            "accel, linearize",
        ),
        (
            "solo_description/robots/solo12.urdf",
            true,
            "accel, linearize",
        ),
        ("talos_data/robots/talos_reduced.urdf", true, "accel"),
    ] {
        let path = robots.join(robot);
        let options = Options {
            floating,
            ..Options::default()
        };
        let text = std::fs::read_to_string(&path)?;
        let imported = urdf::import(&text, &options)
            .map_err(|problems| urdf::errors(&problems, &path.to_string_lossy(), &text, false))?;
        let text = imported.text();
        let body = text.trim_end().strip_suffix('}').ok_or("no end")?;
        let text = format!("{body}    generate {wanted};\n}}\n");
        builder = builder.file(keep(&folder, &path, &text)?);
    }
    builder.generate()?;
    Ok(())
}

/// Writes a description to the folder of this build.
fn keep(folder: &Path, path: &Path, text: &str) -> Result<PathBuf, Box<dyn Error>> {
    let name = path.file_stem().ok_or("no name")?;
    let file = folder.join(name).with_extension("eom");
    std::fs::write(&file, text)?;
    Ok(file)
}
