//! Sine and cosine by the rounded operations of `hamel` itself, in numbers and in code that computes with them.
//!
//! One reduction by parts of π/2 and two polynomials, without branches, up to 10⁶ rad; beyond, code leaves the whole
//! call to the evaluation of tapes step by step. Polynomials and parts of π/2 are those of fdlibm (`k_sin.c`, `k_cos.c`,
//! `e_rem_pio2.c`; © 1993 Sun Microsystems, Inc., permission to use, copy, modify and distribute is freely granted).

/// Angles up to here, in rad, are reduced by parts of π/2.
pub const FARTHEST: f64 = 1e6;
/// 3/2 · 2⁵²: a sum with it is rounded to an integer, which its last bits are.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// π/2 − the number nearest to it.
const REST: f64 = f64::from_bits(0x3C91_A626_3314_5C07);
/// π/2 in two parts of 33 bits, and the rest.
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
/// (a, b, c, d) after 0 to 3 quarter turns: sin = a sin r + b cos r, cos = c cos r + d sin r.
pub const TURNED: [f64; 16] = [
    1.0, -0.0, 1.0, 0.0, //
    0.0, 1.0, 0.0, -1.0, //
    -1.0, 0.0, -1.0, 0.0, //
    0.0, -1.0, 0.0, 1.0,
];

/// What sine and cosine are made of.
pub trait Arithmetic {
    /// A number.
    type Number: Copy;

    /// Whether a b + c is rounded once.
    fn is_fused(&self) -> bool;
    /// A number that is known.
    fn number(&mut self, number: f64) -> Self::Number;
    /// a − b
    fn minus(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    /// a b
    fn times(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    /// a b + c
    fn times_plus(&mut self, a: Self::Number, b: Self::Number, c: Self::Number) -> Self::Number;
    /// c − a b
    fn less_times(&mut self, c: Self::Number, a: Self::Number, b: Self::Number) -> Self::Number;
    /// a + b
    fn plus(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    /// The row of [`TURNED`] whose number is the last two bits of this number.
    fn turned(&mut self, shifted: Self::Number) -> [Self::Number; 4];
}

/// (sin x, cos x) of |x| ≤ [`FARTHEST`].
pub fn sin_cos<W: Arithmetic>(w: &mut W, x: W::Number) -> [W::Number; 2] {
    let (turns, round) = (w.number(std::f64::consts::FRAC_2_PI), w.number(ROUND));
    let shifted = w.times_plus(x, turns, round);
    let round = w.number(ROUND);
    let turns = w.minus(shifted, round);
    let (r, lost) = reduce(w, x, turns);
    let (sine, cosine) = first_quarter(w, r, lost);
    let [a, b, c, d] = w.turned(shifted);
    let part = w.times(a, sine);
    let turned_sine = w.times_plus(b, cosine, part);
    let part = w.times(c, cosine);
    [turned_sine, w.times_plus(d, sine, part)]
}

/// x − turns π/2 as r − lost.
fn reduce<W: Arithmetic>(w: &mut W, x: W::Number, turns: W::Number) -> (W::Number, W::Number) {
    if w.is_fused() {
        let quarter = w.number(std::f64::consts::FRAC_PI_2);
        let close = w.less_times(x, turns, quarter);
        let rest = w.number(REST);
        let r = w.less_times(close, turns, rest);
        let change = w.minus(r, close);
        let rest = w.number(REST);
        return (r, w.times_plus(turns, rest, change));
    }
    let [high, middle, low] = QUARTER.map(|part| w.number(part));
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

/// (sin, cos) of r − lost, |r| ≤ π/4.
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
    let most = w.times_plus(z, half, one);
    let (half, one) = (w.number(-0.5), w.number(1.0));
    let rounded = w.minus(one, most);
    let less = w.times_plus(z, half, rounded);
    let of_cosine = series(w, &COSINE, z, square);
    let small = w.times_plus(r, lost, less);
    let small = w.times_plus(square, of_cosine, small);
    (sine, w.plus(small, most))
}

/// Σ cᵢ zⁱ in pairs.
fn series<W: Arithmetic>(w: &mut W, c: &[f64; 6], z: W::Number, square: W::Number) -> W::Number {
    let [low, middle, high] = [0, 2, 4].map(|i| {
        let (times, plus) = (w.number(c[i + 1]), w.number(c[i]));
        w.times_plus(z, times, plus)
    });
    let upper = w.times_plus(high, square, middle);
    w.times_plus(upper, square, low)
}
