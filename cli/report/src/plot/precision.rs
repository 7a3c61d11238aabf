//! Speed against error: work-precision diagrams.

use super::axes::{Axes, Axis, Frame};
use super::figure::{
    Anchor, Area, DrawResult, Figure, PlotError, circle, draw_heading, letters, line, stroke, write,
};
use super::line::Point;
use super::theme;
use super::width::width;
use crate::data::{Case, Kind, MethodRun, MethodRuns};
use plotters::style::ShapeStyle;

/// One diagram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Error against evaluations of forces.
    Evaluations,
    /// Error against wall time.
    Time,
}

impl Precision {
    fn work(self, run: &MethodRun) -> Option<f64> {
        match self {
            Precision::Evaluations => run.evaluations.map(|count| count as f64),
            Precision::Time => run.seconds.map(|seconds| 1e6 * seconds),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Precision::Evaluations => "evaluations of forces",
            Precision::Time => "time of the run (µs)",
        }
    }

    fn point(self, run: &MethodRun) -> Option<(f64, f64)> {
        let (work, error) = (self.work(run)?, run.error?);
        // An error of order 1 means that a run failed; zero has no place on a logarithmic scale.
        (work > 0.0 && error > 0.0 && error < MAX_DRAWN_ERROR).then_some((work, error))
    }
}

/// Larger errors are not drawn.
const MAX_DRAWN_ERROR: f64 = 30.0;
const FRAME_WIDTH: f64 = 350.0;
const FRAME_HEIGHT: f64 = 330.0;
/// Height of a line of the legend.
const LEGEND_ROW_HEIGHT: f64 = 17.0;
/// Position of names in a line of the legend, and their least width.
const NAME_OFFSET: f64 = 29.0;
const MIN_NAME_WIDTH: f64 = 105.0;

/// Draws error against evaluations, and error against time if it was measured.
///
/// # Errors
/// If the drawing library fails; no case is known.
pub fn precision(case: &Case) -> Result<Figure, PlotError> {
    let measured = |precision: Precision| {
        let mut runs = case.methods.iter().flat_map(|method| &method.runs);
        runs.any(|run| precision.point(run).is_some())
    };
    let mut panels = vec![Precision::Evaluations];
    if measured(Precision::Time) {
        panels.push(Precision::Time);
    }
    let legend = 112.0 + LEGEND_ROW_HEIGHT * case.methods.len() as f64;
    let height = (100.0 + FRAME_HEIGHT + 64.0).max(legend);
    let left = 70.0 + panels.len() as f64 * (FRAME_WIDTH + 70.0);
    let names = case.methods.iter();
    let names = names.map(|method| width(&method.method, 12.0, method.kind == Kind::Method));
    let width = left + NAME_OFFSET + names.fold(MIN_NAME_WIDTH, f64::max) + 16.0;
    let subtitle = format!("t = {}; {}", crate::number::short(case.until), case.error);
    Figure::draw(width, height, &case.title, |area| {
        draw_heading(area, &case.title, &subtitle)?;
        for (index, &panel) in panels.iter().enumerate() {
            let x = 76.0 + index as f64 * (FRAME_WIDTH + 70.0);
            let frame = Frame {
                x,
                y: 100.0,
                width: FRAME_WIDTH,
                height: FRAME_HEIGHT,
            };
            diagram(area, case, panel, frame)?;
        }
        for (index, method) in case.methods.iter().enumerate() {
            let at = (left, 108.0 + LEGEND_ROW_HEIGHT * index as f64);
            let end = (at.0 + 22.0, at.1);
            line(area, &[at, end], style(index, method))?;
            mark(area, (at.0 + 11.0, at.1), index, method)?;
            let bold = method.kind == Kind::Method;
            let text = letters(12.0, theme::series(index), Anchor::Start, bold);
            write(area, &method.method, (at.0 + NAME_OFFSET, at.1), &text)?;
        }
        Ok(())
    })
}

fn diagram(area: &Area, case: &Case, panel: Precision, frame: Frame) -> DrawResult {
    let all: Vec<(f64, f64)> = case
        .methods
        .iter()
        .flat_map(|method| &method.runs)
        .filter_map(|run| panel.point(run))
        .collect();
    let axes = Axes {
        frame,
        across: Axis::logarithmic(all.iter().map(|point| point.0)),
        up: Axis::logarithmic(all.iter().map(|point| point.1)),
    };
    axes.draw(area, true)?;
    axes.name(area, "error")?;
    axes.write_x_label(area, panel.name())?;
    for (index, method) in case.methods.iter().enumerate() {
        let points: Vec<Point> = method
            .runs
            .iter()
            .filter_map(|run| panel.point(run))
            .map(|(work, error)| axes.place(work, error))
            .collect();
        line(area, &points, style(index, method))?;
        for point in points {
            mark(area, point, index, method)?;
        }
    }
    Ok(())
}

/// Returns the style of a line, which is thin for baselines and peers.
fn style(index: usize, method: &MethodRuns) -> ShapeStyle {
    let width = if method.kind == Kind::Method {
        1.8
    } else {
        0.9
    };
    stroke(theme::series(index), width)
}

/// Draws a disk, smaller for baselines and peers.
fn mark(area: &Area, at: Point, index: usize, method: &MethodRuns) -> DrawResult {
    let radius = if method.kind == Kind::Method {
        2.7
    } else {
        1.7
    };
    let style = ShapeStyle {
        filled: true,
        ..stroke(theme::series(index), 1.0)
    };
    circle(area, at, radius, style)
}

#[cfg(test)]
mod tests {
    use super::precision;
    use crate::data::{Case, Kind, MethodRun, MethodRuns};

    #[test]
    fn every_point_is_drawn_once_in_each_diagram() {
        let run = |steps: u64| MethodRun {
            steps,
            evaluations: Some(4 * steps),
            error: Some((steps as f64).powi(-4)),
            seconds: Some(1e-6 * steps as f64),
            ..MethodRun::default()
        };
        let mut runs: Vec<MethodRun> = [10, 20, 40].map(run).to_vec();
        runs.push(MethodRun {
            steps: 80,
            failure: Some("not finite".into()),
            ..MethodRun::default()
        });
        let case = Case {
            title: "a <top>".into(),
            methods: vec![MethodRuns {
                method: "rkmk4".into(),
                kind: Kind::Method,
                order: Some(4),
                runs,
            }],
            ..Case::default()
        };
        let text = precision(&case).expect("a drawing").standalone();
        // Three points in two diagrams, and one mark in the legend.
        assert_eq!(text.matches("h0").count(), 7);
        assert!(text.contains("a &lt;top&gt;") && text.contains("time of the run"));
        let mut untimed = case.clone();
        for run in &mut untimed.methods[0].runs {
            run.seconds = None;
        }
        let text = precision(&untimed).expect("a drawing").standalone();
        assert_eq!(text.matches("h0").count(), 4);
    }
}
