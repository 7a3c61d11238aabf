//! Reads identified base parameters from a file and finds standard parameters that have them.

use super::bodies::{Map, NoBodies, nearest};
use crate::failure::{Failure, print};
use crate::tables::Format;
use hamel_codegen::syntax::suggest::closest;
use hamel_codegen::tables::regressor::BaseParameters;
use hamel_engine::Source;
use hamel_engine::state::parse;
use serde_json::{Value, json};
use std::path::Path;

/// Prints the standard parameters with the identified base parameters.
pub fn print_bodies(
    all: &BaseParameters,
    description: &Source,
    file: &Path,
    format: Format,
) -> Result<(), Failure> {
    if matches!(format, Format::Latex) {
        let message = "--identified is written as text, as Markdown or as JSON, not as LaTeX";
        return Err(Failure::usage(message));
    }
    let Source { path, text, .. } = description.read_related(file, "base parameters")?;
    let beta = read(all, &path, &text)?;
    let found = nearest(all.values(), all.links().len(), &all.map(), &beta);
    let found = found.map_err(|why| {
        Failure::failed(match why {
            NoBodies::Nominal(link) => format!(
                "`{}` is not a physical body in the description: its pseudo-inertia is not positive definite; give it a mass, a centre of mass and an inertia near the real ones",
                all.links().get(link).map_or("a link", String::as_str)
            ),
            NoBodies::NotConverged => format!(
                "{path}: no bodies were found near these base parameters; compare them with those that `hamel regressor` prints for the description"
            ),
        })
    })?;
    let reached = base(&all.map(), &found.standard);
    if !found.exact {
        let gap = |(a, b): (&f64, &f64)| (a - b).abs();
        let gaps: Vec<f64> = beta.iter().zip(&reached).map(gap).collect();
        let place = (0..gaps.len()).max_by(|&a, &b| gaps[a].total_cmp(&gaps[b]));
        let most =
            place.map(|k| format!("; beta[{}] is {:e}, not {:e}", k + 1, reached[k], beta[k]));
        anstream::eprintln!(
            "\x1b[1;33mwarning\x1b[0m: {}: no bodies have exactly these base parameters: those printed come near{}",
            path,
            most.unwrap_or_default()
        );
    }
    let rows = all.standard().iter().zip(all.values()).zip(&found.standard);
    print(&match format {
        Format::Json => {
            let rows = rows.map(|((standard, described), identified)| {
                json!({ "name": standard.name(), "described": described, "identified": identified })
            });
            let rows: Vec<Value> = rows.collect();
            format!(
                "{:#}\n",
                json!({ "beta": beta, "reached": reached, "exact": found.exact, "standard": rows })
            )
        }
        Format::Markdown => {
            let mut text =
                String::from("| standard parameter | described | identified |\n|---|---:|---:|\n");
            for ((standard, described), identified) in rows {
                text += &format!("| `{}` | {described} | {identified} |\n", standard.name());
            }
            text
        }
        _ => {
            let names = all.standard().iter().map(|standard| standard.name());
            let width = names.map(|name| name.len()).max().unwrap_or(0);
            let mut text = format!("{:width$} {:>24} {:>24}\n", "", "described", "identified");
            for ((standard, described), identified) in rows {
                text += &format!(
                    "{:width$} {described:>24.9e} {identified:>24.9e}\n",
                    standard.name()
                );
            }
            text
        }
    })
}

/// Returns the base parameters β = K π.
fn base(map: &Map, standard: &[f64]) -> Vec<f64> {
    let sum = |terms: &Vec<(usize, f64)>| {
        let terms = terms.iter();
        terms.map(|&(k, factor)| factor * standard[k]).sum()
    };
    map.iter().map(sum).collect()
}

/// Reads β from the text of a file.
fn read(all: &BaseParameters, path: &str, text: &str) -> Result<Vec<f64>, Failure> {
    let json = parse(text).map_err(|error| Failure::usages(path, &[error.to_string()]))?;
    let kept: Vec<&str> = all.names().collect();
    let mut beta = base(&all.map(), all.values());
    let mut errors = Vec::new();
    match &json {
        Value::Array(list) if list.len() == beta.len() => {
            for (place, (beta, value)) in beta.iter_mut().zip(list).enumerate() {
                match value.as_f64() {
                    Some(value) => *beta = value,
                    None => errors.push(format!("[{place}]: expected a number, found `{value}`")),
                }
            }
        }
        Value::Array(list) => errors.push(format!(
            "expected {} base parameters, found {}; `hamel regressor` lists them",
            beta.len(),
            list.len()
        )),
        Value::Object(members) => {
            for (name, value) in members {
                match (kept.iter().position(|kept| *kept == name), value.as_f64()) {
                    (Some(place), Some(value)) => beta[place] = value,
                    (Some(_), None) => {
                        errors.push(format!("{name}: expected a number, found `{value}`"));
                    }
                    (None, _) => {
                        let near = closest(name, kept.iter().copied());
                        let near = near.map(|near| format!("; did you mean `{near}`?"));
                        errors.push(format!(
                            "{name}: no base parameter has this name{}",
                            near.unwrap_or_default()
                        ));
                    }
                }
            }
        }
        other => errors.push(format!(
            "expected a list of numbers, or an object of names and numbers, found `{other}`"
        )),
    }
    match errors.is_empty() {
        true => Ok(beta),
        false => Err(Failure::usages(path, &errors)),
    }
}
