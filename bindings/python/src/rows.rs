//! Arrays of states: the last axis contains the entries of one state, the axes before it enumerate states.

use numpy::ndarray::{ArrayViewD, Axis, IxDyn};
use numpy::{
    AllowTypeChange, PyArrayDyn, PyArrayLikeDyn, PyArrayMethods, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyMemoryError, PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::type_object::PyTypeInfo;

/// Largest number of axes of an array.
const AXES: usize = 32;

/// Numbers from Python: an array, or an object that NumPy converts to one.
pub type Given<'py> = PyArrayLikeDyn<'py, f64, AllowTypeChange>;

/// Converts an object to numbers; messages call it `what`.
pub fn numbers<'py>(what: &str, value: &Bound<'py, PyAny>) -> PyResult<Given<'py>> {
    let array: Given<'py> = match is_plain(value) {
        true => value.extract()?,
        false => made(what, value)?.extract()?,
    };
    if array.ndim() > AXES {
        let message = format!(
            "{what} can have at most {AXES} axes, this array has {}",
            array.ndim()
        );
        return Err(PyValueError::new_err(message));
    }
    Ok(array)
}

/// Returns whether an object is a NumPy array that can be read in place. Its numbers must be aligned, unlike those of
/// packed records.
fn is_plain(value: &Bound<'_, PyAny>) -> bool {
    let Ok(array) = value.cast::<PyArrayDyn<f64>>() else {
        return false;
    };
    let size = size_of::<f64>();
    value.get_type().is(PyUntypedArray::type_object(value.py()))
        && array.data().addr().is_multiple_of(size)
        && array
            .strides()
            .iter()
            .all(|stride| stride.unsigned_abs().is_multiple_of(size))
}

/// Converts an object to a new array. NumPy alone would drop imaginary parts and masks, and convert dates and `None` to
/// numbers.
fn made<'py>(what: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let py = value.py();
    let own = |why: PyErr| {
        let message = format!("{what}: {}", why.value(py));
        match why {
            why if why.is_instance_of::<PyTypeError>(py) => PyTypeError::new_err(message),
            why if why.is_instance_of::<PyValueError>(py) => PyValueError::new_err(message),
            why if why.is_instance_of::<PyOverflowError>(py) => PyValueError::new_err(message),
            other => other,
        }
    };
    let numpy = py.import("numpy")?;
    if numpy
        .getattr("ma")?
        .call_method1("is_masked", (value,))?
        .is_truthy()?
    {
        return Err(PyValueError::new_err(format!("{what} has masked entries")));
    }
    let array = numpy.call_method1("asarray", (value,)).map_err(own)?;
    let dtype = array.getattr("dtype")?;
    let kind = dtype.getattr("kind")?.to_string();
    if !"biufO".contains(&kind) {
        let message = format!("{what} needs real numbers, this array has the dtype {dtype}");
        return Err(PyTypeError::new_err(message));
    }
    if kind == "O" {
        for entry in array.getattr("flat")?.try_iter()? {
            let entry = entry?;
            if entry.is_none() || numpy.call_method1("iscomplexobj", (&entry,))?.is_truthy()? {
                let message = format!("{what} needs real numbers, {} was given", entry.repr()?);
                return Err(PyTypeError::new_err(message));
            }
        }
    }
    array.call_method1("astype", ("float64",)).map_err(own)
}

/// Converts an object to numbers, with `length` entries along the last axis; messages call it `what`.
pub fn given<'py>(what: &str, length: usize, value: &Bound<'py, PyAny>) -> PyResult<Given<'py>> {
    let array = numbers(what, value)?;
    let shape = array.shape();
    // A scalar counts as one entry.
    match shape.last() {
        Some(last) if *last == length => Ok(array),
        None if length == 1 => Ok(array),
        _ => Err(PyValueError::new_err(format!(
            "{what} needs {length} entries along its last axis, this array has the shape {shape:?}"
        ))),
    }
}

