//! The files of the report.

use crate::cases::ALL;
use crate::pictures::motions;
use crate::runner::BenchError;
use hamel_files::number::group_thousands;
use hamel_report::data::{Case, Drift, Report};
use hamel_report::page::{self, Picture};
use hamel_report::plot::{Figure, PlotError, drifts, precision};
use hamel_report::summary::summary;
use hamel_report::{book_excerpt, json, markdown};
use std::fs;
use std::path::{Path, PathBuf};

/// The runs from which the part of the book is written, in the repository.
pub const SUMMARY: &str = "docs/summary.json";

/// Writes `report.json`, `report.md`, `index.html` and the pictures, and returns the names of the files.
///
/// # Errors
/// If a picture cannot be drawn or a file cannot be written.
pub fn write(report: &Report, folder: &Path) -> Result<Vec<PathBuf>, BenchError> {
    let said = |error: PlotError| BenchError(error.to_string());
    fs::create_dir_all(folder).map_err(|error| unwritten(folder, &error))?;
    let figures: Vec<Figure> = report
        .cases
        .iter()
        .map(precision)
        .collect::<Result<_, _>>()
        .map_err(said)?;
    let mut further: Vec<(String, Picture)> = motions()?
        .into_iter()
        .map(|(name, picture)| (name.to_string(), picture))
        .collect();
    for case in &report.cases {
        let runs: Vec<&Drift> = report
            .drifts
            .iter()
            .filter(|drift| drift.case == case.name)
            .collect();
        if let Some(first) = runs.first() {
            let title = "Drift of the energy".to_string();
            let subtitle = format!(
                "{}, {} steps of {}",
                case.name,
                group_thousands(first.steps),
                first.step
            );
            let figure = drifts(&title, &subtitle, &runs).map_err(said)?;
            further.push((format!("drift-{}", case.name), Picture { title, figure }));
        }
    }
    let mut files = vec![
        (
            "report.json".to_string(),
            json::write(report).map_err(|error| BenchError(error.to_string()))?,
        ),
        ("report.md".to_string(), markdown::write(report, file_of)),
    ];
    for (case, figure) in report.cases.iter().zip(&figures) {
        if let Some(file) = file_of(case) {
            files.push((file, figure.standalone()));
        }
    }
    for (name, picture) in &further {
        files.push((format!("{name}.svg"), picture.figure.standalone()));
    }
    let inline: Vec<Option<Figure>> = figures.into_iter().map(Some).collect();
    let further: Vec<Picture> = further.into_iter().map(|(_, picture)| picture).collect();
    files.push(("index.html".into(), page::write(report, &inline, &further)));
    files
        .into_iter()
        .map(|(name, text)| {
            let path = folder.join(name);
            written(&path, &text)?;
            Ok(path)
        })
        .collect()
}

/// The name of the separate picture of a case, if it has one.
fn file_of(case: &Case) -> Option<String> {
    let job = ALL.iter().find(|job| job.name == case.name)?;
    job.picture.then(|| format!("{}.svg", case.name))
}

/// The chapter of the book with a part that is written from the report.
pub const CHAPTER: &str = "docs/book/src/integrators.md";

/// Updates the files in the repository at `root` that are made from a full report: the part of [`CHAPTER`], and the
/// runs it is made from, in [`SUMMARY`].
///
/// # Errors
/// If there is no such chapter, or it has no such part.
pub fn keep(report: &Report, root: &Path) -> Result<(), BenchError> {
    let path = root.join(CHAPTER);
    let text = fs::read_to_string(&path).map_err(|error| unwritten(&path, &error))?;
    let new = book_excerpt::replace_block(&text, &book_excerpt::block(report))
        .ok_or_else(|| BenchError(format!("{}: no block of the report", path.display())))?;
    let kept = json::write(&summary(report)).map_err(|error| BenchError(error.to_string()))?;
    written(&root.join(SUMMARY), &kept)?;
    written(&path, &new)
}

/// Writes a file atomically.
fn written(path: &Path, text: &str) -> Result<(), BenchError> {
    hamel_files::write(path, text).map_err(|error| BenchError(error.to_string()))
}

fn unwritten(path: &Path, error: &std::io::Error) -> BenchError {
    BenchError(format!("{}: {error}", path.display()))
}
