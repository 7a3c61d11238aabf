//! The robot as its file describes it.

use crate::angle::Rotation;
use crate::decimal::Decimal;
use std::ops::Range;

/// A robot as it is written.
#[derive(Debug)]
pub(crate) struct Robot {
    pub(crate) name: String,
    /// Place of the robot's name in the text.
    pub(crate) range: Range<usize>,
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) loops: Vec<Loop>,
    pub(crate) springs: Vec<Spring>,
}

/// A name with its place in the text.
#[derive(Clone, Debug)]
pub(crate) struct Named {
    pub(crate) name: String,
    pub(crate) range: Range<usize>,
}

/// A link.
#[derive(Debug)]
pub(crate) struct Link {
    pub(crate) name: Named,
    /// Mass and inertia; `None` without `<inertial>`.
    pub(crate) inertial: Option<Inertial>,
}

/// Mass and inertia of a link.
#[derive(Debug)]
pub(crate) struct Inertial {
    pub(crate) range: Range<usize>,
    pub(crate) mass: Decimal,
    /// Pose of the inertial frame in the link: centre of mass, and axes of `inertia`.
    pub(crate) origin: Origin,
    /// xx, xy, xz, yy, yz, zz about the centre of mass, in the axes of the origin.
    pub(crate) inertia: [Decimal; 6],
    pub(crate) inertia_range: Range<usize>,
}

/// `<origin>`: a pose.
#[derive(Clone, Debug)]
pub(crate) struct Origin {
    pub(crate) position: [Decimal; 3],
    pub(crate) rotation: Rotation,
}

/// Types of joints in URDF and its dialects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Fixed,
    Revolute,
    Continuous,
    Prismatic,
    Planar,
    Floating,
    /// Free rotation about a point.
    Spherical,
    /// Rotation about x and then about the rotated y.
    Universal,
}

impl Kind {
    /// Whether one angle or one length describes the motion.
    pub(crate) fn is_single(self) -> bool {
        matches!(self, Kind::Revolute | Kind::Continuous | Kind::Prismatic)
    }
}

/// A joint.
#[derive(Debug)]
pub(crate) struct Joint {
    pub(crate) name: Named,
    pub(crate) kind: Kind,
    pub(crate) parent: Named,
    pub(crate) child: Named,
    pub(crate) origin: Origin,
    /// Axis of motion; `None` for URDF's default (1, 0, 0).
    pub(crate) axis: Option<[Decimal; 3]>,
    pub(crate) damping: Option<Decimal>,
    /// Coulomb friction; descriptions do not model it.
    pub(crate) friction: Option<Decimal>,
    pub(crate) lower: Option<Decimal>,
    pub(crate) upper: Option<Decimal>,
    pub(crate) velocity: Option<Decimal>,
    pub(crate) effort: Option<Decimal>,
    pub(crate) mimic: Option<Follows>,
    /// Rotor inertias with gear ratios; the armature is Σ inertia · ratio².
    pub(crate) rotors: Vec<(Decimal, Decimal)>,
    /// Stiffness of a spring in the joint, and the position at which it is relaxed.
    pub(crate) spring: Option<(Decimal, Decimal)>,
}

/// A loop-closing joint: it connects frames of two links of the tree.
#[derive(Debug)]
pub(crate) struct Loop {
    pub(crate) name: Named,
    pub(crate) closing: Closing,
    pub(crate) ends: [End; 2],
}

/// Types of loop-closing joints, with the axis of the motion that they leave free.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Closing {
    Fixed,
    Spherical,
    Revolute([Decimal; 3]),
    Prismatic([Decimal; 3]),
}

/// A frame on a link.
#[derive(Debug)]
pub(crate) struct End {
    pub(crate) link: Named,
    pub(crate) origin: Origin,
}

/// A spring and a damper between points of two links.
#[derive(Debug)]
pub(crate) struct Spring {
    pub(crate) range: Range<usize>,
    pub(crate) ends: [End; 2],
    pub(crate) length: Decimal,
    pub(crate) stiffness: Decimal,
    pub(crate) damping: Decimal,
}

/// `<mimic>`: q = multiplier · source + offset.
#[derive(Debug)]
pub(crate) struct Follows {
    pub(crate) source: Named,
    pub(crate) multiplier: Decimal,
    pub(crate) offset: Decimal,
}

/// A number that was changed because it looks rounded.
#[derive(Debug)]
pub(crate) struct Cleaned {
    pub(crate) range: Range<usize>,
    pub(crate) written: String,
    pub(crate) read: String,
}

/// A robot, with the numbers that were changed while reading it.
#[derive(Debug)]
pub(crate) struct Read {
    pub(crate) robot: Robot,
    pub(crate) cleaned: Vec<Cleaned>,
}

impl Inertial {
    /// Whether mass and inertia are both zero.
    pub(crate) fn is_zero(&self) -> bool {
        self.mass.is_zero() && self.inertia.iter().all(Decimal::is_zero)
    }
}

impl Origin {
    pub(crate) fn identity() -> Self {
        Origin {
            position: std::array::from_fn(|_| Decimal::zero()),
            rotation: Rotation::identity(),
        }
    }
}
