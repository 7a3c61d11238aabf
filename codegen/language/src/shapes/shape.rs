//! Shapes, and the exact values that are known during shape inference.

use crate::syntax::ast::{CoordKind, ShapeKind};
use num_rational::BigRational;

/// Largest number of rows and of columns that arrays and functions can produce.
pub const MOST_ENTRIES: usize = 64;

/// The shape of a value of the language, as the shape inference knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shape {
    /// One number.
    Scalar,
    /// A column vector of this length.
    Vector(usize),
    /// A matrix with these numbers of rows and columns.
    Matrix(usize, usize),
    /// The rotation and position of a frame.
    Pose,
}

impl Shape {
    /// Shape of a rotation matrix.
    pub(crate) const TURN: Shape = Shape::Matrix(3, 3);

    /// Describes the shape in words: "a vector of 3".
    pub(crate) fn describe(self) -> String {
        match self {
            Shape::Scalar => "a scalar".into(),
            Shape::Vector(n) => format!("a vector of {n}"),
            Shape::Matrix(rows, columns) => format!("a {rows}×{columns} matrix"),
            Shape::Pose => "a pose".into(),
        }
    }

    /// Returns the shape of an annotation.
    pub(crate) fn declared(kind: ShapeKind) -> Shape {
        match kind {
            ShapeKind::Scalar => Shape::Scalar,
            ShapeKind::Vector(n) => Shape::Vector(n),
            ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => Shape::Matrix(n, n),
        }
    }

    /// Returns the shape of a coordinate.
    pub(crate) fn of_coordinate(kind: CoordKind) -> Shape {
        match kind {
            CoordKind::Real => Shape::Scalar,
            CoordKind::Euclidean(n) => Shape::Vector(n),
            CoordKind::S1 => Shape::Vector(2),
            CoordKind::S3 => Shape::Vector(4),
            CoordKind::SO3 => Shape::TURN,
            CoordKind::SE3 => Shape::Pose,
        }
    }
}

/// A shape, with the exact entries if they are known.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shaped {
    /// Shape of the value.
    pub shape: Shape,
    /// The entries, by rows for a matrix, if all of them are rational numbers that follow from the text.
    pub numbers: Option<Vec<BigRational>>,
}

impl Shaped {
    /// Creates a shape with unknown entries.
    pub fn of(shape: Shape) -> Self {
        Shaped {
            shape,
            numbers: None,
        }
    }

    /// Creates a scalar of known value.
    pub fn number(number: BigRational) -> Self {
        Shaped {
            shape: Shape::Scalar,
            numbers: Some(vec![number]),
        }
    }

    /// Returns the value of a scalar, if it is known.
    pub fn as_number(&self) -> Option<&BigRational> {
        match (self.shape, self.numbers.as_deref()) {
            (Shape::Scalar, Some([number])) => Some(number),
            _ => None,
        }
    }

    /// Returns the same shape with a function applied to all known entries.
    pub fn map(&self, f: impl FnMut(&BigRational) -> BigRational) -> Self {
        let numbers = self.numbers.as_ref();
        Shaped {
            shape: self.shape,
            numbers: numbers.map(|numbers| numbers.iter().map(f).collect()),
        }
    }

    /// Returns a range of the entries, with a given shape.
    pub fn part(&self, shape: Shape, places: std::ops::Range<usize>) -> Self {
        let numbers = self.numbers.as_ref();
        Shaped {
            shape,
            numbers: numbers.and_then(|numbers| Some(numbers.get(places)?.to_vec())),
        }
    }
}
