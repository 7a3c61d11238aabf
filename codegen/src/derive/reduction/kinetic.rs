//! What C(x) contributes to the equations of motion: Ċ ξₐ, and a kinetic energy that the user wrote.

use crate::algebra::derivation::Derivation;
use crate::algebra::graph::Edge;
use crate::algebra::linear::{multiply, transpose};
use crate::derive::calculus::Calculus;
use crate::derive::{commutation, connection, inertia, kinematics};
use crate::model::{KineticTerms, Model};

/// Ċ ξₐ along ẋ = A C ξₐ.
pub fn drift(full: &mut Model, xi_active: &[Edge], complement: &[Vec<Edge>]) -> Vec<Edge> {
    let graph = &mut full.graph;
    let xi: Vec<Edge> = complement
        .iter()
        .map(|row| graph.dot(row, xi_active))
        .collect();
    let rate: Vec<Edge> = full.a.iter().map(|row| graph.dot(row, &xi)).collect();
    let mut along = Derivation::new(full.x.iter().zip(&rate).map(|(x, &rate)| (x.node(), rate)));
    xi.iter().map(|&xi| along.of(graph, xi)).collect()
}

/// Cᵀ K C and Cᵀ (h + K Ċ ξₐ) of the kinetic energy that the user wrote, with Hamel's h before the
/// constraints are put in; still in terms of ξ.
pub fn kinetic_terms(
    full: &mut Model,
    xi_active: &[Edge],
    complement: &[Vec<Edge>],
) -> Option<KineticTerms> {
    if full.kinetic == full.graph.zero() {
        return None;
    }
    let mut calculus = Calculus::new(full);
    let mass = inertia::kinetic_mass(full);
    let rows = kinematics::left_inverse(full)?;
    let gamma = commutation::gamma(full, &mut calculus, &rows);
    let h = connection::quadratic(full, &mut calculus, &mass, &gamma);
    let drift = drift(full, xi_active, complement);
    let graph = &mut full.graph;
    let columns = transpose(complement);
    let sum: Vec<Edge> = mass
        .iter()
        .zip(&h)
        .map(|(row, &h)| {
            let part = graph.dot(row, &drift);
            graph.add(h, part)
        })
        .collect();
    let half = multiply(graph, &mass, complement);
    Some(KineticTerms {
        mass: multiply(graph, &columns, &half),
        bias: columns
            .iter()
            .map(|column| graph.dot(column, &sum))
            .collect(),
    })
}
