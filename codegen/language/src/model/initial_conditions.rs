//! The start as a description gives it.

use crate::algebra::graph::{Edge, Graph};
use crate::algebra::numeric::evaluate;
use std::sync::Arc;

/// Given values of x and ξ, of which some are exact and some are guesses. Entries that are neither are at the
/// identity or at rest.
#[derive(Clone, Debug, Default)]
pub struct InitialConditions {
    /// Values of x.
    pub x: Vec<f64>,
    /// Values of ξ of the full frame.
    pub xi: Vec<f64>,
    /// Values of z.
    pub z: Vec<f64>,
    /// For each entry of x, whether it is exact.
    pub exact_x: Vec<bool>,
    /// For each entry of ξ, whether it is exact.
    pub exact_xi: Vec<bool>,
    /// For each entry of x, whether it is a guess.
    pub guessed_x: Vec<bool>,
    /// For each entry of ξ, whether it is a guess.
    pub guessed_xi: Vec<bool>,
    /// Values that depend on parameters.
    pub formulas: Option<Arc<Formulas>>,
}

/// Initial values that depend on parameters, by their indices.
#[derive(Clone, Debug)]
pub struct Formulas {
    /// Graph of all expressions.
    pub graph: Graph,
    /// Expressions for entries of x.
    pub x: Vec<(usize, Edge)>,
    /// Expressions for entries of ξ.
    pub xi: Vec<(usize, Edge)>,
    /// Expressions for entries of z.
    pub z: Vec<(usize, Edge)>,
}

impl InitialConditions {
    /// Returns the initial conditions for these values of the parameters.
    pub fn at(&self, params: &[f64]) -> InitialConditions {
        let mut initial = self.clone();
        let Some(formulas) = &self.formulas else {
            return initial;
        };
        let mut numbers = vec![std::f64::consts::PI];
        numbers.extend_from_slice(params);
        numbers.resize(formulas.graph.symbols().len(), f64::NAN);
        for (into, list) in [
            (&mut initial.x, &formulas.x),
            (&mut initial.xi, &formulas.xi),
            (&mut initial.z, &formulas.z),
        ] {
            let edges: Vec<Edge> = list.iter().map(|(_, edge)| *edge).collect();
            let values = evaluate(&formulas.graph, &edges, &numbers);
            list.iter()
                .zip(values)
                .for_each(|(&(place, _), value)| into[place] = value);
        }
        initial
    }

    /// Returns whether some coordinate is a guess, so that loops are closed as near to the guesses as possible.
    pub fn guesses_coordinates(&self) -> bool {
        self.guessed_x.contains(&true)
    }
}
