//! `loop` and `spring` statements: what ties links beside the joints of the tree.

use super::Writer;
use super::joint::pose;
use crate::decimal::{Decimal, vector};
use crate::robot::{Closing, End};

impl Writer<'_> {
    /// Closing joints, each with a frame at either end.
    pub(super) fn loops(&mut self) {
        let robot = self.robot;
        for (index, closing) in robot.loops.iter().enumerate() {
            let name = self.names.loops[index].clone();
            let range = &closing.name.range;
            self.page.blank();
            let [a, b] = ["_1", "_2"].map(|end| format!("{name}{end}"));
            for (frame, end) in [&a, &b].into_iter().zip(&closing.ends) {
                let pose = pose(end.origin.rotation.text(), &end.origin.position, None);
                let pose = pose.unwrap_or_else(|| "pose(identity(3), [0, 0, 0])".into());
                let text = match self.carrier(end) {
                    Some(link) => format!("frame {frame} on {link} at {pose};"),
                    None => format!("frame {frame} = {pose};"),
                };
                self.page.line(Some(range), &text);
            }
            // Equations that always hold are none where they stand in one vector with others.
            let rows = rows(&closing.closing, &a, &b);
            let zeros = vec!["0"; rows.len()].join(", ");
            self.page.line(Some(range), "loop [");
            for (place, row) in rows.iter().enumerate() {
                let comma = if place + 1 < rows.len() { "," } else { "" };
                self.page.line(Some(range), &format!("    {row}{comma}"));
            }
            self.page.line(Some(range), &format!("] = [{zeros}];"));
        }
    }

    /// Springs and dampers between points.
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

    /// The frame of the link at an end; `None` where the link stands in the world.
    fn carrier(&self, end: &End) -> Option<String> {
        let mut links = self.robot.links.iter();
        let link = links.position(|link| link.name.name == end.link.name)?;
        let stands = link == self.tree.root && !self.options.floating;
        (!stands).then(|| self.names.links[link].clone())
    }
}

/// The differences that vanish where two frames are closed.
fn rows(closing: &Closing, a: &str, b: &str) -> Vec<String> {
    let gap = |axis: usize| format!("position({a})[{axis}] - position({b})[{axis}]");
    let across = |left: &str, right: &str| format!("dot({a}.R * {left}, {b}.R * {right})");
    let aligned = [
        across("[1, 0, 0]", "[0, 1, 0]"),
        across("[0, 1, 0]", "[0, 0, 1]"),
        across("[0, 0, 1]", "[1, 0, 0]"),
    ];
    match closing {
        Closing::Spherical => [1, 2, 3].map(gap).to_vec(),
        Closing::Fixed => [1, 2, 3].map(gap).into_iter().chain(aligned).collect(),
        Closing::Revolute(axis) => {
            let (along, [first, second]) = (vector(axis), normals(axis));
            let turns = [across(&along, &first), across(&along, &second)];
            [1, 2, 3].map(gap).into_iter().chain(turns).collect()
        }
        Closing::Prismatic(axis) => {
            let slides = normals(axis)
                .map(|normal| format!("dot({a}.R * {normal}, position({b}) - position({a}))"));
            slides.into_iter().chain(aligned).collect()
        }
    }
}

/// Two directions across another one: its product with the unit vector that is farthest from it, and the product of both.
fn normals(axis: &[Decimal; 3]) -> [String; 2] {
    let least = (0..3).min_by(|&i, &j| axis[i].value.abs().total_cmp(&axis[j].value.abs()));
    let least = least.unwrap_or(0);
    let (next, last) = ((least + 1) % 3, (least + 2) % 3);
    let mut first: [Decimal; 3] = std::array::from_fn(|_| Decimal::zero());
    first[next] = axis[last].clone();
    first[last] = axis[next].negated();
    let nonzero: Vec<usize> = (0..3).filter(|&i| !axis[i].is_zero()).collect();
    let second = match nonzero.as_slice() {
        // The unit vector itself.
        [_] => {
            let mut unit: [Decimal; 3] = std::array::from_fn(|_| Decimal::zero());
            unit[least] = Decimal::one();
            vector(&unit)
        }
        _ => format!("cross({}, {})", vector(axis), vector(&first)),
    };
    [vector(&first), second]
}
