//! Shapes in space.

/// The width from which a bar is split into pieces and has a shadow (pixels).
pub(super) const MIN_SPLIT_WIDTH: f64 = 3.0;

/// A point or a direction.
pub type Vector = [f64; 3];

/// The colour of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ink {
    /// Returns the colour of the line with this index.
    Series(usize),
    /// The colour of headings.
    Dark,
    /// The colour of labels.
    Soft,
}

/// A shape; widths and radii are in pixels.
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
    /// A dashed line.
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
    /// A disk of the same size in every picture.
    Ball {
        /// Its centre.
        at: Vector,
        /// Its radius.
        radius: f64,
    },
    /// A circle of the same size in every picture.
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
    /// Its colour.
    pub ink: Ink,
    /// Shape.
    pub shape: Shape,
}
