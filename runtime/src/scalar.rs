//! The scalar types of generated code: `f64`, `f32`, SIMD lanes and dual numbers.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::{s3, so3};

/// A real number, or several that are computed together (SIMD lanes).
///
/// There is no ordering and no equality: a condition can differ from lane to lane, so code computes both branches and
/// selects with [`select_lt`](Scalar::select_lt). `Default` is zero in every lane. Functions follow IEEE 754: outside
/// their domain they return NaN and never panic.
///
/// ```
/// use hamel::{Dual, Scalar};
///
/// /// Smaller of two numbers, whatever they are.
/// fn smaller<S: Scalar>(a: S, b: S) -> S {
///     a.select_lt(b, a, b)
/// }
///
/// assert_eq!(smaller(1.0_f32, 2.0), 1.0);
/// assert_eq!(smaller(Dual::<f64, 1>::along(3.0, 0), Dual::constant(2.0)).slopes, [0.0]);
/// ```
pub trait Scalar:
    Copy
    + Debug
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// Distance from 1 to the next larger number.
    const EPSILON: f64;

    /// Returns the number nearest to `value`, in every lane.
    fn from_f64(value: f64) -> Self;

    /// Returns (sin self, cos self), argument in rad.
    fn sin_cos(self) -> (Self, Self);

    /// Square root; NaN below zero.
    fn sqrt(self) -> Self;

    /// Exponential function.
    fn exp(self) -> Self;

    /// Natural logarithm; NaN below zero.
    fn ln(self) -> Self;

    /// Returns log(1 + self), accurate near 0; NaN below −1. What 1 + self loses to rounding is restored by the quotient
    /// of `self` and what is left of it (Kahan).
    fn ln_1p(self) -> Self {
        let one = Self::from_f64(1.0);
        let sum = one + self;
        let left = sum - one;
        let near = sum.ln() * self / left;
        let near = left
            .abs()
            .select_lt(Self::from_f64(Self::EPSILON), self, near);
        self.abs().select_lt(one, near, sum.ln())
    }

    /// Returns exp(self) − 1, accurate near 0: 2 exp(x/2) sinh(x/2) there.
    fn exp_m1(self) -> Self {
        let one = Self::from_f64(1.0);
        let half = self * Self::from_f64(0.5);
        let near = Self::from_f64(2.0) * half.exp() * half.sinh();
        self.abs().select_lt(one, near, self.exp() - one)
    }

    /// Hyperbolic sine, accurate near 0: x Σ x²ᵏ/(2k + 1)! there, (eˣ − e⁻ˣ)/2 elsewhere.
    fn sinh(self) -> Self {
        const TERMS: [f64; 7] = [
            1.0,
            1.0 / 6.0,
            1.0 / 120.0,
            1.0 / 5040.0,
            1.0 / 362_880.0,
            1.0 / 39_916_800.0,
            1.0 / 6_227_020_800.0,
        ];
        let near = self * series(self * self, TERMS);
        let power = self.exp();
        let far = (power - Self::from_f64(1.0) / power) * Self::from_f64(0.5);
        self.abs().select_lt(Self::from_f64(0.3), near, far)
    }

    /// Hyperbolic cosine.
    fn cosh(self) -> Self {
        let power = self.exp();
        (power + Self::from_f64(1.0) / power) * Self::from_f64(0.5)
    }

    /// Hyperbolic tangent, accurate near 0: sinh/cosh there, 1 − 2/(e²ˣ + 1) elsewhere.
    fn tanh(self) -> Self {
        let (one, two) = (Self::from_f64(1.0), Self::from_f64(2.0));
        let far = one - two / ((two * self).exp() + one);
        let near = self.sinh() / self.cosh();
        self.abs().select_lt(one, near, far)
    }

    /// Angle in rad, in [−π, π], of the point with ordinate `self` and abscissa `x`.
    fn atan2(self, x: Self) -> Self;

    /// Absolute value.
    fn abs(self) -> Self;

    /// Returns the size of the number for convergence tests and error estimates: |self|. For a dual number it is the
    /// largest of |value| and |slopes|, as a constant (with zero slopes).
    #[inline]
    fn magnitude(self) -> Self {
        self.abs()
    }

    /// Returns the error `self` relative to two numbers, |self|/(|a| + |b|), and 0 where `self` is 0. For dual numbers
    /// it is the larger of this ratio for the values and for the largest slopes, as a constant.
    #[inline]
    fn relative_to(self, a: Self, b: Self) -> Self {
        let error = self.abs();
        Self::default().select_lt(error, error / (a.abs() + b.abs()), error)
    }

    /// Returns `self · a + b`; for dual numbers, `self · a` is the scalar product of the vectors of value and slopes, a
    /// constant.
    #[inline]
    fn inner_plus(self, a: Self, b: Self) -> Self {
        self.mul_add(a, b)
    }

    /// Returns 1 with the sign of the number; 0 for 0, NaN for NaN.
    #[inline]
    fn sign(self) -> Self {
        let (zero, one) = (Self::default(), Self::from_f64(1.0));
        zero.select_lt(self, one, self.select_lt(zero, -one, self))
    }

    /// Returns `self · a + b`, rounded once if the target has a fused instruction, twice otherwise. A software routine
    /// that rounds once on every target would be many times slower.
    fn mul_add(self, a: Self, b: Self) -> Self;

    /// Multiplies the number by `a` in place.
    #[inline(always)]
    fn scale(&mut self, a: f64) {
        *self *= Self::from_f64(a);
    }

    /// Returns `self · a + b`, like [`mul_add`](Scalar::mul_add), for a constant `a`.
    #[inline(always)]
    fn times_plus(self, a: f64, b: Self) -> Self {
        Self::from_f64(a).mul_add(self, b)
    }

    /// Returns the larger of two numbers; NaN if either is NaN, so that a maximum cannot hide one.
    fn max(self, other: Self) -> Self;

    /// Returns `then` in the lanes with `self < limit`, `otherwise` elsewhere (also where either is NaN).
    fn select_lt(self, limit: Self, then: Self, otherwise: Self) -> Self;

    /// Returns `then` in the lanes that are positive, `otherwise` in those that are not, and NaN in those that are NaN.
    #[inline]
    fn select_positive(self, then: Self, otherwise: Self) -> Self {
        let zero = Self::default();
        zero.select_lt(
            self,
            then,
            self.select_lt(Self::from_f64(1.0), otherwise, self),
        )
    }

    /// Returns 1/self if |self| ≥ 1e-100 (1e-12 for `f32`), otherwise the inverse of this limit: a large finite number,
    /// which gives 0 when multiplied by 0. The derivative of a length √(a·a) at a = 0 is therefore 0.
    #[inline]
    #[doc(hidden)]
    fn inverse_of_length(self) -> Self {
        let shortest = Self::from_f64(if Self::EPSILON < 1e-10 { 1e-100 } else { 1e-12 });
        let one = Self::from_f64(1.0);
        one / self.abs().select_lt(shortest, shortest, self)
    }

    /// Returns self (1 + 2⁻²⁶), or self (1 + 2⁻¹⁵) for `f32`: larger by a small part that exceeds rounding. This makes
    /// a pivot that may consist of rounding alone safe to divide by.
    #[inline]
    #[doc(hidden)]
    fn inflated(self) -> Self {
        let double = Self::EPSILON < 1e-10;
        let parts = if double { 1u32 << 26 } else { 1 << 15 };
        self * Self::from_f64(1.0 + 1.0 / f64::from(parts))
    }

    /// Implements [`so3::retract`]; dual numbers use the derivative of exp.
    #[inline(always)]
    #[doc(hidden)]
    fn turned_matrix(r: so3::Matrix<Self>, u: so3::Vector<Self>) -> so3::Matrix<Self> {
        so3::product(r, so3::exp(u))
    }

    /// Implements [`s3::retract`]; dual numbers use the derivative of exp.
    #[inline(always)]
    #[doc(hidden)]
    fn turned_quaternion(q: s3::Quaternion<Self>, u: so3::Vector<Self>) -> s3::Quaternion<Self> {
        s3::product(q, s3::exp(u))
    }

    /// Implements [`so3::dexpinv`]; dual numbers with many slopes use its six partial derivatives.
    #[inline(always)]
    #[doc(hidden)]
    fn chart_velocity(u: so3::Vector<Self>, w: so3::Vector<Self>) -> so3::Vector<Self> {
        so3::chart_velocity(u, w)
    }

    /// Returns whether all lanes are positive, finite and not subnormal: a pivot that can be divided by.
    fn is_positive(self) -> bool;

    /// Returns the nearest whole number, for numbers in the range where whole numbers are exact; its slopes are zero.
    #[inline]
    #[doc(hidden)]
    fn nearest_whole(self) -> Self {
        let large = Self::from_f64(1.5 / Self::EPSILON);
        self + large - large
    }

    /// Returns whether no lane is infinite or NaN.
    fn is_finite(self) -> bool;

    /// Returns the largest lane, or NaN if one is NaN. Lanes that are stepped together take the step that the worst of
    /// them needs.
    fn largest_lane(self) -> f64;
}

