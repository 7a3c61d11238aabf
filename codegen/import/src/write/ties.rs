//! Writes `loop` and `spring` statements, the connections between links outside the tree.

use super::Writer;
use super::joint::pose;
use crate::decimal::{Decimal, vector};
use crate::options::Idle;
use crate::robot::{Closing, End};
use std::collections::BTreeMap;

/// Unit vectors of the axes.
const UNITS: [&str; 3] = ["[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"];

/// One equation of a loop-closing joint.
struct Row {
    left: String,
    right: String,
    /// The motion that the equation prevents: `along` or `about` a direction of the world or of the first frame.
    stops: String,
}

impl Writer<'_> {
    /// Writes the loop-closing joints, each with a frame at both ends.
    pub(super) fn loops(&mut self, idle: &BTreeMap<usize, Idle>) {
        let mut before = 0;
        for index in 0..self.robot.loops.len() {
            let name = &self.names.loops[index];
            let ends = ["_1", "_2"].map(|end| format!("{name}{end}"));
            let rows = rows(&self.robot.loops[index].closing, &ends);
            let first = before;
            before += rows.len();
            let reasons = (first..before).map(|place| idle.get(&place).copied());
            let (mut kept, mut left_out) = (Vec::new(), Vec::new());
            for (row, reason) in rows.iter().zip(reasons) {
                match reason {
                    None => kept.push(row),
                    Some(reason) => left_out.push((row, reason)),
                }
            }
            self.page.blank();
            self.closing(index, &ends, &kept);
            self.left_out(index, &left_out);
        }
    }

    /// Writes the frames and equations of a loop-closing joint, if it has any equations.
    fn closing(&mut self, index: usize, names: &[String; 2], rows: &[&Row]) {
        let Some((last, others)) = rows.split_last() else {
            return;
        };
        let closing = &self.robot.loops[index];
        let range = Some(&closing.name.range);
        for (frame, end) in names.iter().zip(&closing.ends) {
            let pose = pose(end.origin.rotation.text(), &end.origin.position, None);
            let pose = pose.unwrap_or_else(|| "pose(identity(3), [0, 0, 0])".into());
            let text = match self.carrier(end) {
                Some(link) => format!("frame {frame} on {link} at {pose};"),
                None => format!("frame {frame} = {pose};"),
            };
            self.page.line(range, &text);
        }
        self.page.line(range, "loop");
        let others = others.iter().map(|row| (row, ","));
        for (row, end) in others.chain([(last, ";")]) {
            self.equations.push(self.page.origins.len());
            let (left, right) = (&row.left, &row.right);
            self.page.line(range, &format!("    {left} = {right}{end}"));
        }
    }

    /// Writes redundant equations as comments, with the reason.
    fn left_out(&mut self, index: usize, rows: &[(&Row, Idle)]) {
        let name = &self.robot.loops[index].name;
        let range = &name.range;
        if !rows.is_empty() {
            let name = &name.name;
            let text = format!(
                "Left out of `{name}`, since it adds nothing for any position of the tree:"
            );
            self.page.comment(range, &text);
        }
        for (row, reason) in rows {
            let why = match reason {
                Idle::Holds => "always holds",
                Idle::Follows => "follows from the others",
            };
            let Row { left, right, stops } = row;
            let text = format!("- {stops}: `{left} = {right}` {why}");
            self.page.comment(range, &text);
        }
    }

    /// Writes springs and dampers between points.
    pub(super) fn springs(&mut self) {
        let robot = self.robot;
        for spring in &robot.springs {
            let ends = spring.ends.each_ref().map(|end| {
                let link = self.carrier(end).unwrap_or_else(|| "world".into());
                format!("{} on {link}", vector(&end.origin.position))
            });
            let (range, ends) = (Some(&spring.range), ends.join(" to "));
            self.page.blank();
            if !spring.stiffness.is_zero() {
                let (stiffness, length) = (&spring.stiffness.text, &spring.length.text);
                let text = format!("spring stiffness {stiffness} length {length} from {ends};");
                self.page.line(range, &text);
            }
            if !spring.damping.is_zero() {
                let text = format!("damper coefficient {} from {ends};", spring.damping.text);
                self.page.line(range, &text);
            }
        }
    }

    /// Returns the frame of the link at an end; `None` if the link is fixed to the world.
    fn carrier(&self, end: &End) -> Option<String> {
        let mut links = self.robot.links.iter();
        let link = links.position(|link| link.name.name == end.link.name)?;
        let stands = link == self.tree.root && !self.options.floating;
        (!stands).then(|| self.names.links[link].clone())
    }
}

/// Returns the equations that hold when two frames are joined.
fn rows(closing: &Closing, [a, b]: &[String; 2]) -> Vec<Row> {
    let gap = |axis: usize| Row {
        left: format!("position({a})[{axis}]"),
        right: format!("position({b})[{axis}]"),
        stops: format!("along {} of the world", UNITS[axis - 1]),
    };
    let across = |left: &str, right: &str, about: &str| Row {
        left: format!("dot({a}.R * {left}, {b}.R * {right})"),
        right: "0".into(),
        stops: format!("about {about} of `{a}`"),
    };
    let aligned = || {
        let [x, y, z] = UNITS;
        [across(x, y, z), across(y, z, x), across(z, x, y)]
    };
    match closing {
        Closing::Spherical => [1, 2, 3].map(gap).into(),
        Closing::Fixed => [1, 2, 3].map(gap).into_iter().chain(aligned()).collect(),
        Closing::Revolute(axis) => {
            let (along, [first, second]) = (vector(axis), normals(axis));
            let turns = [
                across(&along, &first, &second),
                across(&along, &second, &first),
            ];
            [1, 2, 3].map(gap).into_iter().chain(turns).collect()
        }
        Closing::Prismatic(axis) => {
            let slides = normals(axis).map(|normal| Row {
                left: format!("dot({a}.R * {normal}, position({b}) - position({a}))"),
                right: "0".into(),
                stops: format!("along {normal} of `{a}`"),
            });
            slides.into_iter().chain(aligned()).collect()
        }
    }
}

/// Returns two directions orthogonal to an axis: its cross product with the unit vector farthest from it, and the
/// cross product of the axis with that.
fn normals(axis: &[Decimal; 3]) -> [String; 2] {
    let least = (0..3).min_by(|&i, &j| axis[i].value.abs().total_cmp(&axis[j].value.abs()));
    let least = least.unwrap_or(0);
    let (next, last) = ((least + 1) % 3, (least + 2) % 3);
    let mut first: [Decimal; 3] = std::array::from_fn(|_| Decimal::zero());
    first[next] = axis[last].clone();
    first[last] = axis[next].negated();
    let nonzero: Vec<usize> = (0..3).filter(|&i| !axis[i].is_zero()).collect();
    let second = match nonzero.as_slice() {
        // For a coordinate axis this unit vector is the second direction itself.
        [_] => {
            let mut unit: [Decimal; 3] = std::array::from_fn(|_| Decimal::zero());
            unit[least] = Decimal::one();
            vector(&unit)
        }
        _ => format!("cross({}, {})", vector(axis), vector(&first)),
    };
    [vector(&first), second]
}
