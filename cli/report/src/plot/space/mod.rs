//! Drawings of bodies in space: ellipsoids, bars, springs and paths in a parallel projection, in the order of
//! decreasing distance, on a floor with a grid.
//!
//! | file | owns |
//! |---|---|
//! | `shape` | the shapes |
//! | `view` | the projection, outlines of ellipsoids |
//! | `element` | each shape as SVG |
//! | `floor` | the floor, its grid, shadows |

mod element;
mod floor;
mod shape;
mod view;

pub use shape::{Ink, Part, Shape, Vector};
pub use view::{Base, ISOMETRIC, View, base};

use super::figure::{Figure, escape, unit};
use super::line::Point;
use super::theme;
use super::width::fit;
use crate::code_markup::plain;
use element::Sheet;
use floor::Floor;
use shape::MIN_SPLIT_WIDTH;
use std::fmt::Write;
use view::dot;

/// A drawing of space.
#[derive(Clone, Debug)]
pub struct Space {
    /// Heading.
    pub title: String,
    /// A sentence below it.
    pub subtitle: String,
    /// Two horizontal directions and the vertical one.
    pub base: Base,
    /// Azimuth and elevation of the eye (degrees).
    pub eye: (f64, f64),
    /// Whether there is a floor.
    pub floor: bool,
    /// The shapes of the current pose.
    pub parts: Vec<Part>,
    /// Earlier or later poses, drawn faintly, the faintest first.
    pub poses: Vec<Vec<Part>>,
    /// Paths of points, with time as colour.
    pub paths: Vec<Vec<Vector>>,
}

/// Width of a drawing, and its smallest and largest height (pixels).
const DRAWING_WIDTH: f64 = 520.0;
const HEIGHT_RANGE: (f64, f64) = (240.0, 460.0);
/// Margins: at the top and on the other sides.
const TOP_MARGIN: f64 = 58.0;
const SIDE_MARGIN: f64 = 26.0;
/// Longest piece of a bar, each of which has a separate depth, and largest number of pieces; bars thinner than
/// `MIN_SPLIT_WIDTH` have one piece (pixels).
const MAX_PIECE_LENGTH: f64 = 40.0;
const MAX_BAR_PIECES: f64 = 5.0;
/// Opacities of the faintest and the strongest of the faint poses.
const FAINT_OPACITY: (f64, f64) = (0.1, 0.24);

impl Shape {
    /// Returns the points that have to be visible with a margin in pixels.
    fn points(&self) -> Vec<Vector> {
        match self {
            Shape::Ellipsoid { centre, .. } => vec![*centre],
            Shape::Bar { ends, .. }
            | Shape::Dashes { ends }
            | Shape::Spring { ends }
            | Shape::Damper { ends } => ends.to_vec(),
            Shape::Ball { at, .. } | Shape::Ring { at, .. } => vec![*at],
        }
    }

    /// Returns how far the shape extends from its points along a direction.
    fn reach(&self, along: Vector) -> f64 {
        match self {
            Shape::Ellipsoid { arms, .. } => {
                let squares = arms.iter().map(|arm| dot(*arm, along).powi(2));
                squares.sum::<f64>().sqrt()
            }
            _ => 0.0,
        }
    }

    /// Splits the shape into pieces that can be sorted by depth.
    fn pieces(&self, sheet: &Sheet) -> Vec<Shape> {
        let Shape::Bar { ends, width } = self else {
            return vec![self.clone()];
        };
        if *width < MIN_SPLIT_WIDTH {
            return vec![self.clone()];
        }
        let pieces = (sheet.length(ends) / MAX_PIECE_LENGTH)
            .ceil()
            .clamp(1.0, MAX_BAR_PIECES);
        let [from, to] = ends;
        let at = |part: f64| {
            let part = part / pieces;
            std::array::from_fn(|k| from[k] + part * (to[k] - from[k]))
        };
        let all = (0..pieces as u32).map(|piece| Shape::Bar {
            ends: [at(f64::from(piece)), at(f64::from(piece) + 1.0)],
            width: *width,
        });
        all.collect()
    }

    fn is_finite(&self) -> bool {
        let arms = match self {
            Shape::Ellipsoid { arms, .. } => arms.to_vec(),
            _ => Vec::new(),
        };
        let mut all = self.points().into_iter().chain(arms);
        all.all(|point| point.iter().all(|entry| entry.is_finite()))
    }
}

