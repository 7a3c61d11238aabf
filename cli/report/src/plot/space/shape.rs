//! What there is to be drawn in space.

/// The width from which on a bar has more than one piece, and a shadow (pixels).
pub(super) const MIN_SPLIT_WIDTH: f64 = 3.0;

/// A point or a direction.
pub type Vector = [f64; 3];

/// What something is drawn with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ink {
    /// The colour of the line with this index.
    Series(usize),
    /// That of headings.
    Dark,
    /// That of labels.
    Soft,
}

/// What there is to be drawn; widths and radii in pixels.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A solid ellipsoid by its half axes.
    Ellipsoid {
        /// Its centre.
        centre: Vector,
        /// Its half axes, at right angles; none has the length 0.
        arms: [Vector; 3],
    },
    /// A straight bar with round ends.
    Bar {
        /// Its ends.
        ends: [Vector; 2],
        /// Its width.
        width: f64,
    },
    /// A line of dashes.
    Dashes {
        /// Its ends.
        ends: [Vector; 2],
    },
    /// A zigzag between two points.
    Spring {
        /// Its ends.
        ends: [Vector; 2],
    },
    /// A piston in a cylinder.
    Damper {
        /// Its ends.
        ends: [Vector; 2],
    },
    /// A disk that is as large in every picture.
    Ball {
        /// Its centre.
        at: Vector,
        /// Its radius.
        radius: f64,
    },
    /// A circle that is as large in every picture.
    Ring {
        /// Its centre.
        at: Vector,
        /// Its radius.
        radius: f64,
    },
}

/// A shape with its colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// What it is drawn with.
    pub ink: Ink,
    /// What is drawn.
    pub shape: Shape,
}
