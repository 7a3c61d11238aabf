//! The build script's door.

fn main() -> Result<(), hamel_codegen::BuildError> {
    hamel_codegen::Builder::new()
        .file("pendulum.eom")
        .generate()
}
