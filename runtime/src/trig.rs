//! Sine and cosine of one angle, in line, and of lanes.
//!
//! Half of what the forward dynamics of a pendulum costs is a call of the C library, which nothing
//! else overlaps. Here both come from one reduction, without branches and in parallel, by the same
//! rounded operations with and without `std`.
//!
//! The operations are written once, for whatever carries them out ([`Arithmetic`]): numbers, lanes, or a
//! compiler whose code is to have the same bits.
//!
//! Polynomials and the parts of π/2 are those of fdlibm (`k_sin.c`, `k_cos.c`, `e_rem_pio2.c`;
//! © 1993 Sun Microsystems, Inc., permission to use, copy, modify and distribute is freely granted).

use core::marker::PhantomData;

use crate::scalar::{FUSED, Scalar};

/// Angles up to here, in rad, are reduced by parts of π/2.
pub const FARTHEST: f64 = 1e6;
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
pub const TURNED: [[f64; 4]; 4] = [
    [1.0, -0.0, 1.0, 0.0],
    [0.0, 1.0, 0.0, -1.0],
    [-1.0, 0.0, -1.0, 0.0],
    [0.0, -1.0, 0.0, 1.0],
];

/// What sine and cosine are made of.
pub trait Arithmetic {
    /// A number.
    type Number: Copy;

    /// Whether a b + c is rounded once.
    fn is_fused(&self) -> bool;
    /// A number that is known.
    fn number(&mut self, number: f64) -> Self::Number;
    /// a + b
    fn plus(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    /// a − b
    fn minus(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    /// a b
    fn times(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    /// a b + c
    fn times_plus(&mut self, a: Self::Number, b: Self::Number, c: Self::Number) -> Self::Number;
    /// c − a b
    fn less_times(&mut self, c: Self::Number, a: Self::Number, b: Self::Number) -> Self::Number;
}

/// What |x| ≤ [`FARTHEST`] is beside the nearest number n of quarter turns.
#[derive(Clone, Copy, Debug)]
pub struct Reduced<N> {
    /// n
    pub turns: N,
    /// A number whose last two bits are those of n.
    pub shifted: N,
    /// sin(x − n π/2)
    pub sine: N,
    /// cos(x − n π/2)
    pub cosine: N,
}

/// Takes quarter turns off an angle x, in rad, of |x| ≤ [`FARTHEST`].
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

/// (sin x, cos x), with the row of [`TURNED`] whose number is the last two bits of `shifted`.
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
    let w = &mut Plain(PhantomData);
    let of = reduced(w, x);
    let row = TURNED[(of.shifted.to_bits() & 3) as usize];
    let [sine, cosine] = turned(w, row, of);
    Some((sine, cosine))
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
    let Reduced {
        turns,
        sine,
        cosine,
        ..
    } = reduced(&mut Plain(PhantomData), x);
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

/// Numbers and lanes themselves.
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

/// (sin, cos) of r − lost, |r| ≤ π/4.
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
    // 1 − z/2 is rounded; what that loses comes back with the small terms.
    let most = w.times_plus(z, half, one);
    let (half, one) = (w.number(-0.5), w.number(1.0));
    let rounded = w.minus(one, most);
    let less = w.times_plus(z, half, rounded);
    let of_cosine = series(w, &COSINE, z, square);
    let small = w.times_plus(r, lost, less);
    let small = w.times_plus(square, of_cosine, small);
    (sine, w.plus(small, most))
}

/// x − turns π/2 as r − lost, |lost| below the spacing of numbers at r.
#[inline]
fn reduce<W: Arithmetic>(w: &mut W, x: W::Number, turns: W::Number) -> (W::Number, W::Number) {
    if w.is_fused() {
        // Exact: a multiple of the spacing at x or at π/2, and less than 1.
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

/// Σ cᵢ zⁱ, square = z², in pairs.
#[inline]
fn series<W: Arithmetic>(w: &mut W, c: &[f64; 6], z: W::Number, square: W::Number) -> W::Number {
    // Not `map`, which is a call for lanes.
    let (times, plus) = (w.number(c[1]), w.number(c[0]));
    let low = w.times_plus(z, times, plus);
    let (times, plus) = (w.number(c[3]), w.number(c[2]));
    let middle = w.times_plus(z, times, plus);
    let (times, plus) = (w.number(c[5]), w.number(c[4]));
    let high = w.times_plus(z, times, plus);
    let upper = w.times_plus(high, square, middle);
    w.times_plus(upper, square, low)
}
