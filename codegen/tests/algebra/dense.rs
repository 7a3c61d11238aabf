//! Factors and solutions of small dense matrices satisfy their definitions.

use hamel_algebra::dense::{
    apply, backward, cholesky, cholesky_with, dot, forward, gram, largest, least_norm, product,
    solve,
};
use hamel_algebra::residue_pair::Random;

/// Generator of matrices with entries in ±1.
struct Numbers(Random);

impl Numbers {
    fn vector(&mut self, n: usize) -> Vec<f64> {
        let mut number = || (self.0.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
        (0..n).map(|_| number()).collect()
    }

    fn matrix(&mut self, rows: usize, columns: usize) -> Vec<Vec<f64>> {
        (0..rows).map(|_| self.vector(columns)).collect()
    }
}

fn transposed(a: &[Vec<f64>]) -> Vec<Vec<f64>> {
    (0..a[0].len())
        .map(|j| a.iter().map(|row| row[j]).collect())
        .collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let differences: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&differences)
}

#[test]
fn factors_and_solutions_satisfy_their_equations() {
    let mut numbers = Numbers(Random::new(5));
    for n in 1..6 {
        let a = numbers.matrix(n + 2, n);
        let m = gram(&a, n);
        assert!(apart(&m.concat(), &product(&transposed(&a), &a).concat()) < 1e-14);
        let l = cholesky(&m).expect("positive definite");
        assert!(apart(&product(&l, &transposed(&l)).concat(), &m.concat()) < 1e-13);
        let b = numbers.vector(n);
        let y = forward(&l, &b);
        assert!(apart(&apply(&l, &y), &b) < 1e-12);
        assert!(apart(&apply(&transposed(&l), &backward(&l, &y)), &y) < 1e-11);
        // The first pivot is 0, so rows have to be exchanged.
        let mut square = numbers.matrix(n + 1, n + 1);
        square[0][0] = 0.0;
        let b = numbers.vector(n + 1);
        let x = solve(square.clone(), b.clone()).expect("regular");
        assert!(apart(&apply(&square, &x), &b) < 1e-11);
    }
}

#[test]
fn what_has_no_factor_or_solution_is_refused() {
    let indefinite = [vec![1.0, 2.0], vec![2.0, 1.0]];
    assert_eq!(cholesky(&indefinite), None);
    let raised = cholesky_with(&indefinite, &|i, pivot| if i == 1 { 4.0 } else { pivot });
    assert_eq!(raised, Some(vec![vec![1.0, 0.0], vec![2.0, 2.0]]));
    let singular = vec![vec![1.0, 2.0], vec![2.0, 4.0]];
    assert_eq!(solve(singular, vec![1.0, 1.0]), None);
    assert_eq!(solve(vec![vec![f64::NAN]], vec![1.0]), None);
    assert_eq!(largest(&[1.0, f64::NAN, -3.0]), f64::INFINITY);
    assert_eq!(largest(&[1.0, -3.0]), 3.0);
}

/// The shortest h with J h = r is a combination of the rows of J, even if rows are redundant.
#[test]
fn least_solutions_are_combinations_of_rows() {
    let mut numbers = Numbers(Random::new(6));
    for _ in 0..20 {
        let mut rows = numbers.matrix(3, 6);
        rows.push(
            rows[0]
                .iter()
                .zip(&rows[1])
                .map(|(a, b)| a - 2.0 * b)
                .collect(),
        );
        let combination = apply(&transposed(&rows), &numbers.vector(4));
        let right = apply(&rows, &combination);
        let found = least_norm(&rows, &right).expect("numbers");
        assert!(apart(&found, &combination) < 1e-8);
        assert!(dot(&found, &found) <= dot(&combination, &combination) * (1.0 + 1e-9));
    }
    assert_eq!(least_norm(&[vec![f64::NAN]], &[1.0]), None);
}
