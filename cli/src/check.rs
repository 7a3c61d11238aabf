//! `hamel check`: proves or refutes the identities behind a description's equations.

use crate::failure::{Failure, print};
use crate::robot::RobotOptions;
use crate::source;
use clap::Args;
use hamel_codegen::derive::geometry::Inspection;
use hamel_codegen::derive::numerical_loss::{DOCUMENTED_LOSS, LOSS_ADVICE, losses};
use hamel_codegen::derive::structure::choice::choose_method;
use hamel_codegen::functions::FunctionId;
use hamel_codegen::generate::Generated;
use hamel_codegen::proof::check::{Identity, Verdict, check};
use hamel_codegen::proof::confidence::Confidence;
use hamel_codegen::tables::geometry::lines;
use hamel_engine::state::constraint_lines;
use std::path::PathBuf;

/// Functions that lose fewer decimal digits than this are not listed.
const LISTED_FROM_DIGITS: f64 = 1.0;

/// Proves the identities behind the equations of motion.
///
/// Equation numbers are those of KR18, the paper of the method. "proved" is exact, over the rationals and modulo the
/// constraint; "checked" is equality at random points of the configuration manifold in exact arithmetic modulo two
/// primes, with a bound on the probability that a false equation passes.
///
/// Then come geometric properties: which velocities are integrable and the coordinates whose rates they are, the Lie
/// algebra of the frame, the pattern of M, and symmetries. "rounding" is the number of decimal digits that a function
/// loses in f64, listed from one digit on: it is found by comparison with numbers of twice the length at the start and
/// at states close to it, relative to the largest entry of the result.
///
/// The last lines list the integrators that apply: whether the equations split into free motion and kicks, the
/// obstacles where they do not, and the method that `simulate --method auto` takes.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  hamel check heavy_top.eom\n  hamel check models/*.eom && echo sound"
)]
pub struct Arguments {
    /// Descriptions, or robots in URDF; `-` for standard input.
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Checks every file and reports all failures.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut worst: Option<Failure> = None;
    for (index, path) in arguments.files.iter().enumerate() {
        if arguments.files.len() > 1 {
            let gap = if index > 0 { "\n" } else { "" };
            print(&format!("{gap}\x1b[1m{}\x1b[0m\n", path.display()))?;
        }
        let checked = source::open(path, &arguments.robot).and_then(|source| {
            let generated = source.derive_available(&[])?;
            let identities = check(&generated.model, &generated.program);
            print(&table(&identities))?;
            print(&remarks(&generated, &source.text))?;
            let failed = identities
                .iter()
                .filter(|identity| matches!(identity.verdict, Verdict::Failed(_)))
                .count();
            match failed {
                0 => Ok(()),
                1 => Err(Failure::failed(format!(
                    "{}: an identity failed",
                    source.path
                ))),
                _ => Err(Failure::failed(format!(
                    "{}: {failed} identities failed",
                    source.path
                ))),
            }
        });
        match checked {
            Ok(()) => {}
            Err(Failure::Closed) => return Err(Failure::Closed),
            Err(failure) => {
                worst = Some(match worst {
                    Some(worst) => worst.and(failure),
                    None => failure,
                });
            }
        }
    }
    worst.map_or(Ok(()), Err)
}

/// An identity with its verdict as text.
#[derive(Clone, Debug)]
pub struct CheckedIdentity {
    /// Subject of the identity.
    pub label: &'static str,
    /// The identity.
    pub equation: String,
    /// `proved`, `checked` or `failed`.
    pub verdict: &'static str,
    /// Explanation of the verdict; empty if it is proved.
    pub explanation: String,
}

/// Returns the identities behind the equations, with their verdicts.
pub fn check_identities(generated: &Generated) -> Vec<CheckedIdentity> {
    let identities = check(&generated.model, &generated.program).into_iter();
    identities
        .map(|identity| {
            let (verdict, explanation) = match identity.verdict {
                Verdict::Proved => ("proved", String::new()),
                Verdict::Checked(confidence) => ("checked", confidence.to_string()),
                Verdict::Failed(why) => ("failed", why),
            };
            CheckedIdentity {
                label: identity.label,
                equation: identity.equation,
                verdict,
                explanation,
            }
        })
        .collect()
}

/// Returns the text below the identities: rounding, merging, constraints, geometry, methods.
pub fn remarks(generated: &Generated, text: &str) -> String {
    [
        dimensions_report(generated),
        rounding_report(generated),
        merging_report(generated),
        constraints_report(generated, text),
        geometry(generated),
        methods(generated),
    ]
    .concat()
}

