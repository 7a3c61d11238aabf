//! Values with a shape: scalars, vectors, matrices and poses of graph edges.

use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Mat3, Vec3};

/// A value of an expression of the language, whose entries are edges of a graph: scalar, vector, matrix or pose.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// One number.
    Scalar(Edge),
    /// A column vector.
    Vector(Vec<Edge>),
    /// A matrix, as rows of equal length.
    Matrix(Vec<Vec<Edge>>),
    /// Rotation and position of a frame.
    Pose(Mat3, Vec3),
}

impl Value {
    /// Returns whether two values have the same shape.
    pub fn same_shape(&self, other: &Value) -> bool {
        match (self, other) {
            (Value::Scalar(_), Value::Scalar(_)) | (Value::Pose(..), Value::Pose(..)) => true,
            (Value::Vector(a), Value::Vector(b)) => a.len() == b.len(),
            (Value::Matrix(a), Value::Matrix(b)) => {
                a.len() == b.len() && a.first().map(Vec::len) == b.first().map(Vec::len)
            }
            _ => false,
        }
    }

    /// Returns all entries: matrices by rows, poses as position and then rotation by rows.
    pub fn entries(&self) -> Vec<Edge> {
        match self {
            Value::Scalar(edge) => vec![*edge],
            Value::Vector(v) => v.clone(),
            Value::Matrix(m) => m.concat(),
            Value::Pose(r, p) => p.iter().chain(r.iter().flatten()).copied().collect(),
        }
    }

    /// Maps every entry, keeping the shape.
    pub fn map(&self, mut f: impl FnMut(Edge) -> Edge) -> Value {
        match self {
            Value::Scalar(edge) => Value::Scalar(f(*edge)),
            Value::Vector(v) => Value::Vector(v.iter().map(|&e| f(e)).collect()),
            Value::Matrix(m) => Value::Matrix(
                m.iter()
                    .map(|row| row.iter().map(|&e| f(e)).collect())
                    .collect(),
            ),
            Value::Pose(r, p) => {
                let p = p.map(&mut f);
                Value::Pose(r.map(|row| row.map(&mut f)), p)
            }
        }
    }

    /// Combines the entries of two values of the same shape.
    pub fn zip(&self, other: &Value, mut f: impl FnMut(Edge, Edge) -> Edge) -> Value {
        let others = other.entries();
        let mut next = others.iter();
        self.map(|edge| next.next().map_or(edge, |&other| f(edge, other)))
    }

    /// Returns the value if it is a scalar.
    pub fn as_scalar(&self) -> Option<Edge> {
        match self {
            Value::Scalar(edge) => Some(*edge),
            _ => None,
        }
    }

    /// Returns the value if it is a vector of three entries.
    pub fn as_vec3(&self) -> Option<Vec3> {
        match self {
            Value::Vector(v) => <[Edge; 3]>::try_from(v.as_slice()).ok(),
            _ => None,
        }
    }

    /// Returns the value if it is a matrix of three rows and columns.
    pub fn as_mat3(&self) -> Option<Mat3> {
        let Value::Matrix(m) = self else { return None };
        let rows: Vec<Vec3> = m
            .iter()
            .map(|row| <[Edge; 3]>::try_from(row.as_slice()).ok())
            .collect::<Option<_>>()?;
        <[Vec3; 3]>::try_from(rows.as_slice()).ok()
    }

    /// Makes a value of a matrix of three rows and columns.
    pub fn from_mat3(m: &Mat3) -> Value {
        Value::Matrix(m.iter().map(|row| row.to_vec()).collect())
    }

    /// Returns whether every entry is 0 on X.
    pub fn is_zero(&self, graph: &Graph) -> bool {
        self.entries().iter().all(|edge| edge.abs() == graph.zero())
    }

    /// Replaces −0 by 0, so that zero is always the same edge.
    pub fn unsigned_zeros(self, graph: &Graph) -> Value {
        let zero = graph.zero();
        if self.entries().contains(&-zero) {
            self.map(|edge| if edge == -zero { zero } else { edge })
        } else {
            self
        }
    }
}
