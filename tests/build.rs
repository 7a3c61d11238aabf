//! The build script's front end: every model of `models/`, `models/multibody/`, `models/reuse/`, `models/tabled/` and
//! `models/external/` becomes a module of this crate.

use std::path::PathBuf;

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
            "/// Generated from `{}`.\npub mod {stem} {{\n    include!(concat!(env!(\"OUT_DIR\"), \"/{stem}.rs\"));\n}}\n",
            path.display()
        ));
        builder = builder.file(path);
    }
    builder.generate()?;
    let out_dir = std::env::var("OUT_DIR")?;
    std::fs::write(PathBuf::from(out_dir).join("models.rs"), modules)?;
    Ok(())
}
