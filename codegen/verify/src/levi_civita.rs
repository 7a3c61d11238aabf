//! The explicit equations of motion with the connection, KR18 (30c):
//! M_ij ξ̇ʲ + Γᵢⱼₖ ξʲ ξᵏ + ∂ᵢV = fᵢ (N or N m, n entries).

use hamel_algebra::graph::Edge;
use hamel_dynamics::calculus::Calculus;
use hamel_language::model::Model;

/// Returns the expressions Γᵢⱼₖ ξʲ ξᵏ for all i, contracted from the table of Γ.
pub fn contract_connection(model: &mut Model, connection: &[Vec<Vec<Edge>>]) -> Vec<Edge> {
    let xi = model.xi.clone();
    let graph = &mut model.graph;
    connection
        .iter()
        .map(|plane| {
            let rows: Vec<Edge> = plane.iter().map(|row| graph.dot(row, &xi)).collect();
            graph.dot(&rows, &xi)
        })
        .collect()
}

/// Returns the left side of the explicit form (30c), M ξ̇ + h + ∂V with h = Γ ξ ξ, as expressions in (x, ξ, ξ̇).
pub fn explicit_form(
    model: &mut Model,
    calculus: &mut Calculus,
    mass: &[Vec<Edge>],
    bias: &[Edge],
    potential: Edge,
    xi_dot: &[Edge],
) -> Vec<Edge> {
    let graph = &mut model.graph;
    (0..bias.len())
        .map(|i| {
            let inertial = graph.dot(&mass[i], xi_dot);
            let slope = calculus.along(graph, i, potential);
            let sum = graph.add(inertial, bias[i]);
            graph.add(sum, slope)
        })
        .collect()
}
