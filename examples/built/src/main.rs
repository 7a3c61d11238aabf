//! Mechanisms described in Rust, without a text: a drone, and a chain of ten links.
//!
//! `cargo run -p built` prints the tables of both and the length of the code generated for them. A test generates the
//! same code from textual descriptions.

mod chain;
mod drone;

use hamel_codegen::scene::Scene;
use hamel_codegen::tables::text;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    for scene in [drone::drone()?, chain::chain(10)?] {
        print(&scene)?;
    }
    Ok(())
}

/// Prints the tables of a mechanism and the length of its code.
fn print(scene: &Scene) -> Result<(), Box<dyn Error>> {
    let generated = scene.generate()?;
    println!("{}", text(&generated.tables(&[])?, false));
    let lines = scene.rust(&generated)?.lines().count();
    let functions = generated.program.functions.len();
    println!("{functions} functions in {lines} lines of Rust\n");
    Ok(())
}

#[cfg(test)]
mod tests {
    use hamel_codegen::scene::Scene;

    /// Returns the code without its header, which names the source of the description.
    fn code(scene: &Scene) -> String {
        let generated = scene.generate().expect("a correct description");
        let file = scene.rust(&generated).expect("Rust");
        let (_, code) = file.split_once("\n\n").expect("a head");
        code.to_string()
    }

    #[test]
    fn the_drone_is_that_of_its_text() {
        let text = include_str!("../../../tests/models/drone.eom");
        let written = Scene::parse(text).expect("a description");
        assert_eq!(code(&super::drone::drone().expect("built")), code(&written));
    }

    #[test]
    fn the_chain_is_that_of_its_text() {
        let written = Scene::parse(include_str!("../chain.eom")).expect("a description");
        let built = super::chain::chain(10).expect("built");
        let built = code(&built);
        assert_eq!(built, code(&written));
        // A chain of nine links is another mechanism.
        assert_ne!(code(&super::chain::chain(9).expect("built")), built);
    }
}
