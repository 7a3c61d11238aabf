//! Chooses Φ: rows of ∂φ/∂x that are independent on X and at the start, KR18 (4). φ may be redundant, as RᵀR = I with
//! det R = 1 is; all its rows stay in φ.

use crate::algebra::graph::{Edge, Graph};
use crate::algebra::numeric::rank;
use crate::algebra::residue_pair::ResiduePair;

/// Relative size of the new part of a row below which the row counts as dependent at the start.
const SMALL: f64 = 1e-7;

/// Rows of a Jacobian that are independent, and the others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Independent {
    /// Indices of the chosen rows of φ.
    pub rows: Vec<usize>,
    /// The first chosen row that depends on others at the start, if there is one.
    pub singular: Option<usize>,
}

/// Chooses independent rows of a Jacobian in their order; `numbers` are the values of the entries at the start.
pub fn choose(graph: &Graph, jacobian: &[Vec<Edge>], numbers: Option<&[Vec<f64>]>) -> Independent {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let new_at_start = |basis: &mut Vec<Vec<f64>>, row: usize| {
        let Some(numbers) = numbers else { return true };
        let mut rest = numbers[row].clone();
        let length = norm(&rest);
        for unit in basis.iter() {
            let along: f64 = rest.iter().zip(unit).map(|(a, b)| a * b).sum();
            rest.iter_mut().zip(unit).for_each(|(a, b)| *a -= along * b);
        }
        let left = norm(&rest);
        let is_new = left > SMALL * length;
        if is_new {
            basis.push(rest.iter().map(|a| a / left).collect());
        }
        is_new
    };
    let value = |row: &usize| -> Vec<ResiduePair> {
        jacobian[*row]
            .iter()
            .map(|&edge| graph.value(edge))
            .collect()
    };
    let adds = |rows: &[usize], row: usize| {
        let mut matrix: Vec<Vec<ResiduePair>> = rows.iter().map(value).collect();
        matrix.push(value(&row));
        rank(matrix) > rows.len()
    };
    let mut rows = Vec::new();
    for row in 0..jacobian.len() {
        if adds(&rows, row) && new_at_start(&mut basis, row) {
            rows.push(row);
        }
    }
    // If the start is singular, rows that are independent in general complete the choice.
    let regular = rows.len();
    for row in 0..jacobian.len() {
        if !rows.contains(&row) && adds(&rows, row) {
            rows.push(row);
        }
    }
    let singular = rows.get(regular).copied();
    rows.sort_unstable();
    Independent { rows, singular }
}

fn norm(row: &[f64]) -> f64 {
    row.iter().map(|a| a * a).sum::<f64>().sqrt()
}
