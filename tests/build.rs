//! Generates the models through the front end for build scripts: every model of `models/`, `models/multibody/`,
//! `models/reuse/`, `models/tabled/` and `models/external/` becomes a module of this crate.

use std::path::PathBuf;

/// Models with every kind of coordinates, constraints and states, whose steps are differentiated.
const LINEAR: &[&str] = &[
    "bicycle",
    "cart_pole",
    "drone",
    "five_bar",
    "four_bar_loop",
    "heavy_top",
    "heavy_top_quaternion",
    "kapitza",
    "lagging_drone",
    "pendulum_circle",
    "rolling_disk",
    "satellite",
    "sleigh",
    "spherical_angles",
    "rod_particles",
    "spring_chain",
    "two_wheeled_robot",
];

/// Lints that users may have enabled for the crate that includes generated code.
const LINTS: &str = "#[warn(clippy::pedantic, clippy::nursery)]\n";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo:rerun-if-changed=models");
    let mut paths: Vec<PathBuf> = Vec::new();
    for folder in [
        "models",
        "models/multibody",
        "models/reuse",
        "models/tabled",
        "models/external",
    ] {
        for entry in std::fs::read_dir(folder)? {
            paths.push(entry?.path());
        }
    }
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "eom"));
    paths.sort();
    let mut builder = hamel_codegen::Builder::new();
    let mut modules = String::new();
    for path in &paths {
        let stem = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        modules.push_str(&format!(
            "/// Generated from `{}`.\n{LINTS}pub mod {stem} {{\n    include!(concat!(env!(\"OUT_DIR\"), \"/{stem}.rs\"));\n}}\n",
            path.display()
        ));
        builder = builder.file(path);
    }
    let out_dir = std::env::var("OUT_DIR")?;
    // Generates some of them again with their linearisation, which also gives the slopes of steps.
    let mut linear = String::new();
    for stem in LINEAR {
        let text = std::fs::read_to_string(format!("models/{stem}.eom"))?;
        let (body, _) = text.rsplit_once('}').ok_or("a system ends with a brace")?;
        let path = PathBuf::from(&out_dir).join(format!("linear_{stem}.eom"));
        // For the tops, energy and momenta are requested as well.
        let all = if stem.starts_with("heavy_top") {
            "all, "
        } else {
            ""
        };
        std::fs::write(&path, format!("{body}    generate {all}linearize;\n}}\n"))?;
        linear.push_str(&format!(
            "/// Generated from `{stem}.eom`, linearised.\n{LINTS}pub mod {stem} {{\n    include!(concat!(env!(\"OUT_DIR\"), \"/linear_{stem}.rs\"));\n}}\n"
        ));
        builder = builder.file(path);
    }
    modules.push_str(&format!(
        "/// Models with their linearisation.\npub mod linear {{\n{linear}}}\n"
    ));
    builder.generate()?;
    std::fs::write(PathBuf::from(out_dir).join("models.rs"), modules)?;
    Ok(())
}
