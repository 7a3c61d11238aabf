//! Y with Y A = I, the canonical quasi-velocities of the coordinate kinds, and −Ψ φ.

use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{multiply, solve_symmetric, transpose};
use crate::model::Model;
use crate::model::layout::{Block, chart_rate};

/// η = C(x) ẋ: canonical quasi-velocities of all blocks for a given ẋ.
pub fn chart_rates(graph: &mut Graph, blocks: &[Block], x: &[Edge], rate: &[Edge]) -> Vec<Edge> {
    let mut place = 0;
    let mut rates = Vec::new();
    for &block in blocks {
        let range = place..place + block.len();
        rates.extend(chart_rate(graph, block, &x[range.clone()], &rate[range]));
        place += block.len();
    }
    rates
}

/// Y, n rows of ν. With B = C A square: Y = B⁻¹ C, where C are the closed forms of the coordinate
/// kinds, KR18 (36); B⁻¹ is Bᵀ where B is orthogonal, and is found by substitution where B is
/// triangular up to order. Otherwise Y = (AᵀA)⁻¹ Aᵀ.
pub fn left_inverse(model: &mut Model) -> Option<Vec<Vec<Edge>>> {
    let (n, nu) = (model.n(), model.nu());
    let graph = &mut model.graph;
    let columns = transpose(&model.a);
    let b_columns: Vec<Vec<Edge>> = columns
        .iter()
        .map(|column| chart_rates(graph, &model.blocks, &model.x, column))
        .collect();
    if b_columns[0].len() == n {
        let b = transpose(&b_columns);
        let c_columns: Vec<Vec<Edge>> = (0..nu)
            .map(|alpha| {
                let unit: Vec<Edge> = (0..nu)
                    .map(|beta| {
                        if alpha == beta {
                            graph.one()
                        } else {
                            graph.zero()
                        }
                    })
                    .collect();
                chart_rates(graph, &model.blocks, &model.x, &unit)
            })
            .collect();
        let c = transpose(&c_columns);
        let gram = multiply(graph, &b_columns, &b);
        let orthogonal = (0..n)
            .all(|i| (0..n).all(|j| gram[i][j] == if i == j { graph.one() } else { graph.zero() }));
        if orthogonal {
            return Some(multiply(graph, &b_columns, &c));
        }
        if let Some(y) = substitute(graph, &b, &c) {
            return Some(y);
        }
        let right = multiply(graph, &b_columns, &c);
        return solve_symmetric(graph, &gram, &right);
    }
    let gram = multiply(graph, &columns, &model.a);
    solve_symmetric(graph, &gram, &columns)
}

/// B⁻¹ C where some order of rows and columns makes B triangular: rows with one unknown left give it.
fn substitute(graph: &mut Graph, b: &[Vec<Edge>], c: &[Vec<Edge>]) -> Option<Vec<Vec<Edge>>> {
    let n = b.len();
    let mut solution: Vec<Option<Vec<Edge>>> = vec![None; n];
    let mut used = vec![false; n];
    for _ in 0..n {
        let zero = graph.zero();
        let open = |row: &[Edge], solution: &[Option<Vec<Edge>>]| -> Vec<usize> {
            (0..n)
                .filter(|&j| row[j] != zero && solution[j].is_none())
                .collect()
        };
        let row = (0..n).find(|&i| !used[i] && open(&b[i], &solution).len() == 1)?;
        let unknown = open(&b[row], &solution)[0];
        let mut right = c[row].clone();
        for (j, known) in solution.iter().enumerate() {
            if let Some(known) = known
                && b[row][j] != zero
            {
                for (entry, &value) in right.iter_mut().zip(known) {
                    let product = graph.mul(b[row][j], value);
                    *entry = graph.sub(*entry, product);
                }
            }
        }
        for entry in &mut right {
            *entry = graph.div(*entry, b[row][unknown])?;
        }
        used[row] = true;
        solution[unknown] = Some(right);
    }
    solution.into_iter().collect()
}

/// −Ψ φ(x), the direction of the stabilising term of KR18 (8), in the graph with unconstrained
/// points: −½ (|x|² − 1) x for circle and quaternion, −½ R (RᵀR − I), and −Φᵀ(ΦΦᵀ)⁻¹ φ with
/// Φ = ∂φ/∂x for constraints that the user wrote. `None` where those are redundant.
pub fn correction(model: &Model, free: &mut Graph) -> Option<Vec<Edge>> {
    let first = model.points.first;
    let x: Vec<Edge> = (first..first + model.nu())
        .map(|index| Edge::of(free.symbols()[index].node))
        .collect();
    let half = free.ratio(1, 2);
    let mut correction = vec![free.zero(); x.len()];
    let mut place = 0;
    for &block in &model.blocks {
        let entries = &x[place..place + block.len()];
        match block {
            Block::Flat(_) => {}
            Block::Circle | Block::Quaternion => {
                let square = free.dot(entries, entries);
                let defect = free.sub(free.one(), square);
                let factor = free.mul(half, defect);
                for (k, &entry) in entries.iter().enumerate() {
                    correction[place + k] = free.mul(factor, entry);
                }
            }
            Block::Rotation => {
                let rows: Vec<Vec<Edge>> = entries.chunks(3).map(<[Edge]>::to_vec).collect();
                let columns = transpose(&rows);
                let mut gram = multiply(free, &columns, &rows);
                for (i, row) in gram.iter_mut().enumerate() {
                    for (j, entry) in row.iter_mut().enumerate() {
                        let target = if i == j { free.one() } else { free.zero() };
                        let defect = free.sub(target, *entry);
                        *entry = free.mul(half, defect);
                    }
                }
                let product = multiply(free, &rows, &gram);
                for (k, entry) in product.concat().into_iter().enumerate() {
                    correction[place + k] = entry;
                }
            }
        }
        place += block.len();
    }
    let rows = model.points.constraints.clone();
    if rows.is_empty() {
        return Some(correction);
    }
    let jacobian: Vec<Vec<Edge>> = rows
        .iter()
        .map(|&row| {
            x.iter()
                .map(|x| Derivation::new([(x.node(), free.one())]).of(free, row))
                .collect()
        })
        .collect();
    let gram = multiply(free, &jacobian, &transpose(&jacobian));
    let right: Vec<Vec<Edge>> = rows.iter().map(|&row| vec![row]).collect();
    let multipliers = solve_symmetric(free, &gram, &right)?;
    for (alpha, entry) in correction.iter_mut().enumerate() {
        for (row, multiplier) in jacobian.iter().zip(&multipliers) {
            let product = free.mul(row[alpha], multiplier[0]);
            *entry = free.sub(*entry, product);
        }
    }
    Some(correction)
}
