//! Lines over time, each named at its end.

use super::axes::{Axes, Axis, Frame};
use super::figure::{Anchor, Area, DrawResult, letters, line, stroke, write};
use super::line::{Point, by_column, simplify};
use super::width::width;
use super::{Panel, theme};

/// Distance between two labels.
const LABEL_SPACING: f64 = 15.0;
/// Size of labels, their distance from a frame, and the margin after them.
const LABEL_SIZE: f64 = 12.0;
const LABEL_OFFSET: f64 = 14.0;
const LABEL_MARGIN: f64 = 10.0;

/// Returns the width that names of lines need next to a frame.
pub fn room<'a>(names: impl Iterator<Item = &'a str>) -> f64 {
    let widest = names
        .map(|name| width(name, LABEL_SIZE, true))
        .fold(0.0, f64::max);
    LABEL_OFFSET + widest + LABEL_MARGIN
}

/// Returns the least height of a frame with this number of lines.
pub fn height(lines: usize) -> f64 {
    LABEL_SPACING * lines.saturating_sub(1) as f64
}

/// Quantity on the lower axis, which all panels share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Across {
    /// The time.
    Time,
    /// The angular frequency, on a logarithmic axis.
    Frequency,
}

/// Draws a panel; the last one has the labels of the lower axis.
pub fn panel(
    area: &Area,
    panel: &Panel,
    (kind, time): (Across, &[f64]),
    frame: Frame,
    last: bool,
) -> DrawResult {
    let (from, to) = match time {
        [first, .., last] if last > first => (*first, *last),
        _ => (0.0, 1.0),
    };
    let values = panel
        .lines
        .iter()
        .flat_map(|(_, values)| values.iter().copied());
    let axes = Axes {
        frame,
        across: match kind {
            Across::Time => Axis::exact(from, to),
            Across::Frequency => Axis::exact_logarithmic(from, to),
        },
        up: Axis::with_margin(values),
    };
    axes.draw(area, last)?;
    axes.name(area, &format!("{}{}", panel.title, axes.up.factor()))?;
    let (right, bottom) = (frame.x + frame.width, frame.y + frame.height);
    if last {
        let style = letters(12.0, theme::SOFT.0, Anchor::Start, false);
        let name = match kind {
            Across::Time => format!("t{}", axes.across.factor()),
            Across::Frequency => "rad/s".into(),
        };
        write(area, &name, (right + 26.0, bottom + 14.0), &style)?;
    }
    let mut ends = Vec::new();
    for (index, (name, values)) in panel.lines.iter().enumerate() {
        let points: Vec<Point> = time
            .iter()
            .zip(values)
            .filter(|(_, value)| value.is_finite())
            .map(|(&t, &value)| axes.place(t, value))
            .collect();
        let Some(&(_, end)) = points.last() else {
            continue;
        };
        let shown = simplify(&by_column(&points), 0.15);
        line(area, &shown, stroke(theme::series(index), 1.8))?;
        ends.push((index, name.as_str(), end));
    }
    names(area, &ends, frame)
}

/// Writes names next to the ends of lines, moved apart; each has the index of its colour and the height of its end.
pub fn names(area: &Area, ends: &[(usize, &str, f64)], frame: Frame) -> DrawResult {
    let right = frame.x + frame.width;
    let mut order: Vec<&(usize, &str, f64)> = ends.iter().collect();
    order.sort_by(|a, b| a.2.total_cmp(&b.2));
    let gap = LABEL_SPACING.min((frame.height + LABEL_SPACING) / ends.len().max(1) as f64);
    let mut places: Vec<f64> = Vec::new();
    for (_, _, end) in &order {
        places.push(places.last().map_or(*end, |above| end.max(above + gap)));
    }
    let mut limit = frame.y + frame.height + 4.0;
    for place in places.iter_mut().rev() {
        *place = place.min(limit);
        limit = *place - gap;
    }
    for (&(index, name, end), place) in order.into_iter().zip(places) {
        let colour = theme::series(index);
        let lead = [(right + 2.0, end), (right + 11.0, place)];
        line(area, &lead, stroke(colour, 1.0))?;
        let style = letters(LABEL_SIZE, colour, Anchor::Start, true);
        write(area, name, (right + LABEL_OFFSET, place), &style)?;
    }
    Ok(())
}
