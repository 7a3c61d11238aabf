//! Functions of (t, x, ξ) in Python: those that give inputs, and those that are watched for events.

use crate::rows::numbers;
use hamel_engine::run::{Control, Gauge};
use hamel_engine::{Law, Stop};
use numpy::{PyArray1, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How often Python is asked during long work whether it is interrupted.
const PATIENCE: Duration = Duration::from_millis(50);

/// The first exception of a function, or that of an interruption.
#[derive(Clone, Default)]
pub struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    /// The exception, where there was one.
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

/// A function in Python as a law. Where it raises an exception, inputs are NaN from then on, which ends the run, and the
/// exception is kept.
pub fn law(function: Py<PyAny>, raised: &Raised) -> Law {
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
    let control: Arc<Control> = Arc::new(control);
    Law(control)
}

/// What gives up a run: an exception, or an interruption of Python, by Ctrl-C for one, which is kept as one.
pub fn stop(raised: &Raised) -> Stop {
    let (raised, signals) = (raised.clone(), Signals::default());
    Stop(Arc::new(move || {
        if let Err(error) = signals.check() {
            raised.set(error);
        }
        raised.is_set()
    }))
}

/// Signals that Python has got, which it is asked for from time to time.
pub struct Signals(Mutex<Instant>);

impl Default for Signals {
    fn default() -> Self {
        Signals(Mutex::new(Instant::now()))
    }
}

impl Signals {
    /// Runs what Python has to say of its signals, where it was not asked just now.
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

/// A function in Python that gives a number. Where it raises an exception, it has no value from then on, which ends the run,
/// and the exception is kept.
pub fn gauge(name: &str, function: Py<PyAny>, raised: &Raised) -> Arc<Gauge> {
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
                    PyTypeError::new_err(format!("the event `{name}` is a number: {why}"))
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
    // One input may be a number alone.
    if let (1, Ok(number)) = (length, given.extract::<f64>()) {
        return Ok(vec![number]);
    }
    let array = numbers("what the function gives as inputs", &given)?;
    let list: Vec<f64> = array.as_array().iter().copied().collect();
    if array.ndim() != 1 || list.len() != length {
        return Err(PyValueError::new_err(format!(
            "inputs are {length} numbers, the function has given {}",
            given.repr()?
        )));
    }
    Ok(list)
}
