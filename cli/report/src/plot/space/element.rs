//! Shapes as SVG elements, in tenths of pixels.

use super::shape::{Ink, Shape, Vector};
use super::view::{Ellipse, View};

use crate::plot::figure::unit;
use crate::plot::line::{Point, simplify};
use crate::plot::theme::{self, code, ramp};
use plotters::style::RGBColor;
use std::fmt::Write;

/// The style of lines, and the light on ellipsoids, which comes from the upper left.
pub const STYLE_AND_LIGHT: &str = "<style>svg .line{fill:none;stroke-linejoin:round;stroke-linecap:round}</style>\n<defs><radialGradient id=\"light\" cx=\".5\" cy=\".5\" r=\".5\" fx=\".32\" fy=\".26\">\
<stop offset=\"0\" stop-color=\"#fff\" stop-opacity=\".55\"/><stop offset=\".55\" stop-color=\"#fff\" stop-opacity=\".08\"/>\
<stop offset=\".75\" stop-color=\"#000\" stop-opacity=\".02\"/><stop offset=\"1\" stop-color=\"#000\" stop-opacity=\".3\"/>\
</radialGradient></defs>\n";

/// Number of teeth of a spring, and their amplitude (pixels).
const SPRING_TEETH: u32 = 7;
const TOOTH_HEIGHT: f64 = 5.0;
/// The fraction of a spring or damper that is straight, at each end.
const STRAIGHT_PART: f64 = 0.18;
/// Number of single-coloured pieces of a path.
const PATH_PIECES: usize = 48;
/// Ellipses with a shorter half axis below this are drawn as lines (pixels).
const MIN_DRAWN_RADIUS: f64 = 0.2;

/// The transformation from space to the drawing.
pub struct Sheet {
    /// The projection.
    pub view: View,
    /// Pixels per unit of length.
    pub scale: f64,
    /// The position of the origin.
    pub origin: Point,
}

impl Sheet {
    /// Returns the position of a point (pixels).
    fn place(&self, point: Vector) -> Point {
        let (x, y) = self.arm(point);
        (self.origin.0 + x, self.origin.1 + y)
    }

    /// Returns the length of a line in the drawing (pixels).
    pub fn length(&self, [from, to]: &[Vector; 2]) -> f64 {
        let ((a, b), (c, d)) = (self.place(*from), self.place(*to));
        (c - a).hypot(d - b)
    }

    /// Transforms a direction with its length (pixels).
    fn arm(&self, arm: Vector) -> Point {
        let (x, y) = self.view.place(arm);
        (self.scale * x, self.scale * y)
    }

    /// Formats a point for SVG.
    pub fn point(&self, point: Vector) -> String {
        written(self.place(point))
    }

    /// Draws a shape; a faint one is without light.
    pub fn shape(&self, ink: Ink, shape: &Shape, faint: bool) -> String {
        let colour = colour(ink);
        match shape {
            Shape::Ellipsoid { centre, arms } if faint => self.shade(*centre, arms, colour),
            Shape::Ellipsoid { centre, arms } => self.ellipsoid(*centre, arms, colour),
            Shape::Bar { ends, width } => self.stroke(ends, colour, *width, ""),
            Shape::Dashes { ends } => self.stroke(ends, colour, 1.4, " stroke-dasharray=\"40 40\""),
            Shape::Spring { ends } => {
                let [from, to] = ends.map(|end| self.place(end));
                polyline(&zigzag(from, to), colour, 1.5, "")
            }
            Shape::Damper { ends } => {
                let [from, to] = ends.map(|end| self.place(end));
                let lines = piston(from, to);
                lines
                    .iter()
                    .map(|line| polyline(line, colour, 1.5, ""))
                    .collect()
            }
            Shape::Ball { at, radius } => self.disk(*at, *radius, code(colour), theme::GROUND.0),
            Shape::Ring { at, radius } => self.disk(*at, *radius, code(theme::GROUND.0), colour),
        }
    }

    /// Draws a line of this width.
    pub fn stroke(&self, ends: &[Vector; 2], colour: RGBColor, width: f64, more: &str) -> String {
        polyline(&ends.map(|end| self.place(end)), colour, width, more)
    }

