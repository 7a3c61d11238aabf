//! Slopes of the torque-free flow in closed form, by P, by the moments and by the time, against differences of the flow:
//! for any motion, about principal axes, at rest, with equal moments, and over many turns.

use hamel::flows::{Attitude, exact};
use hamel::rotor::{Rotor, Symmetry};
use hamel::{Dual, s3, so3};

type Number = Dual<f64, 7>;

/// P, the moments, and the time.
type Motion = [f64; 7];

/// The attitude and P at the end.
fn end<const N: usize>(start: [f64; N], motion: Motion) -> Vec<f64>
where
    [f64; N]: Attitude<f64>,
{
    let [a, b, c, i, j, k, h] = motion;
    let mut p = [a, b, c];
    let attitude = exact(start, &mut p, [i, j, k], h);
    attitude.into_iter().chain(p).collect()
}

/// The same with all slopes.
fn sloped<const N: usize>(start: [f64; N], motion: Motion) -> Vec<Number>
where
    [Number; N]: Attitude<Number>,
{
    let entries: [Number; 7] = std::array::from_fn(|d| Number::along(motion[d], d));
    let [a, b, c, i, j, k, h] = entries;
    let mut p = [a, b, c];
    let attitude = exact(start.map(Number::constant), &mut p, [i, j, k], h);
    attitude.into_iter().chain(p).collect()
}

/// Fourth-order differences, and the slopes.
fn agree<const N: usize>(start: [f64; N], motion: Motion)
where
    [f64; N]: Attitude<f64>,
    [Number; N]: Attitude<Number>,
{
    let found = sloped(start, motion);
    let values = end(start, motion);
    // Small enough for the phase of the motion.
    let step = 2e-4 / (motion[2] * motion[6]).abs().sqrt().max(1.0);
    for d in 0..7 {
        let at = |k: f64| {
            let mut beside = motion;
            beside[d] += k * step;
            end(start, beside)
        };
        let [near, before, far, behind] = [1.0, -1.0, 2.0, -2.0].map(at);
        for (i, number) in found.iter().enumerate() {
            let once = near[i] - before[i];
            let twice = far[i] - behind[i];
            let slope = (8.0 * once - twice) / (12.0 * step);
            let error = (number.slopes[d] - slope).abs() / slope.abs().max(1.0);
            assert!(
                error < 2e-8,
                "entry {i} by {d} of {motion:?}: {} for {slope}",
                number.slopes[d]
            );
            assert!((number.value - values[i]).abs() < 1e-14);
        }
    }
}

fn both(motion: Motion) {
    agree(so3::exp([0.3, -1.1, 0.6]), motion);
    agree(s3::exp([0.3, -1.1, 0.6]), motion);
}

#[test]
fn over_short_times_and_many_turns() {
    for p in [[0.6, -3.4, 0.8], [-0.4, 0.3, 2.0], [1.5, 0.2, -0.1]] {
        for h in [0.01, -0.3, 1.0, 3.0, 7.0] {
            let [a, b, c] = p;
            both([a, b, c, 2.1, 1.7, 1.2, h]);
        }
    }
}

#[test]
fn about_principal_axes() {
    for k in 0..3 {
        for moments in [[2.1, 1.7, 1.2], [1.2, 2.1, 1.7], [1.7, 1.2, 2.1]] {
            for (size, h) in [(1.3, 0.1), (-2.0, 0.7), (0.4, 3.0)] {
                let mut motion = [0.0; 7];
                motion[k] = size;
                motion[3..6].copy_from_slice(&moments);
                motion[6] = h;
                both(motion);
            }
        }
    }
}

#[test]
fn over_hundreds_of_radians() {
    both([0.0, 0.0, 2.0, 2.1, 1.7, 0.9, 400.0]);
}

#[test]
fn at_rest() {
    for h in [0.1, -2.0] {
        both([0.0, 0.0, 0.0, 2.1, 1.7, 1.2, h]);
    }
}

#[test]
fn with_equal_moments() {
    for p in [
        [0.6, -0.4, 0.8],
        [0.0, 0.0, 1.3],
        [0.3, 1.2, 0.1],
        [0.0, 0.6, 0.8],
    ] {
        for moments in [
            [0.5, 0.5, 0.2],
            [0.2, 0.5, 0.5],
            [0.5, 0.2, 0.5],
            [0.7, 0.7, 0.7],
        ] {
            for h in [0.1, 1.4] {
                let ([a, b, c], [i, j, k]) = (p, moments);
                both([a, b, c, i, j, k, h]);
            }
        }
    }
}

/// Moments whose slopes differ are not equal.
#[test]
fn a_rotor_is_symmetric_in_its_slopes_as_well() {
    let equal = [0.5, 0.5, 0.2].map(Number::constant);
    assert_eq!(Rotor::of_moments(equal).symmetry, Symmetry::Axial(2));
    let varied = std::array::from_fn(|d| Number::along([0.5, 0.5, 0.2][d], d));
    assert_eq!(Rotor::of_moments(varied).symmetry, Symmetry::None);
    let mut inertia = [0.5, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.2].map(Number::constant);
    assert!(Rotor::general(inertia).axes.is_none());
    (inertia[1], inertia[3]) = (Number::along(0.0, 0), Number::along(0.0, 0));
    assert!(Rotor::general(inertia).axes.is_some());
}
