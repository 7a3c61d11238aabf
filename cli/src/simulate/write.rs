//! Writes samples to files.

use crate::failure::Failure;
use crate::json::Json;
use hamel_engine::run::{Run, Sample};
use hamel_files::number::exact;
use std::path::Path;

/// Format of a file, by its extension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Format {
    /// One row for each sample.
    Csv,
    /// A list of samples.
    Json,
    /// A plot.
    Svg,
}

impl Format {
    /// Chooses the format by the extension of a path.
    pub fn of(path: &Path) -> Result<Self, Failure> {
        let extension = path
            .extension()
            .map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("csv") => Ok(Format::Csv),
            Some("json") => Ok(Format::Json),
            Some("svg") => Ok(Format::Svg),
            _ => Err(Failure::usage(format!(
                "{}: the name has to end in .csv, .json or .svg",
                path.display()
            ))),
        }
    }
}

/// Returns the names of the columns.
fn columns(run: &Run) -> impl Iterator<Item = &String> {
    let coordinates = run.coordinate_names.iter().enumerate();
    let coordinates = coordinates.filter(|(place, _)| run.time.place != Some(*place));
    std::iter::once(&run.time.name)
        .chain(coordinates.map(|(_, name)| name))
        .chain(&run.velocity_names)
        .chain(&run.output_names)
}

/// Returns the values of the columns.
fn values(run: &Run, sample: &Sample) -> impl Iterator<Item = f64> {
    let coordinates = sample.x.iter().enumerate();
    let coordinates = coordinates.filter(|(place, _)| run.time.place != Some(*place));
    std::iter::once(run.time.at(sample.t, &sample.x))
        .chain(coordinates.map(|(_, value)| *value))
        .chain(sample.xi.iter().copied())
        .chain(sample.outputs.iter().copied())
}

/// Returns a header and one row for each sample: time, coordinates, velocities, outputs.
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
    let mut text = names.join(",") + "\n";
    for sample in &run.samples {
        let row: Vec<String> = values(run, sample).map(exact).collect();
        text.push_str(&row.join(","));
        text.push('\n');
    }
    text
}

/// Returns a list of objects with the members of the CSV columns, one on each line.
pub fn json(run: &Run) -> String {
    let rows: Vec<String> = run
        .samples
        .iter()
        .map(|sample| {
            let values = values(run, sample).map(Json::Number);
            Json::object(columns(run).map(String::as_str).zip(values)).line()
        })
        .collect();
    format!("[\n{}\n]\n", rows.join(",\n"))
}
