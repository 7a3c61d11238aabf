//! `hamel lqr`: linear-quadratic regulators about a state.

use crate::failure::{Failure, print, write};
use crate::json::Json;
use crate::linear::{LinearArguments, OperatingPoint, pairs, rows, unsteady};
use crate::linearize::{matrix, spectrum};
use crate::outputs;
use clap::{Args, ValueEnum};
use hamel_engine::LinearSystem;
use hamel_engine::linear::{Matrix, Regulator};
use hamel_engine::option_text::{Piece, invalid_option};
use hamel_files::number::{exact, short};
use std::path::{Path, PathBuf};

/// Computes the regulator u = u₀ − K x with the least ∫ (xᵀ Q x + uᵀ R u) dt for the linearisation at a state.
///
/// x = (h, δξ) are the states that `hamel linearize` names, u changes of the inputs, and K = R⁻¹ Bᵀ X, where X solves
/// Riccati's equation. With --step H the regulator is for inputs that are held for H, K = (R + Bᵀ X B)⁻¹ Bᵀ X A, and
/// the sum over the steps takes the place of the integral.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel lqr furuta.eom --at upright.json
  hamel lqr furuta.eom --at upright.json --q \"h = 10, d(arm_dot) = 0.2\" --r \"tau = 400\"
  hamel lqr furuta.eom --at upright.json --step 0.01 -o gain.rs")]
pub struct Arguments {
    #[command(flatten)]
    linear: LinearArguments,
    /// Weights of states, or of outputs without direct term: `h(w[1]) = 2`, `h(w) = 2` for a whole vector, `h = 2` for
    /// all displacements, `d = 2` for all velocities. Later ones prevail; states without one have none. By default
    /// every state has weight 1.
    #[arg(long, value_name = "NAME = W")]
    q: Vec<String>,
    /// Weights of inputs, in the same way; inputs without one have weight 1.
    #[arg(long, value_name = "NAME = W")]
    r: Vec<String>,
    /// Write the regulator as .json, or K as a Rust constant as .rs.
    #[arg(short, long, value_name = "F")]
    out: Option<PathBuf>,
    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Text,
    Json,
}

/// Computes the regulator, writes it and prints it.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let out = arguments.out.as_deref();
    let ending = out
        .and_then(Path::extension)
        .map(|ending| ending.to_string_lossy().to_lowercase());
    let rust = match (out, ending.as_deref()) {
        (None, _) | (_, Some("json")) => false,
        (_, Some("rs")) => true,
        (Some(path), _) => {
            let why = "the name has to end in .json or .rs";
            return Err(Failure::usage(format!("--out {}: {why}", path.display())));
        }
    };
    outputs::apart(
        [("--out", out)],
        [
            Some(arguments.linear.file.as_path()),
            arguments.linear.at.as_deref(),
        ],
    )?;
    let (linear, system, point) = arguments.linear.open_with_law(false)?;
    let weights = (
        state_weights(&system, &arguments.q),
        input_weights(&system, &arguments.r),
    );
    let (q, r) = match weights {
        (Ok(q), Ok(r)) => (q, r),
        (Err(of_states), Err(of_inputs)) => return Err(of_states.and(of_inputs)),
        (Err(error), _) | (_, Err(error)) => return Err(error),
    };
    let found = system
        .regulator(&q, &r)
        .map_err(hamel_engine::Error::from)?;
    let json = || {
        Json::object([
            ("system", Json::Text(linear.system.clone())),
            ("states", Json::texts(&system.states)),
            ("inputs", Json::texts(&system.inputs)),
            ("K", Json::matrix(&rows(&found.gain))),
            ("poles", pairs(&found.poles)),
            ("X", Json::matrix(&rows(&found.cost))),
            ("Q", Json::matrix(&rows(&q))),
            ("R", Json::matrix(&rows(&r))),
            ("step", system.step.map_or(Json::Null, Json::Number)),
        ])
        .pretty()
    };
    let mut text = match arguments.format {
        Format::Text => {
            shown(&linear.system, &system, &found)
                + &law(&system, &found, &point)
                + &unsteady(&linear)
        }
        Format::Json => json(),
    };
    if let Some(path) = out {
        write(
            path,
            &if rust {
                constant(&linear.system, &system, &found)
            } else {
                json()
            },
        )?;
        if matches!(arguments.format, Format::Text) {
            text += &format!("\nwrote {}\n", path.display());
        }
    }
    print(&text)
}

fn shown(name: &str, system: &LinearSystem, found: &Regulator) -> String {
    let (states, inputs) = (&system.states, &system.inputs);
    let size = system.matrices.a.amax();
    let held = system
        .step
        .map_or(String::new(), |h| format!(", held for {} s", exact(h)));
    format!("\x1b[1m{name}\x1b[0m  u = u0 - K (h, d){held}\n")
        + &matrix("K", inputs, states, &rows(&found.gain))
        + "\n\x1b[1mpoles of the closed loop\x1b[0m\n"
        + &spectrum(&found.poles, size)
        + &matrix("X", states, states, &rows(&found.cost))
}

