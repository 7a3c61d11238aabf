//! Storage of coordinates, velocities, chart vectors and inputs.

use core::fmt::Debug;

use crate::Scalar;

/// A list of numbers whose length is fixed by the system: `[S; N]` in generated code, `Vec<S>` in
/// code that interprets a description read at run time (feature `std`).
pub trait Store<S>: Clone + Debug + AsRef<[S]> + AsMut<[S]> {}

impl<S: Scalar, const N: usize> Store<S> for [S; N] {}

#[cfg(feature = "std")]
impl<S: Scalar> Store<S> for Vec<S> {}

/// y ← y + a x, element by element.
#[inline]
pub(crate) fn add_scaled<S: Scalar>(y: &mut [S], a: S, x: &[S]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y = a.mul_add(*x, *y);
    }
}

/// y ← a y, element by element.
#[inline]
pub(crate) fn scale<S: Scalar>(y: &mut [S], a: S) {
    for y in y {
        *y *= a;
    }
}

/// Whether every element is finite.
#[inline]
pub(crate) fn is_finite<S: Scalar>(x: &[S]) -> bool {
    x.iter().all(|x| x.is_finite())
}