    fn disk(&self, at: Vector, radius: f64, fill: String, rim: RGBColor) -> String {
        let (x, y) = self.place(at);
        format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{fill}\" stroke=\"{}\" stroke-width=\"13\"/>\n",
            unit(x),
            unit(y),
            unit(radius),
            code(rim)
        )
    }

    /// Draws the outline, the light, and the visible halves of the three sections through principal axes.
    fn ellipsoid(&self, centre: Vector, arms: &[Vector; 3], colour: RGBColor) -> String {
        let (x, y) = self.place(centre);
        let flat = arms.map(|arm| self.arm(arm));
        let outline = Ellipse::of(&flat);
        let colour = code(colour);
        let [a, b, d] = outline.root.map(unit);
        let (x, y) = (unit(x), unit(y));
        let mut text = format!(
            "{}<circle r=\"1\" transform=\"matrix({a} {b} {b} {d} {x} {y})\" fill=\"url(#light)\"/>\n\
             <path fill=\"none\" stroke=\"{colour}\" stroke-width=\"8\" d=\"",
            ellipse(
                (x, y),
                outline,
                &format!(
                    "fill=\"{colour}\" fill-opacity=\".72\" stroke=\"{colour}\" stroke-width=\"12\""
                )
            )
        );
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            text += &self.section(centre, [arms[i], arms[j]]);
        }
        text += "\"/>\n";
        text
    }

    /// Draws the half of an ellipse on an ellipsoid that faces the eye.
    fn section(&self, centre: Vector, arms: [Vector; 2]) -> String {
        // The normal at cos t a + sin t b is cos t a/|a|² + sin t b/|b|².
        let facing = arms.map(|arm| {
            let square: f64 = arm.iter().map(|entry| entry * entry).sum();
            self.view.depth(arm) / square
        });
        let nearest = facing[1].atan2(facing[0]);
        let middle = self.place(centre);
        let flat = arms.map(|arm| self.arm(arm));
        let at = |angle: f64| {
            let (s, c) = angle.sin_cos();
            (
                middle.0 + c * flat[0].0 + s * flat[1].0,
                middle.1 + c * flat[0].1 + s * flat[1].1,
            )
        };
        let quarter = std::f64::consts::FRAC_PI_2;
        let (from, to) = (
            written(at(nearest - quarter)),
            written(at(nearest + quarter)),
        );
        let whole = Ellipse::of(&flat);
        if whole.short < MIN_DRAWN_RADIUS {
            return format!("M{from}L{to}");
        }
        let turns = flat[0].0 * flat[1].1 - flat[0].1 * flat[1].0;
        let sweep = u8::from(turns > 0.0);
        format!(
            "M{from}A{} {} {:.1} 0 {sweep} {to}",
            unit(whole.long),
            unit(whole.short),
            whole.angle
        )
    }

    /// Draws only the outline, filled.
    pub fn shade(&self, centre: Vector, arms: &[Vector; 3], colour: RGBColor) -> String {
        let (x, y) = self.place(centre);
        let outline = Ellipse::of(&arms.map(|arm| self.arm(arm)));
        let fill = format!("fill=\"{}\"", code(colour));
        ellipse((unit(x), unit(y)), outline, &fill)
    }

    /// Draws a path with time as colour.
    pub fn path(&self, path: &[Vector]) -> String {
        let points: Vec<Point> = path.iter().map(|point| self.place(*point)).collect();
        let steps = points.len().saturating_sub(1);
        let pieces = PATH_PIECES.min(steps.max(1));
        let mut text = String::new();
        for piece in 0..pieces {
            let (from, to) = (piece * steps / pieces, (piece + 1) * steps / pieces);
            let Some(part) = points.get(from..=to) else {
                continue;
            };
            let time = (piece as f64 + 0.5) / pieces as f64;
            text += &polyline(&simplify(part, 0.15), ramp(time), 1.6, "");
        }
        text
    }

    /// Draws the directions of the world axes, at the lower left.
    pub fn compass(&self, height: f64) -> String {
        const AXIS_LENGTH: f64 = 22.0;
        const NAME_DISTANCE: f64 = AXIS_LENGTH + 9.0;
        // Leaves room for the leftmost and the lowest name.
        let ends = [0, 1, 2].map(|axis| self.view.place(along(axis)));
        let left = ends.iter().fold(0.0, |least: f64, end| least.min(end.0));
        let low = ends.iter().fold(0.0, |most: f64, end| most.max(end.1));
        let origin = (
            18.0 - NAME_DISTANCE * left,
            height - 16.0 - NAME_DISTANCE * low,
        );
        let mut text = String::new();
        let mut axes: Vec<(f64, usize)> = (0..3)
            .map(|axis| (self.view.depth(along(axis)), axis))
            .collect();
        axes.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, axis) in axes {
            let (x, y) = self.view.place(along(axis));
            let end = (origin.0 + AXIS_LENGTH * x, origin.1 + AXIS_LENGTH * y);
            text += &polyline(&[origin, end], axis_colour(axis), 1.6, "");
            let name = (
                origin.0 + NAME_DISTANCE * x - 3.0,
                origin.1 + NAME_DISTANCE * y + 4.0,
            );
            // There is no room to name an axis that points towards the eye.
            if x.hypot(y) > 0.3 {
                let _ = writeln!(
                    text,
                    "<text x=\"{}\" y=\"{}\" font-size=\"110\" fill=\"{}\">{}</text>",
                    unit(name.0),
                    unit(name.1),
                    code(theme::SOFT.0),
                    ["x", "y", "z"][axis]
                );
            }
        }
        text
    }
}

