//! All quantities that identities compare, each derived in its own way.

use super::{gibbs, hamel_form, virtual_power};
use hamel_algebra::graph::Edge;
use hamel_dynamics::calculus::Calculus;
use hamel_dynamics::tables::EquationTables;
use hamel_dynamics::{commutation, loads};
use hamel_language::model::Model;

/// Expressions of the quantities that `check` compares, each derived in its own way. They are plain fields, so that a
/// test can break one.
#[derive(Clone, Debug)]
pub struct ComparedQuantities {
    /// Y, γ by (12), M by (20), Γ by (23), V, and the graph that contains everything here.
    pub geometry: EquationTables,
    /// γ by (13).
    pub gamma_of_rows: Vec<Vec<Vec<Edge>>>,
    /// T from velocities of bodies and particles.
    pub kinetic: Edge,
    /// Left side of (30a) at (x, ξ, ξ̇).
    pub hamel: Vec<Edge>,
    /// Left side of (30b) at (x, ξ, ξ̇).
    pub gibbs: Vec<Edge>,
    /// fᵢ of the loads as they are emitted.
    pub applied: Vec<Edge>,
    /// fᵢ by virtual work (28).
    pub virtual_work: Vec<Edge>,
}

impl ComparedQuantities {
    /// Derives the quantities of a model in a graph whose points satisfy φ; `None` if AᵀA is singular, which the
    /// model's checks exclude.
    pub fn new(model: &Model) -> Option<Self> {
        Some(ComparedQuantities::of(EquationTables::new(model)?))
    }

    /// Derives the quantities with free coordinates, where nothing is merged modulo φ, as a start for proofs by normal
    /// forms.
    pub fn unreduced(model: &Model) -> Option<Self> {
        Some(ComparedQuantities::of(EquationTables::unreduced(model)?))
    }

    fn of(mut geometry: EquationTables) -> Self {
        let gamma_of_rows = commutation::gamma_from_rows(&mut geometry.model, &geometry.y);
        let model = &mut geometry.model;
        let mut motion = Calculus::with_drift(model, &model.xi_dot);
        let kinetic = hamel_form::kinetic_energy(model, &mut motion);
        let hamel = hamel_form::hamel_form(
            model,
            &mut motion,
            &geometry.gamma,
            kinetic,
            geometry.potential,
        );
        let gibbs = gibbs::gibbs_appell(model, &mut motion, &gamma_of_rows);
        let applied = loads::applied_force(model, &mut geometry.calculus);
        let mut graph = model.graph.clone();
        let virtual_work = virtual_power::applied_forces(model, &mut graph, &mut geometry.calculus);
        model.graph = graph;
        ComparedQuantities {
            geometry,
            gamma_of_rows,
            kinetic,
            hamel,
            gibbs,
            applied,
            virtual_work,
        }
    }
}
