//! Rotations: exponentials and logarithms, their derivative, and the coordinate kinds.

use approx::assert_relative_eq;
use hamel::{Block, Scalar, manifold, s1, s3, so3};
use so3::Vector;
use std::f64::consts::PI;

fn norm(u: Vector<f64>) -> f64 {
    so3::dot(u, u).sqrt()
}

fn largest(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .fold(0.0, |m, (a, b)| f64::max(m, (a - b).abs()))
}

/// Directions in general position and along axes.
const AXES: [Vector<f64>; 6] = [
    [1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.6, 0.0, -0.8],
    [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0],
    [-6.0 / 7.0, 2.0 / 7.0, 3.0 / 7.0],
];

/// Nine entries of size one, each rounded a few times: 1.1e-15 is seen close to half a turn.
const ORTHONORMAL: f64 = 2e-15;

/// Angles below, at and above the limit of the series, and close to π.
const ANGLES: [f64; 15] = [
    0.0,
    5e-324,
    1e-310,
    1e-160,
    1e-20,
    1e-8,
    9.9e-3,
    1e-2,
    1.01e-2,
    0.4999,
    0.5,
    2.0,
    3.0,
    PI - 1e-6,
    PI - 1e-9,
];

#[test]
fn log_inverts_exp() {
    for axis in AXES {
        for angle in ANGLES {
            let u = axis.map(|a| a * angle);
            // Denormals have an absolute spacing of 5e-324.
            let tolerance = 4e-15 * angle + 1e-323;
            for back in [so3::log(so3::exp(u)), s3::log(s3::exp(u))] {
                assert!(largest(&back, &u) <= tolerance, "{u:?} {back:?}");
            }
            assert!(so3::defect(so3::exp(u)) < ORTHONORMAL);
            assert!(s3::defect(s3::exp(u)) < 1e-15);
            assert!(largest(&so3::exp(u), &s3::to_matrix(s3::exp(u))) < 1e-15);
        }
    }
}

#[test]
fn log_at_half_a_turn_gives_either_sign() {
    for axis in AXES {
        let u = axis.map(|a| a * PI);
        let back = so3::log(so3::exp(u));
        let same = largest(&back, &u).min(largest(&back, &u.map(|u| -u)));
        assert!(same < 1e-14, "{u:?} {back:?}");
    }
}

/// Matrices and quaternions of half turns to the bit: no rounding leaves the angle below π.
#[test]
fn exact_half_turns_have_logarithms_of_length_pi() {
    for axis in 0..3 {
        let mut r = so3::identity().map(|entry: f64| -entry);
        r[4 * axis] = 1.0;
        let mut expected = [0.0; 3];
        expected[axis] = PI;
        assert_eq!(so3::log(r).map(f64::abs), expected);
    }
    for n in AXES {
        // 2 n nᵀ − I, and (0, n).
        let r = std::array::from_fn(|k| {
            let (i, j) = (k / 3, k % 3);
            2.0 * n[i] * n[j] - if i == j { 1.0 } else { 0.0 }
        });
        let by_unit = s3::log([0.0, n[0], n[1], n[2]]);
        assert!(largest(&by_unit, &n.map(|n| PI * n)) < 1e-15, "{by_unit:?}");
        let back = so3::log(r);
        assert!((norm(back) - PI).abs() < 1e-15, "{back:?}");
        assert!(largest(&so3::exp(back), &r) < 1e-15, "{back:?}");
        // The rate of the rotation vector is finite there: parallel to n it is that of the angle.
        let rate = so3::dexpinv(n.map(|n| PI * n), n);
        assert!(largest(&rate, &n) < 1e-15, "{rate:?}");
    }
}

