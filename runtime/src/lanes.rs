//! Scalars that hold several independent numbers, one in each SIMD lane.

use crate::scalar::Scalar;

/// A scalar that holds [`COUNT`](Self::COUNT) independent numbers; `f64` and `f32` have one lane.
///
/// With the feature `wide`, the vectors `f64x4`, `f64x8`, `f32x8` and `f32x16` of the crate `wide` are scalars with
/// that many lanes; see [`wide`](crate::wide). The result in a lane does not depend on the other lanes, except where a
/// method has to make one decision for all of them, by the worst lane: the step sizes of
/// [`Adaptive`](crate::adaptive::Adaptive) and the iterations of implicit methods.
///
/// ```
/// use hamel::Lanes;
///
/// fn lengths<L: Lanes<Element = f64>>() -> Vec<f64> {
///     L::from_lanes(|lane| 0.5 + lane as f64).lanes().as_ref().to_vec()
/// }
/// assert_eq!(lengths::<f64>(), [0.5]);
/// # #[cfg(feature = "wide")]
/// assert_eq!(lengths::<hamel::wide::f64x4>(), [0.5, 1.5, 2.5, 3.5]);
/// ```
pub trait Lanes: Scalar {
    /// The type of the number in one lane.
    type Element: Scalar;
    /// An array of the numbers in all lanes.
    type Array: AsRef<[Self::Element]> + Copy;

    /// The number of lanes.
    const COUNT: usize;

    /// Creates a scalar from the value for the index of each lane, counted from 0.
    fn from_lanes(value: impl FnMut(usize) -> Self::Element) -> Self;

    /// Returns the values, lane by lane.
    fn lanes(self) -> Self::Array;
}

macro_rules! single {
    ($($float:ident)*) => {$(
        impl Lanes for $float {
            type Element = $float;
            type Array = [$float; 1];
            const COUNT: usize = 1;

            #[inline]
            fn from_lanes(mut value: impl FnMut(usize) -> $float) -> Self {
                value(0)
            }

            #[inline]
            fn lanes(self) -> [$float; 1] {
                [self]
            }
        }
    )*};
}

single!(f64 f32);
