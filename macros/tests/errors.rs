//! The macro in the compiler: errors stand inside of the description.

#[test]
fn errors_are_placed_in_the_description() {
    let cases = trybuild::TestCases::new();
    cases.pass("tests/ui/right.rs");
    cases.compile_fail("tests/ui/wrong_*.rs");
}
