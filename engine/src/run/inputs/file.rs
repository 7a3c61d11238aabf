//! CSV files of numbers over time: a header with `t` and names, rows with increasing t.

use super::{UnknownInput, place};
use crate::names::TIME;
use hamel_files::number::short;
use std::error;
use std::fmt;
use std::path::Path;

/// What is wrong with a file of numbers over time.
#[derive(Debug)]
pub enum TableProblem {
    /// It cannot be read.
    Csv(csv::Error),
    /// A row has another number of columns than the header.
    Columns {
        /// The line of the row.
        line: u64,
        /// Columns of the row.
        found: u64,
        /// Columns of the header.
        expected: u64,
    },
    /// An entry is no finite number.
    NoNumber {
        /// The line of its row.
        line: u64,
        /// The entry.
        entry: String,
        /// The name of its column.
        column: String,
    },
    /// There is no column of times.
    NoTimes,
    /// There are no rows.
    NoRows,
    /// Times do not increase.
    Order {
        /// The line of the later row.
        line: u64,
        /// Its time.
        time: f64,
        /// The time of the row before.
        before: f64,
    },
    /// A column is called like no input.
    Unknown(UnknownInput),
    /// Two columns have one name.
    SameName {
        /// Name.
        name: String,
    },
    /// No column is called like an input.
    NoInput {
        /// All entries of the inputs.
        known: Vec<String>,
    },
    /// The times do not cover a run.
    Cover {
        /// The first and the last time of the file.
        times: [f64; 2],
        /// The first and the last time of the run.
        run: [f64; 2],
    },
    /// A time of a sample is outside of the run.
    Outside {
        /// Its line.
        line: u64,
        /// Returns the time.
        time: f64,
        /// The first and the last time of the run.
        run: [f64; 2],
    },
}

impl fmt::Display for TableProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TableProblem::Csv(error) => error.fmt(f),
            TableProblem::Columns {
                line,
                found,
                expected,
            } => {
                let plural = if *found == 1 { "" } else { "s" };
                write!(
                    f,
                    "line {line}: {found} column{plural}, the header has {expected}"
                )
            }
            TableProblem::NoNumber {
                line,
                entry,
                column,
            } => write!(
                f,
                "line {line}: `{entry}` in the column `{column}` is no number"
            ),
            TableProblem::NoTimes => write!(
                f,
                "no column `{TIME}`: the first line has to name the columns, as in `t,F`"
            ),
            TableProblem::NoRows => f.write_str("there are no rows after the header"),
            TableProblem::Order { line, time, before } => write!(
                f,
                "line {line}: t = {} is not after t = {} of the previous row",
                short(*time),
                short(*before)
            ),
            TableProblem::Unknown(unknown) => unknown.fmt(f),
            TableProblem::SameName { name } => write!(f, "two columns are called `{name}`"),
            TableProblem::NoInput { known } => {
                write!(f, "no column besides `{TIME}` is an input: ")?;
                match known.as_slice() {
                    [] => f.write_str("the description has no inputs"),
                    all => write!(f, "the inputs are {}", all.join(", ")),
                }
            }
            TableProblem::Cover { times, run } => write!(
                f,
                "its times reach from {} to {}, the run from {} to {}: add rows, or shorten the run",
                short(times[0]),
                short(times[1]),
                short(run[0]),
                short(run[1])
            ),
            TableProblem::Outside { line, time, run } => write!(
                f,
                "line {line}: t = {} is outside the run, which is from {} to {}",
                short(*time),
                short(run[0]),
                short(run[1])
            ),
        }
    }
}

impl error::Error for TableProblem {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match self {
            TableProblem::Csv(error) => Some(error),
            TableProblem::Unknown(unknown) => Some(unknown),
            _ => None,
        }
    }
}

/// Inputs over time.
#[derive(Clone, Debug)]
pub struct Table {
    /// Times as in the file.
    written: Vec<f64>,
    /// Times relative to the start of the run.
    times: Vec<f64>,
    /// Entries of u with their values at these times.
    columns: Vec<(usize, Vec<f64>)>,
    hold: bool,
    /// Length of runs.
    until: f64,
}

