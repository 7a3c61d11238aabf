//! The build script's front end.

fn main() -> Result<(), hamel_codegen::BuildError> {
    hamel_codegen::Builder::new()
        .file("pendulum.eom")
        .generate()
}