#[test]
fn cayley_turns_by_twice_the_arctangent() {
    for axis in AXES {
        for angle in ANGLES.into_iter().filter(|angle| *angle < 3.1) {
            let f = axis.map(|a| a * (0.5 * angle).tan());
            let r = so3::cayley(f);
            assert!(
                largest(&r, &so3::exp(axis.map(|a| a * angle))) < 2e-15,
                "{f:?}"
            );
            assert!(so3::defect(r) < ORTHONORMAL);
        }
    }
    assert_eq!(so3::cayley([0.0; 3]), so3::identity::<f64>());
}

#[test]
fn log_of_long_turns_and_of_the_antipode() {
    let u = AXES[4].map(|a| a * (2.0 * PI - 0.5));
    let short = AXES[4].map(|a| a * -0.5);
    assert!(largest(&so3::log(so3::exp(u)), &short) < 1e-14);
    let q = s3::exp(short);
    assert!(largest(&s3::log(q.map(|q| -3.0 * q)), &short) < 1e-15);
}

#[test]
fn zero_is_the_identity_exactly() {
    let zero = [0.0; 3];
    assert_eq!(so3::exp(zero), so3::identity::<f64>());
    assert_eq!(s3::exp(zero), [1.0, 0.0, 0.0, 0.0]);
    assert_eq!(s1::exp(0.0), [1.0, 0.0]);
    assert_eq!(so3::log(so3::identity::<f64>()), zero);
    assert_eq!(so3::dexpinv(zero, [1.0, -2.0, 3.0]), [1.0, -2.0, 3.0]);
}

#[test]
fn series_and_closed_forms_meet() {
    // Differences across t = 1/2 against steps of 1e-14 in t.
    for axis in AXES {
        let below = axis.map(|a| a * (0.5 - 1e-14));
        let above = axis.map(|a| a * (0.5 + 1e-14));
        assert!(largest(&so3::exp(below), &so3::exp(above)) < 3e-14);
        assert!(largest(&s3::exp(below), &s3::exp(above)) < 3e-14);
        let w = [0.3, -0.7, 1.1];
        assert!(largest(&so3::dexpinv(below, w), &so3::dexpinv(above, w)) < 3e-14);
    }
}

#[test]
fn dexpinv_is_the_rate_of_the_rotation_vector() {
    let w = [0.3, -0.7, 1.1];
    for axis in AXES {
        for angle in [1e-3, 9e-3, 0.4, 0.6, 1.5, 2.8] {
            // R = exp(u) turned on by ±ε w; central differences of log.
            let u = axis.map(|a| a * angle);
            let r = so3::exp(u);
            let epsilon = 1e-5;
            let ahead = so3::log(so3::retract(r, w.map(|w| epsilon * w)));
            let behind = so3::log(so3::retract(r, w.map(|w| -epsilon * w)));
            let rate = so3::dexpinv(u, w);
            for i in 0..3 {
                let difference = (ahead[i] - behind[i]) / (2.0 * epsilon);
                assert_relative_eq!(rate[i], difference, epsilon = 2e-9);
            }
            // Parallel to u nothing changes.
            assert!(largest(&so3::dexpinv(u, axis), &axis) < 1e-15);
        }
    }
}

#[test]
fn composition_and_frames() {
    let (u, v, b) = ([0.3, -1.1, 0.6], [-0.5, 0.2, 2.0], [1.0, 2.0, -3.0]);
    let (p, q) = (so3::exp(u), so3::exp(v));
    let product = s3::to_matrix(s3::product(s3::exp(u), s3::exp(v)));
    assert!(largest(&so3::product(p, q), &product) < 1e-15);
    assert!(largest(&so3::retract(p, v), &product) < 1e-15);
    assert!(largest(&so3::apply(so3::hat(u), b), &so3::cross(u, b)) < 1e-15);
    let back = so3::apply_transpose(p, so3::apply(p, b));
    assert!(largest(&back, &b) < 1e-14);
    let identity = so3::transpose_product(p, p);
    assert!(largest(&identity, &so3::identity::<f64>()) < 1e-15);
    // exp(π e_z) maps e_x to −e_x; a quarter turn about z maps e_x to e_y.
    let quarter = so3::apply(so3::exp([0.0, 0.0, PI / 2.0]), [1.0, 0.0, 0.0]);
    assert!(largest(&quarter, &[0.0, 1.0, 0.0]) < 1e-15);
}

