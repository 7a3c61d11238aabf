//! Completes a start: exact values stay, prescribed coordinates and velocities are set, and the rest closes loops and
//! satisfies constraints. A description and a state from outside are completed by the same rules.

use super::initial_conditions::InitialConditions;
use super::loop_closure::{LoopClosure, Open};
use crate::algebra::graph::Edge;
use crate::algebra::numeric::evaluate;

/// A constraint that the start cannot satisfy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refused {
    /// A constraint on the coordinates.
    Configuration(Open),
    /// A constraint on the velocities.
    Velocities(Open),
}

/// Function that returns M at a configuration.
pub type Mass<'a> = &'a dyn Fn(&[f64]) -> Vec<Vec<f64>>;

impl InitialConditions {
    /// Sets prescribed coordinates, closes loops and satisfies constraints. Exact values stay; they are refused if
    /// they contradict the constraints. If coordinates are guessed, the result is the nearest configuration in the
    /// metric of M; likewise for guessed velocities.
    ///
    /// # Errors
    /// Returns the constraint that cannot be satisfied.
    pub fn complete(
        &mut self,
        closure: &LoopClosure,
        prescribed: &[(usize, Edge)],
        mass: Mass,
    ) -> Result<(), Refused> {
        self.configure(closure, prescribed, mass)
            .map_err(Refused::Configuration)?;
        self.settle(closure, mass).map_err(Refused::Velocities)
    }

    /// Completes the coordinates x, the first part of [`complete`](Self::complete).
    ///
    /// # Errors
    /// Returns the constraint that cannot be satisfied.
    pub fn configure(
        &mut self,
        closure: &LoopClosure,
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

    /// Completes the velocities ξ for an x that is complete, the second part of [`complete`](Self::complete).
    ///
    /// # Errors
    /// Returns the constraint that cannot be satisfied.
    pub fn settle(&mut self, closure: &LoopClosure, mass: Mass) -> Result<(), Open> {
        match self.guessed_xi.contains(&true) {
            true => {
                let mass = mass(&self.x);
                closure.settle_near(&self.x, &mut self.xi, &self.exact_xi, &mass)
            }
            false => closure.settle(&self.x, &mut self.xi, &self.exact_xi),
        }
    }
}
