//! Linear algebra over a field: reduced row echelon form and its applications.

use super::poly::field::Field;

/// A matrix in reduced row echelon form, without zero rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Echelon<F> {
    /// The rows, each with 1 at its pivot.
    pub rows: Vec<Vec<F>>,
    /// The column of each row's pivot, increasing.
    pub pivots: Vec<usize>,
}

impl<F: Field> Echelon<F> {
    /// Reduces the rows of a matrix, which must all have the same length.
    pub fn new(mut rows: Vec<Vec<F>>) -> Self {
        let columns = rows.first().map_or(0, Vec::len);
        let mut pivots = Vec::new();
        for column in 0..columns {
            let rank = pivots.len();
            let Some(found) = (rank..rows.len()).find(|&row| !rows[row][column].is_zero()) else {
                continue;
            };
            rows.swap(rank, found);
            let Some(inverse) = rows[rank][column].inv() else {
                continue;
            };
            let pivot: Vec<F> = rows[rank].iter().map(|entry| entry.mul(&inverse)).collect();
            for (row, entries) in rows.iter_mut().enumerate() {
                let factor = entries[column].clone();
                if row == rank || factor.is_zero() {
                    continue;
                }
                for (entry, other) in entries.iter_mut().zip(&pivot) {
                    *entry = entry.sub(&factor.mul(other));
                }
            }
            rows[rank] = pivot;
            pivots.push(column);
        }
        rows.truncate(pivots.len());
        Echelon { rows, pivots }
    }

    /// Rank of the matrix.
    pub fn rank(&self) -> usize {
        self.pivots.len()
    }

    /// Returns a basis of the null space {v : rows · v = 0} in a space of `columns` dimensions.
    pub fn null_space(&self, columns: usize) -> Vec<Vec<F>> {
        let open = (0..columns).filter(|column| !self.pivots.contains(column));
        open.map(|column| {
            let mut vector = vec![F::zero(); columns];
            vector[column] = F::one();
            for (row, &pivot) in self.rows.iter().zip(&self.pivots) {
                vector[pivot] = row[column].neg();
            }
            vector
        })
        .collect()
    }
}

/// Returns a solution of A v = b that uses the leftmost independent columns of A; `None` if there is none.
/// Each row of `augmented` is a row of A followed by its entry of b.
pub fn solution<F: Field>(augmented: Vec<Vec<F>>) -> Option<Vec<F>> {
    let columns = augmented.first()?.len().checked_sub(1)?;
    let echelon = Echelon::new(augmented);
    if echelon.pivots.last() == Some(&columns) {
        return None;
    }
    let mut solution = vec![F::zero(); columns];
    for (row, &pivot) in echelon.rows.iter().zip(&echelon.pivots) {
        solution[pivot] = row[columns].clone();
    }
    Some(solution)
}

/// Returns the signature of a symmetric matrix over Q: the numbers of positive and negative squares, by
/// Lagrange's reduction (by Sylvester's law of inertia, they do not depend on the basis).
pub fn signature(matrix: &[Vec<num_rational::BigRational>]) -> (usize, usize) {
    use num_traits::Signed;
    let mut m = matrix.to_vec();
    let n = m.len();
    let (mut plus, mut minus) = (0, 0);
    let mut done = vec![false; n];
    loop {
        let open: Vec<usize> = (0..n).filter(|&i| !done[i]).collect();
        let diagonal = open.iter().copied().find(|&i| !m[i][i].is_zero());
        let Some(k) = diagonal else {
            // No diagonal entry is left: the substitution x → x + y turns a mixed product x y into a
            // square.
            let pair = open.iter().find_map(|&i| {
                let mixed = open.iter().find(|&&j| !m[i][j].is_zero());
                mixed.map(|&j| (i, j))
            });
            let Some((i, j)) = pair else { break };
            for row in 0..n {
                let term = m[row][j].clone();
                m[row][i] += term;
            }
            for column in 0..n {
                let term = m[j][column].clone();
                m[i][column] += term;
            }
            continue;
        };
        if m[k][k].is_positive() {
            plus += 1;
        } else {
            minus += 1;
        }
        done[k] = true;
        for &i in open.iter().filter(|&&i| i != k) {
            for &j in open.iter().filter(|&&j| j != k) {
                let change = &m[i][k] * &m[k][j] / &m[k][k];
                m[i][j] -= change;
            }
        }
        for i in 0..n {
            if i != k {
                m[i][k] = Field::zero();
                m[k][i] = Field::zero();
            }
        }
    }
    (plus, minus)
}
