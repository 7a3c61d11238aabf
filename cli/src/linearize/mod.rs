//! `hamel linearize`: linearises the motion at a state, with eigenvalues.

use crate::columns::aligned;
use crate::failure::{Failure, print};
use crate::json::Json;
use crate::robot::RobotOptions;
use crate::source;
use clap::{Args, ValueEnum};
use hamel_engine::State;
use hamel_engine::linearize::{Linearization, linearize};
use hamel_files::number::short;
use std::path::PathBuf;

/// Largest acceleration that counts as a rounding error of zero.
const REST_TOLERANCE: f64 = 1e-9;

/// Prints the linearisation at a state: matrices A and B, and the eigenvalues of A.
///
/// The state (h, δξ) has no redundant directions: h are displacements along the columns of A(x),
/// δx = A(x) h, one for each velocity coordinate, and δξ the changes of the velocities. Then
/// d/dt (h, δξ) = A (h, δξ) + B δu, and δy = C (h, δξ) + D δu for all outputs. If the system is
/// neither at rest nor in steady motion, the matrices hold only at that instant.
///
/// Under loops and other constraints the matrices refer to the independent displacements and velocities: those that the
/// description names as `independent`, and then those with the best-conditioned equations at the state.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel linearize heavy_top.eom
  hamel linearize heavy_top.eom --at state.json
  hamel linearize heavy_top.eom --format json")]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// State, by coordinates or by joints; see `hamel eval --help`.
    #[arg(long, value_name = "STATE.json")]
    at: Option<PathBuf>,
    /// Include all displacements and velocities, even those that constraints determine.
    #[arg(long)]
    full: bool,
    /// Output format of the matrices.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    #[command(flatten)]
    robot: RobotOptions,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Text,
    Json,
}

/// Real or imaginary parts below this, relative to the largest entry of A, are shown as zero.
const PART_TOLERANCE: f64 = 1e-14;

/// Eigenvalues below this, relative to the largest entry of A, are zero to rounding: a rounding error ε moves a double
/// zero of the characteristic polynomial by √ε.
const EIGENVALUE_TOLERANCE: f64 = 1e-7;

/// Linearises and prints the result.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let source = source::open(&arguments.file, &arguments.robot)?.for_evaluation();
    let generated = source.derive_linearized()?;
    let state = State::read(&source, &generated, arguments.at.as_deref())?;
    let linear = linearize(&generated, &state, source.shown(), arguments.full)?;
    print(&match arguments.format {
        Format::Text => text(&linear),
        Format::Json => json(&linear).pretty(),
    })?;
    complete(&linear)
}

/// Fails if eigenvalues are missing, after A and B have been printed.
fn complete(linear: &Linearization) -> Result<(), Failure> {
    match linear.eigenvalues {
        Some(_) => Ok(()),
        None => Err(Failure::failed(
            "the eigenvalues were not found: the QR algorithm does not converge for this A",
        )),
    }
}

fn text(linear: &Linearization) -> String {
    let mut text = format!(
        "\x1b[1m{}\x1b[0m  d/dt (h, d) = A (h, d) + B du; displacements h along the columns of A(x), changes d of velocities{}\n",
        linear.system,
        if linear.with_states {
            " and states"
        } else {
            ""
        }
    );
    if linear.given > 0 {
        text.push_str(&format!(
            "{} further ones follow from these by constraints; `--full` prints all\n",
            linear.given
        ));
    }
    let (states, inputs, outputs) = (&linear.states, &linear.inputs, &linear.outputs);
    text.push_str(&matrix("A", states, states, &linear.a));
    if !inputs.is_empty() {
        text.push_str(&matrix("B", states, inputs, &linear.b));
    }
    if !outputs.is_empty() {
        text.push_str(&matrix("C", outputs, states, &linear.c));
        if !inputs.is_empty() {
            text.push_str(&matrix("D", outputs, inputs, &linear.d));
        }
    }
    text.push_str("\n\x1b[1meigenvalues of A\x1b[0m\n");
    let size = linear
        .a
        .iter()
        .flatten()
        .fold(0.0, |a: f64, b| a.max(b.abs()));
    let clean = |value: f64| {
        if value.abs() < PART_TOLERANCE * size {
            0.0
        } else {
            value
        }
    };
    if linear.eigenvalues.is_none() {
        text.push_str("  not found\n");
    }
    let values = linear.eigenvalues.iter().flatten();
    let (zeros, others): (Vec<_>, Vec<_>) =
        values.partition(|(re, im)| re.hypot(*im) <= EIGENVALUE_TOLERANCE * size);
    let mut zeros = zeroes(&zeros, PART_TOLERANCE * size);
    for &&(re, im) in &others {
        let re = clean(re);
        // Zeros stand at their place in the order.
        if re < 0.0 {
            text.push_str(&std::mem::take(&mut zeros));
        }
        // A pair of conjugates on one line.
        if im > 0.0 {
            text.push_str(&format!("  {} ± {} i\n", short(re), short(im)));
        } else if im == 0.0 {
            text.push_str(&format!("  {}\n", short(re)));
        }
    }
    text.push_str(&zeros);
    let largest = linear.xi_dot.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    if largest > REST_TOLERANCE {
        text.push_str(&format!(
            "\nthe velocities change here, max |xi_dot| = {}: the matrices hold for this instant\n",
            short(largest)
        ));
    }
    text
}

