//! The path of a unit vector on a sphere, seen from afar; time as colour.

use super::line::{Point, coordinate as c, path, simplify};
use super::{Path, escape};
use crate::number::short;

/// Azimuth and elevation of the eye (rad).
const EYE: (f64, f64) = (0.6, 0.36);
/// Pieces of one colour.
const PIECES: usize = 60;
/// Colours from the first to the last time, to be seen on light and on dark ground.
const RAMP: [[f64; 3]; 4] = [
    [43.0, 124.0, 238.0],
    [139.0, 92.0, 230.0],
    [226.0, 70.0, 140.0],
    [240.0, 140.0, 20.0],
];

/// A parallel projection onto the drawing.
struct View {
    x: f64,
    y: f64,
    radius: f64,
}

impl View {
    /// Place in the drawing, and distance in front of the sphere's centre.
    fn project(&self, p: [f64; 3]) -> (Point, f64) {
        let ((sa, ca), (se, ce)) = (EYE.0.sin_cos(), EYE.1.sin_cos());
        let right = ca * p[1] - sa * p[0];
        let up = ce * p[2] - se * (ca * p[0] + sa * p[1]);
        let depth = se * p[2] + ce * (ca * p[0] + sa * p[1]);
        (
            (self.x + self.radius * right, self.y - self.radius * up),
            depth,
        )
    }

