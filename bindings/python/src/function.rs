//! Generated functions, called from Python with arrays.

use crate::failure::{SingularError, raised};
use crate::rows::{Given, Rows, common, entries_last, given, together, unknown};
use crate::states::States;
use hamel_codegen::program::{Argument, Cause, Shape};
use hamel_engine::{Function as Compiled, Session};
use hamel_native::Constants;
use numpy::ndarray::{ArrayViewD, IxDyn};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

// Python shows the documentation of the generated function, from `__doc__`.
#[allow(missing_docs)]
#[pyclass(frozen, module = "hamel")]
pub struct Function {
    session: Arc<Session>,
    compiled: Compiled,
    /// Parameters with all values that depend on them alone, or the reason why there are none.
    constants: Result<Constants, Cause>,
    /// Result of `__reduce__`: a Python function and its arguments, which restore this function.
    pickled: Py<PyTuple>,
}

/// Name of an argument in Python.
fn name(argument: Argument) -> &'static str {
    match argument {
        Argument::Coordinates => "x",
        Argument::Velocities => "xi",
        Argument::Accelerations => "xi_dot",
        Argument::Momenta => "p",
        Argument::Inputs => "u",
    }
}

/// Shape of a result as lengths of axes.
pub fn axes(shape: Shape) -> Vec<usize> {
    match shape {
        Shape::Scalar => Vec::new(),
        Shape::Vector(n) => vec![n],
        Shape::Matrix(rows, columns) => vec![rows, columns],
    }
}

impl Function {
    /// Compiles a function by its name, with these parameters.
    pub fn new(
        session: &Arc<Session>,
        name: &str,
        params: &[f64],
        pickled: Py<PyTuple>,
    ) -> PyResult<Self> {
        let compiled = session.function(name).map_err(raised)?;
        Ok(Function {
            constants: compiled.constants(params),
            session: Arc::clone(session),
            compiled,
            pickled,
        })
    }

    fn singular(&self, cause: Cause, place: &[usize]) -> PyErr {
        let why = self.session.cause_message(cause);
        SingularError::new_err(match place {
            [] => why,
            place => format!("{why}, at the index {place:?}"),
        })
    }

    /// Matches positional and keyword arguments with the arguments of the function.
    fn given<'py>(
        &self,
        args: &Bound<'py, PyTuple>,
        kwargs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Vec<(Argument, Given<'py>)>> {
        let own = &self.compiled.name;
        let wanted = &self.compiled.arguments;
        let signature = || {
            let names: Vec<&str> = wanted.iter().map(|argument| name(*argument)).collect();
            format!("{own}({})", names.join(", "))
        };
        if args.len() > wanted.len() {
            let message = format!("{} was called with {} arrays", signature(), args.len());
            return Err(PyTypeError::new_err(message));
        }
        for key in kwargs.into_iter().flat_map(|all| all.keys()) {
            let key: String = key.extract()?;
            let place = wanted.iter().position(|argument| name(*argument) == key);
            if place.is_none_or(|place| place < args.len()) {
                let message = match place {
                    Some(_) => format!("{} got `{key}` twice", signature()),
                    None => format!("{} takes no `{key}`", signature()),
                };
                return Err(PyTypeError::new_err(message));
            }
        }
        let (mut all, mut errors) = (Vec::new(), Vec::new());
        for (place, &argument) in wanted.iter().enumerate() {
            let length = self.compiled.length(argument);
            let value = match (args.get_item(place), kwargs) {
                (Ok(value), _) => Some(value),
                (Err(_), Some(kwargs)) => kwargs.get_item(name(argument))?,
                (Err(_), None) => None,
            };
            let what = format!("`{}` of {}", name(argument), signature());
            match value.map(|value| given(&what, length, &value)) {
                Some(Ok(array)) => all.push((argument, array)),
                Some(Err(error)) => errors.push(error),
                // An argument without entries may be omitted.
                None if length == 0 => {}
                None => {
                    let message = format!(
                        "{} was called without `{}` (length {length})",
                        signature(),
                        name(argument)
                    );
                    errors.push(PyTypeError::new_err(message));
                }
            }
        }
        match errors.is_empty() {
            true => Ok(all),
            false => Err(together(args.py(), errors)),
        }
    }
}

