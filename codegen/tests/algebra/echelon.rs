//! Linear algebra over a field: null spaces, solutions and signatures.

use hamel_algebra::echelon::{Echelon, signature, solution};
use hamel_algebra::poly::field::Field;
use num_rational::BigRational;

fn matrix(rows: &[&[i64]]) -> Vec<Vec<BigRational>> {
    let entry = |&value: &i64| BigRational::integer(value);
    rows.iter()
        .map(|row| row.iter().map(entry).collect())
        .collect()
}

#[test]
fn null_spaces_and_solutions_satisfy_their_equations() {
    let a = matrix(&[&[1, 2, 3, 4], &[2, 4, 7, 9], &[3, 6, 10, 13]]);
    let echelon = Echelon::new(a.clone());
    assert_eq!(echelon.rank(), 2);
    let kernel = echelon.null_space(4);
    assert_eq!(kernel.len(), 2);
    let times = |row: &[BigRational], v: &[BigRational]| {
        let products = row.iter().zip(v).map(|(a, b)| a * b);
        products.fold(BigRational::integer(0), |sum, product| sum + product)
    };
    for vector in &kernel {
        for row in &a {
            assert!(Field::is_zero(&times(row, vector)));
        }
    }
    let solved = solution(matrix(&[&[1, 2, 5], &[2, 4, 10], &[0, 1, 2]]));
    assert_eq!(solved, Some(matrix(&[&[1, 2]]).concat()));
    assert_eq!(solution(matrix(&[&[1, 2, 5], &[2, 4, 11]])), None);
}

#[test]
fn signatures_count_squares() {
    assert_eq!(signature(&matrix(&[&[-2, 0], &[0, 3]])), (1, 1));
    assert_eq!(signature(&matrix(&[&[0, 1], &[1, 0]])), (1, 1));
    assert_eq!(signature(&matrix(&[&[1, 1], &[1, 1]])), (1, 0));
    assert_eq!(
        signature(&matrix(&[&[-2, 1, 0], &[1, -2, 0], &[0, 0, 0]])),
        (0, 2)
    );
}
