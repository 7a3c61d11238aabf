//! The reference solutions of `tests/reference/`, and how far a run is from them.

use hamel::{Method, State, StepError, System, integrate};
use serde_json::Value;

/// A reference solution: see the README beside the files.
pub struct Reference(Value);

impl Reference {
    /// Reads `tests/reference/{name}.json`.
    ///
    /// # Panics
    /// When there is no such file, or it is not JSON: a test cannot go on.
    pub fn read(name: &str) -> Self {
        let path = format!("{}/../reference/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        Self(serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}")))
    }

    /// A parameter of N numbers, matrices row by row; zeros where the file does not list it.
    pub fn parameter<const N: usize>(&self, name: &str) -> [f64; N] {
        match &self.0["parameters"][name] {
            Value::Null => [0.0; N],
            value => numbers(value, name),
        }
    }

    /// A parameter that is a matrix, as rows.
    pub fn matrix(&self, name: &str) -> [[f64; 3]; 3] {
        rows(self.parameter(name))
    }

    /// |g|, of gravity that points down.
    ///
    /// # Panics
    /// When it points elsewhere: the models of the cases have it point down.
    pub fn gravity(&self) -> f64 {
        let [x, y, z] = self.parameter("g");
        assert_eq!([x, y], [0.0; 2], "gravity points down");
        -z
    }

    /// A field of the state at t = 0.
    pub fn initial<const N: usize>(&self, name: &str) -> [f64; N] {
        numbers(&self.0["initial"][name], name)
    }

    /// A constant of the case.
    pub fn extra(&self, name: &str) -> f64 {
        let [value] = numbers(&self.0["extra"][name], name);
        value
    }

    /// The times listed, in order.
    pub fn times(&self) -> Vec<f64> {
        let samples = self.0["samples"].as_array().expect("a list of samples");
        let times = samples.iter().map(|sample| {
            let [t] = numbers(&sample["t"], "t");
            t
        });
        times.collect()
    }

    /// A field of the state at one of the times listed.
    ///
    /// # Panics
    /// When the time or the field is not listed.
    pub fn sample<const N: usize>(&self, t: f64, name: &str) -> [f64; N] {
        let list = self.entries(t, name);
        list.try_into()
            .unwrap_or_else(|list| panic!("{name}: {N} numbers expected, found {list:?}"))
    }

    /// The same, of any length.
    ///
    /// # Panics
    /// When the time or the field is not listed.
    pub fn entries(&self, t: f64, name: &str) -> Vec<f64> {
        let samples = self.0["samples"].as_array().expect("a list of samples");
        let sample = samples
            .iter()
            .find(|sample| numbers(&sample["t"], "t") == [t])
            .unwrap_or_else(|| panic!("no sample at t = {t}"));
        list(&sample[name])
    }
}

/// N decimal strings, however nested.
fn numbers<const N: usize>(value: &Value, name: &str) -> [f64; N] {
    list(value)
        .try_into()
        .unwrap_or_else(|list| panic!("{name}: {N} numbers expected, found {list:?}"))
}

/// Decimal strings, however nested.
fn list(value: &Value) -> Vec<f64> {
    fn collect(value: &Value, into: &mut Vec<f64>) {
        match value {
            Value::String(text) => into.push(text.parse().expect("a decimal number")),
            Value::Array(items) => items.iter().for_each(|item| collect(item, into)),
            _ => {}
        }
    }
    let mut list = Vec::new();
    collect(value, &mut list);
    list
}

/// Nine entries, row by row, as rows.
pub fn rows(m: [f64; 9]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| m[3 * i + j]))
}

/// Frobenius norm of the difference.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt()
}

/// Largest difference, over max(1, the largest entry of `b`).
pub fn relative(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let scale = b.iter().fold(1.0_f64, |m, b| m.max(b.abs()));
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max) / scale
}

/// `state` moved to `until` in `n` steps, without inputs.
///
/// # Errors
/// Those of [`integrate()`].
pub fn run<Sys: System, M: Method<Sys>>(
    system: &Sys,
    method: M,
    mut state: State<Sys>,
    until: f64,
    n: u32,
) -> Result<State<Sys>, StepError> {
    let step = (until - state.t) / f64::from(n);
    let none = |_, _: &_, _: &_| system.zero_inputs();
    integrate(system, method, &mut state, step, until, none, |_| {})?;
    Ok(state)
}

/// The orders seen between neighbouring errors, each for half the step of the one before.
pub fn slopes(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}
