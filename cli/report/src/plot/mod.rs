//! Pictures as SVG: lines over time, paths on a sphere, Poinsot's construction, speed against error,
//! drift, bodies in space.
//!
//! The text is deterministic. Colours follow the reader's light or dark scheme.

mod axes;
mod chart;
mod figure;
mod line;
mod precision;
mod scatter;
pub mod space;
mod sphere;
mod theme;
mod width;
mod windows;

pub use figure::{Figure, PlotError, escape};
pub use precision::{Precision, precision};
pub use scatter::{Scatter, scatter};
pub use sphere::Poinsot;
pub use theme::sheet;
pub use width::width;
pub use windows::drifts;

use axes::Frame;
use chart::Across;
use figure::draw_heading;

/// Lines over time that share a vertical axis.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Name of the quantity.
    pub title: String,
    /// Names and values, with one value for every time of the picture.
    pub lines: Vec<(String, Vec<f64>)>,
}

impl Panel {
    /// Creates a panel without lines.
    pub fn new(title: &str) -> Self {
        Panel {
            title: title.to_string(),
            lines: Vec::new(),
        }
    }
}

/// A curve of unit vectors over the times of the picture.
#[derive(Clone, Debug)]
pub struct Path {
    /// Name of the curve.
    pub title: String,
    /// Unit vectors in world axes.
    pub points: Vec<[f64; 3]>,
}

/// The contents of the picture of a run.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Heading.
    pub title: String,
    /// A sentence below it.
    pub subtitle: String,
    /// Times of all values, ascending.
    pub time: Vec<f64>,
    /// Panels from top to bottom; the last one is lower.
    pub panels: Vec<Panel>,
    /// The sphere next to them, if there is one.
    pub path: Option<Path>,
    /// Poinsot's construction, if there is one.
    pub poinsot: Option<Poinsot>,
}

const HEADING_HEIGHT: f64 = 66.0;
const TITLE_HEIGHT: f64 = 26.0;
const PANEL_GAP: f64 = 22.0;
const FOOT_HEIGHT: f64 = 50.0;
const LEFT_MARGIN: f64 = 66.0;
/// Least width for the names of lines.
const MIN_LABEL_WIDTH: f64 = 78.0;
/// Width and height of a sphere with its labels.
const SPHERE_SIZE: (f64, f64) = (380.0, 410.0);
const SPHERE_RADIUS: f64 = 140.0;

/// Draws the picture of a run.
///
/// # Errors
/// If the drawing library fails; no case is known.
pub fn run(picture: &Picture) -> Result<Figure, PlotError> {
    draw(picture, Across::Time)
}

/// Draws a picture with frequencies (rad/s) in place of times, on a logarithmic axis.
///
/// # Errors
/// If the drawing library fails; no case is known.
pub fn bode(picture: &Picture) -> Result<Figure, PlotError> {
    draw(picture, Across::Frequency)
}

