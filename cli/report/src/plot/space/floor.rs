//! The floor below the drawn shapes: its height, its grid, and the shadows on it.

use super::element::{self, Sheet};
use super::shape::{MIN_SPLIT_WIDTH, Part, Shape, Vector};
use super::view::{Base, dot};

use crate::number::short;
use crate::plot::theme;
use plotters::style::RGBColor;
use std::fmt::Write;

/// Margins around the shapes and below hanging shapes, relative to their size.
const MARGIN: f64 = 0.12;
const GAP_BELOW: f64 = 0.06;
/// The floor is at height 0 if no shape is lower and the lowest is no higher than this, relative to the size.
const MAX_HEIGHT_ABOVE_ZERO: f64 = 0.8;
/// Approximate number of squares along its longer side.
const GRID_SQUARES: f64 = 7.0;

/// Black on light ground and on dark.
const SHADOW_COLOR: RGBColor = RGBColor(0, 0, 0);

/// A rectangular grid.
pub struct Floor {
    base: Base,
    height: f64,
    /// The side length of a square.
    spacing: f64,
    /// The first and the last line along both directions, in squares.
    lines: [(i64, i64); 2],
}

impl Floor {
    /// Creates the floor below shapes and paths; `None` if there are none.
    pub fn below<'a>(
        base: Base,
        shapes: impl Iterator<Item = &'a Shape>,
        paths: &[Vec<Vector>],
    ) -> Option<Self> {
        let mut least = [f64::INFINITY; 3];
        let mut most = [f64::NEG_INFINITY; 3];
        let mut hold = |point: Vector, reach: [f64; 3]| {
            for k in 0..3 {
                let place = dot(base[k], point);
                least[k] = least[k].min(place - reach[k]);
                most[k] = most[k].max(place + reach[k]);
            }
        };
        for shape in shapes {
            let reach = base.map(|along| shape.reach(along));
            for point in shape.points() {
                hold(point, reach);
            }
        }
        for point in paths.iter().flatten() {
            hold(*point, [0.0; 3]);
        }
        let sizes: [f64; 3] = std::array::from_fn(|k| most[k] - least[k]);
        let size = sizes.into_iter().fold(0.0, f64::max);
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        let stands = least[2] > -0.02 * size && least[2] < MAX_HEIGHT_ABOVE_ZERO * size;
        let height = if stands {
            0.0
        } else {
            least[2] - GAP_BELOW * size
        };
        let spacing = nice(size / GRID_SQUARES);
        let lines = [0, 1].map(|k| {
            let first = ((least[k] - MARGIN * size) / spacing).floor();
            let last = ((most[k] + MARGIN * size) / spacing).ceil();
            (first as i64, last as i64)
        });
        Some(Floor {
            base,
            height,
            spacing,
            lines,
        })
    }

    /// Returns a grid point, given in squares.
    fn point(&self, u: i64, v: i64) -> Vector {
        let (u, v) = (u as f64 * self.spacing, v as f64 * self.spacing);
        let [first, second, up] = self.base;
        std::array::from_fn(|k| u * first[k] + v * second[k] + self.height * up[k])
    }

    /// Returns its corners, in order.
    pub fn corners(&self) -> [Vector; 4] {
        let [(a, b), (c, d)] = self.lines;
        [(a, c), (b, c), (b, d), (a, d)].map(|(u, v)| self.point(u, v))
    }

    /// Returns a text with the size of its squares.
    pub fn describe_grid(&self) -> String {
        format!("grid {}", short(self.spacing))
    }

    /// Draws the rectangle and its lines.
    pub fn draw(&self, sheet: &Sheet) -> String {
        let corners = self.corners().map(|corner| sheet.point(corner));
        let mut text = format!(
            "<polygon points=\"{}\" fill=\"{}\"/>\n<path stroke=\"{}\" stroke-width=\"7\" fill=\"none\" d=\"",
            corners.join(" "),
            theme::code(theme::BALL.0),
            theme::code(theme::GRID.0)
        );
        let [(a, b), (c, d)] = self.lines;
        let along = (a..=b).map(|u| [self.point(u, c), self.point(u, d)]);
        let across = (c..=d).map(|v| [self.point(a, v), self.point(b, v)]);
        for [from, to] in along.chain(across) {
            let _ = write!(text, "M{}L{}", sheet.point(from), sheet.point(to));
        }
        text += "\"/>\n";
        text
    }

    /// Moves a point or direction vertically down to the floor.
    fn project_down(&self, point: Vector, height: f64) -> Vector {
        let up = self.base[2];
        let above = dot(up, point) - height;
        std::array::from_fn(|k| point[k] - above * up[k])
    }

    /// Draws the shadows of a light vertically above.
    pub fn shadows(&self, sheet: &Sheet, parts: &[Part]) -> String {
        let mut elements = Vec::new();
        for part in parts {
            let point = |at: Vector| self.project_down(at, self.height);
            match &part.shape {
                Shape::Ellipsoid { centre, arms } => {
                    let arms = arms.map(|arm| self.project_down(arm, 0.0));
                    elements.push(sheet.shade(point(*centre), &arms, SHADOW_COLOR));
                }
                Shape::Bar { ends, width } if *width >= MIN_SPLIT_WIDTH => {
                    elements.push(sheet.stroke(&ends.map(point), SHADOW_COLOR, *width, ""));
                }
                _ => {}
            }
        }
        format!(
            "<g opacity=\"0.16\">\n{}</g>\n",
            element::join_elements(elements.into_iter())
        )
    }
}

/// Returns the nearest of 1, 2 and 5 times a power of ten.
fn nice(size: f64) -> f64 {
    let power = 10_f64.powf(size.log10().floor());
    let digit = size / power;
    let nice = match digit {
        _ if digit < 1.5 => 1.0,
        _ if digit < 3.5 => 2.0,
        _ if digit < 7.5 => 5.0,
        _ => 10.0,
    };
    // Divides for negative powers, so that 0.2 is exactly the number 0.2.
    if power < 1.0 {
        nice / (1.0 / power).round()
    } else {
        nice * power
    }
}
