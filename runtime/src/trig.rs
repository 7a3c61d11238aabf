//! Sine and cosine of one angle, in line, and of lanes.
//!
//! Half of what the forward dynamics of a pendulum costs is a call of the C library, which nothing
//! else overlaps. Here both come from one reduction, without branches and in parallel, by the same
//! rounded operations with and without `std`.
//!
//! Polynomials and the parts of π/2 are those of fdlibm (`k_sin.c`, `k_cos.c`, `e_rem_pio2.c`;
//! © 1993 Sun Microsystems, Inc., permission to use, copy, modify and distribute is freely granted).

use crate::scalar::{FUSED, Scalar};

/// Angles up to here, in rad, are reduced by parts of π/2.
const FARTHEST: f64 = 1e6;
/// 2/π
const TURNS: f64 = core::f64::consts::FRAC_2_PI;
/// 3/2 · 2⁵²: a sum with it is rounded to an integer, which its last bits are.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// π/2 − the number nearest to it.
const REST: f64 = f64::from_bits(0x3C91_A626_3314_5C07);
/// π/2 in two parts of 33 bits, whose products with a number of quarter turns are exact, and the rest.
const QUARTER: [f64; 3] = [
    f64::from_bits(0x3FF9_21FB_5440_0000),
    f64::from_bits(0x3DD0_B461_1A60_0000),
    f64::from_bits(0x3BA3_198A_2E03_7073),
];
/// (sin r − r) / r³ in r².
const SINE: [f64; 6] = [
    f64::from_bits(0xBFC5_5555_5555_5549),
    f64::from_bits(0x3F81_1111_1110_F8A6),
    f64::from_bits(0xBF2A_01A0_19C1_61D5),
    f64::from_bits(0x3EC7_1DE3_57B1_FE7D),
    f64::from_bits(0xBE5A_E5E6_8A2B_9CEB),
    f64::from_bits(0x3DE5_D93A_5ACF_D57C),
];
/// (cos r − 1 + r²/2) / r⁴ in r².
const COSINE: [f64; 6] = [
    f64::from_bits(0x3FA5_5555_5555_554C),
    f64::from_bits(0xBF56_C16C_16C1_5177),
    f64::from_bits(0x3EFA_01A0_19CB_1590),
    f64::from_bits(0xBE92_7E4F_809C_52AD),
    f64::from_bits(0x3E21_EE9E_BDB4_B1C4),
    f64::from_bits(0xBDA8_FAE9_BE88_38D4),
];
/// (a, b, c, d) after 0 to 3 quarter turns: sin = a sin r + b cos r, cos = c cos r + d sin r. A branch would
/// be guessed wrong half of the time. −0 keeps the sign of sin −0.
const TURNED: [[f64; 4]; 4] = [
    [1.0, -0.0, 1.0, 0.0],
    [0.0, 1.0, 0.0, -1.0],
    [-1.0, 0.0, -1.0, 0.0],
    [0.0, -1.0, 0.0, 1.0],
];

/// (sin x, cos x), x in rad, of an angle up to 10⁶ rad; `None` of larger ones and of NaN.
///
/// Errors are below one spacing of numbers at the result. Within 10⁻¹⁰ rad of a multiple of π/2, the
/// function that vanishes there has an absolute error below 10⁻²⁶: what a last bit of x makes is 10⁻¹⁶
/// and more.
#[inline]
pub(crate) fn sin_cos(x: f64) -> Option<(f64, f64)> {
    // Not `>`: NaN is far.
    let near = x.abs() <= FARTHEST;
    if !near {
        return None;
    }
    let shifted = Scalar::mul_add(x, TURNS, ROUND);
    let quadrant = shifted.to_bits();
    let (sine, cosine) = first_quarter(reduce(x, shifted - ROUND));
    let [a, b, c, d] = TURNED[(quadrant & 3) as usize];
    Some((
        Scalar::mul_add(b, cosine, a * sine),
        Scalar::mul_add(d, sine, c * cosine),
    ))
}

/// (sin x, cos x) of angles up to 10⁶ rad in all lanes, each as that of one number; of further ones it is
/// not a number or anything.
///
/// Quarter turns are counted in numbers: machines without 64-bit conversions take them lane by lane.
#[cfg(feature = "wide")]
#[inline]
pub(crate) fn of_lanes<S: Scalar>(x: S) -> (S, S) {
    let of = S::from_f64;
    let round = |value: S| value + of(ROUND) - of(ROUND);
    let turns = x.mul_add(of(TURNS), of(ROUND)) - of(ROUND);
    let (sine, cosine) = first_quarter(reduce(x, turns));
    // 1/2 where the number of quarter turns is odd, and where that of half turns is, else 0.
    let pairs = turns * of(0.5);
    let odd = (pairs - round(pairs)).abs();
    let halves = (pairs - odd) * of(0.5);
    let half = (halves - round(halves)).abs();
    let sign = half.mul_add(of(-4.0), of(1.0));
    let other = odd.mul_add(of(-4.0), of(1.0)) * sign;
    (
        odd.select_lt(of(0.25), sine, cosine) * sign,
        odd.select_lt(of(0.25), cosine, sine) * other,
    )
}

/// (sin, cos) of r − lost, |r| ≤ π/4.
#[inline]
fn first_quarter<S: Scalar>((r, lost): (S, S)) -> (S, S) {
    let (one, half) = (S::from_f64(1.0), S::from_f64(-0.5));
    let z = r * r;
    let w = z * z;
    let sine = r - (-(z * r)).mul_add(series(SINE, z, w), lost);
    // 1 − z/2 is rounded; what that loses comes back with the small terms.
    let most = z.mul_add(half, one);
    let less = z.mul_add(half, one - most);
    let cosine = w.mul_add(series(COSINE, z, w), r.mul_add(lost, less)) + most;
    (sine, cosine)
}

/// x − turns π/2 as r − lost, |lost| below the spacing of numbers at r.
#[inline]
fn reduce<S: Scalar>(x: S, turns: S) -> (S, S) {
    if FUSED {
        // Exact: a multiple of the spacing at x or at π/2, and less than 1.
        let close = (-turns).mul_add(S::from_f64(core::f64::consts::FRAC_PI_2), x);
        let r = (-turns).mul_add(S::from_f64(REST), close);
        return (r, turns.mul_add(S::from_f64(REST), r - close));
    }
    let [high, middle, low] = QUARTER;
    let part = turns * S::from_f64(middle);
    let first = x - turns * S::from_f64(high);
    let close = first - part;
    let less = turns * S::from_f64(low) - ((first - close) - part);
    let r = close - less;
    (r, less - (close - r))
}

/// Σ cᵢ zⁱ, w = z², in pairs.
#[inline]
fn series<S: Scalar>(c: [f64; 6], z: S, w: S) -> S {
    // Not `map`, which is a call for lanes.
    let of = S::from_f64;
    let [a, b, c, d, e, f] = c;
    let low = of(b).mul_add(z, of(a));
    let middle = of(d).mul_add(z, of(c));
    let high = of(f).mul_add(z, of(e));
    high.mul_add(w, middle).mul_add(w, low)
}