/// Returns all zero eigenvalues on one line, with the largest deviation that rounding left; empty if there are none.
fn zeroes(zeros: &[&(f64, f64)], rounding: f64) -> String {
    let off = zeros.iter().map(|(re, im)| re.hypot(*im));
    let off = off.fold(0.0, f64::max);
    let by = match off > rounding {
        true => format!(", up to {off:.0e} of rounding"),
        false => String::new(),
    };
    match zeros.len() {
        0 => String::new(),
        1 => format!("  0{by}\n"),
        count => format!("  0, {count} times{by}\n"),
    }
}

/// Returns a matrix with its name; a zero matrix takes one line.
fn matrix(name: &str, rows: &[String], columns: &[String], values: &[Vec<f64>]) -> String {
    if values.iter().flatten().all(|&value| value == 0.0) {
        return format!("\n\x1b[1m{name}\x1b[0m = 0\n");
    }
    format!("\n\x1b[1m{name}\x1b[0m\n{}", table(rows, columns, values))
}

/// Numbers below the names of their columns, after the names of their rows.
fn table(rows: &[String], columns: &[String], values: &[Vec<f64>]) -> String {
    let heading = std::iter::once(String::new()).chain(columns.iter().cloned());
    let mut lines: Vec<Vec<String>> = vec![heading.collect()];
    for (name, row) in rows.iter().zip(values) {
        let numbers = row.iter().map(|&value| short(value));
        lines.push(std::iter::once(name.clone()).chain(numbers).collect());
    }
    aligned(&lines, "  ")
}

fn json(linear: &Linearization) -> Json {
    let pair = |&(re, im): &(f64, f64)| Json::vector(&[re, im]);
    Json::object([
        ("system", Json::Text(linear.system.clone())),
        ("states", Json::texts(&linear.states)),
        ("inputs", Json::texts(&linear.inputs)),
        ("A", Json::matrix(&linear.a)),
        ("B", Json::matrix(&linear.b)),
        ("outputs", Json::texts(&linear.outputs)),
        ("C", Json::matrix(&linear.c)),
        ("D", Json::matrix(&linear.d)),
        (
            "eigenvalues",
            match &linear.eigenvalues {
                Some(values) => Json::List(values.iter().map(pair).collect()),
                None => Json::Null,
            },
        ),
        ("xi_dot", Json::vector(&linear.xi_dot)),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without eigenvalues, both formats print the rest of the result, and the command fails with the reason.
    #[test]
    fn matrices_stand_without_their_eigenvalues() {
        let mut linear = Linearization {
            with_states: false,
            system: "Stalled".into(),
            states: vec!["h(v)".into(), "d(v)".into()],
            inputs: vec!["u".into()],
            a: vec![vec![0.0, 1.0], vec![-2.5, 0.0]],
            b: vec![vec![0.0], vec![0.75]],
            outputs: Vec::new(),
            c: Vec::new(),
            d: Vec::new(),
            given: 0,
            eigenvalues: None,
            xi_dot: vec![3.0],
        };
        let text = text(&linear);
        for part in ["-2.5", "0.75", "not found", "the velocities change here"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let json = json(&linear).pretty();
        for part in ["-2.5", "0.75", "\"eigenvalues\": null"] {
            assert!(json.contains(part), "{part}: {json}");
        }
        match complete(&linear) {
            Err(Failure::Failed(message)) => assert!(message.contains("QR algorithm")),
            other => panic!("{other:?}"),
        }
        linear.eigenvalues = Some(Vec::new());
        assert!(complete(&linear).is_ok());
    }
}
