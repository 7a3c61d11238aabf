//! Writes descriptions of a chain of 16 links, of a tree of the size of a humanoid robot, and of a robot with four
//! legs, and generates their code, with derivatives for the chain and the legs.

use common::Random;
use std::path::PathBuf;

#[path = "../../tests/src/chain.rs"]
mod chain;
#[path = "../../codegen/tests/suite/common/mod.rs"]
mod common;
#[path = "src/quadruped.rs"]
mod quadruped;
#[path = "../../codegen/tests/suite/common/tree/mod.rs"]
mod tree;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo:rerun-if-changed=../src/chain.rs");
    println!("cargo:rerun-if-changed=../../codegen/tests/suite/common");
    let folder = PathBuf::from(std::env::var("OUT_DIR")?);
    let chain = chain::chain(16).replace("accel, rate;", "accel, rate, linearize;");
    let humanoid = tree::text(&tree::humanoid(), "accel, inverse_dynamics");
    let humanoid = humanoid.replacen("system Tree", "/// 38 freedoms.\npub system Humanoid", 1);
    let mut builder = hamel_codegen::Builder::new();
    let texts = [
        ("chain", chain),
        ("humanoid", humanoid),
        ("quadruped", quadruped::quadruped()),
    ];
    for (name, text) in texts {
        let path = folder.join(name).with_extension("eom");
        std::fs::write(&path, text)?;
        builder = builder.file(path);
    }
    builder.generate()?;
    Ok(())
}
