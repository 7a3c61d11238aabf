//! A motion to compute, by methods in equal steps or with error control.

use crate::data::Kind;
use crate::entry::{Deviation, Entry, Outcome, Watch};
use hamel::adaptive::{Adaptive, Report};
use hamel::{Energies, Method, State, StepError, System, integrate};
use std::hint::black_box;
use std::time::Instant;

/// A system with its start, the error of a final state, and constants of motion.
///
/// States are passed to its functions as numbers (x, ξ), whatever the type of the system.
pub struct Problem<'a, Sys: System<Scalar = f64>, U> {
    /// The system.
    pub system: &'a Sys,
    /// Returns how often the system has evaluated its forces until now. A system that does not count itself is wrapped
    /// in [`CountedSystem`](crate::counted_system::CountedSystem).
    pub evaluations: EvaluationCount<'a>,
    /// x at t = 0.
    pub x: Sys::Coordinates,
    /// ξ at t = 0.
    pub xi: Sys::Velocities,
    /// Length of the run.
    pub until: f64,
    /// u as a function of (t, x, ξ).
    pub inputs: U,
    /// The error of (x, ξ) at the end.
    pub error: Judge<'a>,
    /// Constants of motion other than the energy, as functions of (x, ξ); may be empty.
    pub momenta: Quantities<'a>,
    /// Formats the error of a failed step.
    pub error_text: ErrorText<'a>,
    /// Whether T + V is constant.
    pub conservative: bool,
}

/// A number as a function of (x, ξ).
pub type Judge<'a> = Box<dyn Fn(&[f64], &[f64]) -> f64 + 'a>;

/// A count that grows with every evaluation of forces.
pub type EvaluationCount<'a> = Box<dyn Fn() -> u64 + 'a>;

/// Formats an error.
pub type ErrorText<'a> = Box<dyn Fn(&StepError) -> String + 'a>;

/// Numbers as a function of (x, ξ).
pub type Quantities<'a> = Box<dyn Fn(&[f64], &[f64]) -> Vec<f64> + 'a>;