#[test]
fn rates_are_derivatives_of_retractions() {
    let w = [0.3, -0.7, 1.1];
    let epsilon = 1e-6;
    let (plus, minus) = (w.map(|w| epsilon * w), w.map(|w| -epsilon * w));
    let u = [0.3, -1.1, 0.6];

    let (r, q, p) = (so3::exp(u), s3::exp(u), s1::exp(0.9));
    let difference = |ahead: &[f64], behind: &[f64]| -> Vec<f64> {
        let pairs = ahead.iter().zip(behind);
        pairs.map(|(a, b)| (a - b) / (2.0 * epsilon)).collect()
    };
    let dr = difference(&so3::retract(r, plus), &so3::retract(r, minus));
    let dq = difference(&s3::retract(q, plus), &s3::retract(q, minus));
    let dp = difference(&s1::retract(p, epsilon), &s1::retract(p, -epsilon));
    assert!(largest(&so3::rate(r, w), &dr) < 1e-9);
    assert!(largest(&s3::rate(q, w), &dq) < 1e-9);
    assert!(largest(&s1::rate(p, 1.0), &dp) < 1e-9);
    assert!((s1::log(s1::retract(p, 2.0)) - 2.9).abs() < 1e-15);
}

#[test]
fn a_polar_step_squares_the_defect() {
    let mut r = so3::exp([0.3, -1.1, 0.6]);
    for (k, entry) in r.iter_mut().enumerate() {
        *entry += 1e-4 * (k as f64 * 1.7).sin();
    }
    let mut defect = so3::defect(r);
    for _ in 0..3 {
        r = so3::polar(r);
        assert!(so3::defect(r) <= 3.0 * defect * defect + 1e-15);
        defect = so3::defect(r);
    }
    assert!(defect < 1e-15);
    assert!(so3::defect([f64::NAN; 9]).is_nan());
}

#[test]
fn matrices_off_the_group_have_unit_quaternions() {
    let u = [2.0, -1.0, 1.5];
    let r = so3::exp(u).map(|entry| 1.01 * entry);
    assert!(s3::defect(s3::from_matrix(r)) < 1e-15);
    assert!(largest(&so3::log(r), &u) < 0.02 * norm(u));
}

#[test]
fn blocks_move_each_in_its_way() {
    let blocks = [
        Block::Flat(2),
        Block::Rotation,
        Block::Circle,
        Block::Quaternion,
        Block::Flat(1),
    ];
    assert_eq!(manifold::coordinates(&blocks), 18);
    assert_eq!(manifold::chart(&blocks), 10);
    let (a, b) = ([0.3, -1.1, 0.6], [-0.5, 0.2, 2.0]);
    let (r, p, q) = (so3::exp(a), s1::exp(0.4), s3::exp(a));
    let mut x = [1.0, 2.0].to_vec();
    x.extend(r);
    x.extend(p);
    x.extend(q);
    x.push(7.0);
    let u = [0.5, -0.5, b[0], b[1], b[2], 0.25, b[0], b[1], b[2], -3.0];

    let mut moved = x.clone();
    manifold::retract(&blocks, &mut moved, &u);
    assert_eq!(moved[..2], [1.5, 1.5]);
    assert_eq!(moved[2..11], so3::retract(r, b));
    assert_eq!(moved[11..13], s1::retract(p, 0.25));
    assert_eq!(moved[13..17], s3::retract(q, b));
    assert_eq!(moved[17], 4.0);

    let mut w = [1.0, 2.0, a[0], a[1], a[2], 3.0, a[0], a[1], a[2], 4.0];
    manifold::dexpinv(&blocks, &u, &mut w);
    assert_eq!((w[0], w[1], w[5], w[9]), (1.0, 2.0, 3.0, 4.0));
    assert_eq!(w[2..5], so3::dexpinv(b, a));
    assert_eq!(w[6..9], so3::dexpinv(b, a));

    let mut scaled: Vec<f64> = moved.iter().map(|v| v * (1.0 + 1e-9)).collect();
    manifold::normalise(&blocks, &mut scaled);
    assert!(largest(&scaled[2..17], &moved[2..17]) < 1e-15);
    assert_eq!(scaled[0], 1.5 * (1.0 + 1e-9));

    // Too short a list: complete blocks move, the rest stays.
    let mut short = x[..12].to_vec();
    manifold::retract(&blocks, &mut short, &u);
    assert_eq!(short[..11], moved[..11]);
    assert_eq!(short[11], x[11]);
}

