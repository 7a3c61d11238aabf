//! Small dense real matrices, stored as rows: products, Cholesky factorization, and solution of linear
//! systems.

/// aᵀ b.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// max |aᵢ|; infinite if an entry is NaN.
pub fn largest(a: &[f64]) -> f64 {
    let worst = |most: f64, a: &f64| match a.is_nan() {
        true => f64::INFINITY,
        false => most.max(a.abs()),
    };
    a.iter().fold(0.0, worst)
}

/// A b.
pub fn apply(a: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    a.iter().map(|row| dot(row, b)).collect()
}

/// A B.
pub fn product(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let columns = b.first().map_or(0, Vec::len);
    let entry = |row: &[f64], j: usize| row.iter().zip(b).map(|(a, b)| a * b[j]).sum();
    a.iter()
        .map(|row| (0..columns).map(|j| entry(row, j)).collect())
        .collect()
}

/// AᵀA of a matrix A with this number of columns.
pub fn gram(a: &[Vec<f64>], columns: usize) -> Vec<Vec<f64>> {
    let entry = |i: usize, j: usize| a.iter().map(|row| row[i] * row[j]).sum();
    (0..columns)
        .map(|i| (0..columns).map(|j| entry(i, j)).collect())
        .collect()
}

/// Computes the Cholesky factor L of a matrix of numbers (`f64`), L Lᵀ = M; `None` if M is not positive definite.
pub fn cholesky(m: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    cholesky_with(m, &|_, pivot| pivot)
}

/// Computes a Cholesky factor with modified pivots: `pivot` maps the index and the value of a pivot to the
/// value to use.
pub fn cholesky_with(m: &[Vec<f64>], pivot: &dyn Fn(usize, f64) -> f64) -> Option<Vec<Vec<f64>>> {
    let n = m.len();
    let mut l = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let sum = m[i][j] - dot(&l[i][..j], &l[j][..j]);
            l[i][j] = if i == j {
                pivot(i, sum).sqrt()
            } else {
                sum / l[j][j]
            };
        }
        if !(l[i][i] > 0.0 && l[i][i].is_finite()) {
            return None;
        }
    }
    Some(l)
}

/// L⁻¹ b, by forward substitution.
pub fn forward(l: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let mut y = b.to_vec();
    for i in 0..y.len() {
        y[i] = (y[i] - dot(&l[i][..i], &y[..i])) / l[i][i];
    }
    y
}

/// L⁻ᵀ b, by backward substitution.
pub fn backward(l: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let mut y = b.to_vec();
    for i in (0..y.len()).rev() {
        let sum: f64 = (i + 1..y.len()).map(|k| l[k][i] * y[k]).sum();
        y[i] = (y[i] - sum) / l[i][i];
    }
    y
}

/// A⁻¹ b by Gaussian elimination with row exchanges; `None` if A is singular.
pub fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        if a[pivot][k] == 0.0 || !a[pivot][k].is_finite() {
            return None;
        }
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            for j in k..n {
                a[i][j] -= factor * a[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    Some(b)
}

/// Computes the least-norm solution h of J h = r up to rounding, also if rows of J are redundant, by h = Jᵀ
/// (J Jᵀ + ε I)⁻¹ r and one step of refinement. `None` if a number is not finite.
pub fn least_norm(jacobian: &[Vec<f64>], r: &[f64]) -> Option<Vec<f64>> {
    let (m, n) = (r.len(), jacobian.first().map_or(0, Vec::len));
    let mut gram: Vec<Vec<f64>> = jacobian.iter().map(|row| apply(jacobian, row)).collect();
    let scale = (0..m).map(|i| gram[i][i]).fold(f64::MIN_POSITIVE, f64::max);
    for (i, row) in gram.iter_mut().enumerate() {
        row[i] += 1e-12 * scale;
    }
    let l = cholesky(&gram)?;
    let mut h = vec![0.0; n];
    for _ in 0..2 {
        let left: Vec<f64> = (0..m).map(|i| r[i] - dot(&jacobian[i], &h)).collect();
        let y = backward(&l, &forward(&l, &left));
        for (row, y) in jacobian.iter().zip(&y) {
            h.iter_mut().zip(row).for_each(|(h, a)| *h += a * y);
        }
    }
    h.iter().all(|v| v.is_finite()).then_some(h)
}
