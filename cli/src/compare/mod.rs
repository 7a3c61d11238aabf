//! `hamel compare`: compares methods by speed and error.

mod reference;
#[cfg(feature = "command")]
mod write;

use crate::failure::{Failure, print};
use crate::parse::{Expected, positive};
#[cfg(feature = "command")]
use crate::progress;
use crate::robot::RobotOptions;
use crate::source;
use clap::{Args, ValueEnum};
use hamel::Method;
use hamel::adaptive::Adaptive;
use hamel::methods::General;
use hamel_codegen::derive::structure::choice::choose_method;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::structure::Structure;
use hamel_engine::State;
use hamel_engine::mechanism::{Instance, Numbers};
use hamel_engine::method::{self, MethodCategory, NamedMethod, Stepper, UnsuitableMethod};
use hamel_report::auto;
use hamel_report::data::{Case, Choice, Kind, Machine, Missing, Report};
use hamel_report::entry::Entry;
use hamel_report::measure::{Plan, measure};
use hamel_report::problem::Problem;
use hamel_report::solution::{Solution, relative};
use reference::Fields;
use std::path::{Path, PathBuf};

/// Length of a run without --until and --reference.
const DEFAULT_DURATION: f64 = 10.0;
/// Default of --steps.
const DEFAULT_STEPS: [u64; 6] = [100, 200, 400, 800, 1600, 3200];
/// Largest number of steps.
const MAX_STEPS: u64 = 100_000_000;
/// Tolerances of methods with step size control.
const TOLERANCES: [f64; 8] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11];
/// Timings of each run, and the least duration of each (s).
const TIMING_REPEATS: u32 = 3;
const MIN_TIMING: f64 = 1e-3;
/// Errors below this are taken for rounding.
const ERROR_FLOOR: f64 = 1e-13;
/// Ratio of the steps of the reference run to those of the finest run.
const REFERENCE_REFINEMENT: u64 = 4;

/// Compares methods: error at the end, evaluations of forces, drift, time.
///
/// Errors are measured against a reference solution, or against a much finer run of the best method.
/// Functions are compiled, steps are not: compare times with each other only. T + V is constant without inputs,
/// dissipation and other loads that do work; `momentum` is the drift of the invariants that the description claims.
/// rkmk54 and rkmk8 run with equal steps, and with tolerances of 1e-4 to 1e-11.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel compare heavy_top.eom --until 5
  hamel compare heavy_top.eom --methods rkmk4,rk4 --steps 500,1000,2000 -o comparison
  hamel compare kovalevskaya.eom --reference kovalevskaya-top.json --until 20 --format json

A reference solution is JSON: {\"initial\": {\"R\": [[…]], \"omega\": […]}, \"samples\": [{\"t\": 1, \"R\": …}, …]}.
Fields are matched with coordinates and velocities by name (omega also with w); the start of those is
taken from it, everything else from the description or --at.")]
pub struct Arguments {
    /// Descriptions, or robots in URDF.
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Methods, see `hamel simulate --help`; default: all that fit.
    #[arg(long, value_name = "M", value_delimiter = ',')]
    methods: Vec<String>,
    /// Length of the run; default: the last time of the reference, or 10.
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true)]
    until: Option<f64>,
    /// Numbers of steps.
    #[arg(long, value_name = "N", value_delimiter = ',', value_parser = number_of_steps, allow_negative_numbers = true)]
    steps: Vec<u64>,
    /// Reference solution.
    #[arg(long, value_name = "SOLUTION.json")]
    reference: Option<PathBuf>,
    /// Start, by coordinates with parameters and inputs, or by joints; see `hamel eval --help`.
    #[arg(long, value_name = "STATE.json")]
    at: Option<PathBuf>,
    /// Write report.json, report.md, index.html and a picture for each description.
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Output format.
    #[arg(long, value_enum, default_value = "markdown")]
    format: Format,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Output format.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
enum Format {
    /// Tables
    Markdown,
    /// One object
    Json,
}

/// Runs the comparisons and prints the report.
#[cfg(feature = "command")]
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    method::check_names(&arguments.methods)?;
    let solution = arguments.reference.as_deref().map(read).transpose()?;
    let mut report = Report {
        title: "Speed against error".into(),
        command: command(arguments),
        machine: Machine {
            processor: "the machine of the command".into(),
            system: format!("{}, {}", std::env::consts::OS, std::env::consts::ARCH),
            code: match cfg!(feature = "machine") {
                true => "compiled to machine code at once".into(),
                false => "interpreted".into(),
            },
            repeats: TIMING_REPEATS,
        },
        ..Report::default()
    };
    for file in &arguments.files {
        let case = compare(file, arguments, solution.as_ref())?;
        if case.methods.is_empty() {
            let missing = case.missing.iter();
            let why: String = missing
                .map(|missing| format!("\n  {}: {}", missing.method, missing.why))
                .collect();
            return Err(Failure::failed(format!(
                "{}: none of the requested methods fits, so there is nothing to compare{why}",
                file.display()
            )));
        }
        let taken = report
            .cases
            .iter()
            .filter(|other| other.title == case.title)
            .count();
        let name = match taken {
            0 => case.name.clone(),
            more => format!("{}-{}", case.name, more + 1),
        };
        report.cases.push(Case { name, ..case });
    }
    if let Some(folder) = &arguments.out {
        write::files(&report, folder)?;
    }
    print(&match arguments.format {
        Format::Markdown => write::markdown(&report, arguments.out.is_some()),
        Format::Json => write::json(&report)?,
    })
}