/// Combines several errors into one.
pub fn together(py: Python<'_>, mut errors: Vec<PyErr>) -> PyErr {
    if errors.len() == 1 {
        return errors.remove(0);
    }
    let said: Vec<String> = errors
        .iter()
        .map(|error| error.value(py).to_string())
        .collect();
    let said = said.join("\n");
    match errors
        .iter()
        .any(|error| error.is_instance_of::<PyTypeError>(py))
    {
        true => PyTypeError::new_err(said),
        false => PyValueError::new_err(said),
    }
}

/// Allocates `entries` numbers for each state of an array with these axes, filled with NaN.
pub fn unknown(axes: &[usize], entries: usize) -> PyResult<Vec<f64>> {
    let mut all = Vec::new();
    let states = axes
        .iter()
        .try_fold(1_usize, |count, axis| count.checked_mul(*axis));
    match states.and_then(|states| states.checked_mul(entries)) {
        Some(count) if all.try_reserve_exact(count).is_ok() => {
            all.resize(count, f64::NAN);
            Ok(all)
        }
        _ => Err(too_many(axes, entries)),
    }
}

fn too_many(axes: &[usize], entries: usize) -> PyErr {
    PyMemoryError::new_err(format!(
        "there is no memory for {entries} numbers at each state of an array of the shape {axes:?}"
    ))
}

/// Returns an array with an axis of entries; a scalar becomes an array of one entry.
pub fn entries_last(array: ArrayViewD<'_, f64>) -> ArrayViewD<'_, f64> {
    match array.ndim() {
        0 => array.insert_axis(Axis(0)),
        _ => array,
    }
}

/// An array, broadcast to the axes of the states.
pub struct Rows<'a> {
    array: ArrayViewD<'a, f64>,
    /// The whole array, if it is contiguous.
    flat: Option<&'a [f64]>,
    /// Number of entries of a row.
    length: usize,
    /// Buffer for a row that is not contiguous.
    room: Vec<f64>,
}

impl<'a> Rows<'a> {
    /// Broadcasts an array to these axes.
    pub fn new(array: &'a ArrayViewD<'_, f64>, axes: &[usize]) -> PyResult<Self> {
        let length = array.shape().last().copied().unwrap_or(1);
        let shape = [axes, &[length]].concat();
        // The axes are compatible; broadcasting fails if the number of entries overflows.
        let array = array
            .broadcast(IxDyn(&shape))
            .ok_or_else(|| too_many(axes, length))?;
        Ok(Rows {
            flat: array.to_slice(),
            array,
            length,
            room: Vec::new(),
        })
    }

    /// Returns the entries of row `number`, whose index along the axes is `place`.
    pub fn at(&mut self, number: usize, place: &[usize]) -> &[f64] {
        let first = number * self.length;
        let flat = self
            .flat
            .and_then(|flat| flat.get(first..first + self.length));
        if let Some(row) = flat {
            return row;
        }
        let mut row = self.array.clone();
        for &index in place {
            row.index_axis_inplace(Axis(0), index);
        }
        match row.to_slice() {
            Some(slice) => slice,
            None => {
                self.room.clear();
                self.room.extend(row.iter());
                &self.room
            }
        }
    }
}

/// Returns the common axes of the states, by the broadcasting rules of NumPy.
pub fn common<'a>(shapes: impl Iterator<Item = &'a [usize]>) -> PyResult<Vec<usize>> {
    let mut all: Vec<usize> = Vec::new();
    for shape in shapes {
        let own = shape.split_last().map_or(&[][..], |(_, own)| own);
        while all.len() < own.len() {
            all.insert(0, 1);
        }
        let shift = all.len() - own.len();
        for (length, own) in all.iter_mut().skip(shift).zip(own) {
            match (*length, *own) {
                (_, 1) => {}
                (1, own) => *length = own,
                (length, own) if length == own => {}
                (length, own) => {
                    return Err(PyValueError::new_err(format!(
                        "arrays of {length} and of {own} states cannot be broadcast together"
                    )));
                }
            }
        }
    }
    Ok(all)
}

/// Advances an index to the next one in row-major order.
pub fn next(place: &mut [usize], axes: &[usize]) {
    for (index, length) in place.iter_mut().zip(axes).rev() {
        *index += 1;
        if *index < *length {
            return;
        }
        *index = 0;
    }
}