/// The regulator as inputs of `hamel simulate`, in continuous time and if all states are those of coordinates.
fn law(system: &LinearSystem, found: &Regulator, point: &OperatingPoint) -> String {
    let (Some(states), None) = (&point.states, system.step) else {
        return String::new();
    };
    let mut text = "\n\x1b[1mfor `hamel simulate`\x1b[0m\n".to_string();
    for ((name, row), value) in system
        .inputs
        .iter()
        .zip(rows(&found.gain))
        .zip(&point.inputs)
    {
        let terms = row.iter().zip(states).filter(|(gain, _)| **gain != 0.0);
        let terms = terms.map(|(gain, state)| {
            let sign = if *gain < 0.0 { '+' } else { '-' };
            format!(" {sign} {} * {state}", short(gain.abs()))
        });
        let sum = format!("{}{}", short(*value), terms.collect::<String>());
        let sum = sum.strip_prefix("0 + ").unwrap_or(&sum);
        text += &format!("  --input \"{name} = {sum}\"\n");
    }
    text
}

/// K as Rust.
fn constant(name: &str, system: &LinearSystem, found: &Regulator) -> String {
    let (m, n) = found.gain.shape();
    let held = system
        .step
        .map_or(String::new(), |h| format!(", held for {} s", exact(h)));
    let mut text = format!(
        "/// Gain of the regulator u = u₀ − K x of `{name}`{held}; x = ({}), u = ({}).\npub const K: [[f64; {n}]; {m}] = [\n",
        system.states.join(", "),
        system.inputs.join(", ")
    );
    for row in rows(&found.gain) {
        let entries: Vec<String> = row.into_iter().map(exact).collect();
        text += &format!("    [{}],\n", entries.join(", "));
    }
    text + "];\n"
}

/// Q: the weights of states on the diagonal, and w cᵀ c for each output y = c x.
fn state_weights(system: &LinearSystem, given: &[String]) -> Result<Matrix, Failure> {
    let n = system.states.len();
    if given.is_empty() {
        return Ok(Matrix::identity(n, n));
    }
    let names = [system.states.clone(), system.outputs.clone()].concat();
    let weights = weights("--q", &names, given)?;
    let mut q = Matrix::zeros(n, n);
    for (i, weight) in weights.into_iter().enumerate() {
        let weight = weight.unwrap_or(0.0);
        match i.checked_sub(n) {
            None => q[(i, i)] += weight,
            Some(output) if weight > 0.0 => {
                let row = system.matrices.c.row(output);
                if system.matrices.d.row(output).amax() > 0.0 {
                    let name = &system.outputs[output];
                    return Err(Failure::usage(format!(
                        "--q: `{name}` depends directly on inputs; weigh states instead"
                    )));
                }
                q += row.tr_mul(&row) * weight;
            }
            Some(_) => {}
        }
    }
    Ok(q)
}

/// R: the weights of inputs on the diagonal.
fn input_weights(system: &LinearSystem, given: &[String]) -> Result<Matrix, Failure> {
    let weights = weights("--r", &system.inputs, given)?;
    let weights: Vec<f64> = weights
        .into_iter()
        .map(|weight| weight.unwrap_or(1.0))
        .collect();
    Ok(Matrix::from_diagonal(&weights.into()))
}

/// Reads the weights of these names from lists `NAME = W, …`.
fn weights(option: &str, names: &[String], given: &[String]) -> Result<Vec<Option<f64>>, Failure> {
    let mut weights = vec![None; names.len()];
    for text in given {
        let wrong = |error| Failure::from(invalid_option(option, text, &[error]));
        for item in Piece::of(text).map_err(wrong)?.split(',') {
            let parts = item.split('=');
            let [name, value] = parts.as_slice() else {
                return Err(wrong(item.wrong("expected NAME = W")));
            };
            let weight = value
                .text
                .parse::<f64>()
                .ok()
                .filter(|w| w.is_finite() && *w >= 0.0);
            let weight = weight.filter(|w| option == "--q" || *w > 0.0);
            let Some(weight) = weight else {
                let least = if option == "--q" {
                    "zero or greater"
                } else {
                    "greater than zero"
                };
                return Err(wrong(value.wrong(format!("a weight is a number, {least}"))));
            };
            let known = (0..names.len()).filter(|&i| means(name.text, &names[i]));
            let known: Vec<usize> = known.collect();
            if known.is_empty() {
                let all = names.join(", ");
                return Err(wrong(
                    name.wrong(format!("`{}` is none of {all}", name.text)),
                ));
            }
            known.into_iter().for_each(|i| weights[i] = Some(weight));
        }
    }
    Ok(weights)
}

/// Whether a name is that of an entry, of its vector, or `h` or `d` of a displacement or a change.
fn means(name: &str, entry: &str) -> bool {
    let whole = match (entry.find('['), entry.rfind(']')) {
        (Some(open), Some(close)) => format!("{}{}", &entry[..open], &entry[close + 1..]),
        _ => entry.into(),
    };
    let kind = entry.split_once('(').map(|(kind, _)| kind);
    name == entry || name == whole || kind == Some(name)
}