    /// The parts of a curve in front of the sphere and behind it; pieces join where they meet.
    fn split(&self, curve: &[[f64; 3]]) -> [Vec<Vec<Point>>; 2] {
        let mut parts: [Vec<Vec<Point>>; 2] = [Vec::new(), Vec::new()];
        let mut side = None;
        for pair in curve.windows(2) {
            let ((a, depth), (b, next)) = (self.project(pair[0]), self.project(pair[1]));
            let here = usize::from(depth + next < 0.0);
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

/// The sphere with its mesh, axes, path and scale of time.
pub fn sphere(curve: &Path, end: f64, x: f64, y: f64, radius: f64) -> String {
    let view = View { x, y, radius };
    let mut text = format!(
        "<text class=\"name\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
        c(x),
        c(y - radius - 42.0),
        escape(&curve.title)
    );
    text.push_str(&axes(&view, false));
    text.push_str(&format!(
        "<circle class=\"ball\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n",
        c(x),
        c(y),
        c(radius)
    ));
    let [front, behind] = mesh(&view);
    text.push_str(&format!(
        "<path class=\"mesh\" opacity=\".45\" d=\"{behind}\"/>\n"
    ));
    let points: Vec<[f64; 3]> = curve
        .points
        .iter()
        .copied()
        .filter(|p| p.iter().all(|v| v.is_finite()))
        .collect();
    let [path_front, path_behind] = pieces(&view, &points);
    text.push_str(&path_behind);
    text.push_str(&format!("<path class=\"mesh\" d=\"{front}\"/>\n"));
    text.push_str(&format!(
        "<circle class=\"rim\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n",
        c(x),
        c(y),
        c(radius)
    ));
    text.push_str(&path_front);
    text.push_str(&axes(&view, true));
    if let [first, .., last] = points[..] {
        let above = view.project(first).0.1 <= view.project(last).0.1;
        text.push_str(&dot(&view, last, 1.0, "end", !above));
        text.push_str(&dot(&view, first, 0.0, "start", above));
    }
    text.push_str(&scale(end, x, y + radius + 40.0));
    text
}

/// Circles of longitude and latitude every 30 degrees, in front and behind.
fn mesh(view: &View) -> [String; 2] {
    let turn = |i: i32| f64::from(i).to_radians() * 7.5;
    let mut circles: Vec<Vec<[f64; 3]>> = Vec::new();
    for longitude in 0..6 {
        let (s, k) = (f64::from(longitude) * 30.0).to_radians().sin_cos();
        circles.push(
            (0..=48)
                .map(|i| turn(i).sin_cos())
                .map(|(up, out)| [out * k, out * s, up])
                .collect(),
        );
    }
    for latitude in -2..=2 {
        let (up, out) = (f64::from(latitude) * 30.0).to_radians().sin_cos();
        circles.push(
            (0..=48)
                .map(|i| turn(i).sin_cos())
                .map(|(s, k)| [out * k, out * s, up])
                .collect(),
        );
    }
    let mut text = [String::new(), String::new()];
    for circle in &circles {
        for (side, parts) in view.split(circle).into_iter().enumerate() {
            text[side].extend(parts.iter().map(|part| path(&simplify(part, 0.1))));
        }
    }
    text
}

/// The axes of the world where they leave the sphere, those in front or those behind.
fn axes(view: &View, front: bool) -> String {
    let mut text = String::new();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let at = |length: f64| {
            view.project(std::array::from_fn(
                |i| if i == axis { length } else { 0.0 },
            ))
        };
        let ((from, depth), (to, _), (label, _)) = (at(1.0), at(1.13), at(1.22));
        if (depth >= 0.0) == front {
            text.push_str(&format!(
                "<path class=\"pole\" d=\"{}\"/>\n",
                path(&[from, to])
            ));
            text.push_str(&format!(
                "<text class=\"halo\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{name}</text>\n",
                c(label.0),
                c(label.1 + 4.0)
            ));
        }
    }
    text
}

/// The path in pieces of one colour, in front and behind.
fn pieces(view: &View, points: &[[f64; 3]]) -> [String; 2] {
    let mut text = [String::new(), String::new()];
    let steps = points.len().saturating_sub(1);
    let count = PIECES.min(steps);
    for piece in 0..count {
        let (from, to) = (piece * steps / count, (piece + 1) * steps / count);
        let colour = ramp((piece as f64 + 0.5) / count as f64);
        for (side, parts) in view.split(&points[from..=to]).into_iter().enumerate() {
            let d: String = parts
                .iter()
                .map(|part| path(&simplify(part, 0.15)))
                .collect();
            if !d.is_empty() {
                let class = if side == 0 { "path" } else { "path behind" };
                text[side].push_str(&format!(
                    "<path class=\"{class}\" stroke=\"{colour}\" d=\"{d}\"/>\n"
                ));
            }
        }
    }
    text
}

/// The first or the last point, named above or below, towards the middle.
fn dot(view: &View, point: [f64; 3], time: f64, name: &str, above: bool) -> String {
    let ((x, y), depth) = view.project(point);
    let opacity = if depth < 0.0 { " opacity=\".55\"" } else { "" };
    let (side, anchor) = if x >= view.x {
        (-8.0, "end")
    } else {
        (8.0, "start")
    };
    format!(
        "<circle cx=\"{}\" cy=\"{}\" r=\"4.5\" fill=\"{}\"{opacity}/>\n<text class=\"halo\" x=\"{}\" y=\"{}\" text-anchor=\"{anchor}\">{name}</text>\n",
        c(x),
        c(y),
        ramp(time),
        c(x + side),
        c(y + if above { -8.0 } else { 16.0 })
    )
}

/// Colours and the times that they stand for.
fn scale(end: f64, x: f64, y: f64) -> String {
    let stops: String = (0..RAMP.len())
        .map(|i| i as f64 / (RAMP.len() - 1) as f64)
        .map(|s| {
            format!(
                "<stop offset=\"{}\" stop-color=\"{}\"/>",
                (s * 100.0).round() / 100.0,
                ramp(s)
            )
        })
        .collect();
    format!(
        "<defs><linearGradient id=\"time\">{stops}</linearGradient></defs>\n\
         <rect x=\"{}\" y=\"{}\" width=\"140\" height=\"5\" rx=\"2.5\" fill=\"url(#time)\"/>\n\
         <text x=\"{}\" y=\"{}\" text-anchor=\"end\">t = 0</text>\n<text x=\"{}\" y=\"{}\">{}</text>\n",
        c(x - 70.0),
        c(y),
        c(x - 79.0),
        c(y + 7.0),
        c(x + 79.0),
        c(y + 7.0),
        short(end)
    )
}

/// The colour of a time from 0 to 1.
fn ramp(time: f64) -> String {
    let place = time.clamp(0.0, 1.0) * (RAMP.len() - 1) as f64;
    let index = (place as usize).min(RAMP.len() - 2);
    let part = place - index as f64;
    let [r, g, b] = std::array::from_fn(|i| {
        (RAMP[index][i] + part * (RAMP[index + 1][i] - RAMP[index][i])).round() as u8
    });
    format!("#{r:02x}{g:02x}{b:02x}")
}
