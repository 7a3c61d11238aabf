//! Small dense matrices by rows, for the regulator. Loops iterate over entries, not indices, so that no access can be
//! out of bounds.

use hamel::Scalar;

/// R rows of C numbers.
pub(crate) type Matrix<S, const R: usize, const C: usize> = [[S; C]; R];

/// Zeros.
pub(crate) fn zeros<S: Scalar, const R: usize, const C: usize>() -> Matrix<S, R, C> {
    [[S::default(); C]; R]
}

/// y + a x
pub(crate) fn add_scaled<S: Scalar, const C: usize>(y: &mut [S; C], a: S, x: &[S; C]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y = a.mul_add(*x, *y);
    }
}

/// a · b
pub(crate) fn dot<S: Scalar, const N: usize>(a: &[S; N], b: &[S; N]) -> S {
    let pairs = a.iter().zip(b);
    pairs.fold(S::default(), |sum, (a, b)| a.mul_add(*b, sum))
}

/// Y + a D for a diagonal matrix D
pub(crate) fn add_diagonal<S: Scalar, const N: usize>(y: &mut Matrix<S, N, N>, a: S, d: &[S; N]) {
    for ((i, row), d) in y.iter_mut().enumerate().zip(d) {
        if let Some(entry) = row.get_mut(i) {
            *entry = a.mul_add(*d, *entry);
        }
    }
}

/// Y + Aᵀ B with the columns of A from `first` on, as many as Y has rows. Products with zeros of A are skipped: more
/// than half of the slopes of a step are zero.
pub(crate) fn add_transposed_product<
    S: Scalar,
    const R: usize,
    const C: usize,
    const I: usize,
    const A: usize,
    const B: usize,
>(
    y: &mut Matrix<S, R, C>,
    a: &Matrix<S, I, A>,
    first: usize,
    b: &Matrix<S, I, B>,
) {
    for (a, b) in a.iter().zip(b) {
        for (row, a) in y.iter_mut().zip(a.iter().skip(first)) {
            if a.abs().largest_lane() != 0.0 {
                for (y, b) in row.iter_mut().zip(b) {
                    *y = a.mul_add(*b, *y);
                }
            }
        }
    }
}

/// Aᵀ b
pub(crate) fn transposed_apply<S: Scalar, const R: usize, const C: usize>(
    a: &Matrix<S, C, R>,
    b: &[S; C],
) -> [S; R] {
    let mut result = [S::default(); R];
    for (row, b) in a.iter().zip(b) {
        add_scaled(&mut result, *b, row);
    }
    result
}

/// Y + A B for a symmetric A, without the products with zeros of B
pub(crate) fn add_symmetric_product<S: Scalar, const R: usize, const C: usize>(
    y: &mut Matrix<S, R, C>,
    a: &Matrix<S, R, R>,
    b: &Matrix<S, R, C>,
) {
    for (a, b) in a.iter().zip(b) {
        for (j, b) in b.iter().enumerate() {
            if b.abs().largest_lane() != 0.0 {
                for (row, a) in y.iter_mut().zip(a) {
                    if let Some(entry) = row.get_mut(j) {
                        *entry = a.mul_add(*b, *entry);
                    }
                }
            }
        }
    }
}

/// Sets B to Aᵀ.
pub(crate) fn transpose<S: Scalar, const R: usize, const C: usize>(
    a: &Matrix<S, R, C>,
    b: &mut Matrix<S, C, R>,
) {
    for (j, column) in b.iter_mut().enumerate() {
        for (entry, row) in column.iter_mut().zip(a) {
            if let Some(a) = row.get(j) {
                *entry = *a;
            }
        }
    }
}

/// Copies the columns of A from `first` on to B, as far as both extend.
pub(crate) fn take<S: Scalar, const R: usize, const A: usize, const B: usize>(
    a: &Matrix<S, R, A>,
    first: usize,
    b: &mut Matrix<S, R, B>,
) {
    for (entries, a) in b.iter_mut().zip(a) {
        for (entry, a) in entries.iter_mut().zip(a.iter().skip(first)) {
            *entry = *a;
        }
    }
}

/// Solves A X = B in place for a symmetric A, by elimination; returns whether A is positive definite.
pub(crate) fn solve<S: Scalar, const N: usize, const C: usize>(
    a: &mut Matrix<S, N, N>,
    b: &mut Matrix<S, N, C>,
) -> bool {
    for i in 0..N {
        let (pivots, known) = (a[i], b[i]);
        if !pivots[i].is_positive() {
            return false;
        }
        let inverse = S::from_f64(1.0) / pivots[i];
        for k in i + 1..N {
            let factor = -(a[k][i] * inverse);
            add_scaled(&mut a[k], factor, &pivots);
            add_scaled(&mut b[k], factor, &known);
        }
    }
    for i in (0..N).rev() {
        let inverse = S::from_f64(1.0) / a[i][i];
        b[i].iter_mut().for_each(|entry| *entry *= inverse);
        let known = b[i];
        for k in 0..i {
            let factor = -a[k][i];
            add_scaled(&mut b[k], factor, &known);
        }
    }
    true
}
