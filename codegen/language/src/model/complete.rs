//! What follows from the start as it is given. What is exact stays; coordinates and velocities that are prescribed follow;
//! loops are closed and constraints kept by the rest. A description and a state from outside are completed by the same
//! rules.

use super::closure::{Closure, Open};
use super::opening::Opening;
use crate::algebra::graph::Edge;
use crate::algebra::numeric::evaluate;

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
