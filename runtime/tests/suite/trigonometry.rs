//! Sine and cosine of `f64` beside those of the C library.

use hamel::Scalar;

/// Both functions have errors below one spacing of numbers at the result.
const SPACINGS: f64 = 2.0;
/// Of the function that vanishes at a multiple of π/2.
const ABSOLUTE: f64 = 1e-26;

fn spacing(value: f64) -> f64 {
    f64::from_bits(value.abs().to_bits() + 1) - value.abs()
}

/// Angles of all sizes, and next to multiples of π/2.
fn angles() -> impl Iterator<Item = f64> {
    let sizes = (0..40_000).map(|k| {
        let k = f64::from(k);
        (1e-9 * (k * 8.6e-4).exp()) * (1.0 + 0.3 * (k * 0.77).fract())
    });
    let quarters = (0..20_000).flat_map(|k| {
        let near = f64::from(k * 31) * std::f64::consts::FRAC_PI_2;
        [-3, -1, 0, 1, 2].map(|step: i64| near.abs().to_bits().wrapping_add_signed(step))
    });
    sizes
        .chain(quarters.map(f64::from_bits))
        .filter(|x| x.is_finite())
}

#[test]
fn sine_and_cosine_are_those_of_the_c_library() {
    let mut worst = [0.0_f64; 2];
    for x in angles() {
        let (sine, cosine) = Scalar::sin_cos(x);
        for (i, (found, known)) in [(sine, x.sin()), (cosine, x.cos())].into_iter().enumerate() {
            let error = (found - known).abs();
            if error > ABSOLUTE {
                worst[i] = worst[i].max(error / spacing(known));
            }
        }
    }
    assert!(worst.iter().all(|&most| most < SPACINGS), "{worst:?}");
}

/// Rounding is symmetric: sin(−x) = −sin x and cos(−x) = cos x to the bit, signs of zero included.
#[test]
fn sine_is_odd_and_cosine_is_even() {
    for x in angles().chain([0.0, f64::MIN_POSITIVE]) {
        let ((sine, cosine), (odd, even)) = (Scalar::sin_cos(x), Scalar::sin_cos(-x));
        assert_eq!(odd.to_bits(), (-sine).to_bits(), "sin {x}");
        assert_eq!(even.to_bits(), cosine.to_bits(), "cos {x}");
    }
}

#[test]
fn far_angles_are_reduced_and_no_angle_has_no_sine() {
    for x in [1.000_001e6_f64, -7.3e11, 1e300] {
        assert_eq!(Scalar::sin_cos(x), (x.sin(), x.cos()));
    }
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (sine, cosine) = Scalar::sin_cos(x);
        assert!(sine.is_nan() && cosine.is_nan());
    }
}

/// log1p and expm1 keep their digits near 0, in dual numbers too, and have their limits.
#[test]
fn log1p_and_expm1_are_those_of_the_c_library() {
    let mut worst = [0.0_f64; 3];
    let near = [1e-300, 1e-17, 1e-16, 3e-16, 1e-9, 1e-4];
    let few = |x: &f64| x.abs() < 20.0;
    for x in angles().filter(few).chain(near).flat_map(|x| [x, -x]) {
        let off = |found: f64, known: f64| (found - known).abs() / spacing(known);
        worst[0] = worst[0].max(off(Scalar::exp_m1(x), f64::exp_m1(x)));
        if x > -0.999 {
            worst[1] = worst[1].max(off(Scalar::ln_1p(x), f64::ln_1p(x)));
            let both = hamel::Dual::<f64, 1>::along(x, 0);
            let round = Scalar::ln_1p(Scalar::exp_m1(both));
            worst[2] = worst[2].max((round.slopes[0] - 1.0).abs() / f64::EPSILON / x.abs().exp());
        }
    }
    assert!(worst.iter().all(|&most| most < 12.0), "{worst:?}");
    let [inf, nan] = [f64::INFINITY, f64::NAN];
    assert_eq!(
        [Scalar::exp_m1(-1e4_f64), Scalar::exp_m1(1e4_f64)],
        [-1.0, inf]
    );
    assert_eq!([Scalar::ln_1p(inf), Scalar::ln_1p(-1.0_f64)], [inf, -inf]);
    assert!(
        [
            Scalar::ln_1p(-2.0_f64),
            Scalar::ln_1p(nan),
            Scalar::exp_m1(nan)
        ]
        .iter()
        .all(|x| x.is_nan())
    );
}

/// Hyperbolic functions keep their digits, near 0 and where their series end, and have their limits.
#[test]
fn hyperbolic_functions_are_those_of_the_c_library() {
    let mut worst = [0.0_f64; 3];
    let few = |x: &f64| x.abs() < 20.0;
    for x in angles().filter(few).flat_map(|x| [x, -x]) {
        let found = [Scalar::sinh(x), Scalar::cosh(x), Scalar::tanh(x)];
        let known = [x.sinh(), x.cosh(), x.tanh()];
        for ((worst, found), known) in worst.iter_mut().zip(found).zip(known) {
            *worst = worst.max((found - known).abs() / spacing(known));
        }
    }
    assert!(worst.iter().all(|&most| most < 12.0), "{worst:?}");
    assert_eq!([Scalar::tanh(1e3_f64), Scalar::tanh(-1e3_f64)], [1.0, -1.0]);
    assert_eq!(
        (Scalar::sinh(0.0_f64), Scalar::sinh(1e3_f64)),
        (0.0, f64::INFINITY)
    );
    assert!(Scalar::tanh(f64::NAN).is_nan());
}
