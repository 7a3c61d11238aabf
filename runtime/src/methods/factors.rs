//! Systems of linear equations: Gaussian elimination with scaled partial pivoting.
//!
//! P J = L U. The pivot of a column is the entry that is largest relative to its row, after rows and columns have been
//! scaled so that the largest entry of each is about 1. The choice therefore does not depend on units, for example if
//! one row is a current in A and another a speed in mm/s. Every lane has its own row exchanges. Source: G. H. Golub, C.
//! F. Van Loan, *Matrix Computations* (2013), 3.4 and 3.5.2.

use core::marker::PhantomData;

use crate::scalar::Scalar;
use crate::store::{Store, Table};

/// Number of sweeps over rows and columns that determine their scales.
const SWEEPS: u32 = 3;

/// A square matrix, accessed by rows.
pub(super) trait Square<S> {
    /// Returns row `i`; empty beyond the last.
    fn row(&self, i: usize) -> &[S];

    /// Returns row `i` for writing; empty beyond the last.
    fn row_mut(&mut self, i: usize) -> &mut [S];
}

/// The square block of a table that starts at row and column `first` and ends at the last row.
pub(super) struct Part<T> {
    pub(super) table: T,
    pub(super) first: usize,
}

impl<S: Scalar, T: Table<S>> Square<S> for Part<T> {
    fn row(&self, i: usize) -> &[S] {
        let row = self.table.row(self.first + i);
        row.get(self.first..self.table.rows()).unwrap_or(&[])
    }

    fn row_mut(&mut self, i: usize) -> &mut [S] {
        let columns = self.first..self.table.rows();
        let row = self.table.row_mut(self.first + i);
        row.get_mut(columns).unwrap_or(&mut [])
    }
}

/// LU factors, stored in place of the matrix: L without its unit diagonal, and U.
pub(super) struct Factors<S, T, V> {
    matrix: T,
    /// For each column, the index of the row that became its pivot row.
    pivots: V,
    scalar: PhantomData<S>,
}

impl<S: Scalar, T: Square<S>, V: Store<S>> Factors<S, T, V> {
    /// Factorises a matrix with as many rows as `zeros` has entries. A singular matrix leads to infinite or NaN
    /// solutions.
    pub(super) fn new(matrix: T, zeros: V) -> Self {
        let mut factors = Factors {
            matrix,
            pivots: zeros.clone(),
            scalar: PhantomData,
        };
        let mut units = factors.units(zeros.clone());
        let mut above = zeros;
        for column in 0..factors.magnitude() {
            factors.exchange(column, units.as_mut());
            for (own, entry) in above.as_mut().iter_mut().zip(factors.matrix.row(column)) {
                *own = *entry;
            }
            factors.eliminate(column, above.as_ref());
        }
        factors
    }

    fn magnitude(&self) -> usize {
        self.pivots.as_ref().len()
    }

    fn entry(&self, i: usize, j: usize) -> S {
        self.matrix.row(i).get(j).copied().unwrap_or_default()
    }

    /// Returns the scale of each row: 1 over its largest entry, with columns scaled so that the largest entry of each
    /// is about 1.
    fn units(&self, zeros: V) -> V {
        let one = S::from_f64(1.0);
        let (mut rows, mut columns) = (zeros.clone(), zeros);
        columns.as_mut().fill(one);
        for _ in 0..SWEEPS {
            for (i, unit) in rows.as_mut().iter_mut().enumerate() {
                let entries = self.matrix.row(i).iter().zip(columns.as_ref());
                let largest = entries.map(|(entry, column)| *column * entry.abs());
                *unit = one / largest.fold(S::default(), Scalar::max);
            }
            for (j, unit) in columns.as_mut().iter_mut().enumerate() {
                let entries = rows.as_ref().iter().enumerate();
                let largest = entries.map(|(i, row)| *row * self.entry(i, j).abs());
                *unit = one / largest.fold(S::default(), Scalar::max);
            }
        }
        rows
    }

