//! Samples as files.

use super::record::Run;
use crate::failure::Failure;
use crate::json::Json;
use crate::number::exact;
use std::path::Path;

/// What a file holds, by the end of its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Format {
    /// One row a sample.
    Csv,
    /// A list of samples.
    Json,
    /// A plot.
    Svg,
}

impl Format {
    /// The format of a path.
    pub fn of(path: &Path) -> Result<Self, Failure> {
        let extension = path
            .extension()
            .map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("csv") => Ok(Format::Csv),
            Some("json") => Ok(Format::Json),
            Some("svg") => Ok(Format::Svg),
            _ => Err(Failure::usage(format!(
                "{}: a name that ends in .csv, .json or .svg is needed",
                path.display()
            ))),
        }
    }
}

/// Names of the columns after t.
fn columns<'a>(run: &'a Run) -> impl Iterator<Item = &'a String> {
    run.coordinate_names
        .iter()
        .chain(&run.velocity_names)
        .chain(&run.output_names)
}

/// A header and one row a sample: t, coordinates, velocities, outputs.
pub fn csv(run: &Run) -> String {
    let names: Vec<String> = columns(run)
        .map(|name| {
            if name.contains(',') {
                format!("\"{name}\"")
            } else {
                name.clone()
            }
        })
        .collect();
    let mut text = format!("t,{}\n", names.join(","));
    for sample in &run.samples {
        text.push_str(&exact(sample.t));
        for &value in sample.x.iter().chain(&sample.xi).chain(&sample.outputs) {
            text.push(',');
            text.push_str(&exact(value));
        }
        text.push('\n');
    }
    text
}

/// A list of objects with the members of the CSV columns, one a line.
pub fn json(run: &Run) -> String {
    let rows: Vec<String> = run
        .samples
        .iter()
        .map(|sample| {
            let values = sample.x.iter().chain(&sample.xi).chain(&sample.outputs);
            let members = columns(run)
                .map(String::as_str)
                .zip(values.map(|&value| Json::Number(value)));
            let time = std::iter::once(("t", Json::Number(sample.t)));
            Json::object(time.chain(members)).line()
        })
        .collect();
    format!("[\n{}\n]\n", rows.join(",\n"))
}
