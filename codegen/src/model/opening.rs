//! The start as it is given, and what follows from it. What is exact stays; coordinates and velocities that are
//! prescribed follow; loops are closed and constraints kept by the rest. A description and a state from outside are
//! completed by the same rules.

use super::closure::{Closure, Open};
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

/// A constraint that the start cannot keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refused {
    /// By coordinates.
    Configuration(Open),
    /// By velocities.
    Velocities(Open),
}

/// M at a configuration.
pub type Mass<'a> = &'a dyn Fn(&[f64]) -> Vec<Vec<f64>>;

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

    /// Puts coordinates where they are prescribed to be, closes loops and keeps constraints. What is exact stays, and is
    /// refused where it contradicts them. Near guesses of coordinates the configuration is the nearest in the metric of M;
    /// so are velocities near guesses of velocities.
    ///
    /// # Errors
    /// The constraint that cannot be kept.
    pub fn complete(
        &mut self,
        closure: &Closure,
        prescribed: &[(usize, Edge)],
        mass: Mass,
    ) -> Result<(), Refused> {
        self.configure(closure, prescribed, mass)
            .map_err(Refused::Configuration)?;
        self.settle(closure, mass).map_err(Refused::Velocities)
    }

    /// The part of it about x.
    ///
    /// # Errors
    /// The constraint that cannot be kept.
    pub fn configure(
        &mut self,
        closure: &Closure,
        prescribed: &[(usize, Edge)],
        mass: Mass,
    ) -> Result<(), Open> {
        let mut kept = self.exact_x.clone();
        let values: Vec<Edge> = prescribed.iter().map(|(_, value)| *value).collect();
        let values = evaluate(closure.graph, &values, &closure.numbers(&self.x));
        for (&(alpha, _), value) in prescribed.iter().zip(values) {
            if !self.exact_x[alpha] && value.is_finite() {
                self.x[alpha] = value;
                kept[alpha] = true;
            }
        }
        match self.guesses_coordinates() {
            true => {
                let mass = mass(&self.x);
                closure.assemble(&mut self.x, &kept, &mass)
            }
            false => closure.close_loops(&mut self.x, &kept),
        }
    }

    /// The part of it about ξ, where x is what it has to be.
    ///
    /// # Errors
    /// The constraint that cannot be kept.
    pub fn settle(&mut self, closure: &Closure, mass: Mass) -> Result<(), Open> {
        match self.guessed_xi.contains(&true) {
            true => {
                let mass = mass(&self.x);
                closure.settle_near(&self.x, &mut self.xi, &self.exact_xi, &mass)
            }
            false => closure.settle(&self.x, &mut self.xi, &self.exact_xi),
        }
    }
}