    /// Exchanges rows so that the pivot of a column is in its place, lane by lane.
    fn exchange(&mut self, column: usize, units: &mut [S]) {
        let part = |factors: &Self, i: usize| {
            factors.entry(i, column).abs() * units.get(i).copied().unwrap_or_default()
        };
        let (mut largest, mut pivot) = (part(self, column), S::from_f64(column as f64));
        for i in column + 1..self.magnitude() {
            let other = part(self, i);
            pivot = largest.select_lt(other, S::from_f64(i as f64), pivot);
            largest = largest.select_lt(other, other, largest);
        }
        for i in column + 1..self.magnitude() {
            let Some(chosen) = chosen(pivot, i) else {
                continue;
            };
            for j in 0..self.magnitude() {
                let (mut upper, mut lower) = (self.entry(column, j), self.entry(i, j));
                swap(chosen, &mut upper, &mut lower);
                self.put(column, j, upper);
                self.put(i, j, lower);
            }
            if let Ok([upper, lower]) = units.get_disjoint_mut([column, i]) {
                swap(chosen, upper, lower);
            }
        }
        if let Some(own) = self.pivots.as_mut().get_mut(column) {
            *own = pivot;
        }
    }

    fn put(&mut self, i: usize, j: usize, value: S) {
        if let Some(entry) = self.matrix.row_mut(i).get_mut(j) {
            *entry = value;
        }
    }

    /// Subtracts multiples of the pivot row, `above`, from the rows below it, and stores the factors in place of the
    /// zeros.
    fn eliminate(&mut self, column: usize, above: &[S]) {
        let pivot = above.get(column).copied().unwrap_or_default();
        for i in column + 1..self.magnitude() {
            let Some((first, rest)) = self
                .matrix
                .row_mut(i)
                .get_mut(column..)
                .and_then(|row| row.split_first_mut())
            else {
                continue;
            };
            *first /= pivot;
            let factor = -*first;
            for (entry, above) in rest.iter_mut().zip(above.iter().skip(column + 1)) {
                *entry = factor.mul_add(*above, *entry);
            }
        }
    }

    /// Solves J a = b in place: b ← J⁻¹ b.
    pub(super) fn solve(&self, b: &mut [S]) {
        for (column, pivot) in self.pivots.as_ref().iter().enumerate() {
            for i in column + 1..self.magnitude() {
                if let Some(chosen) = chosen(*pivot, i)
                    && let Ok([upper, lower]) = b.get_disjoint_mut([column, i])
                {
                    swap(chosen, upper, lower);
                }
            }
        }
        for i in 0..self.magnitude() {
            let (above, rest) = b.split_at_mut(i.min(b.len()));
            if let Some(own) = rest.first_mut() {
                let known = self.matrix.row(i).iter().zip(above.iter());
                *own = known.fold(*own, |sum, (factor, b)| (-*factor).mul_add(*b, sum));
            }
        }
        for i in (0..self.magnitude()).rev() {
            let Some((own, below)) = b.get_mut(i..).and_then(<[S]>::split_first_mut) else {
                continue;
            };
            let known = self.matrix.row(i).iter().skip(i + 1).zip(below.iter());
            let sum = known.fold(*own, |sum, (factor, b)| (-*factor).mul_add(*b, sum));
            *own = sum / self.entry(i, i);
        }
    }
}

/// Returns 1 in the lanes whose pivot is row `i` and 0 elsewhere; `None` if there is no such lane.
fn chosen<S: Scalar>(pivot: S, i: usize) -> Option<S> {
    let apart = (pivot - S::from_f64(i as f64)).abs();
    let chosen = apart.select_lt(S::from_f64(0.5), S::from_f64(1.0), S::default());
    (chosen.largest_lane() != 0.0).then_some(chosen)
}

