//! Reference solutions as files: states at listed times, as decimal strings.

use serde_json::Value;
use std::error::Error;
use std::fmt;

/// A reference solution: a JSON object with `name`, `parameters`, `initial`, `samples`, and further members for
/// readers. Numbers are strings or numbers, matrices lists of rows.
#[derive(Clone, Debug)]
pub struct Solution(Value);

/// The defect of a reference solution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SolutionError(String);

impl fmt::Display for SolutionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Error for SolutionError {}

impl Solution {
    /// Parses a text.
    ///
    /// # Errors
    /// If it is not JSON, or has no `initial` state or no `samples` with a time.
    pub fn parse(text: &str) -> Result<Self, SolutionError> {
        let value: Value = serde_json::from_str(text)
            .map_err(|error| SolutionError(format!("not valid JSON: {error}")))?;
        let solution = Self(value);
        if !solution.0["initial"].is_object() {
            return Err(SolutionError("no state `initial`".into()));
        }
        if solution.times().is_empty() {
            return Err(SolutionError("no `samples` with a time `t`".into()));
        }
        Ok(solution)
    }

    /// Returns a text member, or an empty string.
    pub fn text(&self, name: &str) -> &str {
        self.0[name].as_str().unwrap_or_default()
    }

    /// Returns the estimated error of the solution.
    pub fn estimated_error(&self) -> Option<f64> {
        numbers(&self.0["estimated_error"])?.first().copied()
    }

    /// Returns the numbers of a parameter, matrices by rows.
    pub fn parameter(&self, name: &str) -> Option<Vec<f64>> {
        numbers(&self.0["parameters"][name])
    }

    /// Returns the names of the fields of the state.
    pub fn fields(&self) -> Vec<String> {
        let members = self.0["initial"].as_object();
        members.map_or_else(Vec::new, |members| members.keys().cloned().collect())
    }

    /// Returns a field of the state at t = 0, matrices by rows.
    pub fn initial(&self, name: &str) -> Option<Vec<f64>> {
        numbers(&self.0["initial"][name])
    }

    /// Returns the times of the samples, in order.
    pub fn times(&self) -> Vec<f64> {
        self.samples().filter_map(time).collect()
    }

    /// Returns a field of the state at a listed time.
    pub fn sample(&self, t: f64, name: &str) -> Option<Vec<f64>> {
        let sample = self.samples().find(|sample| time(sample) == Some(t))?;
        numbers(&sample[name])
    }

    fn samples(&self) -> impl Iterator<Item = &Value> {
        self.0["samples"].as_array().into_iter().flatten()
    }
}

fn time(sample: &Value) -> Option<f64> {
    numbers(&sample["t"])?.first().copied()
}

/// Flattens the numbers of a nested value; `None` if it contains anything else.
fn numbers(value: &Value) -> Option<Vec<f64>> {
    match value {
        Value::Number(number) => Some(vec![number.as_f64()?]),
        Value::String(text) => Some(vec![text.parse().ok()?]),
        Value::Array(items) => {
            let parts: Option<Vec<Vec<f64>>> = items.iter().map(numbers).collect();
            Some(parts?.concat())
        }
        _ => None,
    }
}

/// Returns the largest difference over max(1, the largest entry of `b`); infinity if the lengths differ.
pub fn relative(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    let scale = b.iter().fold(1.0_f64, |most, b| most.max(b.abs()));
    largest(a.iter().zip(b).map(|(a, b)| (a - b).abs())) / scale
}

/// Returns the Frobenius norm of the difference; infinity if the lengths differ.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
    squares.sum::<f64>().sqrt()
}

/// Returns the largest value, at least 0; NaN if one is NaN.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    let more = |most: f64, value: f64| {
        if most.is_nan() || value.is_nan() {
            f64::NAN
        } else {
            most.max(value)
        }
    };
    values.into_iter().fold(0.0, more)
}

#[cfg(test)]
mod tests {
    use super::{Solution, distance, largest, relative};

    #[test]
    fn strings_and_rows_are_numbers() {
        let text = r#"{"name": "a", "estimated_error": "1e-40",
            "parameters": {"J": [["1", "0"], ["0", "2.5"]], "m": 3},
            "initial": {"R": [["1", "0"], ["0", "1"]], "omega": ["7", "8"]},
            "samples": [{"t": "0.5", "R": [["0", "1"], ["-1", "0"]], "omega": ["x"]}]}"#;
        let solution = Solution::parse(text).expect("a solution");
        assert_eq!(solution.parameter("J"), Some(vec![1.0, 0.0, 0.0, 2.5]));
        assert_eq!(solution.parameter("m"), Some(vec![3.0]));
        assert_eq!(solution.parameter("g"), None);
        assert_eq!(solution.fields(), ["R", "omega"]);
        assert_eq!(solution.times(), [0.5]);
        assert_eq!(solution.sample(0.5, "R"), Some(vec![0.0, 1.0, -1.0, 0.0]));
        assert_eq!(solution.sample(0.5, "omega"), None);
        assert_eq!(solution.sample(0.6, "R"), None);
        assert_eq!(solution.estimated_error(), Some(1e-40));
    }

    #[test]
    fn what_is_missing_is_said() {
        for (text, word) in [
            ("{", "not valid JSON"),
            ("{}", "initial"),
            (r#"{"initial": {}, "samples": []}"#, "samples"),
        ] {
            let error = Solution::parse(text).expect_err("no solution").to_string();
            assert!(error.contains(word), "{error}");
        }
    }

    #[test]
    fn distances() {
        assert_eq!(relative(&[1.0, 12.0], &[1.0, 10.0]), 0.2);
        assert_eq!(relative(&[0.5], &[0.25]), 0.25);
        assert_eq!(distance(&[3.0, 0.0], &[0.0, 4.0]), 5.0);
        assert_eq!(relative(&[1.0], &[]), f64::INFINITY);
        assert!(largest([1.0, f64::NAN, 2.0]).is_nan());
    }
}
