//! The results of a comparison, as they stand in JSON.

use crate::entry::Division;
use serde::{Deserialize, Serialize};

/// A whole report.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Heading.
    pub title: String,
    /// The command that makes it again.
    pub command: String,
    /// Where it was measured.
    pub machine: Machine,
    /// What was measured.
    pub cases: Vec<Case>,
    /// Long runs.
    pub drifts: Vec<Drift>,
    /// Other programs, whether they could be measured or not.
    pub peers: Vec<Peer>,
}

/// Where and how times were measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Kind of processor, as the system names it.
    pub processor: String,
    /// Operating system and architecture.
    pub system: String,
    /// `compiled` or `interpreted`.
    pub code: String,
    /// Every time is the median of this many.
    pub repeats: u32,
}

/// One motion, by all methods.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Name, as in file names.
    pub name: String,
    /// What moves.
    pub title: String,
    /// Length of the run, in the unit of time of the case.
    pub until: f64,
    /// What `error` of a run is.
    pub error: String,
    /// What the error is measured against.
    pub reference: String,
    /// How far the reference itself is believed to be off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_error: Option<f64>,
    /// What `--method auto` takes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub auto: Option<Choice>,
    /// The methods.
    pub methods: Vec<MethodRuns>,
    /// Methods that were asked for and cannot run this case.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub missing: Vec<Missing>,
}

/// A method that was chosen by the structure of a system.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// Its name.
    pub method: String,
    /// Why, in a sentence.
    pub reason: String,
}

/// A method that was not measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Missing {
    /// Its name.
    pub method: String,
    /// Why, in a sentence.
    pub why: String,
}

/// What a method is in a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Meant to be used.
    Method,
    /// Kept to compare with.
    Baseline,
    /// Of another program.
    Peer,
}

/// The runs of one method on one case, from long steps to short ones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MethodRuns {
    /// Its name.
    pub method: String,
    /// What it is here.
    pub kind: Kind,
    /// Its order, where it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<u32>,
    /// One run for each number of steps.
    pub runs: Vec<MethodRun>,
}

/// One run. What is `None` does not exist or is not finite.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MethodRun {
    /// Number of steps.
    pub steps: u64,
    /// The error that a step may make, where steps are chosen by it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Attempts at steps whose error was too large.
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
    /// Largest |φ(x)|: for a rotation how far RᵀR is from I.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub defect: Option<f64>,
    /// Wall time of the run in s, a median.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// Why the run ended early.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

impl MethodRun {
    /// How the run was divided into steps.
    pub fn division(&self) -> Division {
        let steps = Division::Steps(self.steps);
        self.tolerance.map_or(steps, Division::Tolerance)
    }

    /// Wall time of a step in s.
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
    /// Largest relative deviation of the momenta over all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub momentum: Option<f64>,
    /// Largest |φ(x)| over all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub defect: Option<f64>,
    /// Why the run ended early.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

impl Drift {
    /// The largest deviation of the energy in the last quarter over that in the first: 1 where the
    /// energy does not drift.
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
    /// What was measured, or why it was not.
    pub note: String,
    /// How to have it in the report.
    pub start: String,
}

/// A number to three significant digits, as results are kept; `None` where it is not finite.
pub fn round_to_three_digits(value: f64) -> Option<f64> {
    value
        .is_finite()
        .then(|| format!("{value:.2e}").parse().unwrap_or(value))
}
