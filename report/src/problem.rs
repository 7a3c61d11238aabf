//! One motion to be computed, and methods that compute it.

use crate::counted::Counted;
use crate::data::Kind;
use crate::solution::largest;
use hamel::{Method, State, StepError, System, integrate};
use std::hint::black_box;
use std::time::Instant;

/// A start, where it leads, and what is constant on the way.
///
/// Results are taken as the numbers (x, ξ), whatever system they are of.
pub struct Problem<'a, Sys: System<Scalar = f64>, U> {
    /// The system.
    pub system: Counted<'a, Sys>,
    /// x at t = 0.
    pub x: Sys::Coordinates,
    /// ξ at t = 0.
    pub xi: Sys::Velocities,
    /// Length of the run.
    pub until: f64,
    /// u of (t, x, ξ).
    pub inputs: U,
    /// The error of (x, ξ) at the end.
    pub error: Judge<'a>,
    /// Constants of the motion but the energy, of (x, ξ); none where there are none.
    pub momenta: Quantities<'a>,
    /// Whether T + V is constant.
    pub conservative: bool,
}

/// A number of (x, ξ).
pub type Judge<'a> = Box<dyn Fn(&[f64], &[f64]) -> f64 + 'a>;

/// Numbers of (x, ξ).
pub type Quantities<'a> = Box<dyn Fn(&[f64], &[f64]) -> Vec<f64> + 'a>;

/// How far a state is from what is constant, relative.
#[derive(Clone, Copy, Debug)]
pub struct Deviation {
    /// |T + V − E₀| over max(|E₀|, T₀), or over 1 where that is zero; NaN where nothing is conserved.
    pub energy: f64,
    /// Norm of the change of the momenta over their norm, or over 1 where that is zero; NaN where
    /// there are none.
    pub momentum: f64,
    /// max |φ(x)|
    pub defect: f64,
}

/// What a run came to.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Evaluations of forces, where they can be counted.
    pub evaluations: Option<u64>,
    /// The error at the end; NaN where it was not reached.
    pub error: f64,
    /// Why the run ended early.
    pub failure: Option<String>,
}

/// Called with every state after the first.
pub type Watch<'w> = &'w mut dyn FnMut(Deviation);

/// A run of so many steps up to a time, watched.
type Run<'a> = Box<dyn Fn(u64, f64, Watch) -> Outcome + 'a>;

/// The wall time of the first ones (second argument) of so many steps (first argument), unwatched, in
/// s; `None` where it fails.
type Clock<'a> = Box<dyn Fn(u64, u64) -> Option<f64> + 'a>;

/// One method on one problem.
pub struct Entry<'a> {
    /// The method's name.
    pub method: String,
    /// What it is here.
    pub kind: Kind,
    /// Its order, where it has one.
    pub order: Option<u32>,
    run: Run<'a>,
    clock: Clock<'a>,
}

impl<'a> Entry<'a> {
    /// A method of any origin.
    pub fn new(
        method: &str,
        kind: Kind,
        order: Option<u32>,
        run: impl Fn(u64, f64, Watch) -> Outcome + 'a,
        clock: impl Fn(u64, u64) -> Option<f64> + 'a,
    ) -> Self {
        Entry {
            method: method.to_string(),
            kind,
            order,
            run: Box::new(run),
            clock: Box::new(clock),
        }
    }

    /// Runs so many steps up to a time, and shows every state.
    pub fn run(&self, steps: u64, until: f64, watch: Watch) -> Outcome {
        (self.run)(steps, until, watch)
    }

    /// The wall time of the first `part` of so many steps, in s.
    pub fn clock(&self, steps: u64, part: u64) -> Option<f64> {
        (self.clock)(steps, part)
    }
}

impl<'a, Sys, U> Problem<'a, Sys, U>
where
    Sys: System<Scalar = f64>,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    /// The start.
    pub fn start(&self) -> State<Counted<'a, Sys>> {
        State {
            t: 0.0,
            x: self.x.clone(),
            xi: self.xi.clone(),
        }
    }

    /// The error of a state at the end.
    pub fn judge(&self, end: &State<Counted<'a, Sys>>) -> f64 {
        (self.error)(end.x.as_ref(), end.xi.as_ref())
    }

    /// This problem by a method.
    pub fn by<'p, M>(&'p self, name: &str, kind: Kind, method: M) -> Entry<'p>
    where
        M: Method<Counted<'a, Sys>> + Clone + 'p,
    {
        let order = Some(method.order());
        let other = method.clone();
        Entry::new(
            name,
            kind,
            order,
            move |steps, until, watch| self.watched(&method, steps, until, watch),
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

    /// How far a state (x, ξ) is from what is constant, compared with the start.
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

    fn watched<M>(&self, method: &M, steps: u64, until: f64, watch: Watch) -> Outcome
    where
        M: Method<Counted<'a, Sys>>,
    {
        let deviation = self.deviation();
        let mut state = self.start();
        self.system.reset();
        let result = self.steps(method, &mut state, steps, until, |state| {
            watch(deviation(&state.x, &state.xi));
        });
        Outcome {
            evaluations: Some(self.system.evaluations()),
            error: if result.is_ok() {
                (self.error)(state.x.as_ref(), state.xi.as_ref())
            } else {
                f64::NAN
            },
            failure: result.err().map(|error| error.to_string()),
        }
    }

    fn steps<M>(
        &self,
        method: &M,
        state: &mut State<Counted<'a, Sys>>,
        steps: u64,
        until: f64,
        observe: impl FnMut(&State<Counted<'a, Sys>>),
    ) -> Result<(), StepError>
    where
        M: Method<Counted<'a, Sys>>,
    {
        let step = until / steps as f64;
        integrate(
            &self.system,
            method,
            state,
            step,
            until,
            &self.inputs,
            observe,
        )
    }

    /// The states at the end of so many steps of a method, as numbers (x, ξ).
    ///
    /// # Errors
    /// Those of [`integrate()`].
    pub fn end<M>(&self, method: &M, steps: u64) -> Result<(Vec<f64>, Vec<f64>), StepError>
    where
        M: Method<Counted<'a, Sys>>,
    {
        let mut state = self.start();
        self.steps(method, &mut state, steps, self.until, |_| {})?;
        Ok((state.x.as_ref().to_vec(), state.xi.as_ref().to_vec()))
    }
}

/// Largest deviations of a run so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst {
    /// Of the energy.
    pub energy: f64,
    /// Of the momenta.
    pub momentum: f64,
    /// Of φ.
    pub defect: f64,
}

impl Worst {
    /// Takes a state into account; what is NaN stays so.
    pub fn take(&mut self, deviation: Deviation) {
        self.energy = largest([self.energy, deviation.energy]);
        self.momentum = largest([self.momentum, deviation.momentum]);
        self.defect = largest([self.defect, deviation.defect]);
    }
}

fn norm(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|value| value * value).sum::<f64>().sqrt()
}

fn or_one(scale: f64) -> f64 {
    if scale > 0.0 { scale } else { 1.0 }
}
