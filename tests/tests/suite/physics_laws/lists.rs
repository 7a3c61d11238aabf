//! Lists of numbers: sums, products, differences, linear equations.

use hamel::Scalar;

/// Step of central differences, extrapolated once: truncation like h⁴, rounding like 1e-16 / h.
const DIFFERENCE_STEP: f64 = 1e-3;

pub fn largest(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |m, v| Scalar::max(m, v.abs()))
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// a + s b
pub fn plus(a: &[f64], s: f64, b: &[f64]) -> Vec<f64> {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a + s * b).collect()
}

pub fn times(m: &[Vec<f64>], v: &[f64]) -> Vec<f64> {
    m.iter().map(|row| dot(row, v)).collect()
}

#[track_caller]
pub fn assert_close(what: &str, a: &[f64], b: &[f64], bound: f64) {
    let difference = largest(&plus(a, -1.0, b));
    // Fails for NaN as well.
    assert!(
        difference <= bound,
        "{what}: {a:?} against {b:?}, difference {difference:e} above {bound:e}"
    );
}

/// df/ds of a list at s = 0, by central differences with one extrapolation
pub fn derivative(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let central = |h: f64| -> Vec<f64> {
        let difference = plus(&f(h), -1.0, &f(-h));
        difference.iter().map(|d| d / (2.0 * h)).collect()
    };
    let (coarse, fine) = (central(DIFFERENCE_STEP), central(DIFFERENCE_STEP / 2.0));
    let change = plus(&fine, -1.0, &coarse);
    plus(&fine, 1.0 / 3.0, &change)
}

/// Returns the Cholesky factor; `None` if the matrix is not positive definite.
pub fn factor(m: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let mut l = m.to_vec();
    for i in 0..l.len() {
        for j in 0..=i {
            let rest = l[i][j] - dot(&l[i][..j], &l[j][..j]);
            l[i][j] = if i != j {
                rest / l[j][j]
            } else if rest > 0.0 {
                rest.sqrt()
            } else {
                return None;
            };
        }
    }
    Some(l)
}

/// Returns the solution of G y = b for a positive definite G.
pub fn solve(g: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let l = factor(g).expect("columns of A are independent");
    let mut y = b.to_vec();
    for i in 0..y.len() {
        y[i] = (y[i] - dot(&l[i][..i], &y[..i])) / l[i][i];
    }
    for i in (0..y.len()).rev() {
        for k in i + 1..y.len() {
            y[i] -= l[k][i] * y[k];
        }
        y[i] /= l[i][i];
    }
    y
}
