//! Numbers over time, one row for each time: inputs of a run, and times of its samples.

use super::{UnknownInput, place};
use crate::names::TIME;
use hamel_files::number::short;
use std::cmp::Ordering;
use std::error;
use std::fmt;
use std::path::PathBuf;

/// A table of numbers over time, with a column for each name; one of them is `t`, which increases from row to row.
///
/// Front ends read it from files. Whether it is complete and fits a run is checked when the run begins.
#[derive(Clone, Debug, Default)]
pub struct TimeSeries {
    /// Path of the file that it comes from, for messages.
    pub path: PathBuf,
    /// Names of the columns.
    pub names: Vec<String>,
    /// Rows, each with the number of its line in the file, for messages, and one value for each column.
    pub rows: Vec<(u64, Vec<f64>)>,
}

/// Error in a time series.
#[derive(Debug)]
pub enum SeriesProblem {
    /// A row has another number of columns than the header.
    Columns {
        /// Line of the row.
        line: u64,
        /// Number of columns of the row.
        found: u64,
        /// Number of columns of the header.
        expected: u64,
    },
    /// There is no column of times.
    NoTimes,
    /// There are no rows.
    NoRows,
    /// Times do not increase.
    Order {
        /// Line of the later row.
        line: u64,
        /// Time of the later row.
        time: f64,
        /// Time of the row before it.
        before: f64,
    },
    /// A column has a name that no input has.
    Unknown(UnknownInput),
    /// Two columns have the same name.
    SameName {
        /// The name.
        name: String,
    },
    /// No column has the name of an input.
    NoInput {
        /// Names of all entries of the inputs.
        known: Vec<String>,
    },
    /// The times do not cover the run.
    Cover {
        /// First and last time of the series.
        times: [f64; 2],
        /// First and last time of the run.
        run: [f64; 2],
    },
    /// The time of a sample is outside of the run.
    Outside {
        /// Line of its row.
        line: u64,
        /// The time.
        time: f64,
        /// First and last time of the run.
        run: [f64; 2],
    },
}

impl fmt::Display for SeriesProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SeriesProblem::Columns {
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
            SeriesProblem::NoTimes => write!(
                f,
                "no column `{TIME}`: the first line has to name the columns, as in `t,F`"
            ),
            SeriesProblem::NoRows => f.write_str("there are no rows after the header"),
            SeriesProblem::Order { line, time, before } => write!(
                f,
                "line {line}: t = {} is not after t = {} of the previous row",
                short(*time),
                short(*before)
            ),
            SeriesProblem::Unknown(unknown) => unknown.fmt(f),
            SeriesProblem::SameName { name } => write!(f, "two columns are called `{name}`"),
            SeriesProblem::NoInput { known } => {
                write!(f, "no column besides `{TIME}` is an input: ")?;
                match known.as_slice() {
                    [] => f.write_str("the description has no inputs"),
                    all => write!(f, "the inputs are {}", all.join(", ")),
                }
            }
            SeriesProblem::Cover { times, run } => write!(
                f,
                "its times reach from {} to {}, the run from {} to {}: add rows, or shorten the run",
                short(times[0]),
                short(times[1]),
                short(run[0]),
                short(run[1])
            ),
            SeriesProblem::Outside { line, time, run } => write!(
                f,
                "line {line}: t = {} is outside the run, which is from {} to {}",
                short(*time),
                short(run[0]),
                short(run[1])
            ),
        }
    }
}

impl error::Error for SeriesProblem {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match self {
            SeriesProblem::Unknown(unknown) => Some(unknown),
            _ => None,
        }
    }
}

/// Inputs given by a time series: the entries of u that have a column.
#[derive(Clone, Debug)]
pub struct InputColumns {
    /// Times of the series.
    written: Vec<f64>,
    /// Times relative to the start of the run.
    times: Vec<f64>,
    /// Entries of u with their values at these times.
    columns: Vec<(usize, Vec<f64>)>,
    hold: bool,
    /// Length of runs.
    until: f64,
}