/// A comparison to make.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Names of methods; empty for all that fit.
    pub methods: Vec<String>,
    /// Length of the run.
    pub until: f64,
    /// Numbers of steps; empty for the default ones.
    pub steps: Vec<u64>,
    /// Number of timings of each run; 0 for none.
    pub repeats: u32,
}

/// Compares the methods on one description.
#[cfg(feature = "command")]
fn compare(
    file: &Path,
    arguments: &Arguments,
    solution: Option<&Solution>,
) -> Result<Case, Failure> {
    let source = source::open(file, &arguments.robot)?.for_evaluation();
    let generated = source.derive_default_functions()?;
    let mut state = State::read(&source, &generated, arguments.at.as_deref())?;
    let fields = solution
        .map(|solution| Fields::of(solution, &generated.program))
        .transpose()?;
    let until = until(arguments, solution)?;
    if let Some(fields) = &fields {
        fields.start(&mut state)?;
    }
    let asked = Comparison {
        methods: arguments.methods.clone(),
        until,
        steps: arguments.steps.clone(),
        repeats: TIMING_REPEATS,
    };
    let bar = progress::named(&generated.program.name);
    let mut show = |done, all| {
        bar.set_length(all);
        bar.set_position(done);
    };
    let case = case(
        &generated,
        source.shown(),
        &state,
        &asked,
        fields.as_ref(),
        &mut show,
    );
    bar.finish_and_clear();
    case
}

/// Compares the methods on a derived description, from a state; `shown` is the text for messages.
pub fn case(
    generated: &Generated,
    shown: &str,
    state: &State,
    asked: &Comparison,
    fields: Option<&Fields>,
    show: &mut dyn FnMut(u64, u64),
) -> Result<Case, Failure> {
    let until = asked.until;
    let system = Instance::new(generated, state, shown)?;
    system.check_parameters(&state.x)?;
    let structure = &generated.program.structure;
    let (methods, missing) = method::suitable(&asked.methods, &system, structure);
    let inputs = |t: f64, x: &Numbers, xi: &Numbers| system.inputs(t, x, xi);
    let momenta = |x: &[f64], xi: &[f64]| -> Vec<f64> {
        let claims = system.invariants().iter();
        let values = claims.map(|claim| system.output(claim, 0.0, x, xi));
        values.flat_map(|value| value.to_vec()).collect()
    };
    let mut problem = Problem {
        system: &system,
        evaluations: Box::new(|| system.evaluations()),
        x: state.x.as_slice().into(),
        xi: state.xi.as_slice().into(),
        until,
        inputs,
        error: Box::new(|_, _| f64::NAN),
        momenta: Box::new(momenta),
        error_text: Box::new(|error| system.step_error(error).to_string()),
        conservative: true,
    };
    let mut steps = asked.steps.clone();
    if steps.is_empty() {
        steps.extend(DEFAULT_STEPS);
    }
    steps.sort_unstable();
    steps.dedup();
    let name = generated.program.name.clone();
    let mut case = Case {
        title: title(&name, &generated.program.docs),
        name: name.to_lowercase(),
        until,
        error: "largest difference of the state, each field over max(1, its largest entry)".into(),
        auto: Some(choice(structure)),
        missing: missing.into_iter().map(unfit).collect(),
        ..Case::default()
    };
    if methods.is_empty() {
        return Ok(case);
    }
    match fields {
        Some(fields) => {
            case.reference = format!("the solution given: {}", fields.names());
            let end = fields.end(until)?;
            problem.error = Box::new(move |x, xi| end.error(x, xi));
        }
        None => {
            let finest = steps.last().copied().unwrap_or(1) * REFERENCE_REFINEMENT;
            let best = best(&methods);
            let failed = |error: hamel::StepError| {
                Failure::failed(format!(
                    "the reference run of {} with {finest} steps failed: {}",
                    best.name,
                    system.step_error(&error)
                ))
            };
            let (x, xi) = problem.end(&best.stepper, finest).map_err(failed)?;
            let (x2, xi2) = problem.end(&best.stepper, finest / 2).map_err(failed)?;
            // Two runs of a method of order p differ by 2ᵖ − 1 times the error of the finer one.
            let difference = relative(&x2, &x).max(relative(&xi2, &xi));
            let order = Method::<Instance>::order(&best.stepper);
            case.reference = format!("{} with {finest} steps", best.name);
            case.reference_error = hamel_report::data::round_to_three_digits(
                difference / (f64::from(order).exp2() - 1.0),
            );
            problem.error = Box::new(move |a, b| relative(a, &x).max(relative(b, &xi)));
        }
    }
    let mut entries: Vec<Entry> = Vec::new();
    for NamedMethod {
        name,
        role,
        stepper,
    } in &methods
    {
        entries.push(problem.by(name, kind(*role), stepper.clone()));
        let adaptive = format!("{name} adaptive");
        match stepper {
            Stepper::General(General::Rkmk54) => {
                entries.push(problem.controlled(&adaptive, 5, Adaptive::rkmk54));
            }
            Stepper::General(General::Rkmk8) => {
                entries.push(problem.controlled(&adaptive, 8, Adaptive::rkmk8));
            }
            _ => {}
        }
    }
    let plan = Plan {
        steps,
        tolerances: TOLERANCES.to_vec(),
        repeats: asked.repeats,
        least: MIN_TIMING,
        floor: ERROR_FLOOR,
    };
    measure(&mut case, &entries, &plan, show);
    Ok(case)
}