impl Table {
    /// Reads a CSV file of inputs over time. Whether its times cover a run of length `until` is checked by
    /// [`from`](Self::from).
    pub fn read(
        path: &Path,
        entries: &[String],
        hold: bool,
        until: f64,
    ) -> Result<Self, TableProblem> {
        let (names, rows) = rows(path)?;
        let times = increasing(&names, &rows)?;
        let mut columns: Vec<(usize, Vec<f64>)> = Vec::new();
        for (column, name) in names.iter().enumerate().filter(|(_, name)| *name != TIME) {
            let entry = place(name, entries).map_err(TableProblem::Unknown)?;
            if columns.iter().any(|(known, _)| *known == entry) {
                return Err(TableProblem::SameName { name: name.clone() });
            }
            columns.push((entry, rows.iter().map(|(_, row)| row[column]).collect()));
        }
        if columns.is_empty() {
            let known = entries.to_vec();
            return Err(TableProblem::NoInput { known });
        }
        Ok(Table {
            written: times.clone(),
            times,
            columns,
            hold,
            until,
        })
    }

    /// The table for a run that begins at a time of the description; fails if the file does not cover it.
    pub fn from(mut self, begin: f64) -> Result<Self, TableProblem> {
        self.times = self.written.iter().map(|time| time - begin).collect();
        match (self.times.first(), self.times.last()) {
            (Some(&first), Some(&last)) if first > 0.0 || last < self.until && !self.hold => {
                Err(TableProblem::Cover {
                    times: [first + begin, last + begin],
                    run: [begin, begin + self.until],
                })
            }
            _ => Ok(self),
        }
    }

    /// Whether an entry of u has a column.
    pub fn has(&self, entry: usize) -> bool {
        self.columns.iter().any(|(known, _)| *known == entry)
    }

    /// Times at which held values jump: all rows except the first.
    pub fn jumps(&self) -> &[f64] {
        match self.hold {
            true => self.times.get(1..).unwrap_or_default(),
            false => &[],
        }
    }

    /// Sets the entries of u that have a column.
    pub fn set(&self, t: f64, u: &mut [f64]) {
        let last = self.times.len() - 1;
        // The row at or before t.
        let row = self
            .times
            .partition_point(|&time| time <= t)
            .saturating_sub(1);
        let part = match row < last && !self.hold {
            true => (t - self.times[row]) / (self.times[row + 1] - self.times[row]),
            false => 0.0,
        };
        for (entry, values) in &self.columns {
            let next = values[(row + 1).min(last)];
            u[*entry] = values[row] + part * (next - values[row]);
        }
    }
}

/// Times of samples relative to the start of a run, which begins at a time of the description: those of the column `t`.
pub fn times(path: &Path, begin: f64, until: f64) -> Result<Vec<f64>, TableProblem> {
    let (names, rows) = rows(path)?;
    let times = increasing(&names, &rows)?;
    let times: Vec<f64> = times.iter().map(|time| time - begin).collect();
    let outside = times
        .iter()
        .zip(&rows)
        .find(|(time, _)| !(0.0..=until).contains(*time));
    match outside {
        Some((time, (line, _))) => Err(TableProblem::Outside {
            line: *line,
            time: *time + begin,
            run: [begin, begin + until],
        }),
        None => Ok(times),
    }
}

/// Numbers of a row, with its line number.
type Row = (u64, Vec<f64>);

/// The header and the rows.
fn rows(path: &Path) -> Result<(Vec<String>, Vec<Row>), TableProblem> {
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_path(path)
        .map_err(TableProblem::Csv)?;
    let header = reader.headers().map_err(TableProblem::Csv)?;
    let names: Vec<String> = header.iter().map(String::from).collect();
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| match error.kind() {
            csv::ErrorKind::UnequalLengths {
                pos,
                expected_len,
                len,
            } => TableProblem::Columns {
                line: pos.as_ref().map_or(0, csv::Position::line),
                found: *len,
                expected: *expected_len,
            },
            _ => TableProblem::Csv(error),
        })?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |(entry, name): (&str, &String)| match entry.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(TableProblem::NoNumber {
                line,
                entry: entry.into(),
                column: name.clone(),
            }),
        };
        let row: Result<Vec<f64>, TableProblem> = record.iter().zip(&names).map(number).collect();
        rows.push((line, row?));
    }
    Ok((names, rows))
}

/// The column of times, which has to increase.
fn increasing(names: &[String], rows: &[Row]) -> Result<Vec<f64>, TableProblem> {
    let Some(column) = names.iter().position(|name| name == TIME) else {
        return Err(TableProblem::NoTimes);
    };
    let times: Vec<f64> = rows.iter().map(|(_, row)| row[column]).collect();
    if times.is_empty() {
        return Err(TableProblem::NoRows);
    }
    let falling = times.windows(2).position(|pair| pair[0] >= pair[1]);
    match falling {
        Some(place) => Err(TableProblem::Order {
            line: rows[place + 1].0,
            time: times[place + 1],
            before: times[place],
        }),
        None => Ok(times),
    }
}
