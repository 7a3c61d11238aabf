//! The floor below what is drawn: its height, its grid, and the shadows on it.

use super::element::{self, Sheet};
use super::shape::{MIN_SPLIT_WIDTH, Part, Shape, Vector};
use super::view::{Base, dot};

use crate::number::short;
use crate::plot::theme;
use plotters::style::RGBColor;
use std::fmt::Write;

/// Room around what stands on it, and below what hangs above it, over the size of all.
const MARGIN: f64 = 0.12;
const GAP_BELOW: f64 = 0.06;
/// It is at the height 0 where nothing is lower, and nothing so far above, over that size.
const MAX_HEIGHT_ABOVE_ZERO: f64 = 0.8;
/// Squares of its grid along its longer side, about.
const GRID_SQUARES: f64 = 7.0;

/// As dark on dark ground.
const SHADOW_COLOR: RGBColor = RGBColor(0, 0, 0);

/// A rectangle of a grid.
pub struct Floor {
    base: Base,
    height: f64,
    /// The side of a square.
    spacing: f64,
    /// Its first and last line along both directions, in squares.
    lines: [(i64, i64); 2],
}

impl Floor {
    /// The floor below these shapes and paths; none where there are none.
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

    /// A point of it, in squares.
    fn point(&self, u: i64, v: i64) -> Vector {
        let (u, v) = (u as f64 * self.spacing, v as f64 * self.spacing);
        let [first, second, up] = self.base;
        std::array::from_fn(|k| u * first[k] + v * second[k] + self.height * up[k])
    }

    /// Its corners, one after the other.
    pub fn corners(&self) -> [Vector; 4] {
        let [(a, b), (c, d)] = self.lines;
        [(a, c), (b, c), (b, d), (a, d)].map(|(u, v)| self.point(u, v))
    }

    /// How large its squares are.
    pub fn describe_grid(&self) -> String {
        format!("grid {}", short(self.spacing))
    }

    /// The rectangle and its lines.
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

    /// A point or direction moved straight down to it.
    fn project_down(&self, point: Vector, height: f64) -> Vector {
        let up = self.base[2];
        let above = dot(up, point) - height;
        std::array::from_fn(|k| point[k] - above * up[k])
    }

    /// The shadows of a light from straight above.
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

/// The nearest of 1, 2 and 5 times a power of ten.
fn nice(size: f64) -> f64 {
    let power = 10_f64.powf(size.log10().floor());
    let digit = size / power;
    let nice = match digit {
        _ if digit < 1.5 => 1.0,
        _ if digit < 3.5 => 2.0,
        _ if digit < 7.5 => 5.0,
        _ => 10.0,
    };
    // As a quotient where it is one, so that 0.2 is the number 0.2.
    if power < 1.0 {
        nice / (1.0 / power).round()
    } else {
        nice * power
    }
}
