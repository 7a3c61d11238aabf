//! Generates the pendulum through the front end for build scripts.

fn main() -> Result<(), hamel_codegen::BuildError> {
    hamel_codegen::Builder::new()
        .file("pendulum.eom")
        .generate()
}
