//! Values of options on the command line.

use std::fmt;

/// Form that the value of an option must have: the error for a value of another form, which the parser of the command
/// line shows in front of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// A number greater than zero.
    Positive,
    /// A number that is not negative.
    NotNegative,
    /// A number of steps, up to this one.
    Steps(u64),
    /// A number of steps or a time.
    Interval,
    /// A range of positive numbers.
    Range,
    /// A number of members of a sweep.
    Members,
    /// A seed of random numbers.
    Seed,
    /// A part of a sweep.
    Part,
    /// A view by this name, or by two angles.
    View(&'static str),
    /// A joint with its value.
    Joint,
    /// A constant with its value.
    Constant,
    /// A name with a number.
    Assignment,
    /// A number.
    Number,
    /// A tolerance of angles.
    Tolerance,
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Expected::Positive => f.write_str("expected a number greater than zero"),
            Expected::NotNegative => f.write_str("expected a number, zero or greater"),
            Expected::Steps(most) => write!(f, "a whole number from 1 to {most} is needed"),
            Expected::Interval => {
                f.write_str("expected a number of steps, 1 or greater, or a time as in 0.01s")
            }
            Expected::Range => f.write_str("expected LOW,HIGH with 0 < LOW < HIGH, as in 0.1,100"),
            Expected::Members => f.write_str("expected a whole number from 1 to 2^63 - 1"),
            Expected::Seed => f.write_str("expected a whole number from 0 to 2^64 - 1"),
            Expected::Part => f.write_str("expected i/N with 1 ≤ i ≤ N, as in 3/16"),
            Expected::View(name) => {
                write!(
                    f,
                    "expected `{name}`, or two angles in degrees as in -60,20"
                )
            }
            Expected::Joint => f.write_str("write JOINT=VALUE, as in `--lock finger_joint=0.04`"),
            Expected::Constant => f.write_str("write NAME=VALUE, as in `--const n=100`"),
            Expected::Assignment => f.write_str("write NAME = VALUE, as in `--rate \"v = 0.5\"`"),
            Expected::Number => f.write_str("not a number"),
            Expected::Tolerance => f.write_str("not between 0 and 0.1"),
        }
    }
}

impl std::error::Error for Expected {}

/// Parses a number greater than zero.
pub fn positive(text: &str) -> Result<f64, Expected> {
    let number = text.parse::<f64>().ok();
    let number = number.filter(|number| number.is_finite() && *number > 0.0);
    number.ok_or(Expected::Positive)
}

/// Parses a number that is not negative.
pub fn rate(text: &str) -> Result<f64, Expected> {
    let number = text.parse::<f64>().ok();
    let number = number.filter(|number| number.is_finite() && *number >= 0.0);
    number.ok_or(Expected::NotNegative)
}

/// Parses a name and a finite number, as in `v = 0.5`.
pub fn assignment(text: &str) -> Result<(String, f64), Expected> {
    let (name, value) = text.split_once('=').ok_or(Expected::Assignment)?;
    let value = value
        .trim()
        .parse()
        .ok()
        .filter(|value: &f64| value.is_finite());
    Ok((name.trim().into(), value.ok_or(Expected::Assignment)?))
}
