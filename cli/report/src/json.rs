//! Reports as JSON: indented, but with one line for each run and for each list of numbers, so that changes can be read.

use crate::data::Report;
use serde::Serialize;
use serde_json::ser::{Formatter, Serializer};
use std::io::{self, Write};

/// Members of objects nested deeper than this are on one line: the runs of the methods of a case.
const MAX_BROKEN_DEPTH: usize = 6;

/// Formats a report, with a final line break.
///
/// # Errors
/// None in practice: a report is written to memory, and all its keys are text.
pub fn write(report: &Report) -> Result<String, serde_json::Error> {
    let mut bytes = Vec::new();
    report.serialize(&mut Serializer::with_formatter(
        &mut bytes,
        Lines::default(),
    ))?;
    bytes.push(b'\n');
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Parses a report.
///
/// # Errors
/// If the text is not a report.
pub fn read(text: &str) -> Result<Report, serde_json::Error> {
    serde_json::from_str(text)
}

/// Breaks lines before members, and before objects in lists.
#[derive(Default)]
struct Lines {
    /// For every open list or object, whether it contains a line break.
    open: Vec<bool>,
    /// If the next value is in a list: whether it is the first one.
    item: Option<bool>,
}

impl Lines {
    fn next_line<W: ?Sized + Write>(&self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b"\n")?;
        (0..self.open.len()).try_for_each(|_| writer.write_all(b" "))
    }

    /// Separates a value from the previous one in a list.
    fn part<W: ?Sized + Write>(&mut self, writer: &mut W, object: bool) -> io::Result<()> {
        match self.item.take() {
            Some(_) if object && self.open.len() <= MAX_BROKEN_DEPTH => self.break_line(writer),
            Some(false) => writer.write_all(b" "),
            _ => Ok(()),
        }
    }

    fn break_line<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        if let Some(broken) = self.open.last_mut() {
            *broken = true;
        }
        self.next_line(writer)
    }

    fn close<W: ?Sized + Write>(&mut self, writer: &mut W, end: &[u8]) -> io::Result<()> {
        if self.open.pop() == Some(true) {
            self.next_line(writer)?;
        }
        writer.write_all(end)
    }
}

impl Formatter for Lines {
    fn write_f64<W: ?Sized + Write>(&mut self, writer: &mut W, value: f64) -> io::Result<()> {
        self.part(writer, false)?;
        write!(writer, "{}", serde_json::Value::from(value))
    }

    fn begin_string<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.part(writer, false)?;
        writer.write_all(b"\"")
    }

    fn begin_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.part(writer, false)?;
        self.open.push(false);
        writer.write_all(b"[")
    }

    fn end_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b"]")
    }

    fn begin_array_value<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        first: bool,
    ) -> io::Result<()> {
        self.item = Some(first);
        writer.write_all(if first { b"" } else { b"," })
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.part(writer, true)?;
        self.open.push(false);
        writer.write_all(b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        first: bool,
    ) -> io::Result<()> {
        writer.write_all(if first { b"" } else { b"," })?;
        if self.open.len() <= MAX_BROKEN_DEPTH {
            self.break_line(writer)
        } else {
            writer.write_all(if first { b"" } else { b" " })
        }
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }
}
