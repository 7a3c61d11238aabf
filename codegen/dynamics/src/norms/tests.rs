//! Norms and inverses of matrices of numbers.

use super::{inverse_positive_definite, max_or_infinite, row_sum_norm};

#[test]
fn inverses_and_norms() {
    let rows = vec![
        vec![4.0, 1.0, 0.0],
        vec![1.0, 3.0, -1.0],
        vec![0.0, -1.0, 2.0],
    ];
    let inverted = inverse_positive_definite(rows.clone());
    for i in 0..3 {
        for j in 0..3 {
            let entry: f64 = (0..3).map(|k| rows[i][k] * inverted[k][j]).sum();
            let unit = if i == j { 1.0 } else { 0.0 };
            assert!((entry - unit).abs() < 1e-15);
        }
    }
    assert_eq!(row_sum_norm(&rows), 5.0);
}

/// M that has no number at a state says nothing of its condition: it counts as any number.
#[test]
fn what_is_no_number_is_no_small_one() {
    assert_eq!(max_or_infinite([f64::NAN, 2.0].into_iter()), f64::INFINITY);
    assert_eq!(max_or_infinite([2.0, f64::NAN].into_iter()), f64::INFINITY);
    assert_eq!(
        row_sum_norm(&[vec![1.0, f64::NAN], vec![0.0, 1.0]]),
        f64::INFINITY
    );
    assert_eq!(max_or_infinite(std::iter::empty()), 0.0);
}
