//! A case: a system that can be run, and the error of a state.

use crate::reference::{Reference, distance, relative};
use hamel::methods::{Scheme, Splitting};
use hamel::{Method, Split, State, StepError, System, integrate};
use std::cell::Cell;

/// A part of the state that the reference lists.
#[derive(Clone, Debug)]
pub enum Field {
    /// Named numbers.
    Numbers(&'static str, Vec<f64>),
    /// A named angle modulo whole turns (rad).
    Angle(&'static str, f64),
    /// A named rotation matrix, nine entries row by row.
    Rotation(&'static str, [f64; 9]),
}

/// The measure of an error as one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// The Frobenius norm of R − R_ref, of the first field.
    Attitude,
    /// The largest of [`Case::deviations`].
    Largest,
}

/// Inputs over time.
pub type Inputs<Sys> = Box<
    dyn Fn(
        f64,
        &<Sys as System>::Coordinates,
        &<Sys as System>::Velocities,
    ) -> <Sys as System>::Inputs,
>;

/// A hard case.
pub struct Case<Sys: System<Scalar = f64>> {
    /// Name of the reference solution.
    pub name: &'static str,
    /// The system, with the parameters of the case.
    pub system: Sys,
    /// The state at t = 0.
    pub start: State<Sys>,
    /// The end of the run at which errors are compared.
    pub until: f64,
    /// u(t, x, ξ)
    pub inputs: Inputs<Sys>,
    /// The parts of a state, named as in the reference.
    pub fields: fn(&Sys, &State<Sys>) -> Vec<Field>,
    /// The measure of the error.
    pub measure: Measure,
    /// States at listed times.
    pub reference: Reference,
}

impl<Sys: System<Scalar = f64>> Case<Sys> {
    /// Returns the state at time `until` after `n` equal steps.
    ///
    /// # Errors
    /// Those of [`integrate()`].
    pub fn run<M: Method<Sys>>(
        &self,
        method: M,
        until: f64,
        n: u32,
    ) -> Result<State<Sys>, StepError> {
        self.counted(method, until, n).map(|(state, _)| state)
    }

    /// Like [`run`](Self::run), with the number of evaluations: each of them evaluates u once.
    ///
    /// # Errors
    /// Those of [`integrate()`].
    pub fn counted<M: Method<Sys>>(
        &self,
        method: M,
        until: f64,
        n: u32,
    ) -> Result<(State<Sys>, u64), StepError> {
        let mut state = self.start.clone();
        let count = Cell::new(0);
        let inputs = |t: f64, x: &_, xi: &_| {
            count.set(count.get() + 1);
            (self.inputs)(t, x, xi)
        };
        let length = until / f64::from(n);
        integrate(
            &self.system,
            method,
            &mut state,
            length,
            until,
            inputs,
            |_| {},
        )?;
        Ok((state, count.get()))
    }

    /// Like [`counted`](Self::counted), by a splitting method.
    ///
    /// # Errors
    /// Those of [`integrate()`].
    pub fn split(&self, scheme: Scheme, until: f64, n: u32) -> Result<(State<Sys>, u64), StepError>
    where
        Sys: Split,
    {
        self.counted(Splitting::new(&self.system, scheme), until, n)
    }

    /// Returns the error at the end of the case; see [`error_at`](Self::error_at).
    pub fn error(&self, state: &State<Sys>) -> f64 {
        self.error_at(self.until, state)
    }

    /// Returns the error of `state` at a listed time, by the [`measure`](Self::measure).
    pub fn error_at(&self, t: f64, state: &State<Sys>) -> f64 {
        if self.measure == Measure::Attitude
            && let [Field::Rotation(name, r), ..] = (self.fields)(&self.system, state).as_slice()
        {
            return distance(r, &self.reference.sample::<9>(t, name));
        }
        let deviations = self.deviations(t, state).into_iter();
        deviations.map(|(_, error)| error).fold(0.0, f64::max)
    }

    /// Returns the largest difference of every field over max(1, the largest entry of the field).
    pub fn deviations(&self, t: f64, state: &State<Sys>) -> Vec<(&'static str, f64)> {
        let fields = (self.fields)(&self.system, state).into_iter();
        fields
            .map(|field| match field {
                Field::Numbers(name, found) => {
                    (name, relative(&found, &self.reference.entries(t, name)))
                }
                Field::Rotation(name, r) => {
                    (name, relative(&r, &self.reference.sample::<9>(t, name)))
                }
                Field::Angle(name, angle) => {
                    let [expected] = self.reference.sample(t, name);
                    let turn = std::f64::consts::TAU;
                    let off = (angle - expected + turn / 2.0).rem_euclid(turn) - turn / 2.0;
                    (name, off.abs() / expected.abs().max(1.0))
                }
            })
            .collect()
    }
}