/// Says how many names have a dimension, if the description has units.
fn dimensions_report(generated: &Generated) -> String {
    let Some(dimensions) = &generated.model.dimensions else {
        return String::new();
    };
    let (declared, inferred) = (dimensions.declared, dimensions.inferred);
    let open: Vec<String> = dimensions
        .open
        .iter()
        .map(|name| format!("`{name}`"))
        .collect();
    let open = match open.is_empty() {
        true => String::new(),
        false => format!("; not known of {}", open.join(", ")),
    };
    format!("  dimensions     consistent: {declared} declared, {inferred} inferred{open}\n")
}

fn table(identities: &[Identity]) -> String {
    let width = |column: fn(&Identity) -> &str| {
        identities
            .iter()
            .map(|identity| column(identity).chars().count())
            .max()
            .unwrap_or(0)
    };
    let (label, equation) = (
        width(|identity| identity.label),
        width(|identity| &identity.equation),
    );
    identities
        .iter()
        .map(|identity| {
            let verdict = match &identity.verdict {
                Verdict::Proved => "\x1b[32mproved\x1b[0m".to_string(),
                Verdict::Checked(confidence) => format!("\x1b[36m{confidence}\x1b[0m"),
                Verdict::Failed(why) => format!("\x1b[1;31mFAILED\x1b[0m: {why}"),
            };
            format!(
                "  {:label$}  {:equation$}  {verdict}\n",
                identity.label, identity.equation
            )
        })
        .collect()
}

/// Reports the digits, of the sixteen of `f64`, that each function loses to rounding; functions that lose none share a
/// line.
fn rounding_report(generated: &Generated) -> String {
    let functions = &generated.program.functions;
    let losses = losses(&generated.active, &generated.program);
    let known: Vec<_> = functions.iter().zip(losses).collect();
    let known = known
        .iter()
        .filter_map(|&(function, digits)| Some((function, digits?)));
    let (lossy, exact): (Vec<_>, Vec<_>) =
        known.partition(|(_, digits)| *digits >= LISTED_FROM_DIGITS);
    let rest = match (exact.len(), lossy.len()) {
        (0, _) => String::new(),
        (_, 0) => "  rounding       no function loses a digit\n".to_string(),
        (1, _) => "  rounding       the other function loses less than a digit\n".to_string(),
        (count, _) => {
            format!("  rounding       the other {count} functions lose less than a digit\n")
        }
    };
    let width = lossy.iter().map(|(f, _)| f.name.len()).max().unwrap_or(0);
    let lines = lossy.iter().map(|(function, digits)| {
        let digits = *digits;
        let help = if digits >= DOCUMENTED_LOSS {
            format!(". {LOSS_ADVICE}")
        } else {
            String::new()
        };
        let name = &function.name;
        format!("  rounding       {name:width$}  loses {digits:.1} digits{help}\n")
    });
    lines.collect::<String>() + &rest
}

/// Reports the confidence that merged expressions are equal.
fn merging_report(generated: &Generated) -> String {
    let graph = &generated.program.graph;
    let confidence = Confidence::of_merging(&generated.model, graph);
    let count = graph.len();
    format!("  merging   {count} expressions compared by their values: {confidence}\n")
}

/// Lists the velocities that constraints leave, and the constraints that determine the others.
fn constraints_report(generated: &Generated, text: &str) -> String {
    let lines = constraint_lines(generated, text);
    lines.iter().map(|line| format!("  {line}\n")).collect()
}

/// Integrable velocities, the Lie algebra of the frame, the pattern of M, symmetries.
fn geometry(generated: &Generated) -> String {
    let lines = match Inspection::new(&generated.model) {
        Some(inspection) => lines(&inspection),
        None => Vec::new(),
    };
    lines
        .iter()
        .map(|line| format!("  {}\n", line.trim_end()))
        .collect()
}

/// Lists the requirements of the integration methods and the one that fits; empty for a system without inertia.
fn methods(generated: &Generated) -> String {
    if !generated.model.has_inertia {
        return String::new();
    }
    let structure = &generated.program.structure;
    let mut lines = structure.lines();
    if generated.program.function(FunctionId::Accel).is_some() {
        lines.push(format!("method {}", choose_method(structure, None)));
    }
    lines.iter().map(|line| format!("  {line}\n")).collect()
}
