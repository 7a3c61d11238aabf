//! The hard cases, one line each in [`ALL`]: the tables of methods that run them, and the constants of motion of each.

use crate::methods;
use crate::peers::{self, Peers};
use crate::runner::{BenchError, Effort, Runner};
use hamel::{Canonical, Energies, Split, State, System, so3};
use hamel_cases::case::Inputs;
use hamel_cases::models::CHOICES;
use hamel_cases::{Case, Measure, bodies, mechanisms};
use hamel_report::auto;
use hamel_report::counted_system::CountedSystem;
use hamel_report::data::{self, Choice, Drift};
use hamel_report::problem::{Problem, Quantities};
use hamel_report::solution::Solution;
use std::path::Path;

/// A case: its name, which is that of the reference, its model, and the function that runs it.
pub struct Job {
    /// Name of the reference solution.
    pub name: &'static str,
    /// Name of the description.
    pub model: &'static str,
    /// Whether the report has a separate picture of it.
    pub picture: bool,
    run: fn(&mut Runner) -> Result<(), BenchError>,
}

/// Lines `name model picture run`.
macro_rules! jobs {
    ($($name:literal $model:literal $picture:literal $run:expr;)*) => {
        &[$(Job { name: $name, model: $model, picture: $picture, run: $run }),*]
    };
}

/// Step lengths of long runs: 0.075 rad each on the benchmark and on Kovalevskaya's top, and 0.1 rad.
const BENCHMARK: Option<f64> = Some(5e-4);
const KOVALEVSKAYA: Option<f64> = Some(0.02);
const DZHANIBEKOV: Option<f64> = Some(0.1);

/// All cases, in the order of the report.
pub const ALL: &[Job] = jobs! {
    "heavy-top-benchmark-150" "benchmark_top" true |r| top(r, &bodies::benchmark_top(), BENCHMARK);
    "kovalevskaya-top" "kovalevskaya_top" true |r| top(r, &bodies::kovalevskaya(), KOVALEVSKAYA);
    "lagrange-fast-top" "lagrange_top" true |r| top(r, &bodies::fast_top(), None);
    "lagrange-sleeping-top-stable" "lagrange_top" false |r| top(r, &bodies::sleeping_top(), None);
    "lagrange-top-through-vertical" "lagrange_top" false |r| top(r, &bodies::vertical_top(), None);
    "spherical-pendulum-through-poles" "spherical_bob" false |r| flight(r, &bodies::spherical_pendulum(), true);
    "free-dzhanibekov-1e-3" "principal_axes" true |r| free(r, &bodies::dzhanibekov(), DZHANIBEKOV);
    "free-dzhanibekov-1e-8" "principal_axes" false |r| free(r, &bodies::dzhanibekov_near(), None);
    "free-elongated-1000" "principal_axes" false |r| free(r, &bodies::elongated(), None);
    "free-fast-spin-1000" "principal_axes" false |r| free(r, &bodies::fast_spin(), None);
    "free-near-symmetric" "principal_axes" false |r| free(r, &bodies::nearly_symmetric(), None);
    "free-body-offset-gravity" "free_body" false |r| flight(r, &bodies::offset_body(), true);
    "quadrotor-constant-wrench" "free_body" false |r| flight(r, &bodies::constant_wrench(), false);
    "satellite-gravity-gradient" "satellite" false |r| flight(r, &bodies::gravity_gradient(), false);
    "two-bodies-ball-joints" "two_bodies" true |r| chain(r, &mechanisms::two_bodies());
    "double-pendulum-planar-chaotic" "double_pendulum_angles" false |r| chain(r, &mechanisms::double_pendulum());
    "chaplygin-sleigh" "sleigh" false |r| rolling(r, &mechanisms::sleigh());
    "rolling-disk" "rolling_disk" true |r| rolling(r, &mechanisms::rolling_disk());
};

/// Makes a problem of a case, with its constants of motion in addition to the energy.
fn problem<'a, Sys: System<Scalar = f64>>(
    runner: &mut Runner,
    case: &'a Case<Sys>,
    system: &'a CountedSystem<'a, Sys>,
    momenta: Quantities<'a>,
    conservative: bool,
) -> Problem<'a, CountedSystem<'a, Sys>, &'a Inputs<Sys>> {
    runner.case.until = case.until;
    runner.case.error = match case.measure {
        Measure::Attitude => "‖R − R*‖, Frobenius",
        Measure::Largest => {
            "largest difference of the state, each field over max(1, its largest entry)"
        }
    }
    .into();
    let error = |x: &[f64], xi: &[f64]| {
        let mut state: State<Sys> = case.start.clone();
        state.x.as_mut().copy_from_slice(x);
        state.xi.as_mut().copy_from_slice(xi);
        case.error(&state)
    };
    Problem {
        system,
        evaluations: Box::new(|| system.evaluations()),
        x: case.start.x.clone(),
        xi: case.start.xi.clone(),
        until: case.until,
        inputs: &case.inputs,
        error: Box::new(error),
        momenta,
        error_text: Box::new(ToString::to_string),
        conservative,
    }
}

