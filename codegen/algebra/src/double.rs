//! Double-double numbers, with twice the precision of `f64`, for measuring rounding errors.
//!
//! A number is the unevaluated sum h + l of two `f64` with |l| ≤ ½ ulp(h), which gives about 32 decimal
//! digits. Sums and products with exact errors follow Dekker (1971) and Knuth: s = fl(a + b), e = a + b −
//! s, and p = fl(a b), e = fma(a, b, −p). Functions are computed by Taylor series after argument reduction,
//! or by one step of Newton's method from the value in `f64`:
//!
//! | function | computed by |
//! |---|---|
//! | √a | r + (a − r²) / 2 r |
//! | sin, cos | a − k π/2, Taylor series on ±π/4 |
//! | exp | 2ᵏ exp(r / 64)⁶⁴, \|r\| ≤ ½ log 2 |
//! | log a | y + a exp(−y) − 1 |
//! | atan2(y, x) | θ + (y cos θ − x sin θ) / √(x² + y²) |

use super::function::MIN_DIVISOR;
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A double-double number, with about 32 decimal digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Double {
    high: f64,
    low: f64,
}

/// π/2 as a sum of three `f64`.
const HALF_PI: [f64; 3] = [
    std::f64::consts::FRAC_PI_2,
    6.123_233_995_736_766e-17,
    -1.497_384_904_859_169_7e-33,
];
/// log 2 as a sum of two `f64`.
const LOG_2: Double = Double {
    high: std::f64::consts::LN_2,
    low: 2.319_046_813_846_3e-17,
};
/// Order at which the Taylor series of sine and cosine end: (π/4)³² / 32! < 2^-110.
const SERIES_ORDER: u32 = 32;
/// Argument beyond which hyperbolic functions are computed in `f64`.
const MAX_HYPERBOLIC_ARGUMENT: f64 = 300.0;
/// Number of times that the argument of exp is halved.
const EXP_HALVINGS: u32 = 6;

impl Double {
    /// 0.
    pub const ZERO: Double = Double::new(0.0);
    /// 1.
    pub const ONE: Double = Double::new(1.0);
    /// π.
    pub const PI: Double = Double {
        high: 2.0 * HALF_PI[0],
        low: 2.0 * HALF_PI[1],
    };

    /// Converts an `f64` exactly.
    pub const fn new(value: f64) -> Self {
        Double {
            high: value,
            low: 0.0,
        }
    }

    /// Returns the nearest `f64`.
    pub fn to_f64(self) -> f64 {
        self.high
    }

    /// Rounds a rational: the remainder after its nearest `f64` is rounded once more.
    pub fn of_rational(value: &BigRational) -> Self {
        let high = value.to_f64().unwrap_or(f64::NAN);
        let rest = BigRational::from_float(high).map_or_else(BigRational::zero, |h| {
            // The difference over the common denominator, not reduced.
            let (n, d) = (value.numer(), value.denom());
            BigRational::new_raw(n * h.denom() - h.numer() * d, d * h.denom())
        });
        sum(high, rest.to_f64().unwrap_or(0.0))
    }

    /// |a|.
    pub fn abs(self) -> Self {
        self.signed(self.high < 0.0)
    }

    /// Sign of a: ±1, or 0 for 0.
    pub fn sign(self) -> Self {
        match self.high == 0.0 {
            true => self,
            false => Double::new(self.high.signum()),
        }
    }

    /// 1/a of a length a, or 1/`MIN_DIVISOR` if a is below `MIN_DIVISOR`. A length is not negative; for other numbers
    /// below `MIN_DIVISOR` the law 1/(−a) = −1/a, which the graph uses, does not hold.
    pub fn inverse_of_length(self) -> Self {
        let short = self.high.abs() < MIN_DIVISOR;
        Double::ONE
            / if short {
                Double::new(MIN_DIVISOR)
            } else {
                self
            }
    }

    /// Returns −a if `negative`, else a.
    pub fn signed(self, negative: bool) -> Self {
        if negative { -self } else { self }
    }

    /// Multiplies by a power of 2.
    fn scaled(self, factor: f64) -> Self {
        Double {
            high: self.high * factor,
            low: self.low * factor,
        }
    }

    /// √a.
    pub fn sqrt(self) -> Self {
        let root = self.high.sqrt();
        if root == 0.0 || !root.is_finite() {
            return Double::new(root);
        }
        let rest = self - product(root, root);
        sum(root, rest.high / (2.0 * root))
    }

