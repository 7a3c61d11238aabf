//! The parametrization ξ = C ξₐ + c of admissible velocities, and its contributions to the equations of motion: the drift Ċ ξₐ + ċ, and the terms of a kinetic energy
//! written by the user.

use crate::calculus::Calculus;
use crate::{commutation, connection, energy, inertia, kinematics};
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{multiply, transpose};
use hamel_language::model::{KineticTerms, Model};

/// Parametrization ξ = C ξₐ + c of the admissible velocities by the active ones, in the graph of the full model.
#[derive(Clone, Debug)]
pub struct VelocityParametrization {
    /// Matrix C, n rows of as many entries as ξₐ has.
    pub complement: Vec<Vec<Edge>>,
    /// Vector c, n entries.
    pub shift: Vec<Edge>,
}

/// Returns all velocities ξ = C ξₐ + c of the full frame for active ones, as expressions.
pub fn all_velocities(
    graph: &mut Graph,
    xi_active: &[Edge],
    parametrization: &VelocityParametrization,
) -> Vec<Edge> {
    let rows = parametrization
        .complement
        .iter()
        .zip(&parametrization.shift);
    rows.map(|(row, &shift)| {
        let part = graph.dot(row, xi_active);
        graph.add(part, shift)
    })
    .collect()
}

/// Returns Ċ ξₐ + ċ, the part of ξ̇ that does not come from ξ̇ₐ, along ẋ = A (C ξₐ + c).
pub fn velocity_drift(
    full: &mut Model,
    xi_active: &[Edge],
    parametrization: &VelocityParametrization,
) -> Vec<Edge> {
    let graph = &mut full.graph;
    let xi = all_velocities(graph, xi_active, parametrization);
    let rate: Vec<Edge> = full.a.iter().map(|row| graph.dot(row, &xi)).collect();
    let mut along = Derivation::new(full.x.iter().zip(&rate).map(|(x, &rate)| (x.node(), rate)));
    xi.iter().map(|&xi| along.of(graph, xi)).collect()
}

/// Returns Cᵀ K C and Cᵀ (h + K (Ċ ξₐ + ċ)) of the kinetic energy written by the user, with Hamel's h derived
/// before the constraints are inserted; the expressions are still in terms of ξ.
///
/// Also stores in the model the difference between that kinetic energy and its contribution to the total energy.
pub fn kinetic_terms(
    full: &mut Model,
    xi_active: &[Edge],
    parametrization: &VelocityParametrization,
) -> Option<KineticTerms> {
    if full.kinetic == full.graph.zero() {
        return None;
    }
    let mut calculus = Calculus::new(full);
    let mass = inertia::written_mass_matrix(full);
    let rows = kinematics::left_inverse(full)?;
    full.gyroscopic = energy::gyroscopic_energy(full, &rows);
    let gamma = commutation::gamma(full, &mut calculus, &rows);
    let h = connection::bias_forces(full, &mut calculus, &mass, &gamma);
    let drift = velocity_drift(full, xi_active, parametrization);
    let graph = &mut full.graph;
    let columns = transpose(&parametrization.complement);
    let sum: Vec<Edge> = mass
        .iter()
        .zip(&h)
        .map(|(row, &h)| {
            let part = graph.dot(row, &drift);
            graph.add(h, part)
        })
        .collect();
    let half = multiply(graph, &mass, &parametrization.complement);
    Some(KineticTerms {
        mass: multiply(graph, &columns, &half),
        bias: columns
            .iter()
            .map(|column| graph.dot(column, &sum))
            .collect(),
    })
}
