//! Joints as they are written.

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

/// What the braces of a joint can hold.
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
    /// `limit LOWER to UPPER;`, two values.
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
    /// Its kind, and where that was written.
    pub kind: (JointKind, Span),
    /// Its axes: one, two for `universal`, none where the kind has none.
    pub axes: Vec<Expr>,
    /// The frame that it is fixed to, the world where absent.
    pub on: Option<Ident>,
    /// Where it stands in that frame, at its origin where absent.
    pub at: Option<Expr>,
    /// The frame that it carries.
    pub moves: Ident,
    /// What its coordinate is, where it has none of its own.
    pub follows: Option<Expr>,
    /// What its braces hold, each once, with the place of its word.
    pub fields: Vec<(JointField, Span, Vec<Expr>)>,
}
