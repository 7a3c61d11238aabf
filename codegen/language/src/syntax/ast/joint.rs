//! Joints of the syntax tree.

use super::{Expr, Ident, Span};

/// The kinds of joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Turns about an axis; its coordinate is the angle.
    Revolute,
    /// Turns about an axis; its coordinate is the pair (c, s).
    Continuous,
    /// Slides along an axis.
    Prismatic,
    /// Turns about a point; its coordinate is a rotation matrix.
    Spherical,
    /// Turns about a point; its coordinate is a unit quaternion.
    SphericalS3,
    /// Moves freely.
    Free,
    /// Slides in a plane and turns about its normal.
    Planar,
    /// Turns about two axes, one after the other.
    Universal,
    /// Turns about an axis and slides along it.
    Cylindrical,
    /// Does not move.
    Fixed,
}

/// Fields that the braces of a joint can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum JointField {
    /// `damping d;`
    Damping,
    /// `armature J;`
    Armature,
    /// `stiffness k;`
    Stiffness,
    /// `rest q0;`
    Rest,
    /// `force E;`
    Force,
    /// `limit LOWER to UPPER;`, with two values.
    Limit,
    /// `max_speed V;`
    MaxSpeed,
    /// `max_force F;`
    MaxForce,
}

/// `joint j: revolute [0, 0, 1] on f at P moves g follows e { … };`
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Its name.
    pub name: Ident,
    /// Kind of the joint, and its source position.
    pub kind: (JointKind, Span),
    /// Axes: two for `universal`, none for kinds without an axis, one otherwise.
    pub axes: Vec<Expr>,
    /// Frame to which the joint is fixed, the world if absent.
    pub on: Option<Ident>,
    /// Placement of the joint in that frame, its origin if absent.
    pub at: Option<Expr>,
    /// New frame that the joint moves.
    pub moves: Ident,
    /// Value of the joint coordinate, if the joint has no coordinate of its own.
    pub follows: Option<Expr>,
    /// Fields in the braces, each at most once: the field, the span of its keyword, and its values.
    pub fields: Vec<(JointField, Span, Vec<Expr>)>,
}
