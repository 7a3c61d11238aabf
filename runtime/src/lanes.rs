//! Several numbers in one: lanes.

use crate::scalar::Scalar;

/// A scalar of [`COUNT`](Self::COUNT) independent numbers; `f64` and `f32` are lanes of one.
///
/// With the feature `wide` the vectors `f64x4`, `f64x8`, `f32x8` and `f32x16` of the crate of that
/// name are lanes of as many numbers, see [`wide`](crate::wide). What a lane computes does not
/// depend on the others, but where a method takes the decision of the worst lane: steps of
/// [`Adaptive`](crate::adaptive::Adaptive), iterations of implicit methods.
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
    /// One of the numbers.
    type Element: Scalar;
    /// All of them.
    type Array: AsRef<[Self::Element]> + Copy;

    /// How many there are.
    const COUNT: usize;

    /// The value of each lane, by its index from 0.
    fn from_lanes(value: impl FnMut(usize) -> Self::Element) -> Self;

    /// The values, lane by lane.
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
