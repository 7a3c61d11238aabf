//! Sine and cosine of an angle, inlined, for single numbers and for SIMD lanes.
//!
//! A call of the C library takes half of the time of the forward dynamics of a pendulum, and nothing overlaps with it.
//! Here both functions come from one argument reduction, without branches and in parallel, by the same rounded
//! operations with and without `std`.
//!
//! The operations are written once, generically in [`Arithmetic`]: for numbers, for lanes, or for a compiler whose
//! generated code must produce the same bits.
//!
//! Polynomials and the parts of π/2 are those of fdlibm (`k_sin.c`, `k_cos.c`, `e_rem_pio2.c`;
//! © 1993 Sun Microsystems, Inc., permission to use, copy, modify and distribute is freely granted).

use core::marker::PhantomData;

use crate::scalar::{FUSED, Scalar};

/// Largest |angle|, in rad, that is reduced by the parts of π/2.
pub const FARTHEST: f64 = 1e6;
/// 3/2 · 2⁵²: adding it rounds a number to an integer, which the last bits of the sum then hold.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// π/2 minus the `f64` nearest to it.
const REST: f64 = f64::from_bits(0x3C91_A626_3314_5C07);
/// π/2 in two parts of 33 bits, whose products with a number of quarter turns are exact, and the remainder.
const QUARTER: [f64; 3] = [
    f64::from_bits(0x3FF9_21FB_5440_0000),
    f64::from_bits(0x3DD0_B461_1A60_0000),
    f64::from_bits(0x3BA3_198A_2E03_7073),
];
/// Coefficients of (sin r − r) / r³ in powers of r².
const SINE: [f64; 6] = [
    f64::from_bits(0xBFC5_5555_5555_5549),
    f64::from_bits(0x3F81_1111_1110_F8A6),
    f64::from_bits(0xBF2A_01A0_19C1_61D5),
    f64::from_bits(0x3EC7_1DE3_57B1_FE7D),
    f64::from_bits(0xBE5A_E5E6_8A2B_9CEB),
    f64::from_bits(0x3DE5_D93A_5ACF_D57C),
];
/// Coefficients of (cos r − 1 + r²/2) / r⁴ in powers of r².
const COSINE: [f64; 6] = [
    f64::from_bits(0x3FA5_5555_5555_554C),
    f64::from_bits(0xBF56_C16C_16C1_5177),
    f64::from_bits(0x3EFA_01A0_19CB_1590),
    f64::from_bits(0xBE92_7E4F_809C_52AD),
    f64::from_bits(0x3E21_EE9E_BDB4_B1C4),
    f64::from_bits(0xBDA8_FAE9_BE88_38D4),
];
/// Coefficients (a, b, c, d) after 0 to 3 quarter turns: sin = a sin r + b cos r, cos = c cos r + d sin r. They replace
/// a branch that would be mispredicted half of the time. −0 keeps the sign of sin −0.
pub const TURNED: [[f64; 4]; 4] = [
    [1.0, -0.0, 1.0, 0.0],
    [0.0, 1.0, 0.0, -1.0],
    [-1.0, 0.0, -1.0, 0.0],
    [0.0, -1.0, 0.0, 1.0],
];

/// The arithmetic operations from which sine and cosine are computed.
pub trait Arithmetic {
    /// Type of a number.
    type Number: Copy;

