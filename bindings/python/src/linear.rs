//! Linear systems: steps, zeros, modes and regulators of matrices from Python.

use crate::failure::{HamelError, raised};
use hamel_engine::linear::{LinearSystem, Matrix, Quadruple};
use numpy::ndarray::IxDyn;
use numpy::{
    Complex64, PyArray1, PyArrayDyn, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::PyComplex;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;
type Complexes<'py> = Bound<'py, PyArray1<Complex64>>;
/// Eigenvalue, names of states, whether inputs reach it, whether outputs show it.
type Mode<'py> = (Bound<'py, PyComplex>, Vec<String>, bool, bool);

fn from_numpy(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Matrix> {
    let [rows, columns] = [array.shape()[0], array.shape()[1]];
    let entries = array.as_array();
    let matrix = Matrix::from_fn(rows, columns, |i, j| entries[[i, j]]);
    match matrix.iter().all(|entry| entry.is_finite()) {
        true => Ok(matrix),
        false => Err(HamelError::new_err(
            "a matrix has entries that are not finite",
        )),
    }
}

fn to_numpy<'py>(py: Python<'py>, matrix: &Matrix) -> PyResult<Array<'py>> {
    let (rows, columns) = matrix.shape();
    let flat = matrix.transpose().as_slice().to_vec();
    PyArray1::from_vec(py, flat).reshape(IxDyn(&[rows, columns]))
}

/// A linear system.
#[pyclass(frozen, module = "hamel._hamel")]
pub struct Linear(LinearSystem);

#[pymethods]
impl Linear {
    #[new]
    fn new(
        matrices: [PyReadonlyArray2<'_, f64>; 4],
        step: Option<f64>,
        names: [Vec<String>; 3],
    ) -> PyResult<Self> {
        let ([a, b, c, d], [states, inputs, outputs]) = (matrices, names);
        let [n, m, p] = [&states, &inputs, &outputs].map(Vec::len);
        for (name, matrix, shape) in [
            ("A", &a, [n, n]),
            ("B", &b, [n, m]),
            ("C", &c, [p, n]),
            ("D", &d, [p, m]),
        ] {
            if matrix.shape() != shape {
                let found = matrix.shape();
                return Err(HamelError::new_err(format!(
                    "{name} has the shape {found:?}, by the names it is {shape:?}"
                )));
            }
        }
        let [a, b, c, d] = [
            from_numpy(&a)?,
            from_numpy(&b)?,
            from_numpy(&c)?,
            from_numpy(&d)?,
        ];
        let matrices = Quadruple { a, b, c, d };
        Ok(Linear(LinearSystem {
            states,
            inputs,
            outputs,
            matrices,
            step,
        }))
    }

    fn discretized<'py>(&self, py: Python<'py>, h: f64) -> PyResult<(Array<'py>, Array<'py>)> {
        let found = self
            .0
            .discretized(h)
            .map_err(|error| raised(error.into()))?;
        Ok((
            to_numpy(py, &found.matrices.a)?,
            to_numpy(py, &found.matrices.b)?,
        ))
    }

    fn poles<'py>(&self, py: Python<'py>) -> PyResult<Complexes<'py>> {
        let found = self.0.poles().map_err(|error| raised(error.into()))?;
        Ok(PyArray1::from_vec(py, found))
    }

    fn zeros<'py>(&self, py: Python<'py>) -> PyResult<Complexes<'py>> {
        let found = self.0.zeros().map_err(|error| raised(error.into()))?;
        Ok(PyArray1::from_vec(py, found))
    }

    fn modes<'py>(&self, py: Python<'py>) -> PyResult<Vec<Mode<'py>>> {
        let found = self.0.modes().map_err(|error| raised(error.into()))?;
        let rows = found.into_iter().map(|mode| {
            (
                PyComplex::from_doubles(py, mode.value.re, mode.value.im),
                mode.states,
                mode.reachable,
                mode.observable,
            )
        });
        Ok(rows.collect())
    }

    fn regulator<'py>(
        &self,
        py: Python<'py>,
        q: PyReadonlyArray2<'py, f64>,
        r: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<(Array<'py>, Array<'py>, Complexes<'py>)> {
        let (q, r) = (from_numpy(&q)?, from_numpy(&r)?);
        for (name, matrix, side) in [
            ("Q", &q, self.0.states.len()),
            ("R", &r, self.0.inputs.len()),
        ] {
            let symmetric = matrix.shape() == (side, side) && {
                (matrix - matrix.transpose()).amax() <= 1e-9 * matrix.amax()
            };
            if !symmetric {
                return Err(HamelError::new_err(format!(
                    "{name} has to be symmetric, with {side} rows"
                )));
            }
        }
        let halved = |matrix: &Matrix| (matrix + matrix.transpose()) * 0.5;
        let found = py.detach(|| self.0.regulator(&halved(&q), &halved(&r)));
        let found = found.map_err(|error| raised(error.into()))?;
        Ok((
            to_numpy(py, &found.gain)?,
            to_numpy(py, &found.cost)?,
            PyArray1::from_vec(py, found.poles),
        ))
    }
}
