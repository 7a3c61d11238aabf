//! The value of a function: a number, a vector or a matrix.

use hamel_codegen::program::Shape;
use serde::{Serialize, Serializer};

/// Numbers of a function's value in its shape.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A number.
    Number(f64),
    /// Entries of a vector.
    Vector(Vec<f64>),
    /// Rows of a matrix.
    Matrix(Vec<Vec<f64>>),
}

impl Value {
    /// Creates a value of a shape from its entries, matrices by rows; a number without an entry is NaN.
    pub fn new(shape: Shape, entries: &[f64]) -> Self {
        match shape {
            Shape::Scalar => Value::Number(entries.first().copied().unwrap_or(f64::NAN)),
            Shape::Vector(_) => Value::Vector(entries.to_vec()),
            Shape::Matrix(_, columns) => {
                let rows = entries.chunks(columns.max(1)).map(<[f64]>::to_vec);
                Value::Matrix(rows.collect())
            }
        }
    }

    /// Returns whether all entries are finite.
    pub fn is_finite(&self) -> bool {
        match self {
            Value::Number(number) => number.is_finite(),
            Value::Vector(list) => list.iter().all(|number| number.is_finite()),
            Value::Matrix(rows) => rows.iter().flatten().all(|number| number.is_finite()),
        }
    }
}

/// Serializes pairs as a map.
pub(super) fn by_name<T: Serialize, S: Serializer>(
    pairs: &[(String, T)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().map(|(name, value)| (name, value)))
}
