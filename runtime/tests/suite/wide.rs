//! SIMD lanes against the numbers that they are made of.

use crate::common::{Body, Reference, Top, distance, run};
use hamel::adaptive::Adaptive;
use hamel::methods::{General, Scheme, Splitting};
use hamel::wide::{f32x8, f32x16, f64x4, f64x8};
use hamel::{Lanes, Scalar, State, StepError};

/// Of sine and cosine, in spacings of numbers at 1: as documented.
const TRIGONOMETRIC: f64 = 1.0;
/// Of the other functions, relative, in spacings of numbers at 1: as documented.
const OTHER: f64 = 4.0;

/// Numbers of all magnitudes and signs, and those at which functions break.
fn arguments(count: usize) -> Vec<f64> {
    let special = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        1e-320,
        -1e-320,
        1e-40,
        f64::MIN_POSITIVE,
        1e300,
        -1e300,
        1e10,
        -3e6,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
        709.0,
        -709.0,
        -744.0,
        750.0,
        -750.0,
        0.5,
    ];
    let spread = (0..count).map(|k| {
        let exponent = -30.0 + 50.0 * ((k as f64 * 0.618_034) % 1.0);
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        sign * exponent.exp2()
    });
    let turns = (0..count).map(|k| (k as f64 - count as f64 / 2.0) * std::f64::consts::FRAC_PI_4);
    special.into_iter().chain(spread).chain(turns).collect()
}

/// Relative for large values of the function, absolute where `absolute`; equal specials are no error.
fn error(found: f64, expected: f64, absolute: bool) -> f64 {
    if found == expected || (found.is_nan() && expected.is_nan()) {
        0.0
    } else if absolute {
        (found - expected).abs()
    } else {
        ((found - expected) / expected).abs()
    }
}