/// R J ω in world axes, for x = R, ξ = ω.
fn angular<'a, Sys: System<Scalar = f64>>(
    case: &Case<Sys>,
) -> impl Fn(&[f64], &[f64]) -> [f64; 3] + use<'a, Sys> {
    let inertia: [f64; 9] = case.reference.parameter("J");
    move |x, xi| match (x.first_chunk(), xi.first_chunk()) {
        (Some(r), Some(w)) => so3::apply(*r, so3::apply(inertia, *w)),
        _ => [f64::NAN; 3],
    }
}

/// Runs a top, whose vertical angular momentum is constant.
fn top<Sys>(runner: &mut Runner, case: &Case<Sys>, long: Option<f64>) -> Result<(), BenchError>
where
    Sys: Split<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3], Inputs = [f64; 0]>
        + Canonical
        + Energies,
{
    let momentum = angular(case);
    let vertical = Box::new(move |x: &[f64], xi: &[f64]| vec![momentum(x, xi)[2]]);
    let system = CountedSystem::new(&case.system);
    let problem = problem(runner, case, &system, vertical, true);
    let mut entries = methods::general(&problem);
    entries.extend(methods::split(&problem));
    entries.extend(methods::canonical(&problem));
    entries.extend(peers::tops(runner, &problem)?);
    runner.entries(&entries, long);
    Ok(())
}

/// Runs a free body, whose angular momentum is constant.
fn free<Sys>(runner: &mut Runner, case: &Case<Sys>, long: Option<f64>) -> Result<(), BenchError>
where
    Sys: Split<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3], Inputs = [f64; 0]>
        + Canonical
        + Energies,
{
    let momentum = angular(case);
    let all = Box::new(move |x: &[f64], xi: &[f64]| momentum(x, xi).to_vec());
    let system = CountedSystem::new(&case.system);
    let problem = problem(runner, case, &system, all, true);
    let mut entries = methods::general(&problem);
    entries.extend(methods::split(&problem));
    entries.extend(methods::canonical(&problem));
    entries.extend(peers::free(runner, &problem)?);
    runner.entries(&entries, long);
    Ok(())
}

/// Runs another body in a potential or under given loads.
fn flight<Sys>(runner: &mut Runner, case: &Case<Sys>, conservative: bool) -> Result<(), BenchError>
where
    Sys: Split<Scalar = f64> + Canonical + Energies,
{
    let system = CountedSystem::new(&case.system);
    let problem = problem(
        runner,
        case,
        &system,
        Box::new(|_, _| Vec::new()),
        conservative,
    );
    let mut entries = methods::general(&problem);
    entries.extend(methods::split(&problem));
    entries.extend(methods::canonical(&problem));
    runner.entries(&entries, None);
    Ok(())
}

/// Runs several bodies, whose M depends on x.
fn chain<Sys>(runner: &mut Runner, case: &Case<Sys>) -> Result<(), BenchError>
where
    Sys: Canonical<Scalar = f64> + Energies,
{
    let system = CountedSystem::new(&case.system);
    let problem = problem(runner, case, &system, Box::new(|_, _| Vec::new()), true);
    let mut entries = methods::general(&problem);
    entries.extend(methods::canonical(&problem));
    runner.entries(&entries, None);
    Ok(())
}

/// Runs bodies with constrained velocities.
fn rolling<Sys>(runner: &mut Runner, case: &Case<Sys>) -> Result<(), BenchError>
where
    Sys: Energies<Scalar = f64>,
{
    let system = CountedSystem::new(&case.system);
    let problem = problem(runner, case, &system, Box::new(|_, _| Vec::new()), true);
    runner.entries(&methods::general(&problem), None);
    Ok(())
}

impl Job {
    /// Runs the case.
    ///
    /// # Errors
    /// If the reference is missing or does not fit the case.
    pub fn run(
        &self,
        references: &Path,
        effort: Effort,
        peers: &Peers,
        tick: &dyn Fn(u64, u64),
    ) -> Result<(data::Case, Vec<Drift>), BenchError> {
        let path = references.join(format!("{}.json", self.name));
        let named = |error: String| BenchError(format!("{}: {error}", path.display()));
        let text = std::fs::read_to_string(&path).map_err(|error| named(error.to_string()))?;
        let solution = Solution::parse(&text).map_err(|error| named(error.to_string()))?;
        let choice = CHOICES.iter().find(|(model, ..)| *model == self.model);
        let case = data::Case {
            name: self.name.into(),
            title: solution.text("title").to_string(),
            reference: "a solution in 240-bit arithmetic".into(),
            auto: choice.map(|(_, method, reason)| Choice {
                method: auto::entry(method),
                reason: (*reason).into(),
            }),
            ..data::Case::default()
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
