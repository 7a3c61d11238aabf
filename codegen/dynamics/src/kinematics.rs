//! Left inverse Y with Y A = I, and the canonical quasi-velocities of the coordinate kinds.

use hamel_algebra::blocks::solve;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{multiply, solve_symmetric, transpose};
use hamel_language::model::Model;
use hamel_language::model::layout::{Block, chart_rate};

/// Returns the chart rates η = C(x) ẋ of all blocks for a given ẋ, as expressions.
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

/// Returns Y with Y A = I, n × ν, as expressions: the rows given in the description, the others derived from A.
pub fn left_inverse(model: &mut Model) -> Option<Vec<Vec<Edge>>> {
    let given = model.completion.y.clone();
    if given.len() == model.n()
        && let Some(rows) = given.iter().cloned().collect()
    {
        return Some(rows);
    }
    let derived = from_kinematic_map(model)?;
    let rows = derived.into_iter().enumerate();
    Some(
        rows.map(|(i, row)| given.get(i).cloned().flatten().unwrap_or(row))
            .collect(),
    )
}

/// Derives Y from A.
///
/// Let B = C A, where C are the closed forms of the coordinate kinds, KR18 (36). If B is square,
/// Y = B⁻¹ C, where B⁻¹ is Bᵀ for an orthogonal B, and is found by substitution if B is triangular
/// up to the order of rows and columns. Otherwise B Y = C is solved for blocks of velocities whose
/// determinants are constant on X, and the rest by (BᵀB)⁻¹ Bᵀ C.
fn from_kinematic_map(model: &mut Model) -> Option<Vec<Vec<Edge>>> {
    let (n, nu) = (model.n(), model.nu());
    let graph = &mut model.graph;
    let columns = transpose(&model.a);
    let b_columns: Vec<Vec<Edge>> = columns
        .iter()
        .map(|column| chart_rates(graph, &model.blocks, &model.x, column))
        .collect();
    let b = transpose(&b_columns);
    let c_columns: Vec<Vec<Edge>> = (0..nu)
        .map(|alpha| {
            let mut unit = vec![graph.zero(); nu];
            unit[alpha] = graph.one();
            chart_rates(graph, &model.blocks, &model.x, &unit)
        })
        .collect();
    let c = transpose(&c_columns);
    if b.len() != n {
        return Some(solve(graph, &b, &c, None).ok()?.x);
    }
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
    solve_symmetric(graph, &gram, &right)
}

/// Returns B⁻¹ C if some order of rows and columns makes B triangular, by solving rows with one
/// remaining unknown.
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
