//! Generates the mechanisms whose descriptions are too long for a macro.

fn main() -> Result<(), hamel_codegen::BuildError> {
    hamel_codegen::Builder::new().file("bicycle.eom").generate()
}