    /// sin a and cos a.
    pub fn sin_cos(self) -> (Self, Self) {
        let quarters = (self.high / HALF_PI[0]).round();
        let parts = HALF_PI.map(|part| product(quarters, part));
        let rest = parts.into_iter().fold(self, |rest, part| rest - part);
        let square = rest * rest;
        // Nested series 1 − x²/(k (k+1)) (1 − …): from k = 2 for sin x / x, from k = 1 for cos x.
        let series = |first: u32| {
            let terms = (first..SERIES_ORDER).step_by(2).rev();
            terms.fold(Double::ONE, |inner, k| {
                let divisor = Double::new(f64::from(k * (k + 1)));
                Double::ONE - square / divisor * inner
            })
        };
        let (sin, cos) = (rest * series(2), series(1));
        match quarters.rem_euclid(4.0) as u8 {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }

    /// exp a.
    pub fn exp(self) -> Self {
        let powers = (self.high / LOG_2.high).round();
        if powers.abs() > 1000.0 || powers.is_nan() {
            return Double::new(self.high.exp());
        }
        (Double::ONE + self.expm1_beside(powers)).scaled(2.0_f64.powi(powers as i32))
    }

    /// exp a − 1.
    pub fn expm1(self) -> Self {
        match (self.high / LOG_2.high).round() == 0.0 {
            true => self.expm1_beside(0.0),
            false => self.exp() - Double::ONE,
        }
    }

    /// exp(a − n log 2) − 1 for a near n log 2.
    fn expm1_beside(self, powers: f64) -> Self {
        let rest = self - Double::new(powers) * LOG_2;
        let small = rest.scaled(0.5_f64.powi(EXP_HALVINGS as i32));
        // Squaring exp x − 1 keeps its relative precision: (1 + e)² − 1 = e (2 + e).
        let tail = (2..18).rev().fold(Double::ONE, |inner, k| {
            Double::ONE + small / Double::new(f64::from(k)) * inner
        });
        let mut less = small * tail;
        for _ in 0..EXP_HALVINGS {
            less = less * (Double::new(2.0) + less);
        }
        less
    }

    /// log a.
    pub fn log(self) -> Self {
        let first = self.high.ln();
        if !first.is_finite() {
            return Double::new(first);
        }
        let first = Double::new(first);
        first + (self * (-first).exp() - Double::ONE)
    }

    /// log(1 + a), by one step of Newton's method for expm1.
    pub fn log1p(self) -> Self {
        if self.high < -0.5 {
            return (Double::ONE + self).log();
        }
        let first = self.high.ln_1p();
        if !first.is_finite() {
            return Double::new(first);
        }
        let first = Double::new(first);
        first + (self - first.expm1()) / first.exp()
    }

    /// Angle of the point (x, y), where `self` is y.
    pub fn atan2(self, x: Double) -> Self {
        let y = self;
        let first = y.high.atan2(x.high);
        let radius = (x * x + y * y).sqrt();
        if radius.high == 0.0 || !first.is_finite() {
            return Double::new(first);
        }
        let first = Double::new(first);
        let (sin, cos) = first.sin_cos();
        first + (y * cos - x * sin) / radius
    }

    /// sin a.
    pub fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// sinh a; near 0 by its Taylor series, which avoids cancellation.
    pub fn sinh(self) -> Self {
        if self.high.abs() > MAX_HYPERBOLIC_ARGUMENT {
            return Double::new(self.high.sinh());
        }
        if self.high.abs() > 0.5 {
            let power = self.exp();
            return (power - Double::ONE / power).scaled(0.5);
        }
        let square = self * self;
        let terms = (2..SERIES_ORDER).step_by(2).rev();
        let sum = terms.fold(Double::ONE, |inner, k| {
            Double::ONE + square / Double::new(f64::from(k * (k + 1))) * inner
        });
        self * sum
    }

    /// cosh a.
    pub fn cosh(self) -> Self {
        if self.high.abs() > MAX_HYPERBOLIC_ARGUMENT {
            return Double::new(self.high.cosh());
        }
        let power = self.exp();
        (power + Double::ONE / power).scaled(0.5)
    }

    /// tanh a = sinh a / cosh a; beyond |a| = 300 in `f64`.
    pub fn tanh(self) -> Self {
        if self.high.abs() > MAX_HYPERBOLIC_ARGUMENT {
            return Double::new(self.high.tanh());
        }
        self.sinh() / self.cosh()
    }

    /// cos a.
    pub fn cos(self) -> Self {
        self.sin_cos().1
    }
}

/// a + b exactly.
fn sum(a: f64, b: f64) -> Double {
    let high = a + b;
    let back = high - a;
    Double {
        high,
        low: (a - (high - back)) + (b - back),
    }
}

/// a + b exactly, where |a| ≥ |b|.
fn ordered_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    Double {
        high,
        low: b - (high - a),
    }
}

/// a b exactly.
fn product(a: f64, b: f64) -> Double {
    let high = a * b;
    Double {
        high,
        low: a.mul_add(b, -high),
    }
}

impl Add for Double {
    type Output = Double;
    fn add(self, b: Double) -> Double {
        let (high, low) = (sum(self.high, b.high), sum(self.low, b.low));
        let first = ordered_sum(high.high, high.low + low.high);
        ordered_sum(first.high, first.low + low.low)
    }
}

impl Neg for Double {
    type Output = Double;
    fn neg(self) -> Double {
        Double {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl Sub for Double {
    type Output = Double;
    fn sub(self, b: Double) -> Double {
        self + -b
    }
}

impl Mul for Double {
    type Output = Double;
    fn mul(self, b: Double) -> Double {
        let exact = product(self.high, b.high);
        let cross = self.high.mul_add(b.low, self.low * b.high);
        ordered_sum(exact.high, exact.low + cross)
    }
}

impl Div for Double {
    type Output = Double;
    fn div(self, b: Double) -> Double {
        let first = self.high / b.high;
        if !first.is_finite() || first == 0.0 {
            return Double::new(first);
        }
        let rest = self - b * Double::new(first);
        let second = rest.high / b.high;
        let rest = rest - b * Double::new(second);
        ordered_sum(first, second) + Double::new(rest.high / b.high)
    }
}
