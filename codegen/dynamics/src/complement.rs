//! Complements Φ and Ψ, which complete Y and A to square matrices inverse to each other:
//! [A Ψ] = [Y; Φ]⁻¹, KR18 (5) and (6).
//!
//! Φ is (ν − n) × ν, Ψ is ν × (ν − n).

use hamel_algebra::blocks::solve;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{multiply, transpose};
use hamel_algebra::numeric::evaluate;
use hamel_language::model::Model;
use hamel_language::model::charts::{all_tangents, jacobian};
use hamel_language::model::layout::Block;

/// The matrices Φ = ∂φ/∂x and Ψ of [A Ψ] = [Y; Φ]⁻¹, in which the constraints of coordinate kinds precede those of the
/// description.
#[derive(Clone, Debug, Default)]
pub struct Complement {
    /// Indices of the rows of φ that Φ consists of.
    pub rows: Vec<usize>,
    /// Φ, which consists of rows of ∂φ/∂x.
    pub phi: Vec<Vec<Edge>>,
    /// Ψ.
    pub psi: Vec<Vec<Edge>>,
    /// Difference between Ψ and the closed forms of the coordinate kinds, in their columns.
    pub beyond: Vec<Vec<Edge>>,
    /// Number of columns that belong to coordinate kinds.
    pub kinds: usize,
}

/// Derives Φ and Ψ for a left inverse Y; `None` if [Y; Φ] is singular everywhere.
///
/// For coordinate kinds alone, Ψ has the closed forms Ψ₀: x/2 for circle and quaternion, the
/// symmetric products ½ R E for rotations. For constraints of the description, Ψ = K X in the
/// tangents K of the kinds, where
/// [Y K; Φ K] X = [0; I].
/// The components of Ψ₀ that Y and these constraints see are then removed: Ψ₀ − A Y Ψ₀ − Ψ Φ Ψ₀.
pub fn complement(model: &mut Model, y: &[Vec<Edge>]) -> Option<Complement> {
    let (n, nu) = (model.n(), model.nu());
    let rows = model.completion.independent.clone();
    let all = jacobian(&model.points, &model.phi, nu, &mut model.graph);
    let phi: Vec<Vec<Edge>> = rows.iter().map(|&row| all[row].clone()).collect();
    let closed = closed_forms(&mut model.graph, &model.blocks, &model.x);
    let kinds = closed.len();
    let user = phi.get(kinds..)?.to_vec();
    let numbers = model.numbers(&model.defaults, &model.start_x, &[], &[], &[]);
    let symbols = model.graph.symbols().len();
    let start = |graph: &Graph, edges: &[Edge]| {
        let mut numbers = numbers.clone();
        numbers.resize(symbols, f64::NAN);
        evaluate(graph, edges, &numbers)
    };
    let graph = &mut model.graph;
    let zero = graph.zero();
    let mut own = vec![Vec::new(); nu];
    if !user.is_empty() {
        let tangents = all_tangents(graph, &model.blocks, &model.x, |_| true);
        let k = transpose(&tangents);
        let (mut m, mut right) = (Vec::new(), Vec::new());
        for (place, row) in y.iter().chain(&user).enumerate() {
            m.push(
                tangents
                    .iter()
                    .map(|column| graph.dot(row, column))
                    .collect(),
            );
            let unit = |j| if n + j == place { graph.one() } else { zero };
            right.push((0..user.len()).map(unit).collect());
        }
        let solution = solve(graph, &m, &right, Some(&start)).ok()?;
        own = multiply(graph, &k, &solution.x);
    }
    let forms = transpose(&closed);
    let of_velocities = multiply(graph, y, &forms);
    let of_user = multiply(graph, &user, &forms);
    let (along, across) = (
        multiply(graph, &model.a, &of_velocities),
        multiply(graph, &own, &of_user),
    );
    let (mut psi, mut beyond) = (Vec::new(), Vec::new());
    for alpha in 0..nu {
        let mut rest = vec![zero; kinds];
        for part in [along.get(alpha), across.get(alpha)].into_iter().flatten() {
            for (entry, &value) in rest.iter_mut().zip(part) {
                *entry = graph.sub(*entry, value);
            }
        }
        let mut row: Vec<Edge> = Vec::new();
        for (j, &entry) in rest.iter().enumerate() {
            row.push(graph.add(closed[j][alpha], entry));
        }
        row.extend(&own[alpha]);
        psi.push(row);
        beyond.push(rest);
    }
    Some(Complement {
        rows,
        phi,
        psi,
        beyond,
        kinds,
    })
}

/// Returns Ψ₀ of the coordinate kinds by columns, in the order of their rows of φ; C Ψ₀ = 0.
fn closed_forms(graph: &mut Graph, blocks: &[Block], x: &[Edge]) -> Vec<Vec<Edge>> {
    let half = graph.ratio(1, 2);
    let mut columns = Vec::new();
    let mut place = 0;
    for &block in blocks {
        let range = place..place + block.len();
        place += block.len();
        let halves: Vec<Edge> = x[range.clone()]
            .iter()
            .map(|&e| graph.mul(half, e))
            .collect();
        let mut push = |part: Vec<Edge>| {
            let mut column = vec![graph.zero(); x.len()];
            column[range.clone()].copy_from_slice(&part);
            columns.push(column);
        };
        match block {
            Block::Flat(_) => {}
            Block::Circle | Block::Quaternion => push(halves),
            // ½ R E with E symmetric: column i of R goes to column j, and j to i.
            Block::Rotation => {
                for (i, j) in [(0, 0), (1, 1), (2, 2), (1, 2), (2, 0), (0, 1)] {
                    let mut part = vec![Edge::of(0); 9];
                    for row in 0..3 {
                        part[3 * row + j] = halves[3 * row + i];
                        part[3 * row + i] = halves[3 * row + j];
                    }
                    push(part);
                }
            }
        }
    }
    columns
}
