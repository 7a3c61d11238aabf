//! M, Γ ξ ξ, ∂V and f by the rules of derivation, and not by the routes of emitted functions: what slopes, claims and
//! constrained systems are compared with in numbers. They are themselves compared with the three forms, which share none of
//! these rules, by `constrained/frame`.

use super::virtual_power;
use hamel_algebra::graph::Edge;
use hamel_dynamics::calculus::Calculus;
use hamel_dynamics::{commutation, connection, energy, inertia, kinematics};
use hamel_language::model::Model;

/// M, h = Γ ξ ξ, ∂V, f, T, V.
pub struct Reference {
    /// The model, its graph holding the rest.
    pub model: Model,
    /// M.
    pub mass: Vec<Vec<Edge>>,
    /// h.
    pub bias: Vec<Edge>,
    /// ∂V.
    pub slope: Vec<Edge>,
    /// f.
    pub force: Vec<Edge>,
    /// T.
    pub kinetic: Edge,
    /// V.
    pub potential: Edge,
    /// D.
    pub dissipation: Edge,
}

impl Reference {
    /// The explicit form (30c), with the forces by virtual work.
    pub fn new(model: &Model) -> Option<Self> {
        let mut model = model.clone();
        let mut calculus = Calculus::new(&model);
        let mass = inertia::mass_matrix(&mut model, &mut calculus);
        let rows = kinematics::left_inverse(&mut model)?;
        let gamma = commutation::gamma(&mut model, &mut calculus, &rows);
        let bias = connection::quadratic(&mut model, &mut calculus, &mass, &gamma);
        let potential = energy::potential(&mut model);
        let slope = (0..model.n())
            .map(|i| calculus.along(&mut model.graph, i, potential))
            .collect();
        let mut graph = model.graph.clone();
        let force = virtual_power::applied(&model, &mut graph, &mut calculus);
        let power = virtual_power::dissipated(&model, &mut graph, &mut calculus);
        let half = graph.ratio(1, 2);
        let dissipation = graph.mul(half, power);
        model.graph = graph;
        let kinetic = energy::kinetic(&mut model, &mass);
        Some(Reference {
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
