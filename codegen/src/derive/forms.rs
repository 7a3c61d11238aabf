//! All symbols of a model side by side, each derived on its own way: what identities compare.

use super::calculus::Calculus;
use super::tables::Geometry;
use super::{
    assemble, commutation, connection, gibbs, hamel_form, kinematics, levi_civita, virtual_power,
};
use crate::algebra::graph::Edge;
use crate::model::Model;

/// The symbols that `check` compares. They are plain fields, so that a test can break one.
#[derive(Clone, Debug)]
pub struct Symbols {
    /// Y, γ by (12), M by (20), Γ by (23), V, and the graph of everything here.
    pub geometry: Geometry,
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

impl Symbols {
    /// Derives all symbols of a model; `None` where AᵀA is singular, which the model's checks exclude.
    pub fn new(model: &Model) -> Option<Self> {
        Some(Symbols::of(Geometry::new(model)?))
    }

    /// The same with free coordinates, where nothing is merged modulo φ: what a proof by normal
    /// forms starts from.
    pub fn unreduced(model: &Model) -> Option<Self> {
        Some(Symbols::of(Geometry::unreduced(model)?))
    }

    fn of(mut geometry: Geometry) -> Self {
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
        let applied = assemble::applied_force(model, &mut geometry.calculus);
        let mut graph = model.graph.clone();
        let virtual_work = virtual_power::applied(model, &mut graph, &mut geometry.calculus);
        model.graph = graph;
        Symbols {
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

/// The left sides of (30a), (30b), (30c) at (x, ξ, ξ̇), and f: what every build is compared with.
#[derive(Clone, Debug)]
pub struct Forms {
    /// The model, its graph holding the expressions below.
    pub model: Model,
    /// (30a), from T and γ by (12).
    pub hamel: Vec<Edge>,
    /// (30b), from S.
    pub gibbs: Vec<Edge>,
    /// (30c), from M and Γ with γ by (13).
    pub levi_civita: Vec<Edge>,
    /// f by virtual work (28).
    pub force: Vec<Edge>,
    /// p = ∂T/∂ξ.
    pub momentum: Vec<Edge>,
    /// T.
    pub kinetic: Edge,
    /// V.
    pub potential: Edge,
    /// D.
    pub dissipation: Edge,
}

/// Models with more velocities get Γ ξ ξ by `connection::quadratic`, without the n³ table of Γ.
const MOST_TABULATED: usize = 8;

impl Forms {
    /// Derives the three forms of a model; `None` where AᵀA is singular.
    pub fn new(model: &Model) -> Option<Self> {
        let mut model = model.clone();
        let mut calculus = Calculus::new(&model);
        let y = kinematics::left_inverse(&mut model)?;
        let gamma = commutation::gamma(&mut model, &mut calculus, &y);
        let gamma_of_rows = commutation::gamma_from_rows(&mut model, &y);
        let potential = super::energy::potential(&mut model);
        let mut motion = Calculus::with_drift(&model, &model.xi_dot);
        let kinetic = hamel_form::kinetic_energy(&mut model, &mut motion);
        let hamel = hamel_form::hamel_form(&mut model, &mut motion, &gamma, kinetic, potential);
        let gibbs = gibbs::gibbs_appell(&mut model, &mut motion, &gamma_of_rows);
        let mass = super::inertia::mass_matrix(&mut model, &mut calculus);
        let bias = if model.n() <= MOST_TABULATED {
            let table = connection::connection(&mut model, &mut calculus, &mass, &gamma_of_rows);
            levi_civita::contracted(&mut model, &table)
        } else {
            connection::quadratic(&mut model, &mut calculus, &mass, &gamma_of_rows)
        };
        let xi_dot = model.xi_dot.clone();
        let levi_civita =
            levi_civita::levi_civita(&mut model, &mut calculus, &mass, &bias, potential, &xi_dot);
        let mut graph = model.graph.clone();
        let force = virtual_power::applied(&model, &mut graph, &mut calculus);
        let power = virtual_power::dissipated(&model, &mut graph, &mut calculus);
        let half = graph.ratio(1, 2);
        let dissipation = graph.mul(half, power);
        model.graph = graph;
        Some(Forms {
            hamel,
            gibbs,
            levi_civita,
            force,
            momentum: hamel_form::by_velocity(&mut model, kinetic),
            model,
            kinetic,
            potential,
            dissipation,
        })
    }
}
