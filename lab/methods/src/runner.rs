//! Measures a case.

use crate::peers::Peers;
use hamel_report::data::{Case, Drift, Kind};
use hamel_report::drift::drift;
use hamel_report::entry::Entry;
use hamel_report::measure::{Plan, measure};
use hamel_report::solution::{Solution, SolutionError};
use std::fmt;

/// The smallest number of steps, which is then doubled repeatedly.
const MIN_STEPS: u64 = 10;
const STEP_DOUBLINGS: u32 = 14;
/// Error tolerances of methods that choose their steps.
const STEP_TOLERANCES: [f64; 11] = [
    1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13,
];
/// Shortest duration of a timing, in s.
const MIN_TIMING: f64 = 3e-4;
/// Errors below this are taken for rounding.
const ERROR_FLOOR: f64 = 1e-12;
/// Number of steps of a long run.
const LONG_RUN_STEPS: u64 = 1_000_000;

/// A failure before anything was measured.
#[derive(Debug)]
pub struct BenchError(pub String);

impl fmt::Display for BenchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for BenchError {}

impl From<SolutionError> for BenchError {
    fn from(error: SolutionError) -> Self {
        BenchError(error.to_string())
    }
}

/// The extent of the measurements.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Number of timings of each run.
    pub repeats: u32,
    /// Whether long runs are made.
    pub long: bool,
}

/// A case with its reference, and the results so far.
pub struct Runner<'a> {
    /// The reference solution.
    pub solution: &'a Solution,
    /// The extent of the measurements.
    pub effort: Effort,
    /// Other programs.
    pub peers: &'a Peers,
    /// Called with the number of finished measurements and with their total.
    pub tick: &'a dyn Fn(u64, u64),
    /// The results.
    pub case: Case,
    /// Long runs.
    pub drifts: Vec<Drift>,
}

impl Runner<'_> {
    /// Measures entries. If a step is given, also measures long runs with it for all methods but those of peers.
    pub fn entries(&mut self, entries: &[Entry], long: Option<f64>) {
        let plan = Plan {
            steps: Plan::doublings(MIN_STEPS, STEP_DOUBLINGS),
            tolerances: STEP_TOLERANCES.to_vec(),
            repeats: self.effort.repeats,
            least: MIN_TIMING,
            floor: ERROR_FLOOR,
        };
        let tick = self.tick;
        measure(&mut self.case, entries, &plan, &mut |done, all| {
            tick(done, all)
        });
        self.peers.add(&mut self.case);
        if let (Some(step), true) = (long, self.effort.long) {
            let ours = entries.iter().filter(|entry| entry.kind != Kind::Peer);
            for entry in ours {
                self.drifts
                    .extend(drift(&self.case.name, entry, step, LONG_RUN_STEPS));
            }
        }
    }

    /// Returns the N numbers of a parameter.
    ///
    /// # Errors
    /// If the reference does not have them.
    pub fn parameter<const N: usize>(&self, name: &str) -> Result<[f64; N], BenchError> {
        take(name, self.solution.parameter(name))
    }

    /// Returns N numbers of the initial state.
    ///
    /// # Errors
    /// If the reference does not have them.
    pub fn initial<const N: usize>(&self, name: &str) -> Result<[f64; N], BenchError> {
        take(name, self.solution.initial(name))
    }

    /// Returns N numbers of the final state.
    ///
    /// # Errors
    /// If the reference does not have them.
    pub fn end<const N: usize>(&self, name: &str) -> Result<[f64; N], BenchError> {
        take(name, self.solution.sample(self.case.until, name))
    }

    /// Returns g of a gravity that points down.
    ///
    /// # Errors
    /// If the reference has none.
    pub fn gravity(&self) -> Result<f64, BenchError> {
        self.parameter::<3>("g").map(|[_, _, z]| -z)
    }
}

fn take<const N: usize>(name: &str, values: Option<Vec<f64>>) -> Result<[f64; N], BenchError> {
    values
        .and_then(|values| values.try_into().ok())
        .ok_or_else(|| BenchError(format!("the reference has no {N} numbers `{name}`")))
}

/// Groups nine entries, given row by row, into rows.
pub fn rows(m: [f64; 9]) -> [[f64; 3]; 3] {
    let [a, b, c, d, e, f, g, h, i] = m;
    [[a, b, c], [d, e, f], [g, h, i]]
}
