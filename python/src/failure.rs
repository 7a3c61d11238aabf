//! Failures as exceptions of Python.

use hamel_cli::Failure;
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

/// The exception of a failure.
pub fn raised(failure: Failure) -> PyErr {
    let text = failure.text();
    let text = text.trim_end();
    HamelError::new_err(text.strip_prefix("error: ").unwrap_or(text).to_string())
}