/// Draws bodies in space. Shapes that are not finite are left out.
pub fn space(space: &Space) -> Figure {
    let view = View::new(space.base, space.eye);
    let seen = |parts: &[Part]| -> Vec<Part> {
        let finite = parts.iter().filter(|part| part.shape.is_finite());
        finite.cloned().collect()
    };
    let parts = seen(&space.parts);
    let poses: Vec<Vec<Part>> = space.poses.iter().map(|pose| seen(pose)).collect();
    let all = || parts.iter().chain(poses.iter().flatten());
    let paths: Vec<Vec<Vector>> = space.paths.iter().map(|path| finite(path)).collect();
    let floor = space
        .floor
        .then(|| Floor::below(space.base, all().map(|part| &part.shape), &paths))
        .flatten();

    let mut frame = Bounds::new();
    for part in all() {
        let (right, up) = (part.shape.reach(view.right()), part.shape.reach(view.up()));
        for point in part.shape.points() {
            let (x, y) = view.place(point);
            frame.hold((x - right, y - up));
            frame.hold((x + right, y + up));
        }
    }
    for point in paths.iter().flatten() {
        frame.hold(view.place(*point));
    }
    for point in floor.iter().flat_map(Floor::corners) {
        frame.hold(view.place(point));
    }
    let (sheet, height) = frame.fit(view);

    let mut text = format!(
        "<rect width=\"{}\" height=\"{}\" fill=\"{}\"/>\n",
        unit(DRAWING_WIDTH),
        unit(height),
        theme::code(theme::GROUND.0)
    );
    text += element::STYLE_AND_LIGHT;
    if let Some(floor) = &floor {
        text += &floor.draw(&sheet);
        text += &floor.shadows(&sheet, &parts);
    }
    for (index, pose) in poses.iter().enumerate() {
        let part = (index + 1) as f64 / poses.len() as f64;
        let opacity = FAINT_OPACITY.0 + part * (FAINT_OPACITY.1 - FAINT_OPACITY.0);
        let _ = writeln!(text, "<g opacity=\"{opacity:.2}\">");
        text += &order_by_depth(pose, &sheet, true);
        text += "</g>\n";
    }
    for path in &paths {
        text += &sheet.path(path);
    }
    text += &order_by_depth(&parts, &sheet, false);
    text += &sheet.compass(height);
    let title = fit(&plain(&space.title), 15.0, true, DRAWING_WIDTH - 40.0);
    text += &written(&title, (20.0, 24.0), 15.0, true);
    let grid = floor.map_or(String::new(), |floor| floor.describe_grid());
    let said = [plain(&space.subtitle), grid];
    let said: Vec<&str> = said
        .iter()
        .map(String::as_str)
        .filter(|part| !part.is_empty())
        .collect();
    let said = fit(&said.join(" · "), 12.0, false, DRAWING_WIDTH - 40.0);
    text += &written(&said, (20.0, 43.0), 12.0, false);
    Figure::of(DRAWING_WIDTH, height, &space.title, text)
}

/// Draws the shapes of a pose, from the farthest to the nearest; faint ones are outlines, each in one piece.
fn order_by_depth(parts: &[Part], sheet: &Sheet, faint: bool) -> String {
    let mut pieces: Vec<(f64, Ink, Shape)> = Vec::new();
    for part in parts {
        let whole = || vec![part.shape.clone()];
        for shape in if faint {
            whole()
        } else {
            part.shape.pieces(sheet)
        } {
            let points = shape.points();
            let depths = points.iter().map(|point| sheet.view.depth(*point));
            let depth = depths.sum::<f64>() / points.len() as f64;
            pieces.push((depth, part.ink, shape));
        }
    }
    // A stable sort, so that pieces of equal depth keep their order.
    pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
    let drawn = pieces
        .iter()
        .map(|(_, ink, shape)| sheet.shape(*ink, shape, faint));
    element::join_elements(drawn)
}

fn finite(path: &[Vector]) -> Vec<Vector> {
    let finite = path
        .iter()
        .filter(|point| point.iter().all(|entry| entry.is_finite()));
    finite.copied().collect()
}

fn written(text: &str, (x, y): Point, size: f64, bold: bool) -> String {
    let (ink, weight) = match bold {
        true => (theme::INK, " font-weight=\"bold\""),
        false => (theme::SOFT, ""),
    };
    format!(
        "<text x=\"{}\" y=\"{}\" font-size=\"{}\"{weight} fill=\"{}\">{}</text>\n",
        unit(x),
        unit(y),
        unit(size),
        theme::code(ink.0),
        escape(text)
    )
}

/// The bounding rectangle of the drawing.
struct Bounds {
    least: Point,
    most: Point,
}

impl Bounds {
    fn new() -> Self {
        Bounds {
            least: (f64::INFINITY, f64::INFINITY),
            most: (f64::NEG_INFINITY, f64::NEG_INFINITY),
        }
    }

    fn hold(&mut self, (x, y): Point) {
        self.least = (self.least.0.min(x), self.least.1.min(y));
        self.most = (self.most.0.max(x), self.most.1.max(y));
    }

    /// Returns the scale and origin at which everything fits, and the height of the drawing.
    fn fit(&self, view: View) -> (Sheet, f64) {
        let Bounds { least, most } = self;
        let size = |least: f64, most: f64| {
            let size = most - least;
            if size.is_finite() { size } else { 0.0 }
        };
        let (wide, high) = (size(least.0, most.0), size(least.1, most.1));
        let room = (
            DRAWING_WIDTH - 2.0 * SIDE_MARGIN,
            HEIGHT_RANGE.1 - TOP_MARGIN - SIDE_MARGIN,
        );
        let scale = (room.0 / wide).min(room.1 / high);
        let scale = if scale.is_finite() { scale } else { 100.0 };
        let height = (TOP_MARGIN + scale * high + SIDE_MARGIN)
            .clamp(HEIGHT_RANGE.0, HEIGHT_RANGE.1)
            .ceil();
        let middle = |least: f64, most: f64| match size(least, most) {
            0.0 if !least.is_finite() => 0.0,
            _ => 0.5 * (least + most),
        };
        let (x, y) = (middle(least.0, most.0), middle(least.1, most.1));
        let sheet = Sheet {
            view,
            scale,
            origin: (
                0.5 * DRAWING_WIDTH - scale * x,
                0.5 * (TOP_MARGIN + height - SIDE_MARGIN) - scale * y,
            ),
        };
        (sheet, height)
    }
}
