//! Reads time series from CSV files: a header with `t` and names, then rows of numbers.

use csv::ErrorKind;
use hamel_engine::TimeSeries;
use hamel_engine::run::{InputProblem, SeriesProblem};
use std::error;
use std::fmt;
use std::path::{Path, PathBuf};

/// Error in a CSV file of numbers over time.
#[derive(Debug)]
pub enum SeriesError {
    /// The file cannot be read.
    Csv {
        /// Path of the file.
        path: PathBuf,
        /// The reason.
        source: csv::Error,
    },
    /// A row has another number of columns than the header.
    Columns(InputProblem),
    /// An entry is not a finite number.
    NoNumber {
        /// Path of the file.
        path: PathBuf,
        /// Line of the entry.
        line: u64,
        /// The entry.
        entry: String,
        /// Name of its column.
        column: String,
    },
}

impl fmt::Display for SeriesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SeriesError::Csv { path, source } => write!(f, "{}: {source}", path.display()),
            SeriesError::Columns(problem) => problem.fmt(f),
            SeriesError::NoNumber {
                path,
                line,
                entry,
                column,
            } => write!(
                f,
                "{}: line {line}: `{entry}` in the column `{column}` is no number",
                path.display()
            ),
        }
    }
}

impl error::Error for SeriesError {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match self {
            SeriesError::Csv { source, .. } => Some(source),
            SeriesError::Columns(problem) => problem.source(),
            SeriesError::NoNumber { .. } => None,
        }
    }
}

/// Reads a CSV file of numbers over time. Lines that begin with `#` are comments.
///
/// # Errors
/// The file cannot be read, its rows differ in length, or an entry is not a finite number.
pub fn read_series(path: &Path) -> Result<TimeSeries, SeriesError> {
    let broken = |source| SeriesError::Csv {
        path: path.into(),
        source,
    };
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_path(path)
        .map_err(broken)?;
    let header = reader.headers().map_err(broken)?;
    let names: Vec<String> = header.iter().map(String::from).collect();
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| match error.kind() {
            ErrorKind::UnequalLengths {
                pos,
                expected_len,
                len,
            } => SeriesError::Columns(InputProblem::Series {
                path: path.into(),
                problem: SeriesProblem::Columns {
                    line: pos.as_ref().map_or(0, csv::Position::line),
                    found: *len,
                    expected: *expected_len,
                },
            }),
            _ => broken(error),
        })?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |(entry, name): (&str, &String)| match entry.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(SeriesError::NoNumber {
                path: path.into(),
                line,
                entry: entry.into(),
                column: name.clone(),
            }),
        };
        let row: Result<Vec<f64>, SeriesError> = record.iter().zip(&names).map(number).collect();
        rows.push((line, row?));
    }
    Ok(TimeSeries {
        path: path.into(),
        names,
        rows,
    })
}
