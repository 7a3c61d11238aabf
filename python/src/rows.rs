//! Arrays of states: the last axis has the entries of one, those before it are looped over.

use numpy::ndarray::{ArrayViewD, Axis, IxDyn};
use numpy::{AllowTypeChange, PyArrayLikeDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Numbers as they were given: an array, or what NumPy makes one of.
pub type Given<'py> = PyArrayLikeDyn<'py, f64, AllowTypeChange>;

/// An array whose last axis has the entries: a number alone is a list of one.
pub fn entries_last(array: ArrayViewD<'_, f64>) -> ArrayViewD<'_, f64> {
    match array.ndim() {
        0 => array.insert_axis(Axis(0)),
        _ => array,
    }
}

/// An array over the axes that are looped over.
pub struct Rows<'a> {
    array: ArrayViewD<'a, f64>,
    /// All of it, where its entries stand one behind the other.
    flat: Option<&'a [f64]>,
    /// How many entries a row has.
    length: usize,
    /// Room for entries that are not one behind the other.
    room: Vec<f64>,
}

impl<'a> Rows<'a> {
    /// An array, repeated along axes that it does not have.
    pub fn new(array: &'a ArrayViewD<'_, f64>, axes: &[usize]) -> PyResult<Self> {
        let length = array.shape().last().copied().unwrap_or(1);
        let shape = [axes, &[length]].concat();
        let array = array.broadcast(IxDyn(&shape));
        let array = array.ok_or_else(|| PyValueError::new_err("arrays do not fit together"))?;
        Ok(Rows {
            flat: array.to_slice(),
            array,
            length,
            room: Vec::new(),
        })
    }

    /// The entries of a row by its number, which is at this place.
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

/// The axes before the last of all arrays, which are repeated where they have the length 1.
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
                        "arrays of {length} and of {own} states cannot be taken together"
                    )));
                }
            }
        }
    }
    Ok(all)
}

/// The place behind a place, in the order of rows.
pub fn next(place: &mut [usize], axes: &[usize]) {
    for (index, length) in place.iter_mut().zip(axes).rev() {
        *index += 1;
        if *index < *length {
            return;
        }
        *index = 0;
    }
}
