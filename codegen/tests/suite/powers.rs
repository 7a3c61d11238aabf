//! Powers with a fractional exponent at base 0: contacts in the air, friction and drag at rest.

use crate::common::{generated, value};

/// Returns the slopes of ẇ by (z, w) at a state, the last entries of A.
fn slopes(of: &hamel_codegen::generate::Generated, x: &[f64], xi: &[f64]) -> [f64; 2] {
    let all = value(of, "linearize", [x, xi, &[], &[]]);
    assert!(all.iter().all(|entry| entry.is_finite()), "{all:?}");
    [all[2], all[3]]
}

fn system(statements: &str) -> String {
    format!(
        "system S {{ param k = 100; coord z; velocity w; rate z = w; kinetic w^2 / 2;
            {statements} start z = 1; generate all, linearize; }}"
    )
}

/// Hertz and Hunt-Crossley contacts have no force in the air, and the slopes of their laws in the ground.
#[test]
fn a_contact_in_the_air_does_nothing() {
    for (law, p) in [
        ("max(0, -z)^(5/2)", 2.5),
        ("max(-z, 0)^2.3", 2.3),
        ("max(-z, 0)^(3/2)", 1.5),
        ("max(-z, 0)^(4/3)", 4.0 / 3.0),
        ("(if z < 0 { -z } else { 0 })^2.1", 2.1),
    ] {
        let of = generated(&system(&format!("potential k * ({law});")));
        let force = |z: f64| value(&of, "potential_force", [&[z], &[0.0], &[], &[]])[0];
        assert_eq!(force(1.0), 0.0, "{law}");
        assert_eq!(
            value(&of, "accel", [&[1.0], &[0.3], &[], &[]]),
            [0.0],
            "{law}"
        );
        assert_eq!(slopes(&of, &[1.0], &[0.3]), [0.0, 0.0], "{law}");
        let expected = 100.0 * p * 0.25_f64.powf(p - 1.0);
        assert!((force(-0.25) + expected).abs() < 1e-11, "{law}");
        let [by_z, _] = slopes(&of, &[-0.25], &[0.0]);
        let expected = 100.0 * p * (p - 1.0) * 0.25_f64.powf(p - 2.0);
        assert!((by_z + expected).abs() < 1e-11 * expected, "{law}: {by_z}");
    }
}

/// The slopes of forces at 0 are 0 if the exponent exceeds 1; elsewhere they are those of the laws.
#[test]
fn forces_by_powers_have_slopes_at_zero() {
    let third = 0.25_f64.powf(1.0 / 3.0);
    let cases: [(&str, f64, f64); 13] = [
        ("k * max(0, -z)^1.3", 0.0, 0.0),
        ("abs(z)^(4/3) * sign(z)", 4.0 / 3.0 * third, 0.0),
        (
            "(z^2 + w^2)^(4/3)",
            8.0 / 3.0 * 0.25 * 0.125_f64.powf(1.0 / 3.0),
            8.0 / 3.0 * 0.25 * 0.125_f64.powf(1.0 / 3.0),
        ),
        (
            "k * norm([z, w])^(7/3)",
            700.0 / 3.0 * 0.25 * 0.125_f64.powf(1.0 / 6.0),
            700.0 / 3.0 * 0.25 * 0.125_f64.powf(1.0 / 6.0),
        ),
        ("k * max(0, -z)^(3/2)", 0.0, 0.0),
        ("k * max(0, -z)^(5/2)", 0.0, 0.0),
        ("-abs(w)^(3/2) * sign(w)", 0.0, -1.5 * 0.5),
        ("abs(z)^(3/2) * sign(z)", 1.5 * 0.5, 0.0),
        ("z^(3/2)", 1.5 * 0.5, 0.0),
        ("abs(z)^(5/2)", 2.5 * 0.125, 0.0),
        ("-0.3 * w * sqrt(abs(w))", 0.0, -0.3 * 1.5 * 0.5),
        ("k * z * sqrt(k * z)", 1000.0 * 1.5 * 0.5, 0.0),
        ("-w * k * sqrt(abs(w))", 0.0, -150.0 * 0.5),
    ];
    for (law, by_z, by_w) in cases {
        let of = generated(&system(&format!("generalized force w = {law};")));
        assert_eq!(slopes(&of, &[0.0], &[0.0]), [0.0, 0.0], "{law}");
        let found = slopes(&of, &[0.25], &[0.25]);
        for (found, expected) in found.into_iter().zip([by_z, by_w]) {
            assert!(
                (found - expected).abs() < 1e-12 * expected.abs().max(1.0),
                "{law}: {found}"
            );
        }
    }
}

/// A mass with an infinite inverse is refused.
#[test]
fn a_subnormal_pivot_is_refused() {
    use hamel_codegen::program::interpret::Interpreter;
    let of = generated(
        "system P { param m = 1e-310; coord q; velocity w; rate q = w; kinetic m * (1 + q^2) * w^2 / 2;
            potential q; }",
    );
    let accel = of.program.function("accel").expect("it is there");
    for (m, fine) in [(1e-310, false), (3e-308, true), (0.0, false), (1.0, true)] {
        let compiled = Interpreter::new(&of.program, accel, &[m]);
        let found = compiled.call_with([&[0.0], &[0.0], &[], &[], &[]]);
        assert_eq!(found.is_ok(), fine, "{m}: {found:?}");
        assert!(found.iter().flatten().all(|entry| entry.is_finite()));
    }
}

/// √(c a⁴ b⁶) = √c a² |b| b² has slopes at a = 0 and b = 0.
#[test]
fn roots_of_even_powers_have_slopes_everywhere() {
    type Case = (&'static str, fn(f64) -> f64, f64);
    let cases: [Case; 7] = [
        ("sqrt(q^4)", |q| 2.0 * q, 0.0),
        ("sqrt(4 * q^4)", |q| 4.0 * q, 0.0),
        ("sqrt(q^6)", |q| 3.0 * q * q.abs(), 0.0),
        ("sqrt(2 * q^8)", |q| 4.0 * 2.0_f64.sqrt() * q.powi(3), 0.0),
        ("sqrt(sqrt(q^8))", |q| 2.0 * q, 0.0),
        ("sqrt(k^2 * q^4)", |q| 6.0 * q, 0.0),
        (
            "sqrt((q - 0.5)^4 * (q + 1)^4)",
            |q| 2.0 * (q - 0.5) * (q + 1.0) * (2.0 * q + 0.5),
            -0.5,
        ),
    ];
    for (potential, slope, at_zero) in cases {
        let of = generated(&format!(
            "system Q {{ param k = -3; coord q; velocity v; rate q = v; kinetic v^2 / 2; potential {potential}; }}"
        ));
        let accel = |q: f64| value(&of, "accel", [&[q], &[0.3], &[], &[]])[0];
        assert_eq!(accel(0.0), -at_zero, "{potential}");
        for q in [-0.7, 0.3, 1.9] {
            assert!(
                (accel(q) + slope(q)).abs() < 1e-12,
                "{potential} at {q}: {}",
                accel(q)
            );
        }
    }
}
