//! What ξ = C ξₐ + c contributes to the equations of motion: Ċ ξₐ + ċ, and a kinetic energy that the user wrote.

use super::Section;
use crate::calculus::Calculus;
use crate::{commutation, connection, energy, inertia, kinematics};
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{multiply, transpose};
use hamel_language::model::{KineticTerms, Model};

/// ξ = C ξₐ + c.
pub fn lifted(graph: &mut Graph, xi_active: &[Edge], section: &Section) -> Vec<Edge> {
    let rows = section.complement.iter().zip(&section.shift);
    rows.map(|(row, &shift)| {
        let part = graph.dot(row, xi_active);
        graph.add(part, shift)
    })
    .collect()
}

/// Ċ ξₐ + ċ along ẋ = A (C ξₐ + c).
pub fn drift(full: &mut Model, xi_active: &[Edge], section: &Section) -> Vec<Edge> {
    let graph = &mut full.graph;
    let xi = lifted(graph, xi_active, section);
    let rate: Vec<Edge> = full.a.iter().map(|row| graph.dot(row, &xi)).collect();
    let mut along = Derivation::new(full.x.iter().zip(&rate).map(|(x, &rate)| (x.node(), rate)));
    xi.iter().map(|&xi| along.of(graph, xi)).collect()
}

/// Cᵀ K C and Cᵀ (h + K (Ċ ξₐ + ċ)) of the kinetic energy that the user wrote, with Hamel's h before the
/// constraints are put in; still in terms of ξ. The model learns what that energy has beyond its part of the whole energy.
pub fn kinetic_terms(
    full: &mut Model,
    xi_active: &[Edge],
    section: &Section,
) -> Option<KineticTerms> {
    if full.kinetic == full.graph.zero() {
        return None;
    }
    let mut calculus = Calculus::new(full);
    let mass = inertia::kinetic_mass(full);
    let rows = kinematics::left_inverse(full)?;
    full.gyroscopic = energy::gyroscopic(full, &rows);
    let gamma = commutation::gamma(full, &mut calculus, &rows);
    let h = connection::quadratic(full, &mut calculus, &mass, &gamma);
    let drift = drift(full, xi_active, section);
    let graph = &mut full.graph;
    let columns = transpose(&section.complement);
    let sum: Vec<Edge> = mass
        .iter()
        .zip(&h)
        .map(|(row, &h)| {
            let part = graph.dot(row, &drift);
            graph.add(h, part)
        })
        .collect();
    let half = multiply(graph, &mass, &section.complement);
    Some(KineticTerms {
        mass: multiply(graph, &columns, &half),
        bias: columns
            .iter()
            .map(|column| graph.dot(column, &sum))
            .collect(),
    })
}