impl<'a, Sys, U> Problem<'a, Sys, U>
where
    Sys: Energies<Scalar = f64>,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    /// Returns the initial state.
    pub fn start(&self) -> State<Sys> {
        State {
            t: 0.0,
            x: self.x.clone(),
            xi: self.xi.clone(),
        }
    }

    /// Returns the error of a final state.
    pub fn judge(&self, end: &State<Sys>) -> f64 {
        (self.error)(end.x.as_ref(), end.xi.as_ref())
    }

    /// Makes an entry for a method with equal steps.
    pub fn by<'p, M>(&'p self, name: &str, kind: Kind, method: M) -> Entry<'p>
    where
        M: Method<Sys> + Clone + 'p,
    {
        let order = Some(method.order());
        let other = method.clone();
        Entry::new(
            name,
            kind,
            order,
            move |steps, until, watch| self.watch_run(&method, steps, until, watch),
            move |steps, part| {
                let until = self.until * (part as f64 / steps as f64);
                let begin = Instant::now();
                let mut state = black_box(self.start());
                self.steps(&other, &mut state, part, until, |_| {}).ok()?;
                black_box(&state);
                Some(begin.elapsed().as_secs_f64())
            },
        )
    }

    /// Makes an entry for a pair with error control.
    pub fn controlled<'p, const M: usize, const D: usize>(
        &'p self,
        name: &str,
        order: u32,
        pair: fn(f64) -> Adaptive<M, D>,
    ) -> Entry<'p> {
        Entry::controlled(
            name,
            order,
            move |tolerance, until, watch| self.watched_by(&pair(tolerance), until, watch),
            move |tolerance, part| {
                let begin = Instant::now();
                let mut state = black_box(self.start());
                let until = self.until * part;
                let statistics = pair(tolerance)
                    .run(self.system, &mut state, until, &self.inputs)
                    .ok()?;
                black_box(&state);
                Some((begin.elapsed().as_secs_f64(), statistics.evaluations))
            },
        )
    }

    /// Returns a function for the deviation of a state (x, ξ) from the constants of motion at the start.
    pub fn deviation(&self) -> impl Fn(&Sys::Coordinates, &Sys::Velocities) -> Deviation + '_ {
        let kinetic = self.system.kinetic_energy(&self.x, &self.xi);
        let energy = kinetic + self.system.potential_energy(&self.x);
        let scale = or_one(energy.abs().max(kinetic));
        let momenta = (self.momenta)(self.x.as_ref(), self.xi.as_ref());
        let size = or_one(norm(momenta.iter().copied()));
        move |x, xi| {
            let now = (self.momenta)(x.as_ref(), xi.as_ref());
            let change = norm(now.iter().zip(&momenta).map(|(now, then)| now - then));
            let here = self.system.kinetic_energy(x, xi) + self.system.potential_energy(x);
            Deviation {
                energy: if self.conservative {
                    (here - energy).abs() / scale
                } else {
                    f64::NAN
                },
                momentum: if momenta.is_empty() {
                    f64::NAN
                } else {
                    change / size
                },
                defect: self.system.constraint_norm(x),
            }
        }
    }

    fn watch_run<M>(&self, method: &M, steps: u64, until: f64, watch: Watch) -> Outcome
    where
        M: Method<Sys>,
    {
        let deviation = self.deviation();
        let mut state = self.start();
        let before = (self.evaluations)();
        let result = self.steps(method, &mut state, steps, until, |state| {
            watch(deviation(&state.x, &state.xi));
        });
        Outcome {
            evaluations: Some((self.evaluations)() - before),
            error: if result.is_ok() {
                (self.error)(state.x.as_ref(), state.xi.as_ref())
            } else {
                f64::NAN
            },
            failure: result.err().map(|error| (self.error_text)(&error)),
            statistics: None,
        }
    }

    /// Makes two runs with the same steps: one shows them, for which dense output may need more evaluations, and one
    /// counts.
    fn watched_by<const M: usize, const D: usize>(
        &self,
        method: &Adaptive<M, D>,
        until: f64,
        watch: Watch,
    ) -> Outcome {
        let deviation = self.deviation();
        let shown = |report: Report<'_, Sys, D>| {
            if let Report::Step(step) = report {
                watch(deviation(&step.end().x, &step.end().xi));
            }
        };
        let mut state = self.start();
        // A failure here occurs in the second run as well.
        let _ = method.integrate(self.system, &mut state, until, &self.inputs, &[], shown);
        let mut state = self.start();
        let before = (self.evaluations)();
        let result = method.run(self.system, &mut state, until, &self.inputs);
        Outcome {
            evaluations: Some((self.evaluations)() - before),
            error: if result.is_ok() {
                self.judge(&state)
            } else {
                f64::NAN
            },
            failure: result.as_ref().err().map(|error| (self.error_text)(error)),
            statistics: result.ok(),
        }
    }

    fn steps<M>(
        &self,
        method: &M,
        state: &mut State<Sys>,
        steps: u64,
        until: f64,
        observe: impl FnMut(&State<Sys>),
    ) -> Result<(), StepError>
    where
        M: Method<Sys>,
    {
        let step = until / steps as f64;
        integrate(
            self.system,
            method,
            state,
            step,
            until,
            &self.inputs,
            observe,
        )
    }

    /// Returns the final state after `steps` steps of a method, as numbers (x, ξ).
    ///
    /// # Errors
    /// Those of [`integrate()`].
    pub fn end<M>(&self, method: &M, steps: u64) -> Result<(Vec<f64>, Vec<f64>), StepError>
    where
        M: Method<Sys>,
    {
        let mut state = self.start();
        self.steps(method, &mut state, steps, self.until, |_| {})?;
        Ok((state.x.as_ref().to_vec(), state.xi.as_ref().to_vec()))
    }
}

fn norm(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|value| value * value).sum::<f64>().sqrt()
}

fn or_one(scale: f64) -> f64 {
    if scale > 0.0 { scale } else { 1.0 }
}
