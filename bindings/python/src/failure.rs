//! Python exceptions for failures.

use hamel_engine::Error;
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

/// Returns the exception of an error.
pub fn raised(error: Error) -> PyErr {
    HamelError::new_err(error.to_string())
}
