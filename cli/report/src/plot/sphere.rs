//! Curves on a sphere, in parallel projection with time as colour: the path of a body axis, and Poinsot's construction.
//! A torque-free body conserves |P| and 2T = P·J⁻¹P, with its angular momentum P in body axes: P moves on the polhodes,
//! the curves in which a sphere and an ellipsoid intersect.

use super::Path;
use super::figure::{Anchor, Area, DrawResult, circle, fill, letters, line, stroke, write};
use super::line::{Point, simplify};
use super::theme::{self, ramp};
use crate::number::short;
use plotters::style::{Color, ShapeStyle};

/// Azimuth and elevation of the eye (rad).
const EYE_DIRECTION: (f64, f64) = (0.6, 0.36);
/// Number of single-coloured pieces.
const MAX_PATH_PIECES: usize = 60;
/// Number of points of a circle of the mesh.
const CIRCLE_POINTS: u32 = 72;
/// Distance of the names of axes, relative to the radius of the sphere.
const NAME_DISTANCE: f64 = 0.22;
/// Largest extent of the ellipsoid with its names, relative to the available radius.
const MAX_REACH: f64 = 1.27;

type Vector = [f64; 3];

/// The data of Poinsot's construction.
#[derive(Clone, Debug)]
pub struct Poinsot {
    /// Angular momenta in body axes over the times of the picture.
    pub momenta: Vec<Vector>,
    /// J in the same axes, about the centre of mass or the fixed point.
    pub inertia: [Vector; 3],
}

/// A parallel projection onto the drawing.
struct View {
    x: f64,
    y: f64,
    radius: f64,
}

impl View {
    /// Returns the position in the drawing, and the distance in front of the sphere's centre.
    fn project(&self, p: Vector) -> (Point, f64) {
        let ((sa, ca), (se, ce)) = (EYE_DIRECTION.0.sin_cos(), EYE_DIRECTION.1.sin_cos());
        let right = ca * p[1] - sa * p[0];
        let up = ce * p[2] - se * (ca * p[0] + sa * p[1]);
        let depth = se * p[2] + ce * (ca * p[0] + sa * p[1]);
        let place = (self.x + self.radius * right, self.y - self.radius * up);
        (place, depth)
    }

    /// Splits a curve into visible and hidden parts, which join where they meet.
    fn split(&self, curve: &[Vector], seen: impl Fn(Vector, f64) -> bool) -> [Vec<Vec<Point>>; 2] {
        let mut parts: [Vec<Vec<Point>>; 2] = [Vec::new(), Vec::new()];
        let mut side = None;
        for pair in curve.windows(2) {
            let &[from, to] = pair else { continue };
            let ((a, depth), (b, next)) = (self.project(from), self.project(to));
            let middle = std::array::from_fn(|i| 0.5 * (from[i] + to[i]));
            let here = usize::from(!seen(middle, depth + next));
            if side != Some(here) {
                parts[here].push(vec![a]);
                side = Some(here);
            }
            if let Some(piece) = parts[here].last_mut() {
                piece.push(b);
            }
        }
        parts
    }
}

fn in_front(_: Vector, depth: f64) -> bool {
    depth >= 0.0
}

fn lines(area: &Area, parts: &[Vec<Point>], style: ShapeStyle) -> DrawResult {
    parts
        .iter()
        .try_for_each(|part| line(area, &simplify(part, 0.1), style))
}

/// Draws the sphere with the path of a body axis in the world, and the scale of time.
pub fn path(area: &Area, path: &Path, end: f64, at: Point, radius: f64) -> DrawResult {
    let view = View {
        x: at.0,
        y: at.1,
        radius,
    };
    heading(area, &path.title, at, radius)?;
    axes(area, &view, ["x", "y", "z"], |_| 1.0, false)?;
    curve(area, &view, &path.points, || Ok(()))?;
    axes(area, &view, ["x", "y", "z"], |_| 1.0, true)?;
    scale(area, end, (at.0, at.1 + radius + 42.0))
}

