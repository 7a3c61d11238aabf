//! Tables for people to read: φ, A, Y, γ, M, Γ as expressions, on demand.

use super::calculus::Calculus;
use super::complement::{Complement, complement};
use super::normal::eliminate_coordinates;
use super::{commutation, connection, energy, inertia, kinematics};
use hamel_algebra::graph::Edge;
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;

/// Y, Φ, Ψ, γ, M, Γ and V of a model as expressions, with the graph that contains them.
#[derive(Clone, Debug)]
pub struct EquationTables {
    /// Model, whose graph contains the expressions below.
    pub model: Model,
    /// Derivations ∂ᵢ and d/dt.
    pub calculus: Calculus,
    /// Y, n × ν.
    pub y: Vec<Vec<Edge>>,
    /// Complements Φ and Ψ.
    pub complement: Complement,
    /// `γ[i][j][k]` = γᵢⱼᵏ.
    pub gamma: Vec<Vec<Vec<Edge>>>,
    /// Mass matrix M.
    pub mass: Vec<Vec<Edge>>,
    /// `Γ[i][j][k]` = Γᵢⱼₖ.
    pub connection: Vec<Vec<Vec<Edge>>>,
    /// Potential V.
    pub potential: Edge,
}

impl EquationTables {
    /// Derives Y, Φ, Ψ, γ, M, Γ and V of a model as expressions; `None` if AᵀA or [Y; Φ] is singular, which the model's
    /// checks exclude.
    pub fn new(model: &Model) -> Option<Self> {
        let mut model = model.clone();
        let mut calculus = Calculus::new(&model);
        let y = kinematics::left_inverse(&mut model)?;
        let complement = complement(&mut model, &y)?;
        let gamma = commutation::gamma(&mut model, &mut calculus, &y);
        let mut mass = inertia::mass_matrix(&mut model, &mut calculus);
        let mut forms = None;
        for entry in mass.iter_mut().flatten() {
            *entry = eliminate_coordinates(
                &mut model.graph,
                &mut calculus,
                &model.points,
                &mut forms,
                *entry,
            );
        }
        let connection = connection::connection(&mut model, &mut calculus, &mass, &gamma);
        let potential = energy::potential(&mut model);
        Some(EquationTables {
            model,
            calculus,
            y,
            complement,
            gamma,
            mass,
            connection,
            potential,
        })
    }

    /// Derives the same quantities in a graph whose points do not satisfy φ.
    ///
    /// Nothing is simplified modulo φ there, so that proofs by normal forms can start from them.
    pub fn unreduced(model: &Model) -> Option<Self> {
        let mut free = model.transplanted(model.points.free.clone(), rebuild);
        let mut calculus = Calculus::new(&free);
        let mut merged = model.clone();
        let y = kinematics::left_inverse(&mut merged)?;
        let mut complement = complement(&mut merged, &y)?;
        let mut carry = |rows: &[Vec<Edge>]| -> Vec<Vec<Edge>> {
            let rows = rows.iter();
            rows.map(|row| rebuild(&merged.graph, &mut free.graph, row))
                .collect()
        };
        let y = carry(&y);
        complement.phi = carry(&complement.phi);
        complement.psi = carry(&complement.psi);
        complement.beyond = carry(&complement.beyond);
        let gamma = commutation::gamma(&mut free, &mut calculus, &y);
        let mass = inertia::mass_matrix(&mut free, &mut calculus);
        let connection = connection::connection(&mut free, &mut calculus, &mass, &gamma);
        let potential = energy::potential(&mut free);
        Some(EquationTables {
            model: free,
            calculus,
            y,
            complement,
            gamma,
            mass,
            connection,
            potential,
        })
    }
}
