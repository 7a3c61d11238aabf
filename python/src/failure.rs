//! Python exceptions for failures.

use hamel_cli::Failure;
use pyo3::exceptions::{PyArithmeticError, PyValueError};
use pyo3::{PyErr, create_exception};

create_exception!(
    hamel,
    HamelError,
    PyValueError,
    "Raised for an error in a description or a request, with its place in the source."
);
create_exception!(
    hamel,
    SingularError,
    PyArithmeticError,
    "Raised if a function has no value: M is not positive definite, or constraints are dependent."
);

/// Converts a failure to an exception.
pub fn raised(failure: Failure) -> PyErr {
    let text = failure.text();
    let text = text.trim_end();
    HamelError::new_err(text.strip_prefix("error: ").unwrap_or(text).to_string())
}
