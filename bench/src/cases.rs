//! The hard cases: systems, starts and errors, one line each in [`ALL`].

mod bodies;
mod rolling;
mod tops;

use crate::peers::Peers;
use crate::runner::{BenchError, Effort, Runner};
use hamel_report::data::{Case, Drift};
use hamel_report::solution::Solution;
use std::path::Path;

/// A case: its name, which is that of the reference, the length of the run, and what runs it.
pub struct Job {
    /// Name of the reference solution.
    pub name: &'static str,
    /// Length of the run.
    pub until: f64,
    /// Whether it has a picture of its own beside the report.
    pub picture: bool,
    run: fn(&mut Runner) -> Result<(), BenchError>,
}

const fn job(
    name: &'static str,
    until: f64,
    run: fn(&mut Runner) -> Result<(), BenchError>,
) -> Job {
    Job {
        name,
        until,
        picture: false,
        run,
    }
}

const fn shown(
    name: &'static str,
    until: f64,
    run: fn(&mut Runner) -> Result<(), BenchError>,
) -> Job {
    Job {
        picture: true,
        ..job(name, until, run)
    }
}

/// All cases, in the order of the report.
pub const ALL: [Job; 18] = [
    shown("heavy-top-benchmark-150", 1.0, tops::benchmark),
    shown("kovalevskaya-top", 20.0, tops::kovalevskaya),
    shown("lagrange-fast-top", 5.0, tops::lagrange),
    job("lagrange-sleeping-top-stable", 20.0, tops::lagrange),
    job("lagrange-top-through-vertical", 10.0, tops::lagrange),
    job("spherical-pendulum-through-poles", 10.0, tops::pendulum),
    shown("free-dzhanibekov-1e-3", 100.0, bodies::free),
    job("free-dzhanibekov-1e-8", 300.0, bodies::free),
    job("free-elongated-1000", 5.0, bodies::free),
    job("free-fast-spin-1000", 0.5, bodies::free),
    job("free-near-symmetric", 100.0, bodies::free),
    job("free-body-offset-gravity", 10.0, bodies::six),
    job("quadrotor-constant-wrench", 10.0, bodies::six),
    job("satellite-gravity-gradient", 20000.0, bodies::satellite),
    shown("two-bodies-ball-joints", 5.0, bodies::two),
    job(
        "double-pendulum-planar-chaotic",
        10.0,
        bodies::double_pendulum,
    ),
    job("chaplygin-sleigh", 20.0, rolling::sleigh),
    shown("rolling-disk", 5.0, rolling::disk),
];

/// The error of cases whose state is an attitude and its rate.
pub const ATTITUDE: &str = "‖R − R*‖, Frobenius";
/// The error of all others.
pub const RELATIVE: &str =
    "largest difference of the state, each field over max(1, its largest entry)";

impl Job {
    /// Runs the case with the reference of a folder.
    ///
    /// # Errors
    /// Where the reference is missing or not what the case takes it for.
    pub fn run(
        &self,
        references: &Path,
        effort: Effort,
        peers: &Peers,
        tick: &dyn Fn(u64, u64),
    ) -> Result<(Case, Vec<Drift>), BenchError> {
        let path = references.join(format!("{}.json", self.name));
        let named = |error: String| BenchError(format!("{}: {error}", path.display()));
        let text = std::fs::read_to_string(&path).map_err(|error| named(error.to_string()))?;
        let solution = Solution::parse(&text).map_err(|error| named(error.to_string()))?;
        let case = Case {
            name: self.name.into(),
            title: solution.text("title").to_string(),
            until: self.until,
            reference: "a solution in 240-bit arithmetic".into(),
            ..Case::default()
        };
        let mut runner = Runner {
            solution: &solution,
            effort,
            peers,
            tick,
            case,
            drifts: Vec::new(),
        };
        (self.run)(&mut runner).map_err(|error| named(error.to_string()))?;
        Ok((runner.case, runner.drifts))
    }
}
