//! CSV files of numbers over time: a header with `t` and names, rows with increasing t.

use super::place;
use crate::failure::Failure;
use crate::names::TIME;
use crate::number::short;
use std::path::Path;

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
    /// Reads a file for runs of this length.
    pub fn read(path: &Path, entries: &[String], hold: bool, until: f64) -> Result<Self, Failure> {
        let wrong = |why: String| Failure::usage(format!("{}: {why}", path.display()));
        let (names, rows) = rows(path).map_err(wrong)?;
        let times = increasing(&names, &rows).map_err(wrong)?;
        let mut columns: Vec<(usize, Vec<f64>)> = Vec::new();
        for (column, name) in names.iter().enumerate().filter(|(_, name)| *name != TIME) {
            let entry = place(name, entries).map_err(wrong)?;
            if columns.iter().any(|(known, _)| *known == entry) {
                return Err(wrong(format!("two columns are called `{name}`")));
            }
            columns.push((entry, rows.iter().map(|(_, row)| row[column]).collect()));
        }
        if columns.is_empty() {
            let all = match entries {
                [] => "the description has no inputs".into(),
                all => format!("the inputs are {}", all.join(", ")),
            };
            return Err(wrong(format!(
                "no column besides `{TIME}` is an input: {all}"
            )));
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
    pub fn from(mut self, begin: f64) -> Result<Self, String> {
        self.times = self.written.iter().map(|time| time - begin).collect();
        match (self.times.first(), self.times.last()) {
            (Some(&first), Some(&last)) if first > 0.0 || last < self.until && !self.hold => {
                Err(format!(
                    "its times reach from {} to {}, the run from {} to {}: add rows, or shorten the run",
                    short(first + begin),
                    short(last + begin),
                    short(begin),
                    short(begin + self.until)
                ))
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
pub fn times(path: &Path, begin: f64, until: f64) -> Result<Vec<f64>, Failure> {
    let wrong = |why: String| Failure::usage(format!("{}: {why}", path.display()));
    let (names, rows) = rows(path).map_err(wrong)?;
    let times = increasing(&names, &rows).map_err(wrong)?;
    let times: Vec<f64> = times.iter().map(|time| time - begin).collect();
    let outside = times
        .iter()
        .zip(&rows)
        .find(|(time, _)| !(0.0..=until).contains(*time));
    match outside {
        Some((time, (line, _))) => Err(wrong(format!(
            "line {line}: t = {} is outside the run, which is from {} to {}",
            short(*time + begin),
            short(begin),
            short(begin + until)
        ))),
        None => Ok(times),
    }
}

/// Numbers of a row, with its line number.
type Row = (u64, Vec<f64>);

/// The header and the rows.
fn rows(path: &Path) -> Result<(Vec<String>, Vec<Row>), String> {
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_path(path)
        .map_err(|error| error.to_string())?;
    let header = reader.headers().map_err(|error| error.to_string())?;
    let names: Vec<String> = header.iter().map(String::from).collect();
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| match error.kind() {
            csv::ErrorKind::UnequalLengths {
                pos,
                expected_len,
                len,
            } => {
                let line = pos.as_ref().map_or(0, csv::Position::line);
                let plural = if *len == 1 { "" } else { "s" };
                format!("line {line}: {len} column{plural}, the header has {expected_len}")
            }
            _ => error.to_string(),
        })?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |(entry, name): (&str, &String)| match entry.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(format!(
                "line {line}: `{entry}` in the column `{name}` is not a number"
            )),
        };
        let row: Result<Vec<f64>, String> = record.iter().zip(&names).map(number).collect();
        rows.push((line, row?));
    }
    Ok((names, rows))
}

/// The column of times, which has to increase.
fn increasing(names: &[String], rows: &[Row]) -> Result<Vec<f64>, String> {
    let Some(column) = names.iter().position(|name| name == TIME) else {
        return Err(format!(
            "no column `{TIME}`: the first line has to name the columns, as in `t,F`"
        ));
    };
    let times: Vec<f64> = rows.iter().map(|(_, row)| row[column]).collect();
    if times.is_empty() {
        return Err("there are no rows after the header".into());
    }
    let falling = times.windows(2).position(|pair| pair[0] >= pair[1]);
    match falling {
        Some(place) => Err(format!(
            "line {}: t = {} is not after t = {} of the previous row",
            rows[place + 1].0,
            short(times[place + 1]),
            short(times[place])
        )),
        None => Ok(times),
    }
}
