//! Writes comparisons as text and as files.

use crate::failure::Failure;
use hamel_report::data::{Case, Report};
use hamel_report::plot::{Figure, precision};
use hamel_report::{json, markdown, page};
use std::path::Path;

/// Returns the tables as Markdown, with links to the pictures if these are written.
pub fn markdown(report: &Report, pictures: bool) -> String {
    markdown::write(report, |case| pictures.then(|| file(case)))
}

/// Returns the report as one JSON object.
pub fn json(report: &Report) -> Result<String, Failure> {
    json::write(report).map_err(|error| Failure::failed(error.to_string()))
}

/// Writes all files to a folder, which is created if it does not exist.
pub fn files(report: &Report, folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::usage(format!("cannot make {}: {error}", folder.display())))?;
    let mut figures: Vec<Option<Figure>> = Vec::new();
    for case in &report.cases {
        let figure = precision(case).map_err(|error| Failure::failed(error.to_string()))?;
        crate::failure::write(&folder.join(file(case)), &figure.standalone())?;
        figures.push(Some(figure));
    }
    for (name, text) in [
        ("report.json", json(report)?),
        ("report.md", markdown(report, true)),
        ("index.html", page::write(report, &figures, &[])),
    ] {
        crate::failure::write(&folder.join(name), &text)?;
    }
    Ok(())
}

fn file(case: &Case) -> String {
    format!("{}.svg", case.name)
}
