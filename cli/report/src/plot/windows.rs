//! Drift: the largest deviation of the energy in every window of long runs.

use super::axes::{Axes, Axis, Frame};
use super::chart::{names, room};
use super::figure::{Figure, PlotError, draw_heading, line, stroke};
use super::line::Point;
use super::theme;
use crate::data::Drift;

/// Larger deviations are a blow-up, and are drawn at the upper edge.
const MAX_DEVIATION: f64 = 1e3;

/// Draws long runs of one case on a logarithmic scale.
///
/// # Errors
/// If the drawing library fails; no case is known.
pub fn drifts(title: &str, subtitle: &str, runs: &[&Drift]) -> Result<Figure, PlotError> {
    const RIGHT_EDGE: f64 = 640.0;
    let beside = room(runs.iter().map(|run| run.method.as_str()));
    let width = f64::max(800.0, RIGHT_EDGE + beside);
    Figure::draw(width, 430.0, title, |area| {
        draw_heading(area, title, subtitle)?;
        let steps = runs.iter().map(|run| run.steps).max().unwrap_or(1) as f64;
        let energies = runs.iter().flat_map(|run| run.energy.iter());
        let energies = energies.map(|&energy| f64::min(energy, MAX_DEVIATION));
        let axes = Axes {
            frame: Frame {
                x: 70.0,
                y: 100.0,
                width: RIGHT_EDGE - 70.0,
                height: 270.0,
            },
            across: Axis::exact(0.0, steps),
            up: Axis::logarithmic(energies),
        };
        axes.draw(area, true)?;
        axes.name(
            area,
            "largest relative deviation of the energy in each window",
        )?;
        axes.write_x_label(area, &format!("steps{}", axes.across.factor()))?;
        let mut ends = Vec::new();
        for (index, run) in runs.iter().enumerate() {
            let window = run.steps as f64 / run.energy.len().max(1) as f64;
            let points: Vec<Point> = run
                .energy
                .iter()
                .enumerate()
                .map(|(number, &energy)| {
                    let middle = (number as f64 + 0.5) * window;
                    axes.place(middle, energy.min(MAX_DEVIATION).max(axes.up.low()))
                })
                .collect();
            let Some(&(_, end)) = points.last() else {
                continue;
            };
            line(area, &points, stroke(theme::series(index), 1.8))?;
            ends.push((index, run.method.as_str(), end));
        }
        names(area, &ends, axes.frame)
    })
}
