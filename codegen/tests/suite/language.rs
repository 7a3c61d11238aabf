//! Numbers in generated C.

use hamel_codegen::emit::c::Precision::{Double, Float};

#[test]
fn literals_read_as_the_numbers_that_they_are() {
    let cases = [
        (0.1, "0.1", "0.1f"),
        (1.0, "1.0", "1.0f"),
        (1e300, "1e300", "HUGE_VALF"),
        (1e-300, "1e-300", "0.0f"),
        (-2.5, "(-2.5)", "(-2.5f)"),
        (f64::INFINITY, "HUGE_VAL", "HUGE_VALF"),
        (f64::NEG_INFINITY, "(-HUGE_VAL)", "(-HUGE_VALF)"),
        (f64::NAN, "NAN", "NAN"),
        (1.0 / 3.0, "0.3333333333333333", "0.33333334f"),
    ];
    for (value, double, float) in cases {
        assert_eq!(Double.literal(value), double);
        assert_eq!(Float.literal(value), float);
    }
}