impl InputColumns {
    /// Finds the inputs of a time series. Whether its times cover a run of length `until` is checked by
    /// [`from`](Self::from).
    pub fn new(
        series: &TimeSeries,
        entries: &[String],
        hold: bool,
        until: f64,
    ) -> Result<Self, SeriesProblem> {
        let times = series.times()?;
        let mut columns: Vec<(usize, Vec<f64>)> = Vec::new();
        let named = series.names.iter().enumerate();
        for (column, name) in named.filter(|(_, name)| *name != TIME) {
            let entry = place(name, entries).map_err(SeriesProblem::Unknown)?;
            if columns.iter().any(|(known, _)| *known == entry) {
                return Err(SeriesProblem::SameName { name: name.clone() });
            }
            columns.push((entry, series.column(column)));
        }
        if columns.is_empty() {
            let known = entries.to_vec();
            return Err(SeriesProblem::NoInput { known });
        }
        Ok(InputColumns {
            written: times.clone(),
            times,
            columns,
            hold,
            until,
        })
    }

    /// Shifts the times for a run that begins at a time of the description; fails if they do not cover the run.
    pub fn from(mut self, begin: f64) -> Result<Self, SeriesProblem> {
        self.times = self.written.iter().map(|time| time - begin).collect();
        match (self.times.first(), self.times.last()) {
            (Some(&first), Some(&last)) if first > 0.0 || last < self.until && !self.hold => {
                Err(SeriesProblem::Cover {
                    times: [first + begin, last + begin],
                    run: [begin, begin + self.until],
                })
            }
            _ => Ok(self),
        }
    }

    /// Returns whether an entry of u has a column.
    pub fn has(&self, entry: usize) -> bool {
        self.columns.iter().any(|(known, _)| *known == entry)
    }

    /// Returns the times at which held values jump: those of all rows except the first.
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

impl TimeSeries {
    /// Returns the times of samples relative to the start of a run of length `until`, which begins at a time of the
    /// description.
    pub(super) fn sample_times(&self, begin: f64, until: f64) -> Result<Vec<f64>, SeriesProblem> {
        let times = self.times()?;
        let times: Vec<f64> = times.iter().map(|time| time - begin).collect();
        let outside = times
            .iter()
            .zip(&self.rows)
            .find(|(time, _)| !(0.0..=until).contains(*time));
        match outside {
            Some((time, (line, _))) => Err(SeriesProblem::Outside {
                line: *line,
                time: *time + begin,
                run: [begin, begin + until],
            }),
            None => Ok(times),
        }
    }

    /// Returns the column of times, and checks that they increase and that all rows are complete.
    fn times(&self) -> Result<Vec<f64>, SeriesProblem> {
        let expected = self.names.len();
        if let Some((line, row)) = self.rows.iter().find(|(_, row)| row.len() != expected) {
            return Err(SeriesProblem::Columns {
                line: *line,
                found: row.len() as u64,
                expected: expected as u64,
            });
        }
        let Some(column) = self.names.iter().position(|name| name == TIME) else {
            return Err(SeriesProblem::NoTimes);
        };
        let times = self.column(column);
        if times.is_empty() {
            return Err(SeriesProblem::NoRows);
        }
        // Also true for values that are not numbers.
        let falling = |pair: &[f64]| pair[0].partial_cmp(&pair[1]) != Some(Ordering::Less);
        match times.windows(2).position(falling) {
            Some(place) => Err(SeriesProblem::Order {
                line: self.rows[place + 1].0,
                time: times[place + 1],
                before: times[place],
            }),
            None => Ok(times),
        }
    }

    /// Returns the values of a column.
    fn column(&self, column: usize) -> Vec<f64> {
        let rows = self.rows.iter();
        rows.filter_map(|(_, row)| row.get(column).copied())
            .collect()
    }
}
