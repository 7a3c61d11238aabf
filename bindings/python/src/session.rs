//! A description, and all requests to it.

use crate::failure::{HamelError, SingularError, raised};
use crate::function::Function;
use crate::law::{Raised, Signals, stop};
use crate::rows::{Rows, common, entries_last, given, next, together, unknown};
use crate::run;
use crate::warnings::Warnings;
use hamel_cli::{Failure, Format, reports};
use hamel_codegen::urdf::Mimic;
use hamel_engine::{Names, OpenOptions, State, TrimOptions};
use numpy::ndarray::{ArrayViewD, IxDyn};
use numpy::{
    Complex64, PyArray1, PyArrayDyn, PyArrayMethods, PyReadonlyArray1, PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyTuple};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Runs the command line, whose first word is the name of the program, and returns the exit status.
#[pyfunction]
pub fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| hamel_cli::command(words))
}

/// Runs the command line, and raises an exception if it fails.
#[pyfunction]
pub fn asked(py: Python<'_>, words: Vec<OsString>) -> PyResult<()> {
    let thrown = Raised::default();
    let stop = stop(&thrown);
    let done = py.detach(|| hamel_cli::asked(words, Some(&stop)));
    match thrown.take() {
        Some(error) => Err(error),
        None => done.map_err(|failure| match failure {
            Failure::Engine(error) => raised(error),
            other => {
                let text = other.render(false);
                let text = text.trim_end();
                HamelError::new_err(text.strip_prefix("error: ").unwrap_or(text).to_string())
            }
        }),
    }
}

/// Decodes the bytes of a file.
#[pyfunction]
pub fn decoded(name: &str, bytes: Vec<u8>) -> PyResult<String> {
    hamel_engine::source::decoded(name, bytes).map_err(raised)
}

/// A description with its derived equations of motion.
#[pyclass(frozen, module = "hamel._hamel")]
pub struct Session(Arc<hamel_engine::Session>);

/// Numbers of a state from Python: x, ξ and z, u, parameters.
type Numbers<'py> = (
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
);

/// Numbers of a state to Python, in the same order.
type Arrays<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
);

/// x, ξ and the derivatives of a step.
type Stepped<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArrayDyn<f64>>,
);

/// x and ξ of many states.
type Ends<'py> = (Bound<'py, PyArrayDyn<f64>>, Bound<'py, PyArrayDyn<f64>>);

/// Names of all entries, and groups of entries: name, index of the first entry, number of entries.
type Named = (Vec<String>, Vec<(String, usize, usize)>);

fn arrays<'py>(py: Python<'py>, state: &State) -> Arrays<'py> {
    let array = |numbers: &[f64]| PyArray1::from_slice(py, numbers);
    (
        array(&state.x),
        array(&state.xi),
        array(&state.u),
        array(&state.params),
    )
}

fn named(names: Names) -> Named {
    (names.entries, names.groups)
}

/// Checks the length of a step; a negative one goes back in time.
fn length(h: f64) -> PyResult<()> {
    match h.is_finite() && h != 0.0 {
        true => Ok(()),
        false => Err(HamelError::new_err(format!(
            "`h` is a finite number other than 0, {h} was given"
        ))),
    }
}

/// Converts an object to a list of `length` finite numbers, for one state.
fn list(what: &str, length: usize, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let array = given(what, length, value)?;
    if array.ndim() > 1 {
        let shape = array.shape();
        return Err(PyValueError::new_err(format!(
            "{what} needs {length} entries and no other axes, this array has the shape {shape:?}"
        )));
    }
    let numbers: Vec<f64> = array.as_array().iter().copied().collect();
    match numbers.iter().position(|number| !number.is_finite()) {
        None => Ok(numbers),
        Some(place) => Err(HamelError::new_err(format!(
            "{what} needs finite numbers, the entry at the index {place} is {}",
            numbers[place]
        ))),
    }
}

/// Converts rows to a matrix.
fn matrix<'py>(
    py: Python<'py>,
    rows: &[Vec<f64>],
    columns: usize,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let flat: Vec<f64> = rows.iter().flatten().copied().collect();
    PyArray1::from_vec(py, flat).reshape(IxDyn(&[rows.len(), columns]))
}

