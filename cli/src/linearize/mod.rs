//! `hamel linearize`: linearises the motion at a state, with eigenvalues.

mod formats;

use crate::columns::aligned;
use crate::failure::{Failure, print};
use crate::json::Json;
use crate::linear::{LinearArguments, pairs, rows, unsteady};
use clap::{Args, ValueEnum};
use hamel_engine::linear::{LinearSystem, Mode, pair};
use hamel_engine::linearize::Linearization;
use hamel_files::number::short;
use nalgebra::Complex;

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
  hamel linearize heavy_top.eom --format json
  hamel linearize cart_pole.eom --at upright.json --modes
  hamel linearize cart_pole.eom --at upright.json --step 0.01 --format python")]
pub struct Arguments {
    #[command(flatten)]
    linear: LinearArguments,
    /// Include all displacements and velocities, even those that constraints determine.
    #[arg(long)]
    full: bool,
    /// List the modes in place of the eigenvalues: their states, damping, and whether inputs reach them and outputs
    /// show them; then the zeros.
    #[arg(long)]
    modes: bool,
    /// Output format; `csv` is [A B; C D] with names, `matlab` and `python` are programs that make an `ss` with names,
    /// for MATLAB's Control System Toolbox or Octave, and for python-control.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Text,
    Json,
    Csv,
    Matlab,
    Python,
}

/// Real or imaginary parts below this, relative to the largest entry of A, are shown as zero.
const PART_TOLERANCE: f64 = 1e-14;

/// Eigenvalues below this, relative to the largest entry of A, are zero to rounding: a rounding error ε moves a double
/// zero of the characteristic polynomial by √ε.
const EIGENVALUE_TOLERANCE: f64 = 1e-7;

/// Modes and zeros.
struct Modes {
    modes: Vec<Mode>,
    zeros: Vec<Complex<f64>>,
}

