//! Failures as exceptions of Python.

use hamel_engine::Error;
use pyo3::exceptions::{PyArithmeticError, PyValueError};
use pyo3::{PyErr, create_exception};

create_exception!(
    hamel,
    HamelError,
    PyValueError,
    "What is wrong with a description or with what was asked of it, with its place in the source."
);
create_exception!(
    hamel,
    SingularError,
    PyArithmeticError,
    "A function has no value: M is not positive definite there, or constraints depend on one another."
);

/// The exception of an error.
pub fn raised(error: Error) -> PyErr {
    HamelError::new_err(error.to_string())
}
