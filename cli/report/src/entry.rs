//! A method on a problem, as it is run and timed.

use crate::data::{Kind, MethodRun};
use crate::solution::largest;
use hamel::adaptive::Statistics;

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
    /// Steps taken and refused, where a tolerance chooses them.
    pub statistics: Option<Statistics>,
}

/// Called with every state after the first.
pub type Watch<'w> = &'w mut dyn FnMut(Deviation);

/// How finely a run is divided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Division {
    /// So many equal steps.
    Steps(u64),
    /// Steps that make this error each, chosen by the method.
    Tolerance(f64),
}

/// A run of so many steps up to a time, watched.
type Run<'a> = Box<dyn Fn(u64, f64, Watch) -> Outcome + 'a>;

/// The wall time of the first ones (second argument) of so many steps (first argument), unwatched, in
/// s; `None` where it fails.
type Clock<'a> = Box<dyn Fn(u64, u64) -> Option<f64> + 'a>;

/// A run with a tolerance up to a time, watched.
type Controlled<'a> = Box<dyn Fn(f64, f64, Watch) -> Outcome + 'a>;

/// The wall time of the first part (second argument, of 1) of a run with a tolerance (first argument),
/// unwatched, in s, and the evaluations in it.
type ControlledClock<'a> = Box<dyn Fn(f64, f64) -> Option<(f64, u64)> + 'a>;

enum Stepping<'a> {
    Equal {
        run: Run<'a>,
        clock: Clock<'a>,
    },
    Controlled {
        run: Controlled<'a>,
        clock: ControlledClock<'a>,
    },
}

/// One method on one problem.
pub struct Entry<'a> {
    /// The method's name.
    pub method: String,
    /// What it is here.
    pub kind: Kind,
    /// Its order, where it has one.
    pub order: Option<u32>,
    stepping: Stepping<'a>,
}

impl<'a> Entry<'a> {
    /// A method of any origin, in equal steps.
    pub fn new(
        method: &str,
        kind: Kind,
        order: Option<u32>,
        run: impl Fn(u64, f64, Watch) -> Outcome + 'a,
        clock: impl Fn(u64, u64) -> Option<f64> + 'a,
    ) -> Self {
        let (run, clock) = (Box::new(run), Box::new(clock));
        Entry {
            method: method.to_string(),
            kind,
            order,
            stepping: Stepping::Equal { run, clock },
        }
    }

    /// A method that chooses its steps by a tolerance.
    pub fn controlled(
        method: &str,
        order: u32,
        run: impl Fn(f64, f64, Watch) -> Outcome + 'a,
        clock: impl Fn(f64, f64) -> Option<(f64, u64)> + 'a,
    ) -> Self {
        let (run, clock) = (Box::new(run), Box::new(clock));
        Entry {
            method: method.to_string(),
            kind: Kind::Method,
            order: Some(order),
            stepping: Stepping::Controlled { run, clock },
        }
    }

    /// Which of these divisions it can be run with.
    pub fn divisions(&self, steps: &[u64], tolerances: &[f64]) -> Vec<Division> {
        match self.stepping {
            Stepping::Equal { .. } => steps.iter().copied().map(Division::Steps).collect(),
            Stepping::Controlled { .. } => {
                let tolerances = tolerances.iter().copied();
                tolerances.map(Division::Tolerance).collect()
            }
        }
    }

    /// Runs up to a time, and shows every state; `None` for a division that is none of its own.
    pub fn run(&self, division: Division, until: f64, watch: Watch) -> Option<Outcome> {
        match (&self.stepping, division) {
            (Stepping::Equal { run, .. }, Division::Steps(steps)) => Some(run(steps, until, watch)),
            (Stepping::Controlled { run, .. }, Division::Tolerance(tolerance)) => {
                Some(run(tolerance, until, watch))
            }
            _ => None,
        }
    }

    /// The wall time of the first steps of a run that was measured, at most about `part` of them, and that
    /// of the whole run in proportion, in s.
    pub fn clock(&self, measured: &MethodRun, part: u64) -> Option<(f64, f64)> {
        let steps = measured.steps;
        let part = steps.min(part);
        match (&self.stepping, measured.division()) {
            (Stepping::Equal { clock, .. }, Division::Steps(steps)) => {
                let seconds = clock(steps, part)?;
                Some((seconds, seconds * (steps as f64 / part as f64)))
            }
            (Stepping::Controlled { clock, .. }, Division::Tolerance(tolerance)) => {
                let (seconds, evaluations) = clock(tolerance, part as f64 / steps as f64)?;
                let all = measured.evaluations? as f64;
                Some((seconds, seconds * (all / evaluations as f64)))
            }
            _ => None,
        }
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