/// Linearises and prints the result.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.modes && !matches!(arguments.format, Format::Text | Format::Json) {
        return Err(Failure::usage(
            "--modes: modes are written as text or JSON; leave out --format, or write --format json",
        ));
    }
    let (mut linear, system) = arguments.linear.open(arguments.full)?;
    if system.step.is_some() {
        (linear.a, linear.b) = (rows(&system.matrices.a), rows(&system.matrices.b));
        let poles = system.poles().ok();
        linear.eigenvalues =
            poles.map(|poles| poles.iter().map(|pole| (pole.re, pole.im)).collect());
    }
    let modes = arguments
        .modes
        .then(|| -> Result<Modes, hamel_engine::LinearError> {
            Ok(Modes {
                modes: system.modes()?,
                zeros: system.zeros()?,
            })
        });
    let modes = modes.transpose().map_err(hamel_engine::Error::from)?;
    print(&match arguments.format {
        Format::Text => text(&linear, &system, modes.as_ref()),
        Format::Json => json(&linear, system.step, modes.as_ref()).pretty(),
        Format::Csv => formats::csv(&system),
        Format::Matlab => formats::matlab(&linear.system, &system),
        Format::Python => formats::python(&linear.system, &system),
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

fn text(linear: &Linearization, system: &LinearSystem, modes: Option<&Modes>) -> String {
    let rate = match system.step {
        Some(h) => format!("(h, d) after {} s =", short(h)),
        None => "d/dt (h, d) =".into(),
    };
    let mut text = format!(
        "\x1b[1m{}\x1b[0m  {rate} A (h, d) + B du; displacements h along the columns of A(x), changes d of velocities{}\n",
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
    let size = system.matrices.a.amax();
    if let Some(Modes { modes, zeros }) = modes {
        text.push_str(&format!(
            "\n\x1b[1mmodes\x1b[0m\n{}",
            modes_table(modes, system)
        ));
        let zeros = if zeros.is_empty() {
            "  none\n".into()
        } else {
            spectrum(zeros, size)
        };
        text.push_str(&format!("\n\x1b[1mzeros\x1b[0m\n{zeros}"));
    } else {
        text.push_str("\n\x1b[1meigenvalues of A\x1b[0m\n");
        match &linear.eigenvalues {
            Some(values) => {
                let values: Vec<Complex<f64>> = values
                    .iter()
                    .map(|&(re, im)| Complex::new(re, im))
                    .collect();
                text.push_str(&spectrum(&values, size));
            }
            None => text.push_str("  not found\n"),
        }
    }
    text + &unsteady(linear)
}

/// Modes with their natural frequencies, damping ratios and states, one on each line.
fn modes_table(modes: &[Mode], system: &LinearSystem) -> String {
    let mut lines = vec![
        ["eigenvalue", "rad/s", "damping"]
            .map(String::from)
            .to_vec(),
    ];
    let mut remarks = vec!["states".to_string()];
    for equal in modes.chunk_by(|a, b| a == b) {
        let mode = &equal[0];
        // ln z / h of a mode in steps.
        let rate = match system.step {
            Some(h) => {
                Complex::new(
                    mode.value.re.hypot(mode.value.im).ln(),
                    mode.value.im.atan2(mode.value.re),
                ) / h
            }
            None => mode.value,
        };
        let size = rate.re.hypot(rate.im);
        let damping = if size > 0.0 {
            short(-rate.re / size)
        } else {
            "-".into()
        };
        let value = match equal.len() {
            1 => pair(mode.value),
            count => format!("{}, {count} times", pair(mode.value)),
        };
        lines.push(vec![value, short(size), damping]);
        let mut remark = mode.states.join(", ");
        if !mode.reachable && !system.inputs.is_empty() {
            remark += "; not reached by inputs";
        }
        if !mode.observable && !system.outputs.is_empty() {
            remark += "; not shown by outputs";
        }
        remarks.push(remark);
    }
    let lines = aligned(&lines, "  ");
    lines
        .lines()
        .zip(remarks)
        .map(|(line, remark)| format!("{line}  {remark}\n"))
        .collect()
}

/// Eigenvalues, one or a pair on each line; `size` is the largest entry of the matrix.
pub fn spectrum(values: &[Complex<f64>], size: f64) -> String {
    let mut text = String::new();
    let clean = |value: f64| {
        if value.abs() < PART_TOLERANCE * size {
            0.0
        } else {
            value
        }
    };
    let values = values.iter().map(|value| (value.re, value.im));
    let (zeros, others): (Vec<_>, Vec<_>) =
        values.partition(|(re, im)| re.hypot(*im) <= EIGENVALUE_TOLERANCE * size);
    let mut zeros = zeroes(&zeros, PART_TOLERANCE * size);
    for (re, im) in others {
        let re = clean(re);
        // Zeros stand at their place in the order.
        if re < 0.0 {
            text.push_str(&std::mem::take(&mut zeros));
        }
        // A pair of conjugates on one line.
        if im > 0.0 {
            text.push_str(&format!("  {}\n", pair(Complex::new(re, im))));
        } else if im == 0.0 {
            text.push_str(&format!("  {}\n", short(re)));
        }
    }
    text + &zeros
}

/// Returns all zero eigenvalues on one line, with the largest deviation that rounding left; empty if there are none.
fn zeroes(zeros: &[(f64, f64)], rounding: f64) -> String {
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
pub fn matrix(name: &str, rows: &[String], columns: &[String], values: &[Vec<f64>]) -> String {
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

fn json(linear: &Linearization, step: Option<f64>, modes: Option<&Modes>) -> Json {
    let complex = |values: &[(f64, f64)]| {
        Json::List(
            values
                .iter()
                .map(|&(re, im)| Json::vector(&[re, im]))
                .collect(),
        )
    };
    let mut members = vec![
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
            linear.eigenvalues.as_deref().map_or(Json::Null, complex),
        ),
        ("xi_dot", Json::vector(&linear.xi_dot)),
    ];
    members.extend(step.map(|step| ("step", Json::Number(step))));
    if let Some(Modes { modes, zeros }) = modes {
        let list = modes.iter().map(|mode| {
            Json::object([
                ("value", Json::vector(&[mode.value.re, mode.value.im])),
                ("states", Json::texts(&mode.states)),
                ("reachable", Json::Bool(mode.reachable)),
                ("observable", Json::Bool(mode.observable)),
            ])
        });
        members.extend([
            ("modes", Json::List(list.collect())),
            ("zeros", pairs(zeros)),
        ]);
    }
    Json::object(members)
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
        let text = text(&linear, &LinearSystem::from(&linear), None);
        for part in ["-2.5", "0.75", "not found", "the velocities change here"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let json = json(&linear, None, None).pretty();
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