/// Exchanges two numbers in the lanes where `chosen` is 1.
fn swap<S: Scalar>(chosen: S, a: &mut S, b: &mut S) {
    let half = S::from_f64(0.5);
    let (one, other) = (*a, *b);
    *a = half.select_lt(chosen, other, one);
    *b = half.select_lt(chosen, one, other);
}

#[cfg(test)]
mod tests {
    use super::{Factors, Part};

    fn whole<T>(table: T) -> Part<T> {
        Part { table, first: 0 }
    }

    /// Returns the solution of J a = b, and the largest |J a − b| relative to |J| |a|, row by row.
    fn solved<const N: usize>(j: [[f64; N]; N], b: [f64; N]) -> ([f64; N], f64) {
        let mut a = b;
        Factors::new(whole(j), [0.0; N]).solve(&mut a);
        let mut worst: f64 = 0.0;
        for (row, b) in j.iter().zip(b) {
            let left: f64 = row.iter().zip(a).map(|(j, a)| j * a).sum();
            let size: f64 = row.iter().zip(a).map(|(j, a)| (j * a).abs()).sum();
            worst = worst.max((left - b).abs() / size);
        }
        (a, worst)
    }

    /// Uses random matrices with zeros on the diagonal, in units that differ by a factor of 1e12.
    #[test]
    fn solutions_are_exact_whatever_the_units() {
        let mut seed = 1_u64;
        let mut number = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for _ in 0..500 {
            let (mut rows, mut columns) = ([0.0; 7], [0.0; 7]);
            for unit in rows.iter_mut().chain(&mut columns) {
                *unit = 10.0_f64.powf(12.0 * number());
            }
            let plain: [[f64; 7]; 7] = core::array::from_fn(|i| {
                core::array::from_fn(|j| if i == j { 0.0 } else { number() })
            });
            let b: [f64; 7] = core::array::from_fn(|_| number());
            let scaled: [[f64; 7]; 7] = core::array::from_fn(|i| {
                core::array::from_fn(|j| rows[i] * columns[j] * plain[i][j])
            });
            let (a, worst) = solved(plain, b);
            assert!(worst < 1e-12, "{worst:e}");
            let (c, worst) = solved(scaled, core::array::from_fn(|i| rows[i] * b[i]));
            assert!(worst < 1e-12, "{worst:e}");
            for ((a, c), unit) in a.iter().zip(c).zip(columns) {
                let size = a.abs().max(1.0);
                assert!((c * unit - a).abs() < 1e-8 * size, "{a} {c}");
            }
        }
    }

    /// Without scaling, the large unit of the first equation would make it the pivot row, and the second would be lost.
    #[test]
    fn a_large_unit_makes_no_pivot() {
        let (a, _) = solved([[10.0, 1e20], [1.0, 1.0]], [1e20, 2.0]);
        assert!(
            (a[0] - 1.0).abs() < 1e-15 && (a[1] - 1.0).abs() < 1e-15,
            "{a:?}"
        );
    }

    #[test]
    fn a_singular_matrix_has_no_solution() {
        for j in [
            [[1.0, 2.0], [2.0, 4.0]],
            [[0.0; 2]; 2],
            [[1.0, 0.0], [1.0, 0.0]],
        ] {
            let mut a = [1.0_f64, 1.0];
            Factors::new(whole(j), [0.0; 2]).solve(&mut a);
            assert!(a.iter().any(|a| !a.is_finite()), "{a:?}");
        }
    }

    /// The factorised matrix is a part of a table whose other entries are ignored.
    #[test]
    fn the_matrix_may_stand_within_a_table() {
        let table = [[7.0; 4], [7.0, 0.0, 2.0, 7.0], [7.0, 4.0, 0.0, 7.0]];
        let mut a = [6.0_f64, 8.0];
        Factors::new(Part { table, first: 1 }, [0.0; 2]).solve(&mut a);
        assert_eq!(a, [2.0, 3.0]);
    }
}
