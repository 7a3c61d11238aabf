//! Evaluation of expressions: in floating point, and exactly at new points modulo p.

use super::field_point::FieldPoint;
use super::graph::{Edge, Graph};
use super::numbers::{Arithmetic, Step};
use super::residue_pair::ResiduePair;
use super::walk;
use num_traits::ToPrimitive;

/// Floating-point arithmetic, with the values of all symbols.
#[derive(Clone, Copy, Debug)]
pub struct Floats<'a>(pub &'a [f64]);

impl Arithmetic for Floats<'_> {
    type Number = f64;

    #[inline]
    fn make(&mut self, step: Step<f64>) -> Option<f64> {
        Some(match step {
            Step::Whole(value) => value.into(),
            Step::Constant(value) => value.to_f64().unwrap_or(f64::NAN),
            Step::Symbol(index) => self.0.get(index).copied().unwrap_or(f64::NAN),
            Step::Neg(a) => -a,
            Step::Add(a, b) => a + b,
            Step::Sub(a, b) => a - b,
            Step::Mul(a, b) => a * b,
            Step::Div(a, b) => a / b,
            Step::Apply(function, a, _) => (function.row().value)(*a),
            Step::Atan2(y, x) => y.atan2(*x),
            // If c is NaN, so is the result.
            Step::Select(c, a, b) => match self.is_positive(c) {
                Some(true) => *a,
                Some(false) => *b,
                None => f64::NAN,
            },
            // External functions have no numerical values.
            Step::Listed(..) | Step::External(..) => f64::NAN,
        })
    }

    fn is_positive(&self, a: &f64) -> Option<bool> {
        (!a.is_nan()).then_some(*a > 0.0)
    }

    fn is_zero(&self, a: &f64) -> bool {
        *a == 0.0
    }
}

/// Evaluates the expressions in floating point, given the value of every symbol.
pub fn evaluate(graph: &Graph, roots: &[Edge], symbols: &[f64]) -> Vec<f64> {
    let values = walk::evaluate(graph, roots, &mut Floats(symbols));
    values.unwrap_or_else(|| vec![f64::NAN; roots.len()])
}

/// Evaluates the expressions modulo p at another point, whose symbols have been pushed into `point`; `None`
/// if a denominator vanishes or a square root has no value there.
pub fn evaluate_at(
    graph: &Graph,
    roots: &[Edge],
    point: &mut FieldPoint,
) -> Option<Vec<ResiduePair>> {
    let values = walk::evaluate(graph, roots, point)?;
    (!point.has_missing_root()).then_some(values)
}

/// Solves a square linear system over F_p; `None` if it is singular.
pub fn solve(
    mut rows: Vec<Vec<ResiduePair>>,
    mut right: Vec<ResiduePair>,
) -> Option<Vec<ResiduePair>> {
    let n = right.len();
    for k in 0..n {
        let pivot = (k..n).find(|&row| !rows[row][k].is_zero())?;
        rows.swap(k, pivot);
        right.swap(k, pivot);
        let inverse = rows[k][k].inv()?;
        for row in (0..n).filter(|&row| row != k) {
            let factor = rows[row][k] * inverse;
            if !factor.is_zero() {
                for column in k..n {
                    let product = factor * rows[k][column];
                    rows[row][column] = rows[row][column] - product;
                }
                right[row] = right[row] - factor * right[k];
            }
        }
    }
    (0..n).map(|k| Some(right[k] * rows[k][k].inv()?)).collect()
}

/// Returns the rank of a matrix over F_p.
pub fn rank(mut rows: Vec<Vec<ResiduePair>>) -> usize {
    let columns = rows.first().map_or(0, Vec::len);
    let mut rank = 0;
    for column in 0..columns {
        let Some(pivot) = (rank..rows.len()).find(|&row| !rows[row][column].is_zero()) else {
            continue;
        };
        rows.swap(rank, pivot);
        let Some(inverse) = rows[rank][column].inv() else {
            continue;
        };
        for row in rank + 1..rows.len() {
            let factor = rows[row][column] * inverse;
            if !factor.is_zero() {
                for k in column..columns {
                    let product = factor * rows[rank][k];
                    rows[row][k] = rows[row][k] - product;
                }
            }
        }
        rank += 1;
    }
    rank
}