/// Draws Poinsot's construction, and the scale of time.
pub fn poinsot(area: &Area, poinsot: &Poinsot, end: f64, at: Point, radius: f64) -> DrawResult {
    heading(area, "Poinsot: P in body axes", at, radius)?;
    let size = |p: &Vector| p.iter().map(|v| v * v).sum::<f64>().sqrt();
    let first = poinsot.momenta.iter().map(size).find(|size| *size > 0.0);
    let (Some(length), Some(inverse)) = (first, inverse(&poinsot.inertia)) else {
        return Ok(());
    };
    let points: Vec<Vector> = poinsot
        .momenta
        .iter()
        .map(|p| p.map(|v| v / length))
        .collect();
    // 2T over |P|²: the ellipsoid reaches √(2T / d·J⁻¹d) / |P| along the unit vector d.
    let form = |d: &Vector| -> f64 {
        let row = |i: usize| (0..3).map(|j| inverse[i][j] * d[j]).sum::<f64>();
        (0..3).map(|i| d[i] * row(i)).sum()
    };
    let energy = points.first().map_or(0.0, form);
    let reach = |d: &Vector| (energy / form(d)).sqrt();
    let shell: Vec<Vec<Vector>> = circles()
        .into_iter()
        .map(|circle| {
            let out = |d: Vector| d.map(|v| v * reach(&d));
            circle.into_iter().map(out).collect::<Vec<Vector>>()
        })
        .filter(|circle| circle.iter().flatten().all(|v| v.is_finite()))
        .collect();
    let most = shell.iter().flatten().map(size).fold(1.0, f64::max);
    let view = View {
        x: at.0,
        y: at.1,
        radius: radius * (MAX_REACH / (most + NAME_DISTANCE)).min(1.0),
    };
    let ends = |i: usize| reach(&unit(i)).max(1.0);
    let names = ["1", "2", "3"];
    axes(area, &view, names, ends, false)?;
    let colour = theme::SHELL.0;
    let outside = |p: Vector, depth: f64| depth >= 0.0 && size(&p) > 1.0;
    curve(area, &view, &points, || {
        for circle in &shell {
            let [seen, hidden] = view.split(circle, outside);
            lines(area, &hidden, stroke(colour.mix(0.22), 0.8))?;
            lines(area, &seen, stroke(colour.mix(0.8), 1.0))?;
        }
        Ok(())
    })?;
    axes(area, &view, names, ends, true)?;
    let note = letters(12.0, theme::SOFT.0, Anchor::Middle, false);
    let below = at.1 + radius + 24.0;
    let text = "sphere |P|, ellipsoid P·J⁻¹P = 2T, polhode";
    write(area, text, (at.0, below + 14.0), &note)?;
    scale(area, end, (at.0, below + 34.0))
}

fn heading(area: &Area, text: &str, at: Point, radius: f64) -> DrawResult {
    let style = letters(12.0, theme::INK.0, Anchor::Middle, true);
    write(area, text, (at.0, at.1 - radius - 50.0), &style)
}

fn unit(axis: usize) -> Vector {
    std::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 })
}

/// Draws a ball with its mesh and a curve on it; `between` draws everything between the hidden and the visible parts of
/// the curve.
fn curve(
    area: &Area,
    view: &View,
    points: &[Vector],
    between: impl FnOnce() -> DrawResult,
) -> DrawResult {
    let middle = (view.x, view.y);
    let ball = ShapeStyle::from(theme::BALL.0).filled();
    circle(area, middle, view.radius, ball)?;
    let mesh: Vec<_> = circles()
        .iter()
        .map(|circle| view.split(circle, in_front))
        .collect();
    for [_, behind] in &mesh {
        lines(area, behind, stroke(theme::GRID.0.mix(0.45), 0.8))?;
    }
    let points: Vec<Vector> = points
        .iter()
        .copied()
        .filter(|p| p.iter().all(|v| v.is_finite()))
        .collect();
    let pieces = pieces(view, &points);
    for (colour, [_, behind]) in &pieces {
        lines(area, behind, stroke(ramp(*colour).mix(0.45), 1.2))?;
    }
    for [front, _] in &mesh {
        lines(area, front, stroke(theme::GRID.0, 0.8))?;
    }
    circle(area, middle, view.radius, stroke(theme::SOFT.0, 1.0))?;
    between()?;
    for (colour, [front, _]) in &pieces {
        lines(area, front, stroke(ramp(*colour), 2.2))?;
    }
    if let [first, .., last] = points[..] {
        let above = view.project(first).0.1 <= view.project(last).0.1;
        dot(area, view, last, 1.0, "end", !above)?;
        dot(area, view, first, 0.0, "start", above)?;
    }
    Ok(())
}

