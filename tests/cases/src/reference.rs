//! The reference solutions of `tests/reference/`, and the error of a run.

use hamel::{Method, State, StepError, System, integrate};
use serde_json::Value;

/// A reference solution; see the README next to the files.
pub struct Reference(Value);

impl Reference {
    /// Reads `tests/reference/{name}.json`.
    ///
    /// # Panics
    /// If there is no such file, or it is not JSON.
    pub fn read(name: &str) -> Self {
        let path = format!("{}/../reference/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        Self(serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}")))
    }

    /// Returns the N numbers of a parameter, matrices row by row; zeros if the file does not list it.
    pub fn parameter<const N: usize>(&self, name: &str) -> [f64; N] {
        match &self.0["parameters"][name] {
            Value::Null => [0.0; N],
            value => numbers(value, name),
        }
    }

    /// Returns the rows of a matrix parameter.
    pub fn matrix(&self, name: &str) -> [[f64; 3]; 3] {
        rows(self.parameter(name))
    }

    /// Returns |g| of a gravity that points down.
    ///
    /// # Panics
    /// If it does not point down, as the models of the cases assume.
    pub fn gravity(&self) -> f64 {
        let [x, y, z] = self.parameter("g");
        assert_eq!([x, y], [0.0; 2], "gravity points down");
        -z
    }

    /// Returns a field of the state at t = 0.
    pub fn initial<const N: usize>(&self, name: &str) -> [f64; N] {
        numbers(&self.0["initial"][name], name)
    }

    /// Returns a constant of the case.
    pub fn extra(&self, name: &str) -> f64 {
        let [value] = numbers(&self.0["extra"][name], name);
        value
    }

    /// Returns the listed times, in order.
    pub fn times(&self) -> Vec<f64> {
        let samples = self.0["samples"].as_array().expect("a list of samples");
        let times = samples.iter().map(|sample| {
            let [t] = numbers(&sample["t"], "t");
            t
        });
        times.collect()
    }

    /// Returns a field of the state at a listed time.
    ///
    /// # Panics
    /// If the time or the field is not listed.
    pub fn sample<const N: usize>(&self, t: f64, name: &str) -> [f64; N] {
        let list = self.entries(t, name);
        list.try_into()
            .unwrap_or_else(|list| panic!("{name}: {N} numbers expected, found {list:?}"))
    }

    /// Returns a field of any length.
    ///
    /// # Panics
    /// If the time or the field is not listed.
    pub fn entries(&self, t: f64, name: &str) -> Vec<f64> {
        let samples = self.0["samples"].as_array().expect("a list of samples");
        let sample = samples
            .iter()
            .find(|sample| numbers(&sample["t"], "t") == [t])
            .unwrap_or_else(|| panic!("no sample at t = {t}"));
        list(&sample[name])
    }
}

/// Parses N nested decimal strings.
fn numbers<const N: usize>(value: &Value, name: &str) -> [f64; N] {
    list(value)
        .try_into()
        .unwrap_or_else(|list| panic!("{name}: {N} numbers expected, found {list:?}"))
}

/// Parses nested decimal strings.
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

/// Groups nine entries, given row by row, into rows.
pub fn rows(m: [f64; 9]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| m[3 * i + j]))
}

/// Returns the Frobenius norm of the difference.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt()
}

/// Returns the largest difference over max(1, the largest entry of `b`).
pub fn relative(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let scale = b.iter().fold(1.0_f64, |m, b| m.max(b.abs()));
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max) / scale
}

/// Integrates `state` to `until` in `n` steps, without inputs.
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

/// Returns the observed orders between consecutive errors, each for half the previous step.
pub fn slopes(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}
