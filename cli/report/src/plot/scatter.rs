//! Scatter diagrams of many runs: each result against each cause.

use super::axes::{Axes, Axis, Frame};
use super::figure::{Area, DrawResult, Figure, PlotError, circle, draw_heading, stroke};
use super::theme;
use plotters::style::ShapeStyle;

/// Numbers of many runs, by their names; in every list a run has the same index. Values that are not finite are not
/// drawn.
#[derive(Clone, Debug)]
pub struct Scatter {
    /// Heading.
    pub title: String,
    /// A sentence below it.
    pub subtitle: String,
    /// The quantity on the lower edge of each column of diagrams.
    pub across: Vec<(String, Vec<f64>)>,
    /// The quantity on the left edge of each row of diagrams.
    pub up: Vec<(String, Vec<f64>)>,
}

const TOP_MARGIN: f64 = 96.0;
const LEFT_MARGIN: f64 = 76.0;
const FRAME_WIDTH: f64 = 230.0;
const FRAME_HEIGHT: f64 = 150.0;
/// Gaps between frames, with room for the name of the frame below or the labels of the frame to the right.
const FRAME_GAPS: (f64, f64) = (86.0, 40.0);
const BOTTOM_MARGIN: f64 = 62.0;

/// Draws a diagram for each pair.
///
/// # Errors
/// If the drawing library fails; no case is known.
pub fn scatter(of: &Scatter) -> Result<Figure, PlotError> {
    let (columns, rows) = (of.across.len().max(1) as f64, of.up.len().max(1) as f64);
    let width = LEFT_MARGIN + columns * (FRAME_WIDTH + FRAME_GAPS.0) - FRAME_GAPS.0 + 30.0;
    let height = TOP_MARGIN + rows * (FRAME_HEIGHT + FRAME_GAPS.1) - FRAME_GAPS.1 + BOTTOM_MARGIN;
    Figure::draw(width, height, &of.title, |area| {
        draw_heading(area, &of.title, &of.subtitle)?;
        for row in 0..of.up.len() {
            for column in 0..of.across.len() {
                diagram(area, of, row, column)?;
            }
        }
        Ok(())
    })
}

fn diagram(area: &Area, of: &Scatter, row: usize, column: usize) -> DrawResult {
    let ((cause, causes), (result, results)) = (&of.across[column], &of.up[row]);
    let frame = Frame {
        x: LEFT_MARGIN + column as f64 * (FRAME_WIDTH + FRAME_GAPS.0),
        y: TOP_MARGIN + row as f64 * (FRAME_HEIGHT + FRAME_GAPS.1),
        width: FRAME_WIDTH,
        height: FRAME_HEIGHT,
    };
    let axes = Axes {
        frame,
        across: Axis::with_margin(causes.iter().copied()),
        up: Axis::with_margin(results.iter().copied()),
    };
    let last = row + 1 == of.up.len();
    axes.draw(area, last)?;
    axes.name(area, &format!("{result}{}", axes.up.factor()))?;
    if last {
        axes.write_x_label(area, &format!("{cause}{}", axes.across.factor()))?;
    }
    let style = ShapeStyle {
        filled: true,
        ..stroke(theme::series(row), 1.0)
    };
    let points = causes.iter().zip(results);
    for (&x, &y) in points.filter(|(x, y)| x.is_finite() && y.is_finite()) {
        circle(area, axes.place(x, y), 1.5, style)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Scatter, scatter};

    #[test]
    fn every_run_is_a_point_of_every_diagram() {
        let numbers = |factor: f64| (0..10).map(|k| factor * f64::from(k)).collect();
        let mut picture = Scatter {
            title: "a <sweep>".into(),
            subtitle: "ten members".into(),
            across: vec![("m".into(), numbers(0.1)), ("w".into(), numbers(-2.0))],
            up: vec![("end".into(), numbers(3.0)), ("max".into(), numbers(7.0))],
        };
        let text = scatter(&picture).expect("a drawing").standalone();
        assert_eq!(text.matches("h0").count(), 4 * 10);
        assert!(text.contains("a &lt;sweep&gt;"));
        // A member without a result gives no point.
        picture.up[1].1[3] = f64::NAN;
        let text = scatter(&picture).expect("a drawing").standalone();
        assert_eq!(text.matches("h0").count(), 4 * 10 - 2);
    }
}
