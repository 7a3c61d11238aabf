//! Norm and inverse of a numerical matrix.

#[cfg(test)]
mod tests;

/// Returns the row-sum norm ‖M‖_∞ of a matrix of numbers: its largest sum of absolute entries in a row.
pub fn row_sum_norm(rows: &[Vec<f64>]) -> f64 {
    max_or_infinite(rows.iter().map(|row| row.iter().map(|e| e.abs()).sum()))
}

/// Returns the largest of some non-negative numbers; infinite if one of them is NaN.
pub fn max_or_infinite(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |most, number| match number.is_nan() {
        true => f64::INFINITY,
        false => most.max(number),
    })
}

/// Returns the inverse of a positive definite matrix, by Gauss-Jordan elimination without pivoting.
pub fn inverse_positive_definite(mut rows: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = rows.len();
    for k in 0..n {
        let pivot = std::mem::replace(&mut rows[k][k], 1.0);
        rows[k].iter_mut().for_each(|entry| *entry /= pivot);
        let own = rows[k].clone();
        for row in (0..n).filter(|&row| row != k) {
            let factor = std::mem::replace(&mut rows[row][k], 0.0);
            for (entry, other) in rows[row].iter_mut().zip(&own) {
                *entry -= factor * other;
            }
        }
    }
    rows
}
