//! Numbers in doubled precision: their arithmetic, their functions, and the laws of these.

use hamel_algebra::double::Double;
use num_bigint::BigInt;
use num_rational::BigRational;

/// Parses a number from its decimal digits.
fn decimal(text: &str) -> Double {
    let (whole, digits) = text.split_once('.').expect("a point");
    let numerator: BigInt = format!("{whole}{digits}").parse().expect("digits");
    let denominator = BigInt::from(10).pow(digits.len() as u32);
    Double::of_rational(&BigRational::new(numerator, denominator))
}

fn close(a: Double, b: Double) {
    let apart = (a - b).abs().to_f64();
    let size = b.abs().to_f64();
    assert!(apart <= 4e-31 * size, "{a:?} and {b:?} differ by {apart:e}");
}

#[test]
fn arithmetic_inverts_itself() {
    let (a, b) = (
        decimal("3.1415926535897932384626433832795029"),
        decimal("0.0001234567890123456789012345678901"),
    );
    close(a / b * b, a);
    close(a - b + b, a);
    close(a.sqrt() * a.sqrt(), a);
    close(a, Double::PI);
    assert_eq!((Double::new(1.0) + Double::new(1e-20)).to_f64(), 1.0);
    assert_eq!(
        (Double::new(1.0) + Double::new(1e-20) - Double::ONE).to_f64(),
        1e-20
    );
}

/// Compares with table values of 34 digits.
#[test]
fn functions_have_their_values() {
    let one = Double::ONE;
    let (sin, cos) = one.sin_cos();
    close(sin, decimal("0.8414709848078965066525023216302990"));
    close(cos, decimal("0.5403023058681397174009366074429766"));
    close(one.exp(), decimal("2.7182818284590452353602874713526625"));
    close(
        decimal("10.0").log(),
        decimal("2.3025850929940456840179914546843642"),
    );
    close(one.atan2(one) * Double::new(4.0), Double::PI);
    close(
        (-one).atan2(-one) * Double::new(-4.0),
        Double::PI * Double::new(3.0),
    );
    close(
        decimal("2.0").sqrt(),
        decimal("1.4142135623730950488016887242096981"),
    );
}

#[test]
fn functions_obey_their_laws() {
    for k in -40..40 {
        let a = Double::new(f64::from(k) * 0.37) / Double::new(1.7);
        let (sin, cos) = a.sin_cos();
        close(sin * sin + cos * cos, Double::ONE);
        let (twice, _) = (a + a).sin_cos();
        assert!((twice - sin * cos * Double::new(2.0)).abs().to_f64() < 1e-30);
        close(a.exp() * (-a).exp(), Double::ONE);
        close(a.abs().sinh() + a.cosh(), a.abs().exp());
        close(a.tanh() * a.cosh(), a.sinh());
        let tiny = a * Double::new(1e-9);
        for a in [a, tiny] {
            let near = |found: Double, expected: Double, bound: f64| {
                let error = (found - expected).abs().to_f64();
                assert!(error <= bound * expected.abs().to_f64(), "{a:?}: {error:e}");
            };
            // expm1(a) (1 + e⁻ᵃ) = 2 sinh a, without a difference; log1p is its inverse.
            let twice = a.abs().sinh() * Double::new(2.0);
            near(
                a.abs().expm1() * (Double::ONE + (-a.abs()).exp()),
                twice,
                1e-29,
            );
            near(a.expm1().log1p(), a, 1e-27);
        }
        if k != 0 {
            assert!((a.abs().log().exp() - a.abs()).abs().to_f64() < 1e-30 * a.abs().to_f64());
        }
        let turned = sin.atan2(cos).sin_cos();
        assert!((turned.0 - sin).abs().to_f64() < 1e-31 && (turned.1 - cos).abs().to_f64() < 1e-31);
    }
}
