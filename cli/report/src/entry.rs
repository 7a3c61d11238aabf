//! A method on a problem, which can be run and timed.

use crate::data::{Kind, MethodRun};
use crate::solution::largest;
use hamel::adaptive::Statistics;

/// The relative deviation of a state from the constants of motion.
#[derive(Clone, Copy, Debug)]
pub struct Deviation {
    /// |T + V − E₀| over max(|E₀|, T₀), or over 1 if that is zero; NaN if nothing is conserved.
    pub energy: f64,
    /// Norm of the change of the momenta over their norm, or over 1 if that is zero; NaN if there are none.
    pub momentum: f64,
    /// max |φ(x)|
    pub defect: f64,
}

/// The outcome of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Evaluations of forces, if they can be counted.
    pub evaluations: Option<u64>,
    /// The error at the end; NaN if the run failed.
    pub error: f64,
    /// The reason for an early end of the run.
    pub failure: Option<String>,
    /// Steps taken and rejected, with error control.
    pub statistics: Option<Statistics>,
}

/// Called with every state after the first.
pub type Watch<'w> = &'w mut dyn FnMut(Deviation);

/// The division of a run into steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Division {
    /// This number of equal steps.
    Steps(u64),
    /// Steps chosen by the method, with this error tolerance each.
    Tolerance(f64),
}

/// A watched run, by the number of steps and the final time.
type Run<'a> = Box<dyn Fn(u64, f64, Watch) -> Outcome + 'a>;

/// The wall time, in s, of the first steps (second argument) of an unwatched run with a number of steps (first
/// argument); `None` if it fails.
type Clock<'a> = Box<dyn Fn(u64, u64) -> Option<f64> + 'a>;

/// A watched run, by the tolerance and the final time.
type Controlled<'a> = Box<dyn Fn(f64, f64, Watch) -> Outcome + 'a>;

/// The wall time, in s, and the evaluations of the first part (second argument, up to 1) of an unwatched run with a
/// tolerance (first argument).
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
    /// Its role.
    pub kind: Kind,
    /// Its order, if it has one.
    pub order: Option<u32>,
    stepping: Stepping<'a>,
}

impl<'a> Entry<'a> {
    /// Makes an entry of a method of any origin, in equal steps.
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

    /// Makes an entry of a method with error control.
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

    /// Returns the divisions that the method supports.
    pub fn divisions(&self, steps: &[u64], tolerances: &[f64]) -> Vec<Division> {
        match self.stepping {
            Stepping::Equal { .. } => steps.iter().copied().map(Division::Steps).collect(),
            Stepping::Controlled { .. } => {
                let tolerances = tolerances.iter().copied();
                tolerances.map(Division::Tolerance).collect()
            }
        }
    }

    /// Runs up to a time, and shows every state; `None` for a division that the method does not support.
    pub fn run(&self, division: Division, until: f64, watch: Watch) -> Option<Outcome> {
        match (&self.stepping, division) {
            (Stepping::Equal { run, .. }, Division::Steps(steps)) => Some(run(steps, until, watch)),
            (Stepping::Controlled { run, .. }, Division::Tolerance(tolerance)) => {
                Some(run(tolerance, until, watch))
            }
            _ => None,
        }
    }

    /// Times the first steps of a run that was measured, at most about `part` of them. Returns this wall time and the
    /// proportional one of the whole run, in s.
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

/// The largest deviations of a run so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst {
    /// Largest deviation of the energy.
    pub energy: f64,
    /// Largest deviation of the momenta.
    pub momentum: f64,
    /// Largest deviation of φ.
    pub defect: f64,
}

impl Worst {
    /// Updates the deviations by those of a state; NaN persists.
    pub fn take(&mut self, deviation: Deviation) {
        self.energy = largest([self.energy, deviation.energy]);
        self.momentum = largest([self.momentum, deviation.momentum]);
        self.defect = largest([self.defect, deviation.defect]);
    }
}