/// Whether `mul_add` of the standard library is a single instruction on this target.
pub(crate) const FUSED: bool =
    cfg!(feature = "std") && cfg!(any(target_feature = "fma", target_arch = "aarch64"));

#[cfg(feature = "std")]
macro_rules! math {
    ($float:ident, $std:ident, $libm:ident, $($argument:expr),+) => { $float::$std($($argument),+) };
}
#[cfg(not(feature = "std"))]
macro_rules! math {
    ($float:ident, $std:ident, $libm:ident, $($argument:expr),+) => { libm::$libm($($argument),+) };
}

macro_rules! scalar {
    ($float:ident, $near:expr, $sincos:ident, $sqrt:ident, $exp:ident, $log:ident, $atan2:ident, $fabs:ident) => {
        impl Scalar for $float {
            const EPSILON: f64 = $float::EPSILON as f64;

            #[inline]
            fn from_f64(value: f64) -> Self {
                value as $float
            }

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                #[cold]
                #[inline(never)]
                fn far(angle: $float) -> ($float, $float) {
                    math!($float, sin_cos, $sincos, angle)
                }
                match $near(self) {
                    Some(both) => both,
                    None => far(self),
                }
            }

            #[inline]
            fn sqrt(self) -> Self {
                math!($float, sqrt, $sqrt, self)
            }

            #[inline]
            fn exp(self) -> Self {
                math!($float, exp, $exp, self)
            }

            #[inline]
            fn ln(self) -> Self {
                math!($float, ln, $log, self)
            }

            #[inline]
            fn atan2(self, x: Self) -> Self {
                math!($float, atan2, $atan2, self, x)
            }

            #[inline]
            fn abs(self) -> Self {
                math!($float, abs, $fabs, self)
            }

            #[inline]
            fn mul_add(self, a: Self, b: Self) -> Self {
                #[cfg(feature = "std")]
                if FUSED {
                    return $float::mul_add(self, a, b);
                }
                self * a + b
            }

            #[inline]
            fn max(self, other: Self) -> Self {
                if self > other || self.is_nan() {
                    self
                } else {
                    other
                }
            }

            #[inline]
            fn select_lt(self, limit: Self, then: Self, otherwise: Self) -> Self {
                if self < limit { then } else { otherwise }
            }

            #[inline]
            fn is_positive(self) -> bool {
                // Compares bit patterns, from that of the smallest normal number to that of infinity: for two
                // comparisons of numbers the compiler generates three times as many instructions.
                const SMALLEST_NORMAL: $float = $float::MIN_POSITIVE;
                self.to_bits().wrapping_sub(SMALLEST_NORMAL.to_bits())
                    < $float::INFINITY.to_bits() - SMALLEST_NORMAL.to_bits()
            }

            #[inline]
            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }

            #[inline]
            fn largest_lane(self) -> f64 {
                f64::from(self)
            }
        }
    };
}

