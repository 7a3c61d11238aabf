//! Writes `body on link { mass; com; inertia }`.

use super::Writer;
use super::page::WIDTH;
use crate::angle::Rotation;
use crate::decimal::{Decimal, vector};
use crate::robot::{Inertial, Origin};

impl Writer<'_> {
    /// Writes the body of a link; nothing if it has no mass.
    pub(super) fn body(&mut self, link: usize) {
        let robot = self.robot;
        let frame = self.names.links[link].clone();
        let link = &robot.links[link];
        let Some(inertial) = link
            .inertial
            .as_ref()
            .filter(|inertial| !inertial.is_zero())
        else {
            // A frame without mass costs nothing and needs no explanation.
            return;
        };
        let mut fields = Vec::new();
        let params = self.options.params;
        let given = |name: &str, value: String| match params {
            true => format!("{frame}_{name}"),
            false => value,
        };
        fields.push(format!(
            "mass {};",
            given("mass", inertial.mass.text.clone())
        ));
        if params
            || inertial
                .origin
                .position
                .iter()
                .any(|entry| !entry.is_zero())
        {
            let com = given("com", vector(&inertial.origin.position));
            fields.push(format!("com {com};"));
        }
        if params || inertial.inertia.iter().any(|entry| !entry.is_zero()) {
            let inertia = match params {
                true => turned(format!("{frame}_inertia"), &inertial.origin.rotation),
                false => inertia(inertial),
            };
            fields.push(format!("inertia {inertia} about com;"));
        }
        let (head, range) = (format!("body on {frame} {{"), Some(&inertial.range));
        let text = format!("{head} {} }}", fields.join(" "));
        if text.len() <= WIDTH {
            return self.page.line(range, &text);
        }
        self.page.line(range, &head);
        for field in fields {
            self.page.line(range, &format!("    {field}"));
        }
        self.page.line(range, "}");
    }

    /// Writes the parameters of a body.
    pub(super) fn parameters_of(&mut self, link: usize) {
        let robot = self.robot;
        let frame = self.names.links[link].clone();
        let Some(inertial) = &robot.links[link].inertial else {
            return;
        };
        let [xx, xy, xz, yy, yz, zz] = inertial.inertia.each_ref().map(|entry| &entry.text);
        let Origin { position, .. } = &inertial.origin;
        let (mass, com) = (&inertial.mass.text, vector(position));
        let text = format!(
            "param {frame}_mass = {mass}, {frame}_com: vec3 = {com}, {frame}_inertia: sym3 = [[{xx}, {xy}, {xz}], [{xy}, {yy}, {yz}], [{xz}, {yz}, {zz}]];"
        );
        self.page.line(Some(&inertial.range), &text);
    }
}

/// Writes the inertia in link axes: R I Rᵀ, multiplied out if R only permutes and flips axes.
fn inertia(inertial: &Inertial) -> String {
    let [xx, xy, xz, yy, yz, zz] = &inertial.inertia;
    let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    match inertial.origin.rotation.exact() {
        Some(rotation) => {
            // Row i of R has one nonzero entry, ±1.
            let turned = rotation.map(|row| {
                let column = row.iter().position(|&entry| entry != 0).unwrap_or(0);
                (column, row[column] < 0)
            });
            let entry = |i: usize, j: usize| -> Decimal {
                let ((k, left), (l, right)) = (turned[i], turned[j]);
                let value = rows[k][l].clone();
                if left == right {
                    value
                } else {
                    value.negated()
                }
            };
            let rows: [[Decimal; 3]; 3] =
                std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
            written(&rows.each_ref().map(|row| row.each_ref()))
        }
        None => turned(written(&rows), &inertial.origin.rotation),
    }
}

/// Writes `R * I * transpose(R)`.
fn turned(inertia: String, rotation: &Rotation) -> String {
    match rotation.text() {
        Some(turn) => format!("{turn} * {inertia} * transpose({turn})"),
        None => inertia,
    }
}

/// Writes `diag(a, b, c)`, or the rows of the matrix.
fn written(rows: &[[&Decimal; 3]; 3]) -> String {
    let diagonal = (0..3).all(|i| (0..3).all(|j| i == j || rows[i][j].is_zero()));
    if diagonal {
        let entries: Vec<&str> = (0..3).map(|i| rows[i][i].text.as_str()).collect();
        return format!("diag({})", entries.join(", "));
    }
    let rows: Vec<String> = rows
        .iter()
        .map(|row| vector(&row.map(Decimal::clone)))
        .collect();
    format!("[{}]", rows.join(", "))
}
