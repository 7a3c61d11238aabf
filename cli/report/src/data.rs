//! The results of a comparison, in the form of the JSON file.

use crate::entry::Division;
use serde::{Deserialize, Serialize};

/// A whole report.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Heading.
    pub title: String,
    /// The command that makes the report.
    pub command: String,
    /// The machine of the measurements.
    pub machine: Machine,
    /// The measured cases.
    pub cases: Vec<Case>,
    /// Long runs.
    pub drifts: Vec<Drift>,
    /// Other programs, measured or not.
    pub peers: Vec<Peer>,
}

/// Machine and code with which times were measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Kind of processor, as reported by the operating system.
    pub processor: String,
    /// Operating system and architecture.
    pub system: String,
    /// `compiled` or `interpreted`.
    pub code: String,
    /// Number of timings of which every time is the median.
    pub repeats: u32,
}

/// One motion, computed by all methods.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Name, as used in file names.
    pub name: String,
    /// The moving system.
    pub title: String,
    /// Length of the run, in the unit of time of the case.
    pub until: f64,
    /// Definition of `error` of a run.
    pub error: String,
    /// The reference of the error.
    pub reference: String,
    /// Estimated error of the reference.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_error: Option<f64>,
    /// The choice of `--method auto`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub auto: Option<Choice>,
    /// The methods.
    pub methods: Vec<MethodRuns>,
    /// Methods that were requested and cannot run this case.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub missing: Vec<Missing>,
}

/// A method that was chosen by the structure of a system.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// Name.
    pub method: String,
    /// The reason, in a sentence.
    pub reason: String,
}

/// A method that was not measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Missing {
    /// Name.
    pub method: String,
    /// The reason, in a sentence.
    pub why: String,
}

/// The role of a method in a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Meant to be used.
    Method,
    /// Kept for comparison.
    Baseline,
    /// A method of another program.
    Peer,
}

/// The runs of one method on one case, in the order of decreasing step length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MethodRuns {
    /// Name.
    pub method: String,
    /// Its role.
    pub kind: Kind,
    /// Its order, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<u32>,
    /// One run for each number of steps or tolerance.
    pub runs: Vec<MethodRun>,
}

/// One run. A value that does not exist or is not finite is `None`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MethodRun {
    /// Number of steps.
    pub steps: u64,
    /// The error tolerance of a step, with error control.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Rejected attempts at steps, whose error was too large.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rejected: Option<u64>,
    /// Evaluations of forces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub evaluations: Option<u64>,
    /// Error at the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Largest drift of the energy, relative.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<f64>,
    /// Largest drift of conserved momenta, relative.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub momentum: Option<f64>,
    /// Largest |φ(x)|; for a rotation, the deviation of RᵀR from I.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub defect: Option<f64>,
    /// Wall time of the run in s, as a median.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// The reason for an early end of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

impl MethodRun {
    /// Returns how the run was divided into steps.
    pub fn division(&self) -> Division {
        let steps = Division::Steps(self.steps);
        self.tolerance.map_or(steps, Division::Tolerance)
    }

    /// Returns the wall time of a step in s.
    pub fn seconds_per_step(&self) -> Option<f64> {
        self.seconds.map(|seconds| seconds / self.steps as f64)
    }
}

/// One long run of one method: the largest deviations in windows of equal length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Drift {
    /// The case.
    pub case: String,
    /// The method.
    pub method: String,
    /// Length of a step.
    pub step: f64,
    /// Number of steps.
    pub steps: u64,
    /// Largest relative deviation of the energy in each window.
    pub energy: Vec<f64>,
    /// Largest relative deviation of the momenta over the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub momentum: Option<f64>,
    /// Largest |φ(x)| over the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub defect: Option<f64>,
    /// The reason for an early end of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

impl Drift {
    /// Returns the largest deviation of the energy in the last quarter relative to the first: 1 if the energy does not
    /// drift.
    pub fn growth(&self) -> Option<f64> {
        let quarter = self.energy.len() / 4;
        if quarter == 0 || self.failure.is_some() {
            return None;
        }
        let most = |part: &[f64]| part.iter().copied().fold(0.0, f64::max);
        let first = most(self.energy.get(..quarter)?);
        let last = most(self.energy.get(self.energy.len() - quarter..)?);
        (first > 0.0).then_some(last / first)
    }
}

/// Another program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Peer {
    /// Its name and version.
    pub name: String,
    /// Whether it was measured.
    pub available: bool,
    /// A note on the measurement, or the reason for its absence.
    pub note: String,
    /// The command that includes it in the report.
    pub start: String,
}

/// Rounds a number to three significant digits, as results are stored; `None` if it is not finite.
pub fn round_to_three_digits(value: f64) -> Option<f64> {
    value
        .is_finite()
        .then(|| format!("{value:.2e}").parse().unwrap_or(value))
}