scalar!(
    f64,
    crate::trig::sin_cos,
    sincos,
    sqrt,
    exp,
    log,
    atan2,
    fabs
);
scalar!(f32, |_| None, sincosf, sqrtf, expf, logf, atan2f, fabsf);

/// Returns the spacing of numbers at 1: that of `f64`, or that of `f32` if the scalar cannot resolve the former.
#[inline]
pub(crate) fn epsilon<S: Scalar>() -> S {
    let (one, double) = (S::from_f64(1.0), S::from_f64(f64::EPSILON));
    if (one + double - one).is_positive() {
        double
    } else {
        S::from_f64(f32::EPSILON as f64)
    }
}

/// Returns Σ cᵢ zⁱ. The first term is added last (it carries the rounding), the others are summed in pairs, which
/// halves the chain of dependent operations of Horner's rule.
#[inline]
pub(crate) fn series<S: Scalar>(z: S, coefficients: [f64; 7]) -> S {
    // Written out instead of `map`, which compiles to a call for SIMD lanes.
    let of = S::from_f64;
    let [c0, c1, c2, c3, c4, c5, c6] = coefficients;
    let z2 = z * z;
    let low = of(c2).mul_add(z, of(c1));
    let middle = of(c4).mul_add(z, of(c3));
    let high = of(c6).mul_add(z, of(c5));
    let rest = high.mul_add(z2 * z2, middle.mul_add(z2, low));
    rest.mul_add(z, of(c0))
}