#[test]
fn scalar_conventions() {
    fn check<S: Scalar + PartialEq>() {
        let [zero, one, two] = [0.0, 1.0, 2.0].map(S::from_f64);
        let nan = zero / zero;
        assert!(zero == S::default());
        assert!(zero.select_lt(one, one, two) == one);
        assert!(one.select_lt(one, one, two) == two);
        assert!(nan.select_lt(one, one, two) == two);
        assert!(!nan.is_positive() && !zero.is_positive() && one.is_positive());
        assert!(!(one / zero).is_positive() && !(one / zero).is_finite());
        assert!(!nan.is_finite() && two.is_finite());
        for (a, b) in [(nan, one), (one, nan)] {
            let largest = Scalar::max(a, b);
            assert!(largest != largest);
        }
        assert!(Scalar::max(one, two) == two && Scalar::max(two, one) == two);
        assert!(Scalar::mul_add(two, two, one) == S::from_f64(5.0));
        assert!(two.exp().ln().is_finite() && (-two).abs() == two);
        assert!((two * two).sqrt() == two);
        assert!(Scalar::atan2(zero, -one) == S::from_f64(PI));
        assert!(zero.sin_cos() == (zero, one));
    }
    check::<f64>();
    check::<f32>();
}

#[cfg(feature = "nalgebra")]
mod nalgebra_interop {
    use super::*;
    use hamel::nalgebra_interop;

    #[test]
    fn views_of_blocks() {
        let blocks = [Block::Flat(1), Block::Rotation, Block::Quaternion];
        let u = [0.3, -1.1, 0.6];
        let mut x = vec![7.0];
        x.extend(so3::exp(u));
        x.extend(s3::exp(u));

        let r = nalgebra_interop::rotation(&blocks, &x, 1).expect("a rotation");
        assert_eq!(r[(0, 1)], x[2]);
        assert_eq!(nalgebra_interop::rows(&r), so3::exp(u));
        let from_quaternion = nalgebra_interop::rotation(&blocks, &x, 2).expect("a quaternion");
        assert!((r - from_quaternion).amax() < 1e-15);
        let q = nalgebra_interop::quaternion(&blocks, &x, 2).expect("a quaternion");
        assert_eq!([q.w, q.i, q.j, q.k], s3::exp(u));
        assert_eq!(
            nalgebra_interop::vector::<f64, 3>(&x, 1).expect("three entries")[1],
            x[2]
        );
        assert_eq!(nalgebra_interop::vector3(u)[2], 0.6);
        assert_eq!(nalgebra_interop::matrix(so3::exp(u)), r);

        assert!(nalgebra_interop::rotation(&blocks, &x, 0).is_none());
        assert!(nalgebra_interop::rotation(&blocks, &x[..5], 1).is_none());
        assert!(nalgebra_interop::quaternion(&blocks, &x, 9).is_none());
        assert!(nalgebra_interop::vector::<f64, 3>(&x, usize::MAX).is_none());
    }
}
