//! Shapes, and what is known of a value before it is computed.

use crate::syntax::ast::{CoordKind, ShapeKind};
use num_rational::BigRational;

/// Largest number of rows and columns of what arrays and functions make.
pub const MOST_ENTRIES: usize = 64;

/// The shape of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shape {
    /// One number.
    Scalar,
    /// A column of so many numbers.
    Vector(usize),
    /// So many rows and columns.
    Matrix(usize, usize),
    /// Rotation and position of a frame.
    Pose,
}

impl Shape {
    /// A rotation matrix.
    pub(crate) const TURN: Shape = Shape::Matrix(3, 3);

    /// The shape in words: "a vector of 3".
    pub(crate) fn describe(self) -> String {
        match self {
            Shape::Scalar => "a scalar".into(),
            Shape::Vector(n) => format!("a vector of {n}"),
            Shape::Matrix(rows, columns) => format!("a {rows}×{columns} matrix"),
            Shape::Pose => "a pose".into(),
        }
    }

    /// The shape that an annotation says.
    pub(crate) fn declared(kind: ShapeKind) -> Shape {
        match kind {
            ShapeKind::Scalar => Shape::Scalar,
            ShapeKind::Vector(n) => Shape::Vector(n),
            ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => Shape::Matrix(n, n),
        }
    }

    /// The shape of a coordinate.
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

/// A shape, with exact numbers where they are known.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shaped {
    /// The shape.
    pub shape: Shape,
    /// The entries, matrices by rows, where all of them are rational numbers of the text.
    pub numbers: Option<Vec<BigRational>>,
}

impl Shaped {
    /// A shape without numbers.
    pub fn of(shape: Shape) -> Self {
        Shaped {
            shape,
            numbers: None,
        }
    }

    /// A number.
    pub fn number(number: BigRational) -> Self {
        Shaped {
            shape: Shape::Scalar,
            numbers: Some(vec![number]),
        }
    }

    /// The number that a scalar is.
    pub fn as_number(&self) -> Option<&BigRational> {
        match (self.shape, self.numbers.as_deref()) {
            (Shape::Scalar, Some([number])) => Some(number),
            _ => None,
        }
    }

    /// The same shape with every number mapped.
    pub fn map(&self, f: impl FnMut(&BigRational) -> BigRational) -> Self {
        let numbers = self.numbers.as_ref();
        Shaped {
            shape: self.shape,
            numbers: numbers.map(|numbers| numbers.iter().map(f).collect()),
        }
    }

    /// Some of the numbers, in a shape.
    pub fn part(&self, shape: Shape, places: std::ops::Range<usize>) -> Self {
        let numbers = self.numbers.as_ref();
        Shaped {
            shape,
            numbers: numbers.and_then(|numbers| Some(numbers.get(places)?.to_vec())),
        }
    }
}