impl Session {
    /// Converts arrays to a state; checks lengths, and that all numbers are finite.
    fn of(&self, py: Python<'_>, (x, xi, u, params): Numbers<'_>) -> PyResult<State> {
        let start = self.0.start();
        let parts = [
            ("`x` of a state", x, start.x.len()),
            ("`xi` of a state", xi, start.xi.len()),
            ("`u` of a state", u, start.u.len()),
            ("`parameters` of a state", params, start.params.len()),
        ];
        let mut errors = Vec::new();
        let [x, xi, u, params] = parts.map(|(what, array, length)| {
            list(what, length, &array).unwrap_or_else(|error| {
                errors.push(error);
                Vec::new()
            })
        });
        match errors.is_empty() {
            true => Ok(State { x, xi, u, params }),
            false => Err(together(py, errors)),
        }
    }
}

#[pymethods]
impl Session {
    /// Reads a text whose name is `path`, or the file at `path` if `text` is `None`; also returns the warnings.
    #[staticmethod]
    #[pyo3(signature = (path, text=None, *, constants=Vec::new(), floating=false, locks=Vec::new(), params=false, mimic=None, name=None, rounding=None))]
    fn open(
        py: Python<'_>,
        path: PathBuf,
        text: Option<String>,
        constants: Vec<(String, String)>,
        floating: bool,
        locks: Vec<(String, String)>,
        params: bool,
        mimic: Option<&str>,
        name: Option<String>,
        rounding: Option<f64>,
    ) -> PyResult<(Self, String)> {
        let mimic = match mimic {
            None => None,
            Some("follow") => Some(Mimic::Follow),
            Some("free") => Some(Mimic::Free),
            Some(other) => {
                let message = format!("`mimic` is \"follow\" or \"free\", not {other:?}");
                return Err(PyValueError::new_err(message));
            }
        };
        if let Some(other) = rounding.filter(|angle| !(0.0..=0.1).contains(angle)) {
            let message = format!("`rounding` is a number from 0 to 0.1, not {other}");
            return Err(HamelError::new_err(message));
        }
        let options = OpenOptions {
            floating,
            locks,
            params,
            mimic,
            name,
            rounding,
            constants,
        };
        let warnings = Arc::new(Warnings::default());
        let opened = py.detach(|| {
            let reporter = warnings.clone();
            match text {
                Some(text) => {
                    let name = path.to_string_lossy();
                    hamel_engine::Session::read(text, &name, &options, reporter)
                }
                None => hamel_engine::Session::open(Path::new(&path), &options, reporter),
            }
        });
        let session = opened.map_err(raised)?;
        Ok((Session(Arc::new(session)), warnings.take()))
    }

    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    #[getter]
    fn text(&self) -> &str {
        self.0.text()
    }

    fn coordinates(&self) -> Named {
        named(self.0.coordinates())
    }

    fn velocities(&self) -> Named {
        named(self.0.velocities())
    }

    fn inputs(&self) -> Named {
        named(self.0.inputs())
    }

    fn parameters(&self) -> Named {
        named(self.0.parameters())
    }

    fn outputs(&self) -> Vec<String> {
        self.0.outputs()
    }

    fn joints(&self) -> Vec<(String, usize, usize)> {
        self.0.joints()
    }

    fn frames(&self) -> Vec<String> {
        self.0.frames()
    }

    fn functions(&self) -> Vec<String> {
        self.0.functions()
    }

