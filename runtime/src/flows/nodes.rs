//! Advance of a free rotation: sn, cn, dn after a time, and the integral of sn²/(1 + n sn²), which gives the angle by
//! which the body turns about its angular momentum.
//!
//! Short times are covered by panels, each with a series for the functions and five Gauss points: the relative accuracy
//! holds however short the time is. Longer times use the integral of the third kind at both ends, whose absolute
//! accuracy does not depend on the length of the time.

use crate::flows::carlson::third_kind;
use crate::flows::exact::FreeRotation;
use crate::flows::jacobi::{Jacobi, Mean, SERIES_BELOW, Series};
use crate::scalar::Scalar;

/// Result of advancing a motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Angle<S> {
    /// Values sn, cn, dn at the end.
    pub(crate) end: Jacobi<S>,
    /// The integral |P| (κ₁ − κ₃) ∫ sn²/(1 + n sn²) dt.
    pub(crate) integral: S,
    /// Number of sign changes of cn, negative for negative u.
    pub(crate) folds: S,
}

/// Gauss points on [0, 1] and their weights.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668_004, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// Advances the motion by the time `h`.
#[inline]
pub(crate) fn advance<S: Scalar>(motion: &FreeRotation<S>, h: S) -> Angle<S> {
    let size = (motion.rate * h).abs();
    for count in [1, 2, 4, 8] {
        let limit = S::from_f64(SERIES_BELOW * f64::from(count));
        if (limit - size).is_positive() {
            return panels(motion, h, count);
        }
    }
    let (long, short) = (long(motion, h), panels(motion, h, 1));
    let pick = |short: S, long: S| size.select_lt(S::from_f64(SERIES_BELOW), short, long);
    Angle {
        end: Jacobi {
            sn: pick(short.end.sn, long.end.sn),
            cn: pick(short.end.cn, long.end.cn),
            dn: pick(short.end.dn, long.end.dn),
        },
        integral: pick(short.integral, long.integral),
        folds: pick(short.folds, long.folds),
    }
}

/// Advances the motion in `count` equal panels, each of |u| below the limit of the series.
#[inline]
fn panels<S: Scalar>(motion: &FreeRotation<S>, h: S, count: u32) -> Angle<S> {
    let one = S::from_f64(1.0);
    let series = Series::new(motion.m);
    let h = h / S::from_f64(f64::from(count));
    let width = motion.rate * h;
    let along = GAUSS.map(|(node, _)| series.at(S::from_f64(node) * width));
    let whole = series.at(width);

    let mut here = motion.start;
    let mut sum = S::default();
    for _ in 0..count {
        for (step, (_, weight)) in along.iter().zip(GAUSS) {
            let sn = here.plus(*step, motion.m).sn;
            let square = sn * sn;
            sum += S::from_f64(weight) * square / (one + motion.n * square);
        }
        here = here.plus(whole, motion.m);
    }
    Angle {
        end: here,
        integral: motion.factor * h * sum,
        folds: crossed(motion.start, here, width),
    }
}

/// Returns the value of 1 − m below which the time between two flips is longer than any run, and the |u| beyond which
/// such a motion then rests.
#[inline]
fn separatrix<S: Scalar>() -> (S, S) {
    let double = S::from_f64(1e-290);
    if double.is_positive() {
        (double, S::from_f64(300.0))
    } else {
        (S::from_f64(1e-36), S::from_f64(17.0))
    }
}

/// Advances the motion by whole periods and the integral of the third kind.
fn long<S: Scalar>(motion: &FreeRotation<S>, h: S) -> Angle<S> {
    let (zero, one, two) = (S::default(), S::from_f64(1.0), S::from_f64(2.0));
    let (floor, far) = separatrix::<S>();
    let endless = motion.complement;
    let complement = Scalar::max(motion.complement, floor);
    let mean = Mean::new(complement);
    let period = two * mean.quarter_period();
    let at_quarter = third_kind(zero, complement, one, one + motion.n) / S::from_f64(3.0);

    let u = motion.rate * h;
    let periods = endless.select_lt(floor, zero, round(u / period));
    let rest = u - periods * period;
    let sign = u.select_lt(zero, -one, one);
    let beyond = (rest.abs() - far).max(zero);
    let beyond = endless.select_lt(floor, beyond, zero);
    let rest = beyond.select_lt(floor, rest, sign * far);

    let near = motion.start.plus(mean.at(rest), motion.m);
    // Uses the same sides as `folded`, also if cn is 0 at the start.
    let folds = periods + crossed(motion.start, near, rest);

    let integral = folded(near, motion.n) - folded(motion.start, motion.n);
    let integral = integral + two * folds * at_quarter + sign * beyond / (one + motion.n);
    Angle {
        end: near.shifted(parity(periods)),
        integral: integral / motion.per_factor,
        folds,
    }
}

/// Returns 1 if cn has changed its sign over |u| < 2K, with the sign of u; 0 otherwise.
fn crossed<S: Scalar>(start: Jacobi<S>, end: Jacobi<S>, u: S) -> S {
    let one = S::from_f64(1.0);
    let crossed = (one - side(start) * side(end)) * S::from_f64(0.5);
    crossed * u.select_lt(S::default(), -one, one)
}

/// Returns ∫₀ᵘ sn²/(1 + n sn²), with u shifted by multiples of 2K to |u| ≤ K.
fn folded<S: Scalar>(at: Jacobi<S>, n: S) -> S {
    let one = S::from_f64(1.0);
    let square = at.sn * at.sn;
    let integral = third_kind(at.cn * at.cn, at.dn * at.dn, one, one + n * square);
    side(at) * at.sn * square * integral / S::from_f64(3.0)
}

/// Returns (−1)ʲ for a whole number j.
pub(crate) fn parity<S: Scalar>(j: S) -> S {
    let half = j * S::from_f64(0.5);
    S::from_f64(1.0) - S::from_f64(4.0) * (half - round(half)).abs()
}

/// Returns −1 where cn is negative, 1 elsewhere.
pub(crate) fn side<S: Scalar>(at: Jacobi<S>) -> S {
    let one = S::from_f64(1.0);
    at.cn.select_lt(S::default(), -one, one)
}

/// Returns the nearest whole number.
#[inline]
pub(crate) fn round<S: Scalar>(value: S) -> S {
    value.nearest_whole()
}

/// Returns the largest |u| for which hyperbolic functions are evaluated.
#[inline]
pub(crate) fn farthest<S: Scalar>() -> S {
    separatrix::<S>().1
}