#[pymethods]
impl Function {
    /// Name of the function.
    #[getter]
    fn name(&self) -> &str {
        &self.compiled.name
    }

    #[getter]
    fn __name__(&self) -> &str {
        &self.compiled.name
    }

    #[getter]
    fn __doc__(&self) -> String {
        let arguments = self.compiled.arguments.iter();
        let arguments = arguments.map(|&argument| {
            let length = self.compiled.length(argument);
            format!("{}: (…, {length})", name(argument))
        });
        let arguments: Vec<String> = arguments.collect();
        let axes: Vec<String> = axes(self.compiled.shape)
            .iter()
            .map(usize::to_string)
            .collect();
        format!(
            "{}({}) -> ({})\n\n{}",
            self.compiled.name,
            arguments.join(", "),
            [vec!["…".to_string()], axes].concat().join(", "),
            self.compiled.docs
        )
    }

    /// Names of the arguments, in order.
    #[getter]
    fn arguments(&self) -> Vec<&'static str> {
        let arguments = self.compiled.arguments.iter();
        arguments.map(|&argument| name(argument)).collect()
    }

    /// Shape of the result for one state.
    #[getter]
    fn shape(&self, py: Python<'_>) -> PyResult<Py<PyTuple>> {
        Ok(PyTuple::new(py, axes(self.compiled.shape))?.unbind())
    }

    fn __reduce__(&self, py: Python<'_>) -> Py<PyTuple> {
        self.pickled.clone_ref(py)
    }

    fn __repr__(&self) -> String {
        let names = self.arguments().join(", ");
        format!(
            "<function {}({names}) of {}>",
            self.compiled.name,
            self.session.name()
        )
    }

    /// Evaluate the function at one state, or at many along the first axes of the arrays.
    ///
    /// Parameters
    /// ----------
    /// *args : array_like
    ///     The `arguments`, by position or by keyword, with the entries of one state along the last axis.
    /// parameters : array_like, optional
    ///     Parameters (..., parameters), in place of those of the system.
    /// singular : {"raise", "nan"}
    ///     Whether a state without a value raises SingularError, or gives NaN.
    ///
    /// Returns
    /// -------
    /// float or array
    ///     Result of the shape of the first axes followed by `shape`.
    ///
    /// Raises
    /// ------
    /// SingularError
    ///     If a state has no value, with the index of the state.
    #[pyo3(signature = (*args, parameters=None, singular="raise", **kwargs))]
    fn __call__<'py>(
        &self,
        py: Python<'py>,
        args: &Bound<'py, PyTuple>,
        parameters: Option<Bound<'py, PyAny>>,
        singular: &str,
        kwargs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let raise = match singular {
            "raise" => true,
            "nan" => false,
            other => {
                let message = format!("`singular` is \"raise\" or \"nan\", not {other:?}");
                return Err(PyValueError::new_err(message));
            }
        };
        let own = self.given(args, kwargs)?;
        let mut arrays: Vec<ArrayViewD<'_, f64>> = Vec::new();
        for (_, array) in &own {
            arrays.push(entries_last(array.as_array()));
        }
        let count = self.session.parameters().entries.len();
        let parameters = parameters.map(|array| given("`parameters`", count, &array));
        let parameters = parameters.transpose()?;
        if let Some(params) = &parameters {
            arrays.push(entries_last(params.as_array()));
        }
        let lead = common(arrays.iter().map(|array| array.shape()))?;
        let mut rows: Vec<Rows<'_>> = Vec::new();
        for array in &arrays {
            rows.push(Rows::new(array, &lead)?);
        }
        let taken: Vec<Argument> = own.iter().map(|(argument, _)| *argument).collect();
        let entries = self.compiled.shape.entries();
        let mut out = unknown(&lead, entries)?;
        let constants = &self.constants;
        let mut all = States::new(&self.compiled, constants, taken, rows, &lead);
        let failed = py.detach(|| all.evaluate(&mut out, raise));
        if let Some((cause, place)) = failed {
            return Err(self.singular(cause, &place));
        }
        let shape = [lead, axes(self.compiled.shape)].concat();
        let array = PyArray1::from_vec(py, out).reshape(IxDyn(&shape))?;
        match shape.is_empty() {
            true => array.call_method0("item"),
            false => Ok(array.into_any()),
        }
    }
}
