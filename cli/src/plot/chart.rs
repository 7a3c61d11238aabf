//! Lines over time, each named at its end.

use super::axis::Axis;
use super::line::{by_column, coordinate as c, path, simplify};
use super::{Panel, colour, escape};

/// Where the lines are drawn.
#[derive(Clone, Copy, Debug)]
pub struct Area {
    /// Left edge.
    pub x: f64,
    /// Upper edge.
    pub y: f64,
    /// From left to right.
    pub width: f64,
    /// From top to bottom.
    pub height: f64,
}

/// Distance of two labels.
const LABEL: f64 = 15.0;

/// A panel; the last one carries the labels of the time axis.
pub fn panel(panel: &Panel, time: &[f64], area: &Area, last: bool) -> String {
    let (from, to) = match time {
        [first, .., last] if last > first => (*first, *last),
        _ => (0.0, 1.0),
    };
    let across = Axis::exact(from, to, 6.0);
    let up = Axis::around(
        panel
            .lines
            .iter()
            .flat_map(|(_, values)| values.iter().copied()),
        (area.height / 36.0).max(2.0),
    );
    let (right, bottom) = (area.x + area.width, area.y + area.height);
    let x = |value: f64| area.x + area.width * across.place(value);
    let y = |value: f64| bottom - area.height * up.place(value);

    let mut text = format!(
        "<text class=\"name\" x=\"{}\" y=\"{}\">{}{}</text>\n",
        c(area.x),
        c(area.y - 9.0),
        escape(&panel.title),
        up.factor()
    );
    let mut grid = String::new();
    let mut labels = String::new();
    for &tick in &across.ticks {
        grid.push_str(&format!("M{} {}V{}", c(x(tick)), c(area.y), c(bottom)));
        if last {
            labels.push_str(&format!(
                "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                c(x(tick)),
                c(bottom + 18.0),
                across.label(tick)
            ));
        }
    }
    for &tick in &up.ticks {
        grid.push_str(&format!("M{} {}H{}", c(area.x), c(y(tick)), c(right)));
        labels.push_str(&format!(
            "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n",
            c(area.x - 8.0),
            c(y(tick) + 4.0),
            up.label(tick)
        ));
    }
    text.push_str(&format!("<path class=\"grid\" d=\"{grid}\"/>\n"));
    if up.low < 0.0 && up.high > 0.0 {
        text.push_str(&format!(
            "<path class=\"zero\" d=\"M{} {}H{}\"/>\n",
            c(area.x),
            c(y(0.0)),
            c(right)
        ));
    }
    text.push_str(&labels);
    if last {
        text.push_str(&format!(
            "<text x=\"{}\" y=\"{}\">t{}</text>\n",
            c(right + 26.0),
            c(bottom + 18.0),
            across.factor()
        ));
    }
    let mut ends = Vec::new();
    for (index, (name, values)) in panel.lines.iter().enumerate() {
        let points: Vec<(f64, f64)> = time
            .iter()
            .zip(values)
            .filter(|(_, value)| value.is_finite())
            .map(|(&t, &value)| (x(t), y(value)))
            .collect();
        let Some(&(_, end)) = points.last() else {
            continue;
        };
        let shown = simplify(&by_column(&points), 0.15);
        text.push_str(&format!(
            "<path class=\"line s{}\" d=\"{}\"/>\n",
            colour(index),
            path(&shown)
        ));
        ends.push((index, name, end));
    }
    text.push_str(&names(&ends, right, area));
    text
}

/// Names beside the ends of lines, moved apart.
fn names(ends: &[(usize, &String, f64)], right: f64, area: &Area) -> String {
    let mut order: Vec<usize> = (0..ends.len()).collect();
    order.sort_by(|&a, &b| ends[a].2.total_cmp(&ends[b].2));
    let gap = LABEL.min((area.height + LABEL) / ends.len().max(1) as f64);
    let mut places: Vec<f64> = order.iter().map(|&index| ends[index].2).collect();
    for index in 1..places.len() {
        places[index] = places[index].max(places[index - 1] + gap);
    }
    let mut limit = area.y + area.height + 4.0;
    for place in places.iter_mut().rev() {
        *place = place.min(limit);
        limit = *place - gap;
    }
    let mut text = String::new();
    for (&index, place) in order.iter().zip(places) {
        let (line, name, end) = ends[index];
        let colour = colour(line);
        let lead = format!(
            "M{} {}L{} {}",
            c(right + 2.0),
            c(end),
            c(right + 11.0),
            c(place)
        );
        text.push_str(&format!("<path class=\"lead s{colour}\" d=\"{lead}\"/>\n"));
        text.push_str(&format!(
            "<text class=\"label l{colour}\" x=\"{}\" y=\"{}\">{}</text>\n",
            c(right + 14.0),
            c(place + 4.0),
            escape(name)
        ));
    }
    text
}