    /// Returns whether a b + c is rounded once.
    fn is_fused(&self) -> bool;
    /// Creates a constant.
    fn number(&mut self, number: f64) -> Self::Number;
    /// Returns a + b.
    fn plus(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    /// Returns a − b.
    fn minus(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    /// Returns a b.
    fn times(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    /// Returns a b + c.
    fn times_plus(&mut self, a: Self::Number, b: Self::Number, c: Self::Number) -> Self::Number;
    /// Returns c − a b.
    fn less_times(&mut self, c: Self::Number, a: Self::Number, b: Self::Number) -> Self::Number;
}

/// An angle |x| ≤ [`FARTHEST`] after reduction by the nearest number n of quarter turns.
#[derive(Clone, Copy, Debug)]
pub struct Reduced<N> {
    /// Number n of quarter turns.
    pub turns: N,
    /// A number whose last two bits are those of n.
    pub shifted: N,
    /// sin(x − n π/2)
    pub sine: N,
    /// cos(x − n π/2)
    pub cosine: N,
}

/// Reduces an angle x, in rad, |x| ≤ [`FARTHEST`], by whole quarter turns.
#[inline]
pub fn reduced<W: Arithmetic>(w: &mut W, x: W::Number) -> Reduced<W::Number> {
    let (per, round) = (w.number(core::f64::consts::FRAC_2_PI), w.number(ROUND));
    let shifted = w.times_plus(x, per, round);
    let round = w.number(ROUND);
    let turns = w.minus(shifted, round);
    let (r, lost) = reduce(w, x, turns);
    let (sine, cosine) = first_quarter(w, r, lost);
    Reduced {
        turns,
        shifted,
        sine,
        cosine,
    }
}

/// Returns (sin x, cos x) from a reduced angle and the row of [`TURNED`] whose index is the last two bits of `shifted`.
#[inline]
pub fn turned<W: Arithmetic>(
    w: &mut W,
    [a, b, c, d]: [W::Number; 4],
    of: Reduced<W::Number>,
) -> [W::Number; 2] {
    let part = w.times(a, of.sine);
    let sine = w.times_plus(b, of.cosine, part);
    let part = w.times(c, of.cosine);
    [sine, w.times_plus(d, of.sine, part)]
}

/// Returns (sin x, cos x), x in rad, for |x| up to 10⁶ rad; `None` for larger angles and for NaN.
///
/// Errors are below one spacing of numbers at the result. Within 10⁻¹⁰ rad of a multiple of π/2, the function that
/// vanishes there has an absolute error below 10⁻²⁶, while the last bit of x alone amounts to at least 10⁻¹⁶.
#[inline]
pub(crate) fn sin_cos(x: f64) -> Option<(f64, f64)> {
    // Not `>`, so that NaN counts as far.
    let near = x.abs() <= FARTHEST;
    if !near {
        return None;
    }
    let w = &mut Plain(PhantomData);
    let of = reduced(w, x);
    let row = TURNED[(of.shifted.to_bits() & 3) as usize];
    let [sine, cosine] = turned(w, row, of);
    Some((sine, cosine))
}

/// Returns (sin x, cos x) for angles up to 10⁶ rad in all lanes, bitwise as for single numbers; the result in lanes
/// with larger angles is meaningless.
///
/// Quarter turns are counted in floating point, since machines without 64-bit integer conversions would process them
/// lane by lane.
#[cfg(feature = "wide")]
#[inline]
pub(crate) fn of_lanes<S: Scalar>(x: S) -> (S, S) {
    let of = S::from_f64;
    let round = |value: S| value + of(ROUND) - of(ROUND);
    let Reduced {
        turns,
        sine,
        cosine,
        ..
    } = reduced(&mut Plain(PhantomData), x);
    // `odd` is 1/2 where the number of quarter turns is odd, `half` is 1/2 where that of half turns is odd; 0
    // elsewhere.
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

/// Direct evaluation in numbers and lanes.
struct Plain<S>(PhantomData<S>);

impl<S: Scalar> Arithmetic for Plain<S> {
    type Number = S;

    #[inline]
    fn is_fused(&self) -> bool {
        FUSED
    }

    #[inline]
    fn number(&mut self, number: f64) -> S {
        S::from_f64(number)
    }

    #[inline]
    fn plus(&mut self, a: S, b: S) -> S {
        a + b
    }

    #[inline]
    fn minus(&mut self, a: S, b: S) -> S {
        a - b
    }

    #[inline]
    fn times(&mut self, a: S, b: S) -> S {
        a * b
    }

    #[inline]
    fn times_plus(&mut self, a: S, b: S, c: S) -> S {
        a.mul_add(b, c)
    }

    #[inline]
    fn less_times(&mut self, c: S, a: S, b: S) -> S {
        (-a).mul_add(b, c)
    }
}

/// Returns (sin, cos) of r − lost, |r| ≤ π/4.
#[inline]
fn first_quarter<W: Arithmetic>(
    w: &mut W,
    r: W::Number,
    lost: W::Number,
) -> (W::Number, W::Number) {
    let z = w.times(r, r);
    let square = w.times(z, z);
    let of_sine = series(w, &SINE, z, square);
    let cube = w.times(z, r);
    let less = w.less_times(lost, cube, of_sine);
    let sine = w.minus(r, less);
    let (half, one) = (w.number(-0.5), w.number(1.0));
    // 1 − z/2 is rounded; its rounding error is added back with the small terms.
    let most = w.times_plus(z, half, one);
    let (half, one) = (w.number(-0.5), w.number(1.0));
    let rounded = w.minus(one, most);
    let less = w.times_plus(z, half, rounded);
    let of_cosine = series(w, &COSINE, z, square);
    let small = w.times_plus(r, lost, less);
    let small = w.times_plus(square, of_cosine, small);
    (sine, w.plus(small, most))
}

/// Returns x − turns π/2 as (r, lost), meaning r − lost; |lost| is below the spacing of numbers at r.
#[inline]
fn reduce<W: Arithmetic>(w: &mut W, x: W::Number, turns: W::Number) -> (W::Number, W::Number) {
    if w.is_fused() {
        // This product difference is exact: a multiple of the spacing at x or at π/2, and less than 1.
        let quarter = w.number(core::f64::consts::FRAC_PI_2);
        let close = w.less_times(x, turns, quarter);
        let rest = w.number(REST);
        let r = w.less_times(close, turns, rest);
        let change = w.minus(r, close);
        let rest = w.number(REST);
        return (r, w.times_plus(turns, rest, change));
    }
    let [high, middle, low] = QUARTER;
    let (high, middle, low) = (w.number(high), w.number(middle), w.number(low));
    let part = w.times(turns, middle);
    let first = w.times(turns, high);
    let first = w.minus(x, first);
    let close = w.minus(first, part);
    let gone = w.minus(first, close);
    let gone = w.minus(gone, part);
    let less = w.times(turns, low);
    let less = w.minus(less, gone);
    let r = w.minus(close, less);
    let back = w.minus(close, r);
    (r, w.minus(less, back))
}

/// Returns Σ cᵢ zⁱ, summed in pairs, with square = z².
#[inline]
fn series<W: Arithmetic>(w: &mut W, c: &[f64; 6], z: W::Number, square: W::Number) -> W::Number {
    // Written out instead of `map`, which compiles to a call for SIMD lanes.
    let (times, plus) = (w.number(c[1]), w.number(c[0]));
    let low = w.times_plus(z, times, plus);
    let (times, plus) = (w.number(c[3]), w.number(c[2]));
    let middle = w.times_plus(z, times, plus);
    let (times, plus) = (w.number(c[5]), w.number(c[4]));
    let high = w.times_plus(z, times, plus);
    let upper = w.times_plus(high, square, middle);
    w.times_plus(upper, square, low)
}
