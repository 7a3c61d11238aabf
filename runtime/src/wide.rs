//! SIMD lanes: the vectors of the crate `wide` as scalars.
//!
//! `FreeBody::<f64x8>` moves eight bodies at once with the same code that moves one. Build with
//! `RUSTFLAGS="-C target-cpu=native"`, or with the target features of the target machine: without them a vector is
//! split into pairs of numbers on x86-64.
//!
//! Sums, products, quotients, fused products (with the feature `std`) and roots are rounded exactly as for the element
//! type, and so are sine and cosine of `f64`. A lane that uses no other functions is therefore bitwise equal to a run
//! with the element type. The other functions are the polynomials of `wide` (after A. Fog's vector class library and S.
//! Moshier's Cephes): sin and cos of `f32` to 1 ε, exp, ln and atan2 to 4 ε relative, where ε is the spacing of numbers
//! at 1. Outside the range of these polynomials, the function of the element type is used in the lanes concerned:
//! angles beyond 10⁶ rad (`f32`: 4000 rad), logarithms of subnormal and non-positive numbers, directions to infinite
//! points.

pub use wide::{f32x8, f32x16, f64x4, f64x8};

use crate::lanes::Lanes;
use crate::scalar::Scalar;

macro_rules! lanes {
    ($($vector:ident: $count:literal of $float:ident, $farthest:literal, $both:expr;)*) => {$(
        impl Scalar for $vector {
            const EPSILON: f64 = <$float as Scalar>::EPSILON;

            #[inline]
            fn from_f64(value: f64) -> Self {
                Self::splat(value as $float)
            }

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                #[cold]
                #[inline(never)]
                fn lane_by_lane(angles: $vector) -> ($vector, $vector) {
                    let each = angles.to_array().map(Scalar::sin_cos);
                    (
                        $vector::new(each.map(|(sine, _)| sine)),
                        $vector::new(each.map(|(_, cosine)| cosine)),
                    )
                }
                let (sine, cosine) = $both(self);
                let far = self.abs().simd_gt(Self::splat($farthest));
                if far.any() {
                    let exact = lane_by_lane(self);
                    (far.select(exact.0, sine), far.select(exact.1, cosine))
                } else {
                    (sine, cosine)
                }
            }

            #[inline]
            fn sqrt(self) -> Self {
                $vector::sqrt(self)
            }

            #[inline]
            fn exp(self) -> Self {
                $vector::exp(self)
            }

            #[inline]
            fn ln(self) -> Self {
                let inner = $vector::ln(self);
                let outside = self.simd_lt(Self::splat($float::MIN_POSITIVE));
                if outside.any() {
                    let exact = Self::new(self.to_array().map(Scalar::ln));
                    outside.select(exact, inner)
                } else {
                    inner
                }
            }

            #[inline]
            fn atan2(self, x: Self) -> Self {
                let inner = $vector::atan2(self, x);
                let infinite = self.is_inf() | x.is_inf();
                if infinite.any() {
                    let (y, x) = (self.to_array(), x.to_array());
                    let exact = Self::from_lanes(|lane| Scalar::atan2(y[lane], x[lane]));
                    infinite.select(exact, inner)
                } else {
                    inner
                }
            }

            #[inline]
            fn abs(self) -> Self {
                $vector::abs(self)
            }

            #[inline]
            fn mul_add(self, a: Self, b: Self) -> Self {
                $vector::mul_add(self, a, b)
            }

            #[inline]
            fn max(self, other: Self) -> Self {
                (self.simd_gt(other) | self.is_nan()).select(self, other)
            }

            #[inline]
            fn select_lt(self, limit: Self, then: Self, otherwise: Self) -> Self {
                self.simd_lt(limit).select(then, otherwise)
            }

            #[inline]
            fn is_positive(self) -> bool {
                (self.simd_ge(Self::splat($float::MIN_POSITIVE)) & self.simd_lt(Self::splat($float::INFINITY))).all()
            }

            #[inline]
            fn is_finite(self) -> bool {
                $vector::is_finite(self).all()
            }

            #[inline]
            fn largest_lane(self) -> f64 {
                let largest = self.to_array().into_iter().fold($float::NEG_INFINITY, Scalar::max);
                largest.largest_lane()
            }
        }

        impl Lanes for $vector {
            type Element = $float;
            type Array = [$float; $count];
            const COUNT: usize = $count;

            #[inline]
            fn from_lanes(value: impl FnMut(usize) -> $float) -> Self {
                Self::new(core::array::from_fn(value))
            }

            #[inline]
            fn lanes(self) -> [$float; $count] {
                self.to_array()
            }
        }
    )*};
}

lanes! {
    f64x4: 4 of f64, 1e6, crate::trig::of_lanes;
    f64x8: 8 of f64, 1e6, crate::trig::of_lanes;
    f32x8: 8 of f32, 4e3, f32x8::sin_cos;
    f32x16: 16 of f32, 4e3, f32x16::sin_cos;
}