fn draw(picture: &Picture, across_axis: Across) -> Result<Figure, PlotError> {
    let spheres = usize::from(picture.path.is_some()) + usize::from(picture.poinsot.is_some());
    let across = if spheres > 0 { 446.0 } else { 656.0 };
    let lines = picture.panels.iter().flat_map(|panel| &panel.lines);
    let names = chart::room(lines.map(|(name, _)| name.as_str()));
    let wide = LEFT_MARGIN + across + names.max(MIN_LABEL_WIDTH);
    let upper = if picture.panels.len() > 2 {
        140.0
    } else {
        200.0
    };
    // The names of all lines fit below each other.
    let height_of = |index: usize| {
        let last = index + 1 == picture.panels.len();
        let lines = picture.panels[index].lines.len();
        chart::height(lines).max(if last { 92.0 } else { upper })
    };
    let charts: f64 = (0..picture.panels.len())
        .map(|index| TITLE_HEIGHT + height_of(index) + PANEL_GAP)
        .sum();
    let least = HEADING_HEIGHT + if spheres > 0 { SPHERE_SIZE.1 } else { 0.0 };
    let height = (HEADING_HEIGHT + charts - PANEL_GAP + FOOT_HEIGHT).max(least);
    let width = wide + SPHERE_SIZE.0 * spheres as f64;
    Figure::draw(width, height, &picture.title, |area| {
        draw_heading(area, &picture.title, &picture.subtitle)?;
        let mut top = HEADING_HEIGHT;
        for (index, panel) in picture.panels.iter().enumerate() {
            top += TITLE_HEIGHT;
            let frame = Frame {
                x: LEFT_MARGIN,
                y: top,
                width: across,
                height: height_of(index),
            };
            let last = index + 1 == picture.panels.len();
            chart::panel(area, panel, (across_axis, &picture.time), frame, last)?;
            top += frame.height + PANEL_GAP;
        }
        let end = picture.time.last().copied().unwrap_or(0.0);
        let middle = (HEADING_HEIGHT + height) / 2.0 - 8.0;
        let mut x = wide + 0.5 * SPHERE_SIZE.0 - 10.0;
        if let Some(path) = &picture.path {
            sphere::path(area, path, end, (x, middle), SPHERE_RADIUS)?;
            x += SPHERE_SIZE.0;
        }
        if let Some(poinsot) = &picture.poinsot {
            sphere::poinsot(area, poinsot, end, (x, middle), SPHERE_RADIUS)?;
        }
        Ok(())
    })
}

/// Draws only Poinsot's construction.
///
/// # Errors
/// If the drawing library fails; no case is known.
pub fn construction(
    title: &str,
    subtitle: &str,
    poinsot: &Poinsot,
    end: f64,
) -> Result<Figure, PlotError> {
    Figure::draw(480.0, 540.0, title, |area| {
        draw_heading(area, title, subtitle)?;
        sphere::poinsot(area, poinsot, end, (240.0, 296.0), 160.0)
    })
}

#[cfg(test)]
mod tests {
    use super::{Panel, Path, Picture, Poinsot, run};

    fn picture() -> Picture {
        let time: Vec<f64> = (0..=100).map(|i| f64::from(i) * 0.1).collect();
        let mut panel = Panel::new("a < b");
        panel
            .lines
            .push(("w[1]".into(), time.iter().map(|t| t.sin()).collect()));
        let mut flat = Panel::new("energy");
        flat.lines.push(("E".into(), vec![0.0; time.len()]));
        let points = time.iter().map(|t| [t.cos(), t.sin(), 0.0]).collect();
        let momenta = time.iter().map(|t| [t.cos(), 0.0, t.sin()]).collect();
        Picture {
            title: "T & V".into(),
            subtitle: "a picture".into(),
            time,
            panels: vec![panel, flat],
            path: Some(Path {
                title: "axis".into(),
                points,
            }),
            poinsot: Some(Poinsot {
                momenta,
                inertia: [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]],
            }),
        }
    }

    #[test]
    fn the_same_picture_is_the_same_text() {
        let picture = picture();
        let text = run(&picture).expect("a drawing").standalone();
        assert_eq!(text, run(&picture).expect("a drawing").standalone());
        for part in [
            "T &amp; V",
            "a &lt; b",
            "w[1]",
            "axis",
            "polhode",
            "prefers-color-scheme",
        ] {
            assert!(text.contains(part), "{part}");
        }
        assert!(!text.contains("NaN") && !text.contains("inf"));
        assert!(text.starts_with("<svg") && text.ends_with("</svg>\n"));
    }

    #[test]
    fn what_is_not_finite_is_left_out() {
        let mut picture = picture();
        picture.panels[0].lines[0].1 = vec![f64::NAN, f64::INFINITY];
        picture.path = None;
        picture.poinsot = None;
        let text = run(&picture).expect("a drawing").standalone();
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    }
}
