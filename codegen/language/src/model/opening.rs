//! The start as it is given.

use crate::algebra::graph::{Edge, Graph};
use crate::algebra::numeric::evaluate;
use std::sync::Arc;

/// x and ξ as they are given: numbers, which of them are exact, and which are guesses. What is neither is at the identity
/// and at rest.
#[derive(Clone, Debug, Default)]
pub struct Opening {
    /// x.
    pub x: Vec<f64>,
    /// ξ of the full frame.
    pub xi: Vec<f64>,
    /// z.
    pub z: Vec<f64>,
    /// The entries of x that are exact.
    pub exact_x: Vec<bool>,
    /// The entries of ξ that are exact.
    pub exact_xi: Vec<bool>,
    /// The entries of x that are guesses.
    pub guessed_x: Vec<bool>,
    /// The entries of ξ that are guesses.
    pub guessed_xi: Vec<bool>,
    /// What of it depends on parameters.
    pub formulas: Option<Arc<Formulas>>,
}

/// Starts that depend on parameters, by their places.
#[derive(Clone, Debug)]
pub struct Formulas {
    /// The graph of all expressions.
    pub graph: Graph,
    /// Those of x.
    pub x: Vec<(usize, Edge)>,
    /// Those of ξ.
    pub xi: Vec<(usize, Edge)>,
    /// Those of z.
    pub z: Vec<(usize, Edge)>,
}

impl Opening {
    /// The same where the parameters have these values.
    pub fn at(&self, params: &[f64]) -> Opening {
        let mut opening = self.clone();
        let Some(formulas) = &self.formulas else {
            return opening;
        };
        let mut numbers = vec![std::f64::consts::PI];
        numbers.extend_from_slice(params);
        numbers.resize(formulas.graph.symbols().len(), f64::NAN);
        for (into, list) in [
            (&mut opening.x, &formulas.x),
            (&mut opening.xi, &formulas.xi),
            (&mut opening.z, &formulas.z),
        ] {
            let edges: Vec<Edge> = list.iter().map(|(_, edge)| *edge).collect();
            let values = evaluate(&formulas.graph, &edges, &numbers);
            list.iter()
                .zip(values)
                .for_each(|(&(place, _), value)| into[place] = value);
        }
        opening
    }

    /// Whether coordinates are guessed: then loops are closed as near to the guesses as possible.
    pub fn guesses_coordinates(&self) -> bool {
        self.guessed_x.contains(&true)
    }
}
