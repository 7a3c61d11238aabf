//! Generates the models of the comparison: four of `tests/models`, and the trees that `peers.py` wrote.

use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};

const SMALL: [(&str, &str); 4] = [
    ("free_body", "free_body"),
    ("heavy_top", "heavy_top"),
    ("cart_pole", "cart_pole"),
    ("double_pendulum", "double_pendulum_angles"),
];

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-env-changed=HAMEL_CASADI");
    let folder = std::env::var("HAMEL_CASADI")
        .map_err(|_| "HAMEL_CASADI is not set: start this by lab/casadi/run.sh")?;
    let models = Path::new(&folder).join("models");
    println!("cargo:rerun-if-changed={}", models.display());
    let tests = Path::new("../../tests/models");
    let mut list: Vec<(String, PathBuf, bool)> = SMALL
        .iter()
        .map(|(name, file)| (name.to_string(), tests.join(format!("{file}.eom")), false))
        .collect();
    let mut trees: Vec<PathBuf> = std::fs::read_dir(models)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    trees.sort();
    for path in trees {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        list.push((stem.into_owned(), path, true));
    }

    let mut builder = hamel_codegen::Builder::new();
    let mut text = String::new();
    let mut all = String::from("pub fn models() -> Vec<Box<dyn Model>> {\n    vec![\n");
    for (name, path, inverse) in list {
        println!("cargo:rerun-if-changed={}", path.display());
        let description = std::fs::read_to_string(&path)?;
        let system = description
            .split_once("pub system ")
            .and_then(|(_, rest)| rest.split_whitespace().next())
            .ok_or("a description without a system")?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        writeln!(
            text,
            "pub mod {name} {{ include!(concat!(env!(\"OUT_DIR\"), \"/{stem}.rs\")); }}"
        )?;
        let inverse = if inverse {
            "Some(|s, x, xi, a| s.inverse_dynamics(x, xi, a))"
        } else {
            "None"
        };
        writeln!(
            all,
            "        Box::new(Generated::new({name:?}, {name}::{system}::<f64>::default(), {inverse})),"
        )?;
        builder = builder.file(path);
    }
    builder.generate()?;
    all.push_str("    ]\n}\n");
    let out = PathBuf::from(std::env::var("OUT_DIR")?).join("models.rs");
    std::fs::write(out, text + &all)?;
    Ok(())
}