/// Returns circles of longitude and latitude every 30 degrees.
fn circles() -> Vec<Vec<Vector>> {
    let turns = || {
        (0..=CIRCLE_POINTS).map(|i| (f64::from(i) * 360.0 / f64::from(CIRCLE_POINTS)).to_radians())
    };
    let mut circles: Vec<Vec<Vector>> = Vec::new();
    for longitude in 0..6 {
        let (s, k) = (f64::from(longitude) * 30.0).to_radians().sin_cos();
        let point = |turn: f64| {
            let (up, out) = turn.sin_cos();
            [out * k, out * s, up]
        };
        circles.push(turns().map(point).collect());
    }
    for latitude in -2..=2 {
        let (up, out) = (f64::from(latitude) * 30.0).to_radians().sin_cos();
        let point = |turn: f64| {
            let (s, k) = turn.sin_cos();
            [out * k, out * s, up]
        };
        circles.push(turns().map(point).collect());
    }
    circles
}

/// Draws three axes from their exit points from the sphere or the shell, either those in front or those behind.
fn axes(
    area: &Area,
    view: &View,
    names: [&str; 3],
    reach: impl Fn(usize) -> f64,
    front: bool,
) -> DrawResult {
    let style = letters(12.0, theme::SOFT.0, Anchor::Middle, false);
    for (axis, name) in names.into_iter().enumerate() {
        let out = reach(axis);
        let at = |length: f64| view.project(unit(axis).map(|v| v * (out + length)));
        let ((from, depth), (to, _), (label, _)) = (at(0.0), at(0.13), at(NAME_DISTANCE));
        if (depth >= 0.0) == front {
            line(area, &[from, to], stroke(theme::SOFT.0, 1.4))?;
            write(area, name, label, &style)?;
        }
    }
    Ok(())
}

/// Splits a curve into single-coloured pieces, in front and behind.
fn pieces(view: &View, points: &[Vector]) -> Vec<(f64, [Vec<Vec<Point>>; 2])> {
    let steps = points.len().saturating_sub(1);
    let count = MAX_PATH_PIECES.min(steps);
    (0..count)
        .filter_map(|piece| {
            let (from, to) = (piece * steps / count, (piece + 1) * steps / count);
            let part = points.get(from..=to)?;
            let colour = (piece as f64 + 0.5) / count as f64;
            Some((colour, view.split(part, in_front)))
        })
        .collect()
}

/// Draws the first or the last point, with its name above or below, towards the middle.
fn dot(area: &Area, view: &View, point: Vector, time: f64, name: &str, above: bool) -> DrawResult {
    let ((x, y), depth) = view.project(point);
    let colour = ramp(time).mix(if depth < 0.0 { 0.55 } else { 1.0 });
    circle(area, (x, y), 4.5, ShapeStyle::from(colour).filled())?;
    let (side, anchor) = if x >= view.x {
        (-8.0, Anchor::End)
    } else {
        (8.0, Anchor::Start)
    };
    let style = letters(12.0, theme::SOFT.0, anchor, false);
    let up = if above { -12.0 } else { 12.0 };
    write(area, name, (x + side, y + up), &style)
}

/// Draws the colours and the times that they represent.
fn scale(area: &Area, end: f64, at: Point) -> DrawResult {
    const WIDTH: f64 = 140.0;
    const PARTS: usize = 28;
    let left = at.0 - 0.5 * WIDTH;
    for part in 0..PARTS {
        let x = |index: usize| left + WIDTH * index as f64 / PARTS as f64;
        let (from, to) = (x(part), x(part + 1));
        let (low, high) = (at.1 - 2.5, at.1 + 2.5);
        let corners = [(from, low), (to, low), (to, high), (from, high)];
        let colour = ramp((part as f64 + 0.5) / PARTS as f64);
        fill(area, &corners, colour.to_rgba())?;
    }
    let before = letters(12.0, theme::SOFT.0, Anchor::End, false);
    write(area, "t = 0", (left - 9.0, at.1), &before)?;
    let after = letters(12.0, theme::SOFT.0, Anchor::Start, false);
    write(area, &short(end), (left + WIDTH + 9.0, at.1), &after)
}

/// Returns J⁻¹ by the adjugate; `None` if J is singular.
fn inverse(j: &[Vector; 3]) -> Option<[Vector; 3]> {
    let minor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        j[r1][c1] * j[r2][c2] - j[r1][c2] * j[r2][c1]
    };
    let det: f64 = (0..3).map(|c| j[0][c] * minor(0, c)).sum();
    let inverse = std::array::from_fn(|r| std::array::from_fn(|c| minor(c, r) / det));
    (det.is_normal()).then_some(inverse)
}
