//! Writes the description of a chain of 16 links and generates its code, derivatives included.

use std::path::PathBuf;

#[path = "../src/chain.rs"]
mod chain;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo:rerun-if-changed=../src/chain.rs");
    let path = PathBuf::from(std::env::var("OUT_DIR")?).join("chain.eom");
    let text = chain::chain(16).replace("accel, rate;", "accel, rate, linearize;");
    std::fs::write(&path, text)?;
    hamel_codegen::Builder::new().file(path).generate()?;
    Ok(())
}
