//! Sine and cosine of one angle, in line.
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
    let shifted = fused(x, TURNS, ROUND);
    let quadrant = shifted.to_bits();
    let (r, lost) = reduce(x, shifted - ROUND);
    let z = r * r;
    let w = z * z;
    let sine = r - fused(-(z * r), series(SINE, z, w), lost);
    // 1 − z/2 is rounded; what that loses comes back with the small terms.
    let most = fused(z, -0.5, 1.0);
    let less = fused(z, -0.5, 1.0 - most);
    let cosine = fused(w, series(COSINE, z, w), fused(r, lost, less)) + most;
    let [a, b, c, d] = TURNED[(quadrant & 3) as usize];
    Some((fused(b, cosine, a * sine), fused(d, sine, c * cosine)))
}

/// x − turns π/2 as r − lost, |lost| below the spacing of numbers at r.
#[inline]
fn reduce(x: f64, turns: f64) -> (f64, f64) {
    if FUSED {
        // Exact: a multiple of the spacing at x or at π/2, and less than 1.
        let close = fused(-turns, core::f64::consts::FRAC_PI_2, x);
        let r = fused(-turns, REST, close);
        return (r, fused(turns, REST, r - close));
    }
    let [a, b, c] = QUARTER.map(|part| turns * part);
    let first = x - a;
    let close = first - b;
    let less = c - ((first - close) - b);
    let r = close - less;
    (r, less - (close - r))
}

/// Σ cᵢ zⁱ, w = z², in pairs.
#[inline]
fn series(c: [f64; 6], z: f64, w: f64) -> f64 {
    let [a, b, c, d, e, f] = c;
    let (low, middle, high) = (fused(b, z, a), fused(d, z, c), fused(f, z, e));
    fused(fused(high, w, middle), w, low)
}

/// a b + c as generated code computes it.
#[inline]
fn fused(a: f64, b: f64, c: f64) -> f64 {
    Scalar::mul_add(a, b, c)
}
