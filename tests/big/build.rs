//! Writes the description of a chain of 20 links and generates its code.

use std::path::PathBuf;

#[path = "../src/chain.rs"]
mod chain;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo:rerun-if-changed=../src/chain.rs");
    let path = PathBuf::from(std::env::var("OUT_DIR")?).join("chain.eom");
    std::fs::write(&path, chain::chain(20))?;
    hamel_codegen::Builder::new().file(path).generate()?;
    Ok(())
}
