//! M, Γ ξ ξ, ∂V and f by the rules of derivation, not by the routes of emitted functions.
//!
//! Derivatives, claims and constrained systems are compared with them in numbers. They are themselves compared by
//! `constrained/frame` with the three forms, which share none of these rules.

use super::virtual_power;
use hamel_algebra::graph::Edge;
use hamel_dynamics::calculus::Calculus;
use hamel_dynamics::{commutation, connection, energy, inertia, kinematics};
use hamel_language::model::Model;

/// Expressions of M, h = Γ ξ ξ, ∂V, f, T, V, D of a model, derived by other routes than the emitted functions.
pub struct ReferenceQuantities {
    /// The model; its graph contains the expressions below.
    pub model: Model,
    /// Mass matrix M.
    pub mass: Vec<Vec<Edge>>,
    /// Bias forces h = Γ ξ ξ.
    pub bias: Vec<Edge>,
    /// Derivatives ∂ᵢV of the potential energy.
    pub slope: Vec<Edge>,
    /// Generalised forces f.
    pub force: Vec<Edge>,
    /// Kinetic energy T.
    pub kinetic: Edge,
    /// Potential energy V.
    pub potential: Edge,
    /// Dissipation D.
    pub dissipation: Edge,
}

impl ReferenceQuantities {
    /// Derives the quantities from kinematics and inertia of a model, with forces by virtual work; `None` if AᵀA is
    /// singular.
    pub fn new(model: &Model) -> Option<Self> {
        let mut model = model.clone();
        let mut calculus = Calculus::new(&model);
        let mass = inertia::mass_matrix(&mut model, &mut calculus);
        let rows = kinematics::left_inverse(&mut model)?;
        let gamma = commutation::gamma(&mut model, &mut calculus, &rows);
        let bias = connection::bias_forces(&mut model, &mut calculus, &mass, &gamma);
        let potential = energy::potential(&mut model);
        let slope = (0..model.n())
            .map(|i| calculus.along(&mut model.graph, i, potential))
            .collect();
        let mut graph = model.graph.clone();
        let force = virtual_power::applied_forces(&model, &mut graph, &mut calculus);
        let power = virtual_power::dissipated_power(&model, &mut graph, &mut calculus);
        let half = graph.ratio(1, 2);
        let dissipation = graph.mul(half, power);
        model.graph = graph;
        let kinetic = energy::kinetic(&mut model, &mass);
        Some(ReferenceQuantities {
            model,
            mass,
            bias,
            slope,
            force,
            kinetic,
            potential,
            dissipation,
        })
    }
}