    /// Returns x, ξ, u and parameters of the description.
    fn start<'py>(&self, py: Python<'py>) -> Arrays<'py> {
        arrays(py, &self.0.start())
    }

    /// Returns the same with these parameters, changed by the values of a JSON text.
    fn state<'py>(
        &self,
        py: Python<'py>,
        params: PyReadonlyArray1<'py, f64>,
        json: &str,
    ) -> PyResult<Arrays<'py>> {
        let params = params.as_array().to_vec();
        let state = self.0.state(&params, json, "state").map_err(raised)?;
        Ok(arrays(py, &state))
    }

    /// Compiles a function with these parameters; `pickled` is the result of its `__reduce__`.
    fn function(
        &self,
        py: Python<'_>,
        name: &str,
        params: PyReadonlyArray1<'_, f64>,
        pickled: Py<PyTuple>,
    ) -> PyResult<Function> {
        let params = params.as_array().to_vec();
        py.detach(|| Function::new(&self.0, name, &params, pickled))
    }

    fn tables(&self, py: Python<'_>, of: Vec<String>, format: &str, all: bool) -> PyResult<String> {
        let format = match format {
            "text" => Format::Text,
            "markdown" => Format::Markdown,
            "latex" => Format::Latex,
            "json" => Format::Json,
            other => {
                let message = format!("no format is called {other:?}");
                return Err(PyValueError::new_err(message));
            }
        };
        py.detach(|| reports::tables(&self.0, &of, format, all))
            .map_err(raised)
    }

    /// Returns the output of `hamel eval`, as JSON.
    fn evaluate(&self, py: Python<'_>, state: Numbers<'_>) -> PyResult<String> {
        let state = self.of(py, state)?;
        let numbers = py.detach(|| self.0.evaluate(&state)).map_err(raised)?;
        serde_json::to_string(&numbers).map_err(|error| HamelError::new_err(error.to_string()))
    }

    /// Integrates the motion from a state.
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        state: Numbers<'py>,
        options: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyDict>> {
        run::simulate(py, &self.0, &self.of(py, state)?, options)
    }

    /// Returns x and ξ after a step from each of many states.
    #[pyo3(signature = (state, x, xi, u, h, method))]
    fn step<'py>(
        &self,
        py: Python<'py>,
        state: Numbers<'py>,
        x: Bound<'py, PyAny>,
        xi: Bound<'py, PyAny>,
        u: Bound<'py, PyAny>,
        h: f64,
        method: &str,
    ) -> PyResult<Ends<'py>> {
        let state = self.of(py, state)?;
        length(h)?;
        let lengths = [state.x.len(), state.xi.len(), state.u.len()];
        let (mut all, mut errors) = (Vec::new(), Vec::new());
        for ((name, array), length) in [("`x`", x), ("`xi`", xi), ("`u`", u)].iter().zip(lengths) {
            match given(name, length, array) {
                Ok(array) => all.push(array),
                Err(error) => errors.push(error),
            }
        }
        if !errors.is_empty() {
            return Err(together(py, errors));
        }
        let mut arrays: Vec<ArrayViewD<'_, f64>> = Vec::new();
        for array in &all {
            arrays.push(entries_last(array.as_array()));
        }
        let lead = common(arrays.iter().map(|array| array.shape()))?;
        let mut rows: Vec<Rows<'_>> = Vec::new();
        for array in &arrays {
            rows.push(Rows::new(array, &lead)?);
        }
        let [x_rows, xi_rows, u_rows] = rows.as_mut_slice() else {
            return Err(PyTypeError::new_err("expected x, xi and u"));
        };
        let (mut all_x, mut all_xi) = (unknown(&lead, lengths[0])?, unknown(&lead, lengths[1])?);
        let stepped = py.detach(|| -> PyResult<()> {
            let stepped = self.0.single_stepper(&state, method).map_err(raised)?;
            let signals = Signals::default();
            let mut place = vec![0; lead.len()];
            let ends = all_x
                .chunks_exact_mut(lengths[0].max(1))
                .zip(all_xi.chunks_exact_mut(lengths[1].max(1)));
            for (number, (end_x, end_xi)) in ends.enumerate() {
                let mut x = x_rows.at(number, &place).to_vec();
                let mut xi = xi_rows.at(number, &place).to_vec();
                let ended = stepped.step(&mut x, &mut xi, u_rows.at(number, &place), h);
                ended.map_err(|why| match place.as_slice() {
                    [] => SingularError::new_err(why.to_string()),
                    place => SingularError::new_err(format!("{why}, at the index {place:?}")),
                })?;
                signals.check()?;
                end_x.copy_from_slice(&x);
                end_xi.copy_from_slice(&xi);
                next(&mut place, &lead);
            }
            Ok(())
        });
        stepped?;
        let array = |numbers: Vec<f64>, length: usize| {
            let shape = [&lead[..], &[length]].concat();
            PyArray1::from_vec(py, numbers).reshape(IxDyn(&shape))
        };
        Ok((array(all_x, lengths[0])?, array(all_xi, lengths[1])?))
    }

    /// Returns x and ξ after a step from one state, and the derivatives of the step.
    #[pyo3(signature = (state, h, method))]
    fn step_slopes<'py>(
        &self,
        py: Python<'py>,
        state: Numbers<'py>,
        h: f64,
        method: &str,
    ) -> PyResult<Stepped<'py>> {
        let state = self.of(py, state)?;
        length(h)?;
        let stepped = py.detach(|| {
            let (varied, method) = self.0.sensitivity_stepper(&state, method).map_err(raised)?;
            let end = varied.step(&method, [&state.x, &state.xi, &state.u], h);
            end.map_err(|error| SingularError::new_err(error.to_string()))
        });
        let (x, xi, slopes) = stepped?;
        let columns = slopes.first().map_or(0, Vec::len);
        Ok((
            PyArray1::from_vec(py, x),
            PyArray1::from_vec(py, xi),
            matrix(py, &slopes, columns)?,
        ))
    }

    fn linearize<'py>(
        &self,
        py: Python<'py>,
        state: Numbers<'py>,
        full: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let state = self.of(py, state)?;
        let linear = py
            .detach(|| self.0.linearize(&state, full))
            .map_err(raised)?;
        let Some(eigenvalues) = &linear.eigenvalues else {
            return Err(HamelError::new_err(
                "the eigenvalues were not found: the QR algorithm does not converge for this A",
            ));
        };
        let eigenvalues = eigenvalues.iter().map(|&(re, im)| Complex64::new(re, im));
        let all = PyDict::new(py);
        let (n, m) = (linear.states.len(), linear.inputs.len());
        all.set_item("A", matrix(py, &linear.a, n)?)?;
        all.set_item("B", matrix(py, &linear.b, m)?)?;
        all.set_item("C", matrix(py, &linear.c, n)?)?;
        all.set_item("D", matrix(py, &linear.d, m)?)?;
        all.set_item("states", linear.states)?;
        all.set_item("inputs", linear.inputs)?;
        all.set_item("outputs", linear.outputs)?;
        all.set_item("eigenvalues", PyArray1::from_iter(py, eigenvalues))?;
        all.set_item("xi_dot", PyArray1::from_vec(py, linear.xi_dot))?;
        Ok(all)
    }

    /// Finds an equilibrium or a steady motion; `rates` are entries of ξ and z with their rates.
    fn trim<'py>(
        &self,
        py: Python<'py>,
        state: Numbers<'py>,
        steady: bool,
        free: Vec<String>,
        fix: Vec<String>,
        rates: Vec<(String, f64)>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let state = self.of(py, state)?;
        let options = TrimOptions {
            steady,
            free,
            fix,
            rates,
        };
        let trim = py
            .detach(|| self.0.trim(&state, &options))
            .map_err(raised)?;
        let stability = trim
            .spectrum
            .as_ref()
            .map(|found| found.stability.to_string());
        let values = trim.spectrum.iter().flat_map(|found| &found.values);
        let values = values.map(|&(re, im)| Complex64::new(re, im));
        let eigenvalues = PyArray1::from_iter(py, values);
        let undetermined = trim.undetermined.into_iter().map(|direction| direction.0);
        let undetermined: Vec<Bound<'py, PyDict>> = undetermined
            .map(|entries| entries.into_py_dict(py))
            .collect::<PyResult<_>>()?;
        let all = PyDict::new(py);
        let State { x, xi, u, params } = trim.state;
        let state = [x, xi, u, params].map(|part| PyArray1::from_vec(py, part));
        all.set_item("state", PyTuple::new(py, state)?)?;
        all.set_item("xi_dot", PyArray1::from_vec(py, trim.xi_dot))?;
        all.set_item("residual", trim.residual)?;
        all.set_item("steps", trim.steps)?;
        all.set_item("neighbour", trim.neighbour)?;
        all.set_item("unknowns", trim.unknowns)?;
        all.set_item("conditions", trim.conditions)?;
        all.set_item("rank", trim.rank)?;
        all.set_item("undetermined", undetermined)?;
        all.set_item("stability", stability)?;
        all.set_item("eigenvalues", eigenvalues)?;
        Ok(all)
    }

    /// Returns the base parameters in four formats.
    fn base_parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        use hamel_codegen::tables::regressor::{json, latex, markdown, text};
        let base = py.detach(|| self.0.base_parameters()).map_err(raised)?;
        let all = PyDict::new(py);
        all.set_item("json", json(&base).to_string())?;
        all.set_item("text", text(&base))?;
        all.set_item("latex", latex(&base))?;
        all.set_item("markdown", markdown(&base))?;
        Ok(all)
    }
}
