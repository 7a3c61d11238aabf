//! ξ̇ and the multipliers λ of M ξ̇ = f − h + Bᵀ λ, B ξ̇ = b, by M = L D Lᵀ and the Schur complement
//! S = B M⁻¹ Bᵀ, both unrolled.

use super::parts::Parts;
use crate::algebra::graph::{Edge, Graph};
use crate::derive::calculus::Calculus;
use crate::model::Model;

/// The solution, and the pivots that have to be positive: those of M, then those of S.
#[derive(Clone, Debug)]
pub struct Saddle {
    /// ξ̇.
    pub xi_dot: Vec<Edge>,
    /// λ, one for each row of B.
    pub multipliers: Vec<Edge>,
    /// Pivots of M in order of elimination, then of S in order of rows; a pivot of S vanishes where
    /// the rows of B become dependent, at a singular configuration.
    pub pivots: Vec<Edge>,
}

/// b = −Ḃ ξ − 2 λ B ξ − λ² φ.
pub fn right_side(model: &mut Model, calculus: &mut Calculus) -> Vec<Edge> {
    let constraints = model.constraints.clone();
    constraints
        .iter()
        .map(|constraint| {
            let graph = &mut model.graph;
            let speed = graph.dot(&constraint.row, &model.xi);
            let mut sum = calculus.rate(graph, speed);
            if let Some(lambda) = constraint.stabilized {
                let two = graph.ratio(2, 1);
                let damping = graph.mul(two, lambda);
                let damped = graph.mul(damping, speed);
                let stiffness = graph.mul(lambda, lambda);
                let pulled = graph.mul(stiffness, constraint.residual);
                sum = graph.sum(&[sum, damped, pulled]);
            }
            -sum
        })
        .collect()
}

/// Solves with an order of elimination of M; `None` where a pivot vanishes identically.
pub fn solve(
    graph: &mut Graph,
    parts: &Parts,
    rows: &[Vec<Edge>],
    right: &[Edge],
    order: &[usize],
) -> Option<Saddle> {
    let (n, m) = (order.len(), rows.len());
    let ordered = |row: &[Edge]| order.iter().map(|&i| row[i]).collect::<Vec<_>>();
    let mut mass: Vec<Vec<Edge>> = order.iter().map(|&i| ordered(&parts.mass[i])).collect();
    let sums: Vec<Edge> = (0..n)
        .map(|i| {
            let column: Vec<Edge> = parts.groups.iter().map(|group| group[i]).collect();
            graph.sum(&column)
        })
        .collect();
    let mut columns = vec![ordered(&sums)];
    columns.extend(rows.iter().map(|row| ordered(row)));
    let factors = factor(graph, &mut mass)?;
    for column in &mut columns {
        forward(graph, &factors, column);
    }
    let (force, bonds) = columns.split_first()?;
    // S = W D⁻¹ Wᵀ with the rows of W as L⁻¹ Bᵀ by columns.
    let scaled: Vec<Vec<Edge>> = bonds
        .iter()
        .map(|bond| {
            let entries = bond.iter().zip(&factors.inverses);
            entries.map(|(&b, &d)| graph.mul(b, d)).collect()
        })
        .collect();
    let mut schur: Vec<Vec<Edge>> = vec![vec![graph.zero(); m]; m];
    for i in 0..m {
        for j in 0..=i {
            let entry = graph.dot(&scaled[i], &bonds[j]);
            (schur[i][j], schur[j][i]) = (entry, entry);
        }
    }
    let mut multipliers: Vec<Edge> = (0..m)
        .map(|i| {
            let free = graph.dot(&scaled[i], force);
            graph.sub(right[i], free)
        })
        .collect();
    let inner = factor(graph, &mut schur)?;
    forward(graph, &inner, &mut multipliers);
    for (entry, &inverse) in multipliers.iter_mut().zip(&inner.inverses) {
        *entry = graph.mul(*entry, inverse);
    }
    backward(graph, &inner, &mut multipliers);
    let mut solution: Vec<Edge> = (0..n)
        .map(|k| {
            let column: Vec<Edge> = bonds.iter().map(|bond| bond[k]).collect();
            let pull = graph.dot(&column, &multipliers);
            let sum = graph.add(force[k], pull);
            graph.mul(sum, factors.inverses[k])
        })
        .collect();
    backward(graph, &factors, &mut solution);
    let mut xi_dot = vec![graph.zero(); n];
    for (place, &i) in order.iter().enumerate() {
        xi_dot[i] = solution[place];
    }
    let mut pivots = factors.pivots;
    pivots.extend(inner.pivots);
    Some(Saddle {
        xi_dot,
        multipliers,
        pivots,
    })
}

/// L D Lᵀ.
struct Factors {
    lower: Vec<Vec<Edge>>,
    pivots: Vec<Edge>,
    inverses: Vec<Edge>,
}

fn factor(graph: &mut Graph, a: &mut [Vec<Edge>]) -> Option<Factors> {
    let (n, zero) = (a.len(), graph.zero());
    let mut lower = vec![vec![zero; n]; n];
    let (mut pivots, mut inverses) = (Vec::new(), Vec::new());
    for c in 0..n {
        let pivot = a[c][c];
        let inverse = graph.div(graph.one(), pivot)?;
        for r in c + 1..n {
            lower[r][c] = graph.mul(a[r][c], inverse);
        }
        for r in c + 1..n {
            for s in c + 1..=r {
                if lower[r][c] != zero && a[s][c] != zero {
                    let product = graph.mul(lower[r][c], a[s][c]);
                    a[r][s] = graph.sub(a[r][s], product);
                    a[s][r] = a[r][s];
                }
            }
        }
        pivots.push(pivot);
        inverses.push(inverse);
    }
    Some(Factors {
        lower,
        pivots,
        inverses,
    })
}

/// L⁻¹ v.
fn forward(graph: &mut Graph, factors: &Factors, v: &mut [Edge]) {
    for c in 0..v.len() {
        for r in c + 1..v.len() {
            let product = graph.mul(factors.lower[r][c], v[c]);
            v[r] = graph.sub(v[r], product);
        }
    }
}

/// L⁻ᵀ v.
fn backward(graph: &mut Graph, factors: &Factors, v: &mut [Edge]) {
    for c in (0..v.len()).rev() {
        for r in c + 1..v.len() {
            let product = graph.mul(factors.lower[r][c], v[r]);
            v[c] = graph.sub(v[c], product);
        }
    }
}
