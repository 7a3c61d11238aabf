//! Torque-free flows composed of turns about fixed axes.
//!
//! All act on the attitude and on the angular momentum P in principal axes, and conserve R P. Sources: R. McLachlan
//! 1993; S. Reich, Physica D 76 (1994) 375; J. Touma, J. Wisdom, Astron. J. 107 (1994) 1189.

use crate::flows::attitude::{Attitude, others};
use crate::scalar::Scalar;
use crate::so3::Vector;

/// Flow for three equal moments J: R exp(h P/J). Exact.
#[inline(always)]
pub fn spherical<S: Scalar, A: Attitude<S>>(attitude: A, p: Vector<S>, j: S, h: S) -> A {
    let factor = h / j;
    attitude.turned(p.map(|p| factor * p))
}

/// Flow for two equal moments Jₐ, those other than that of `axis`, c: R exp(h P/Jₐ), then a turn by
/// h P_c (1/J_c − 1/Jₐ) about c, which also turns P back. Exact.
#[inline(always)]
pub fn axial<S: Scalar, A: Attitude<S>>(
    attitude: A,
    p: &mut Vector<S>,
    moments: Vector<S>,
    axis: usize,
    h: S,
) -> A {
    let (equal, own) = (moments[others(axis).0], moments[axis]);
    let turned = spherical(attitude, *p, equal, h);
    let before = across(*p, axis);
    let turned = about(turned, p, axis, h * (equal - own) / (equal * own));
    // The same angle recurs at every step with the same rounding error of sin² + cos², which would accumulate in P.
    let factor = S::from_f64(0.5) * (before - across(*p, axis)) / before;
    let factor = S::default().select_lt(before, factor, S::default());
    let (b, c) = others(axis);
    p[b] = factor.mul_add(p[b], p[b]);
    p[c] = factor.mul_add(p[c], p[c]);
    turned
}

/// Returns the square of the part of P perpendicular to an axis.
#[inline(always)]
fn across<S: Scalar>(p: Vector<S>, axis: usize) -> S {
    let (b, c) = others(axis);
    p[b].mul_add(p[b], p[c] * p[c])
}

/// Flow for any moments: turns about the axes 1, 2, 3, 2, 1 at the rates Pᵢ/Jᵢ for h/2, h/2, h, h/2, h/2. Order 2,
/// symmetric, symplectic.
#[inline(always)]
pub fn axes<S: Scalar, A: Attitude<S>>(
    attitude: A,
    p: &mut Vector<S>,
    moments: Vector<S>,
    h: S,
) -> A {
    let half = S::from_f64(0.5) * h;
    let rates = [half / moments[0], half / moments[1], h / moments[2]];
    let turned = about(attitude, p, 0, rates[0]);
    let turned = about(turned, p, 1, rates[1]);
    let turned = about(turned, p, 2, rates[2]);
    let turned = about(turned, p, 1, rates[1]);
    about(turned, p, 0, rates[0])
}

/// Flow for two nearly equal moments Jₐ, J_b: the flow for two equal moments Jₐ between two turns by
/// (h/2) P_b (1/J_b − 1/Jₐ) about b. Order 2 with an error proportional to that difference.
///
/// Jₐ and J_b are the two moments whose inverses are closest.
#[inline(always)]
pub fn pair<S: Scalar, A: Attitude<S>>(
    attitude: A,
    p: &mut Vector<S>,
    moments: Vector<S>,
    h: S,
) -> A {
    let axis = odd_one_out(moments);
    let (a, b) = others(axis);
    let (kept, other) = (moments[a], moments[b]);
    let rate = S::from_f64(0.5) * h * (kept - other) / (kept * other);
    let mut symmetric = moments;
    symmetric[b] = kept;
    let mut turned = about(attitude, p, b, rate);
    turned = axial(turned, p, symmetric, axis, h);
    about(turned, p, b, rate)
}

/// Turns the attitude by `rate` P_axis about a principal axis, and P back.
#[inline(always)]
fn about<S: Scalar, A: Attitude<S>>(attitude: A, p: &mut Vector<S>, axis: usize, rate: S) -> A {
    let (turned, angle) = attitude.turned_about(axis, rate * p[axis]);
    angle.turn_back(axis, p);
    turned
}

/// Returns the axis other than those of the two moments whose inverses are closest, if that holds in all lanes;
/// otherwise the third axis.
#[inline(always)]
fn odd_one_out<S: Scalar>(moments: Vector<S>) -> usize {
    let gap = |axis: usize| {
        let (a, b) = others(axis);
        ((moments[a] - moments[b]) / (moments[a] * moments[b])).abs()
    };
    let gaps = [gap(0), gap(1), gap(2)];
    let least = |axis: usize| {
        let (a, b) = others(axis);
        (gaps[a] - gaps[axis]).is_positive() && (gaps[b] - gaps[axis]).is_positive()
    };
    if least(0) {
        0
    } else if least(1) {
        1
    } else {
        2
    }
}