fn kind(role: MethodCategory) -> Kind {
    match role {
        MethodCategory::Method => Kind::Method,
        MethodCategory::Baseline => Kind::Baseline,
    }
}

fn unfit(method: UnsuitableMethod) -> Missing {
    Missing {
        method: method.name.into(),
        why: method.obstacles.join("; "),
    }
}

/// One case as JSON.
pub fn one(case: &Case) -> Result<String, Failure> {
    serde_json::to_string(case).map_err(|error| Failure::failed(error.to_string()))
}

/// Returns the method of the highest order, baselines last; the first in the table among equals.
fn best(methods: &[NamedMethod]) -> &NamedMethod {
    let rank = |named: &NamedMethod| {
        let order = Method::<Instance>::order(&named.stepper);
        (named.role == MethodCategory::Method, order)
    };
    let better = |best, named| {
        if rank(named) > rank(best) {
            named
        } else {
            best
        }
    };
    methods.iter().skip(1).fold(&methods[0], better)
}

/// Returns the choice of `--method auto`.
fn choice(structure: &Structure) -> Choice {
    let choice = choose_method(structure, None);
    Choice {
        method: auto::entry(choice.method),
        reason: choice.reason.into(),
    }
}

/// Returns the name of the system with the first line of its documentation.
fn title(name: &str, docs: &[String]) -> String {
    match docs.first() {
        Some(line) if !line.trim().is_empty() => format!("{name}: {}", line.trim()),
        _ => name.to_string(),
    }
}

/// Parses a number of steps.
fn number_of_steps(text: &str) -> Result<u64, Expected> {
    let number = text.trim().parse::<u64>().ok();
    let number = number.filter(|number| (1..=MAX_STEPS).contains(number));
    number.ok_or(Expected::Steps(MAX_STEPS))
}

/// Returns the end time, which a reference has to list.
fn until(arguments: &Arguments, solution: Option<&Solution>) -> Result<f64, Failure> {
    let Some(solution) = solution else {
        return Ok(arguments.until.unwrap_or(DEFAULT_DURATION));
    };
    let times = solution.times();
    let until = arguments
        .until
        .or(times.last().copied())
        .unwrap_or(DEFAULT_DURATION);
    if times.contains(&until) && until > 0.0 {
        return Ok(until);
    }
    let list: Vec<String> = times
        .iter()
        .map(|&t| hamel_files::number::short(t))
        .collect();
    Err(Failure::usage(format!(
        "the reference has no state at t = {until}; it has {}",
        list.join(", ")
    )))
}

fn read(path: &Path) -> Result<Solution, Failure> {
    let source = source::read(path)?;
    Solution::parse(&source.text)
        .map_err(|error| Failure::usage(format!("{}: {error}", source.path)))
}

/// Returns the given command line, with file names instead of paths.
fn command(arguments: &Arguments) -> String {
    let name = |path: Option<&Path>| -> String {
        let name = path.and_then(Path::file_name);
        name.map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    };
    let files: Vec<String> = arguments
        .files
        .iter()
        .map(|file| name(Some(file)))
        .collect();
    let mut text = format!("hamel compare {}", files.join(" "));
    let list = |values: &[u64]| {
        let values: Vec<String> = values.iter().map(u64::to_string).collect();
        values.join(",")
    };
    for (option, value) in [
        ("methods", arguments.methods.join(",")),
        ("steps", list(&arguments.steps)),
        (
            "until",
            arguments
                .until
                .map_or_else(String::new, hamel_files::number::short),
        ),
        ("reference", name(arguments.reference.as_deref())),
        ("at", name(arguments.at.as_deref())),
    ] {
        if !value.is_empty() {
            text.push_str(&format!(" --{option} {value}"));
        }
    }
    text
}