/// Returns the unit vector of an axis.
fn along(axis: usize) -> Vector {
    std::array::from_fn(|k| if k == axis { 1.0 } else { 0.0 })
}

/// Red, green and blue for the first, second and third axis.
fn axis_colour(axis: usize) -> RGBColor {
    theme::series([4, 2, 0][axis])
}

fn colour(ink: Ink) -> RGBColor {
    match ink {
        Ink::Series(index) => theme::series(index),
        Ink::Dark => theme::INK.0,
        Ink::Soft => theme::SOFT.0,
    }
}

fn written((x, y): Point) -> String {
    format!("{} {}", unit(x), unit(y))
}

fn ellipse((x, y): (i32, i32), of: Ellipse, style: &str) -> String {
    let (long, short) = (unit(of.long), unit(of.short));
    let turn = match of.angle {
        angle if angle.abs() < 0.05 || long == short => String::new(),
        angle => format!(" transform=\"rotate({angle:.1} {x} {y})\""),
    };
    format!("<ellipse cx=\"{x}\" cy=\"{y}\" rx=\"{long}\" ry=\"{short}\" {style}{turn}/>\n")
}

/// The end of the text that [`polyline`] writes.
const POLYLINE_END: &str = "\"/>\n";

fn polyline(points: &[Point], colour: RGBColor, width: f64, more: &str) -> String {
    let points: Vec<String> = points.iter().map(|point| written(*point)).collect();
    format!(
        "<path class=\"line\" stroke=\"{}\" stroke-width=\"{}\"{more} d=\"M{}{POLYLINE_END}",
        code(colour),
        unit(width),
        points.join("L")
    )
}

/// Concatenates elements; consecutive lines of one kind become one element.
pub fn join_elements(elements: impl Iterator<Item = String>) -> String {
    let mut text = String::new();
    let mut open = String::new();
    for element in elements {
        let head = element
            .find(" d=\"M")
            .filter(|_| element.starts_with("<path class"));
        let begin = head.map_or("", |end| &element[..end + 4]);
        // Only single lines are merged; elements with several lines, such as dampers, stay unchanged.
        let one = !begin.is_empty() && element.matches('<').count() == 1;
        match text.strip_suffix(POLYLINE_END) {
            Some(rest) if one && begin == open => {
                let length = rest.len();
                text.truncate(length);
                text += &element[begin.len()..];
            }
            _ => text += &element,
        }
        open = if one { begin.into() } else { String::new() };
    }
    text
}

/// Returns the point at a fraction of a line, moved sideways by a number of pixels.
fn point_beside(from: Point, to: Point, part: f64, aside: f64) -> Point {
    let (x, y) = (to.0 - from.0, to.1 - from.1);
    let length = x.hypot(y).max(f64::MIN_POSITIVE);
    (
        from.0 + part * x - aside * y / length,
        from.1 + part * y + aside * x / length,
    )
}

fn zigzag(from: Point, to: Point) -> Vec<Point> {
    let mut points = vec![from, point_beside(from, to, STRAIGHT_PART, 0.0)];
    for tooth in 0..2 * SPRING_TEETH {
        let part = (f64::from(tooth) + 0.5) / f64::from(2 * SPRING_TEETH);
        let side = if tooth % 2 == 0 {
            TOOTH_HEIGHT
        } else {
            -TOOTH_HEIGHT
        };
        points.push(point_beside(
            from,
            to,
            STRAIGHT_PART + (1.0 - 2.0 * STRAIGHT_PART) * part,
            side,
        ));
    }
    points.extend([point_beside(from, to, 1.0 - STRAIGHT_PART, 0.0), to]);
    points
}

/// Returns a rod with its piston, and the cylinder around it.
fn piston(from: Point, to: Point) -> [Vec<Point>; 4] {
    const HALF_WIDTH: f64 = 5.0;
    let at = |part: f64, aside: f64| point_beside(from, to, part, aside);
    [
        vec![from, at(0.55, 0.0)],
        vec![at(0.55, HALF_WIDTH - 1.5), at(0.55, 1.5 - HALF_WIDTH)],
        vec![
            at(0.4, HALF_WIDTH),
            at(0.7, HALF_WIDTH),
            at(0.7, -HALF_WIDTH),
            at(0.4, -HALF_WIDTH),
        ],
        vec![at(0.7, 0.0), to],
    ]
}
