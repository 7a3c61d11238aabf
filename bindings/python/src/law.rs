//! Python functions of (t, x, ξ), which supply inputs or are watched for events.

use crate::rows::numbers;
use hamel_engine::run::{ControlFunction, EventFunction};
use hamel_engine::{CancellationToken, ControlLaw};
use numpy::{PyArray1, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time between two checks of Python's signals during long computations.
const PATIENCE: Duration = Duration::from_millis(50);

/// First exception raised by a function or by an interruption.
#[derive(Clone, Default)]
pub struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    /// Takes the exception, if there is one.
    pub fn take(&self) -> Option<PyErr> {
        let mut raised = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        raised.take()
    }

    fn is_set(&self) -> bool {
        let raised = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        raised.is_some()
    }

    fn set(&self, error: PyErr) {
        let mut raised = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        raised.get_or_insert(error);
    }
}

/// Converts a Python function to a law. If it raises an exception, the exception is kept, and inputs are NaN from then
/// on, which ends the run.
pub fn law(function: Py<PyAny>, raised: &Raised) -> ControlLaw {
    let raised = raised.clone();
    let control = move |t: f64, x: &[f64], xi: &[f64], u: &mut [f64]| {
        let given = match raised.is_set() {
            true => None,
            false => Python::attach(|py| {
                py.check_signals()
                    .and_then(|()| called(py, &function, (t, x, xi), u.len()))
                    .map_err(|error| raised.set(error))
                    .ok()
            }),
        };
        match given {
            Some(given) => u.copy_from_slice(&given),
            None => u.fill(f64::NAN),
        }
    };
    let control: Arc<ControlFunction> = Arc::new(control);
    ControlLaw(control)
}

/// Cancels a run after an exception, or after an interruption of Python such as Ctrl-C, whose exception is kept.
pub fn stop(raised: &Raised) -> CancellationToken {
    let (raised, signals) = (raised.clone(), Signals::default());
    CancellationToken(Arc::new(move || {
        if let Err(error) = signals.check() {
            raised.set(error);
        }
        raised.is_set()
    }))
}

/// Periodic check of Python's signals.
pub struct Signals(Mutex<Instant>);

impl Default for Signals {
    fn default() -> Self {
        Signals(Mutex::new(Instant::now()))
    }
}

impl Signals {
    /// Runs Python's signal handlers, unless the last check was less than `PATIENCE` ago.
    pub fn check(&self) -> PyResult<()> {
        let mut last = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if last.elapsed() < PATIENCE {
            return Ok(());
        }
        *last = Instant::now();
        drop(last);
        Python::attach(|py| py.check_signals())
    }
}

/// Converts a Python function to a watched quantity. If it raises an exception, the exception is kept, and the quantity
/// is NaN from then on, which ends the run.
pub fn gauge(name: &str, function: Py<PyAny>, raised: &Raised) -> Arc<EventFunction> {
    let (name, raised) = (name.to_string(), raised.clone());
    Arc::new(move |t: f64, x: &[f64], xi: &[f64]| {
        if raised.is_set() {
            return f64::NAN;
        }
        Python::attach(|py| {
            let number = |x, xi| -> PyResult<f64> {
                py.check_signals()?;
                let (x, xi) = (PyArray1::from_slice(py, x), PyArray1::from_slice(py, xi));
                let given = function.bind(py).call1((t, x, xi))?;
                given.extract().map_err(|why: PyErr| {
                    let why = why.value(py);
                    PyTypeError::new_err(format!("the event `{name}` must return a number: {why}"))
                })
            };
            number(x, xi).unwrap_or_else(|error| {
                raised.set(error);
                f64::NAN
            })
        })
    })
}

fn called(
    py: Python<'_>,
    function: &Py<PyAny>,
    (t, x, xi): (f64, &[f64], &[f64]),
    length: usize,
) -> PyResult<Vec<f64>> {
    let x = PyArray1::from_slice(py, x);
    let xi = PyArray1::from_slice(py, xi);
    let given = function.bind(py).call1((t, x, xi))?;
    // A single input may be a scalar.
    if let (1, Ok(number)) = (length, given.extract::<f64>()) {
        return Ok(vec![number]);
    }
    let array = numbers("the result of the input function", &given)?;
    let list: Vec<f64> = array.as_array().iter().copied().collect();
    if array.ndim() != 1 || list.len() != length {
        return Err(PyValueError::new_err(format!(
            "the input function must return {length} numbers, it returned {}",
            given.repr()?
        )));
    }
    Ok(list)
}
