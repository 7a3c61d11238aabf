//! `hamel linearize`: linearises the motion at a state, with eigenvalues.

mod minimal;

use crate::columns::aligned;
use crate::eigenvalues::eigenvalues;
use crate::failure::{Failure, print};
use crate::json::Json;
use crate::mechanism::{Instance, function};
use crate::names;
use crate::number::short;
use crate::robot::RobotOptions;
use crate::source::Source;
use crate::state::State;
use clap::{Args, ValueEnum};
use hamel_codegen::functions::SLOPES;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Shape;
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

/// Numbers of a linearisation.
#[derive(Clone, Debug)]
pub struct Linear {
    /// Name of the system.
    pub system: String,
    /// Names of h and δξ.
    pub states: Vec<String>,
    /// Names of u.
    pub inputs: Vec<String>,
    /// A, by rows.
    pub a: Vec<Vec<f64>>,
    /// B, by rows.
    pub b: Vec<Vec<f64>>,
    /// Names of the entries of y.
    pub outputs: Vec<String>,
    /// C, by rows.
    pub c: Vec<Vec<f64>>,
    /// D, by rows.
    pub d: Vec<Vec<f64>>,
    /// Number of displacements and velocities that constraints determine from these; 0 in the full form.
    pub given: usize,
    /// Real and imaginary parts, the fastest growing first; `None` if they were not found.
    pub eigenvalues: Option<Vec<(f64, f64)>>,
    /// Whether there are states of first order.
    pub with_states: bool,
    /// ξ̇ at the state.
    pub xi_dot: Vec<f64>,
}

/// Linearises and prints the result.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let source = Source::open(&arguments.file, &arguments.robot)?.in_numbers();
    let generated = source.derive_linearized()?;
    let state = State::read(&source, &generated, arguments.at.as_deref())?;
    let linear = linear(&generated, &state, source.shown(), arguments.full)?;
    print(&match arguments.format {
        Format::Text => text(&linear),
        Format::Json => json(&linear).pretty(),
    })?;
    complete(&linear)
}

/// The linearisation at a state, of all displacements and velocities if `full`; `shown` is the text whose line numbers
/// messages give.
///
/// # Errors
/// If the motion has no value at the state.
pub fn linear(
    generated: &Generated,
    state: &State,
    shown: &str,
    full: bool,
) -> Result<Linear, Failure> {
    let program = &generated.program;
    let State { params, x, xi, u } = state;
    let system = Instance::new(generated, state, shown)?;
    let none = |why: String| Failure::failed(format!("there is no linearisation: {why}"));
    let xi_dot = system.motion(x, xi, u).map_err(none)?;
    let flat = function(program, "linearize", params)?
        .call(x, xi, u, &[])
        .map_err(|_| none(system.state_message(x)))?;
    let inputs: Vec<String> = generated
        .model
        .inputs
        .iter()
        .flat_map(names::group)
        .collect();
    // Displacements along the full frame, and changes of the velocities that constraints leave.
    let mut frame = names::velocities(&generated.model);
    if let Some(clock) = generated.model.clock {
        // The time is not displaced.
        frame.remove(clock.xi);
    }
    let velocities = names::moving(&generated.active);
    let displacements = frame.iter().map(|name| format!("h({name})"));
    let changes = velocities.iter().map(|name| format!("d({name})"));
    let states: Vec<String> = displacements.chain(changes).collect();
    if let Some(entry) = flat.iter().position(|value| !value.is_finite()) {
        return Err(Failure::failed(format!(
            "the linearisation is not finite at this state: row {} has no value",
            entry / (states.len() + inputs.len()).max(1) + 1
        )));
    }
    let split = |flat: &[f64]| -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let rows = flat.chunks((states.len() + inputs.len()).max(1));
        let rows = rows.map(|row| row.split_at(states.len()));
        rows.map(|(left, right)| (left.to_vec(), right.to_vec()))
            .unzip()
    };
    let (a, b) = split(&flat);
    let (mut outputs, mut slopes) = (Vec::new(), Vec::new());
    for (name, _) in &generated.model.outputs {
        let Ok(function) = function(program, &format!("{name}{SLOPES}"), params) else {
            continue;
        };
        slopes.extend(
            function
                .call(x, xi, u, &[])
                .map_err(|_| none(system.state_message(x)))?,
        );
        let shape = program.function(name).map_or(Shape::Scalar, |f| f.shape);
        outputs.extend(names::shaped(name, shape));
    }
    let (c, d) = split(&slopes);
    let mut linear = Linear {
        system: generated.model.name.clone(),
        eigenvalues: None,
        with_states: !generated.model.states.is_empty(),
        states,
        inputs,
        a,
        b,
        outputs,
        c,
        d,
        given: 0,
        xi_dot,
    };
    if !full {
        let flat = function(program, "displacement_frame", params)?
            .call(x, &[], &[], &[])
            .map_err(|_| none(system.state_message(x)))?;
        let columns = flat.len() / x.len().max(1);
        let rows: Vec<Vec<f64>> = flat.chunks(columns.max(1)).map(<[f64]>::to_vec).collect();
        if let Some(tangent) = minimal::tangent(generated, state, &rows) {
            linear.given = linear.states.len() - tangent.kept.len();
            linear.a = tangent.of_square(&linear.a);
            linear.b = tangent.of_list(&linear.b);
            linear.c = tangent.of_columns(&linear.c);
            linear.states = tangent.of_list(&linear.states);
        }
    }
    linear.eigenvalues = eigenvalues(&linear.a);
    Ok(linear)
}

/// Fails if eigenvalues are missing, after A and B have been printed.
fn complete(linear: &Linear) -> Result<(), Failure> {
    match linear.eigenvalues {
        Some(_) => Ok(()),
        None => Err(Failure::failed(
            "the eigenvalues were not found: the QR algorithm does not converge for this A",
        )),
    }
}

fn text(linear: &Linear) -> String {
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

/// All zero eigenvalues on one line, with the largest deviation that rounding left; empty if there are none.
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

/// A matrix with its name; a zero matrix takes one line.
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

fn json(linear: &Linear) -> Json {
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
        let mut linear = Linear {
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
