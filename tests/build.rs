//! The build script's door: every model of `models/` becomes a module of this crate.

use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo:rerun-if-changed=models");
    let mut paths: Vec<PathBuf> = std::fs::read_dir("models")?
        .map(|entry| entry.map(|e| e.path()))
        .collect::<Result<_, _>>()?;
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
            "/// Generated from `models/{stem}.eom`.\npub mod {stem} {{\n    include!(concat!(env!(\"OUT_DIR\"), \"/{stem}.rs\"));\n}}\n"
        ));
        builder = builder.file(path);
    }
    builder.generate()?;
    let out_dir = std::env::var("OUT_DIR")?;
    std::fs::write(PathBuf::from(out_dir).join("models.rs"), modules)?;
    Ok(())
}
