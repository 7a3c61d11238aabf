//! Storage of coordinates, velocities, chart vectors and inputs.

use core::fmt::Debug;

use crate::Scalar;

/// A list of numbers whose length is fixed by the system: `[S; N]` in generated code, `Vec<S>` in
/// code that interprets a description read at run time (feature `std`).
///
/// ```
/// use hamel::Store;
///
/// let fixed: [f64; 3] = Store::zeros(3);
/// let listed: Vec<f64> = Store::zeros(3);
/// assert_eq!(listed, fixed);
/// ```
pub trait Store<S>: Clone + Debug + AsRef<[S]> + AsMut<[S]> {
    /// Returns `length` zeros. Storage of a fixed length, such as `[S; N]`, has its own length and ignores `length`.
    fn zeros(length: usize) -> Self;
}

impl<S: Scalar, const N: usize> Store<S> for [S; N] {
    #[inline(always)]
    fn zeros(_: usize) -> Self {
        [S::default(); N]
    }
}

#[cfg(feature = "std")]
impl<S: Scalar> Store<S> for Vec<S> {
    #[inline]
    fn zeros(length: usize) -> Self {
        vec![S::default(); length]
    }
}

/// A matrix, stored by rows, whose size is fixed by the system: `[[S; COLUMNS]; ROWS]`.
pub trait Table<S>: Clone + Debug {
    /// Returns a matrix of zeros.
    fn zero() -> Self;

    /// Returns the number of rows.
    fn rows(&self) -> usize;

    /// Returns row `i`; empty beyond the last.
    fn row(&self, i: usize) -> &[S];

    /// Returns row `i` for writing; empty beyond the last.
    fn row_mut(&mut self, i: usize) -> &mut [S];

    /// Adds to row `i` the rows of `other` from row `k` on, each multiplied by its factor. Rows with the factor 0 are
    /// skipped.
    fn add_combination(&mut self, i: usize, factors: &[S], other: &Self, k: usize);

    /// Adds `factor` times another row, `k`, to row `i`.
    fn add_scaled(&mut self, i: usize, factor: S, k: usize);

    /// Sets row `i` to `factor` times another row, `k`.
    fn repeat(&mut self, i: usize, factor: S, k: usize);

    /// Returns whether every entry is finite.
    fn is_finite(&self) -> bool;
}

impl<S: Scalar, const ROWS: usize, const COLUMNS: usize> Table<S> for [[S; COLUMNS]; ROWS] {
    #[inline]
    fn zero() -> Self {
        [[S::default(); COLUMNS]; ROWS]
    }

    #[inline]
    fn rows(&self) -> usize {
        ROWS
    }

    #[inline]
    fn row(&self, i: usize) -> &[S] {
        self.get(i).map_or(&[], |row| row)
    }

    #[inline]
    fn row_mut(&mut self, i: usize) -> &mut [S] {
        self.get_mut(i).map_or(&mut [], |row| row)
    }

    #[inline]
    fn add_combination(&mut self, i: usize, factors: &[S], other: &Self, k: usize) {
        let Some(own) = self.get_mut(i) else { return };
        let mut sum = *own;
        for (factor, row) in factors.iter().zip(other.iter().skip(k)) {
            if factor.abs().largest_lane() != 0.0 {
                for (entry, by) in sum.iter_mut().zip(row) {
                    *entry = factor.mul_add(*by, *entry);
                }
            }
        }
        *own = sum;
    }

    #[inline]
    fn add_scaled(&mut self, i: usize, factor: S, k: usize) {
        if let Ok([own, row]) = self.get_disjoint_mut([i, k]) {
            for (entry, by) in own.iter_mut().zip(row) {
                *entry = factor.mul_add(*by, *entry);
            }
        }
    }

    #[inline]
    fn repeat(&mut self, i: usize, factor: S, k: usize) {
        if let Ok([own, row]) = self.get_disjoint_mut([i, k]) {
            for (entry, by) in own.iter_mut().zip(row) {
                *entry = factor * *by;
            }
        }
    }

    #[inline]
    fn is_finite(&self) -> bool {
        is_finite(self.as_flattened())
    }
}

/// y ← y + x, element by element.
#[inline]
pub(crate) fn add<S: Scalar>(y: &mut [S], x: &[S]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += *x;
    }
}

/// y ← y + a x, element by element.
#[inline]
pub(crate) fn add_scaled<S: Scalar>(y: &mut [S], a: f64, x: &[S]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y = x.times_plus(a, *y);
    }
}

/// y ← a y, element by element.
#[inline]
pub(crate) fn scale<S: Scalar>(y: &mut [S], a: f64) {
    for y in y {
        y.scale(a);
    }
}

/// Returns the largest [`size`](Scalar::magnitude) of an element.
#[inline]
pub(crate) fn largest<S: Scalar>(x: &[S]) -> S {
    x.iter()
        .fold(S::default(), |most, x| Scalar::max(most, x.magnitude()))
}

/// Returns whether every element is finite. There is no early exit, so the processor can test several elements at a
/// time.
#[inline]
pub(crate) fn is_finite<S: Scalar>(x: &[S]) -> bool {
    x.iter().fold(true, |all, x| all & x.is_finite())
}