/// Compares all functions of a kind of lanes with those of their element.
fn functions_agree<L: Lanes>()
where
    L::Element: Into<f64>,
{
    type Unary<S> = (&'static str, fn(S) -> S, f64, bool);
    fn functions<S: Scalar>() -> [Unary<S>; 6] {
        [
            ("sin", |v| v.sin_cos().0, TRIGONOMETRIC, true),
            ("cos", |v| v.sin_cos().1, TRIGONOMETRIC, true),
            ("exp", |v| v.exp(), OTHER, false),
            ("ln", |v| v.ln(), OTHER, false),
            ("sqrt", |v| v.sqrt(), 0.0, false),
            ("abs", |v| v.abs(), 0.0, false),
        ]
    }
    let arguments: Vec<L::Element> = arguments(4000).into_iter().map(Scalar::from_f64).collect();
    let at = |k: usize| arguments[k % arguments.len()];
    // Numbers below the normal ones have fewer digits.
    let tiny = if L::EPSILON < 1e-10 {
        f64::MIN_POSITIVE
    } else {
        f64::from(f32::MIN_POSITIVE)
    };
    for ((name, wide, most, absolute), (_, single, ..)) in
        functions::<L>().into_iter().zip(functions::<L::Element>())
    {
        for start in (0..arguments.len()).step_by(L::COUNT) {
            let found = wide(L::from_lanes(|lane| at(start + lane)));
            for (lane, found) in found.lanes().as_ref().iter().enumerate() {
                let argument: f64 = at(start + lane).into();
                let (found, expected) = ((*found).into(), single(at(start + lane)).into());
                let error = error(found, expected, absolute || expected.abs() < tiny);
                assert!(
                    error <= most * L::EPSILON,
                    "{name}({argument:e}): {found:e}, not {expected:e}: {:.2}",
                    error / L::EPSILON
                );
            }
        }
    }
    for (start, step) in (0..arguments.len()).step_by(L::COUNT).zip(1..) {
        let other = |lane: usize| at(7 * start + step * (lane + 1));
        let (y, x) = (L::from_lanes(|lane| at(start + lane)), L::from_lanes(other));
        let (angle, larger) = (y.atan2(x), Scalar::max(y, x));
        let chosen = y.select_lt(x, L::from_f64(1.0), L::from_f64(2.0));
        for lane in 0..L::COUNT {
            let (a, b) = (at(start + lane), other(lane));
            let pair: (f64, f64) = (a.into(), b.into());
            let (found, expected) = (angle.lanes().as_ref()[lane].into(), a.atan2(b).into());
            let error = error(found, expected, expected.abs() < tiny);
            assert!(
                error <= OTHER * L::EPSILON,
                "atan2{pair:?}: {found:e}, not {expected:e}"
            );
            let found: f64 = larger.lanes().as_ref()[lane].into();
            let expected: f64 = Scalar::max(a, b).into();
            assert!(
                found == expected || (found.is_nan() && expected.is_nan()),
                "max{pair:?}"
            );
            let found: f64 = chosen.lanes().as_ref()[lane].into();
            assert_eq!(found, if pair.0 < pair.1 { 1.0 } else { 2.0 }, "{pair:?}");
        }
    }
}

#[test]
fn functions_of_lanes_agree_with_those_of_their_elements() {
    functions_agree::<f64x4>();
    functions_agree::<f64x8>();
    functions_agree::<f32x8>();
    functions_agree::<f32x16>();
}

fn guards<L: Lanes>() {
    let one = |bad: f64| L::from_lanes(|lane| Scalar::from_f64(if lane == 1 { bad } else { 2.0 }));
    let subnormal = if L::EPSILON > 1e-10 { 1e-40 } else { 1e-310 };
    for bad in [0.0, -0.0, -1.0, subnormal, f64::INFINITY, f64::NAN] {
        assert!(!one(bad).is_positive(), "{bad}");
        assert_eq!(one(bad).is_finite(), bad.is_finite(), "{bad}");
    }
    assert!(one(1e-30).is_positive() && one(1e-30).is_finite());
    assert_eq!(one(-3.0).largest_lane(), 2.0);
    assert_eq!(one(5.0).largest_lane(), 5.0);
    assert!(one(f64::NAN).largest_lane().is_nan());
    assert_eq!(L::default().largest_lane(), 0.0);
}

#[test]
fn one_bad_lane_is_noticed() {
    guards::<f64x4>();
    guards::<f64x8>();
    guards::<f32x8>();
    guards::<f32x16>();
}

/// The same top in every lane, started with another spin each.
fn tops() -> (Vec<Body<f64>>, Body<f64x4>) {
    let body = Reference::read("kovalevskaya-top").body();
    let bodies: Vec<Body<f64>> = (0..4)
        .map(|lane| Body {
            w0: body.w0.map(|w: f64| w * (1.0 + 0.2 * f64::from(lane))),
            ..body.clone()
        })
        .collect();
    let together = Body {
        inertia: body.inertia.map(f64x4::from_f64),
        m: f64x4::from_f64(body.m),
        s: body.s.map(f64x4::from_f64),
        g: body.g.map(f64x4::from_f64),
        r0: body.r0.map(f64x4::from_f64),
        w0: std::array::from_fn(|i| f64x4::from_lanes(|lane| bodies[lane].w0[i])),
    };
    (bodies, together)
}

fn lane<const N: usize>(list: [f64x4; N], index: usize) -> [f64; N] {
    list.map(|value| value.lanes()[index])
}

#[test]
fn methods_without_other_functions_are_equal_to_the_bit() -> Result<(), StepError> {
    let (bodies, together) = tops();
    for method in [General::Rkmk4, General::Cf4, General::Rkmk8] {
        let end = run(&Top(together.clone()), method, 1.0, 500)?;
        for (index, body) in bodies.iter().enumerate() {
            let alone = run(&Top(body.clone()), method, 1.0, 500)?;
            assert_eq!(lane(end.x, index), alone.x, "{method:?}");
            assert_eq!(lane(end.xi, index), alone.xi, "{method:?}");
        }
    }
    Ok(())
}

#[test]
fn closed_forms_agree() -> Result<(), StepError> {
    let (bodies, together) = tops();
    let top = Top(together);
    let end = run(&top, Splitting::new(&top, Scheme::Nystrom6), 1.0, 20)?;
    for (index, body) in bodies.into_iter().enumerate() {
        let alone = Top(body);
        let method = Splitting::new(&alone, Scheme::Nystrom6);
        let error = distance(lane(end.x, index), run(&alone, method, 1.0, 20)?.x);
        // Rounding of the functions in 220 flows.
        assert!(error < 1e-12, "{error:e}");
    }
    Ok(())
}

#[test]
fn adaptive_steps_serve_the_worst_lane() -> Result<(), StepError> {
    let (bodies, together) = tops();
    let system = Top(together);
    let mut state = State::start(&system);
    Adaptive::rkmk54(1e-8).run(&system, &mut state, 1.0, |_, _, _| [])?;
    for (index, body) in bodies.into_iter().enumerate() {
        let alone = Top(body);
        let mut exact = State::start(&alone);
        Adaptive::rkmk8(1e-13).run(&alone, &mut exact, 1.0, |_, _, _| [])?;
        let error = distance(lane(state.x, index), exact.x);
        // A hundred times the tolerance, as for single runs.
        assert!(error < 1e-6, "{error:e}");
    }
    Ok(())
}

/// Without `std` a lane may round its fused products once where a number rounds twice.
#[cfg(feature = "std")]
#[test]
fn sine_and_cosine_of_lanes_are_those_of_numbers() {
    for k in 0..40_000_i32 {
        let angle = |lane: usize| f64::from(k - 20_000) * (0.1 + 5.0 * lane as f64);
        let (sine, cosine) = Scalar::sin_cos(f64x8::from_lanes(angle));
        for (lane, both) in sine.lanes().into_iter().zip(cosine.lanes()).enumerate() {
            assert_eq!(both, Scalar::sin_cos(angle(lane)), "{}", angle(lane));
        }
    }
}
