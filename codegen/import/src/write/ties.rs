//! Writes `loop` and `spring` statements, the connections between links outside the tree.

use super::Writer;
use super::joint::pose;
use crate::decimal::{Decimal, vector};
use crate::options::Idle;
use crate::robot::{Closing, End};
use hamel_language::expression::{call, ident, shifted};
use hamel_language::syntax::ast::{self, Acting, Expr, ItemKind};
use hamel_language::syntax::written::equation;
use std::collections::BTreeMap;

/// One equation of a loop-closing joint.
struct Row {
    left: Expr,
    right: Expr,
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
            self.draft.blank();
            self.closing(index, &ends, &kept);
            self.left_out(index, &left_out);
        }
    }

    /// Writes the frames and equations of a loop-closing joint, if it has any equations.
    fn closing(&mut self, index: usize, names: &[String; 2], rows: &[&Row]) {
        if rows.is_empty() {
            return;
        }
        let robot = self.robot;
        let closing = &robot.loops[index];
        let range = &closing.name.range;
        for (frame, end) in names.iter().zip(&closing.ends) {
            let pose = pose(end.origin.rotation.expr(), &end.origin.position, None);
            let frame = ItemKind::Frame {
                name: ident(frame),
                on: self.carrier(end).map(ident),
                pose: pose.unwrap_or_else(|| shifted([0, 0, 0])),
            };
            self.draft.statement(range, frame);
        }
        for row in rows {
            self.equations.push(self.draft.items.len());
            let equation = ItemKind::Loop {
                left: row.left.clone(),
                right: row.right.clone(),
                stabilized: None,
            };
            self.draft.statement(range, equation);
        }
    }

    /// Writes redundant equations as comments, with the reason.
    fn left_out(&mut self, index: usize, rows: &[(&Row, Idle)]) {
        let name = &self.robot.loops[index].name.name;
        if !rows.is_empty() {
            self.draft.comment(format!(
                "Left out of `{name}`, since it adds nothing for any position of the tree:"
            ));
        }
        for (row, reason) in rows {
            let why = match reason {
                Idle::Holds => "always holds",
                Idle::Follows => "follows from the others",
            };
            let (stops, equation) = (&row.stops, equation(&row.left, &row.right));
            self.draft.comment(format!("- {stops}: `{equation}` {why}"));
        }
    }

    /// Writes springs and dampers between points.
    pub(super) fn springs(&mut self) {
        let robot = self.robot;
        for spring in &robot.springs {
            let [from, to] = spring.ends.each_ref().map(|end| ast::End {
                at: Some(vector(&end.origin.position)),
                frame: ident(self.carrier(end).unwrap_or("world")),
            });
            let acting = Acting::Between(from, to);
            self.draft.blank();
            if !spring.stiffness.is_zero() {
                let spring_between = ItemKind::Spring {
                    stiffness: (&spring.stiffness).into(),
                    length: Some((&spring.length).into()),
                    acting: acting.clone(),
                };
                self.draft.statement(&spring.range, spring_between);
            }
            if !spring.damping.is_zero() {
                let coefficient = (&spring.damping).into();
                let damper = ItemKind::Damper {
                    coefficient,
                    acting,
                };
                self.draft.statement(&spring.range, damper);
            }
        }
    }

    /// Returns the frame of the link at an end; `None` if the link is fixed to the world.
    fn carrier(&self, end: &End) -> Option<&str> {
        let mut links = self.robot.links.iter();
        let link = links.position(|link| link.name.name == end.link.name)?;
        let stands = link == self.tree.root && !self.options.floating;
        (!stands).then(|| self.names.links[link].as_str())
    }
}

/// Returns the equations that hold when two frames are joined.
fn rows(closing: &Closing, [a, b]: &[String; 2]) -> Vec<Row> {
    let position = |frame: &str| call("position", [Expr::name(frame)]);
    let rotation = |frame: &str| Expr::name(frame).part("R");
    let unit = |axis: usize| Expr::from([0, 1, 2].map(|i| i32::from(i == axis)));
    let gap = |axis: usize| Row {
        left: position(a).entry(axis as i32 + 1),
        right: position(b).entry(axis as i32 + 1),
        stops: format!("along {} of the world", unit(axis)),
    };
    let across = |left: &Expr, right: &Expr, about: &Expr| Row {
        left: call("dot", [rotation(a) * left, rotation(b) * right]),
        right: 0.into(),
        stops: format!("about {about} of `{a}`"),
    };
    let aligned = || {
        let [x, y, z] = [0, 1, 2].map(unit);
        [across(&x, &y, &z), across(&y, &z, &x), across(&z, &x, &y)]
    };
    match closing {
        Closing::Spherical => [0, 1, 2].map(gap).into(),
        Closing::Fixed => [0, 1, 2].map(gap).into_iter().chain(aligned()).collect(),
        Closing::Revolute(axis) => {
            let (along, [first, second]) = (vector(axis), normals(axis));
            let turns = [
                across(&along, &first, &second),
                across(&along, &second, &first),
            ];
            [0, 1, 2].map(gap).into_iter().chain(turns).collect()
        }
        Closing::Prismatic(axis) => {
            let slides = normals(axis).map(|normal| Row {
                left: call("dot", [rotation(a) * &normal, position(b) - position(a)]),
                right: 0.into(),
                stops: format!("along {normal} of `{a}`"),
            });
            slides.into_iter().chain(aligned()).collect()
        }
    }
}

/// Returns two directions orthogonal to an axis: its cross product with the unit vector farthest from it, and the
/// cross product of the axis with that.
fn normals(axis: &[Decimal; 3]) -> [Expr; 2] {
    let least = (0..3).min_by(|&i, &j| axis[i].value.abs().total_cmp(&axis[j].value.abs()));
    let least = least.unwrap_or(0);
    let (next, last) = ((least + 1) % 3, (least + 2) % 3);
    let mut first: [Decimal; 3] = std::array::from_fn(|_| Decimal::zero());
    first[next] = axis[last].clone();
    first[last] = axis[next].negated();
    let first = vector(&first);
    let nonzero = axis.iter().filter(|entry| !entry.is_zero()).count();
    let second = match nonzero {
        // For a coordinate axis this unit vector is the second direction itself.
        1 => Expr::from([0, 1, 2].map(|i| i32::from(i == least))),
        _ => call("cross", [vector(axis), first.clone()]),
    };
    [first, second]
}
