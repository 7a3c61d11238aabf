//! Generates the code of a chain of 16 links, of a tree of the size of a humanoid robot, and of a robot with four legs,
//! with derivatives for the chain and the legs.

fn main() -> Result<(), hamel_codegen::BuildError> {
    hamel_codegen::Builder::new()
        .file("models/chain.eom")
        .file("models/humanoid.eom")
        .file("models/quadruped.eom")
        .generate()
}
