//! Writes `body on link { mass; com; inertia }`.

use super::{Writer, declared};
use crate::angle::Rotation;
use crate::decimal::{Decimal, vector};
use crate::robot::{Inertial, Origin};
use hamel_language::expression::{call, diagonal, ident};
use hamel_language::syntax::ast::{About, Body, Expr, ItemKind, ShapeKind};

impl Writer<'_> {
    /// Writes the body of a link; nothing if it has no mass.
    pub(super) fn body(&mut self, link: usize) {
        let robot = self.robot;
        let frame = &self.names.links[link];
        let link = &robot.links[link];
        let Some(inertial) = link
            .inertial
            .as_ref()
            .filter(|inertial| !inertial.is_zero())
        else {
            // A frame without mass costs nothing and needs no explanation.
            return;
        };
        let Origin { position, rotation } = &inertial.origin;
        let body = if self.options.params {
            let parameter = |name: &str| Expr::name(&format!("{frame}_{name}"));
            let inertia = turned(parameter("inertia"), rotation);
            Body {
                frame: ident(frame),
                mass: Some(parameter("mass")),
                com: Some(parameter("com")),
                inertia: Some((inertia, Some(About::Com))),
            }
        } else {
            let is_zero = |entries: &[Decimal]| entries.iter().all(Decimal::is_zero);
            let about_com = |inertia| (inertia, Some(About::Com));
            Body {
                frame: ident(frame),
                mass: Some((&inertial.mass).into()),
                com: (!is_zero(position)).then(|| vector(position)),
                inertia: (!is_zero(&inertial.inertia)).then(|| about_com(inertia(inertial))),
            }
        };
        self.draft.statement(&inertial.range, ItemKind::Body(body));
    }

    /// Writes the parameters of a body.
    pub(super) fn parameters_of(&mut self, link: usize) {
        let robot = self.robot;
        let frame = &self.names.links[link];
        let Some(inertial) = &robot.links[link].inertial else {
            return;
        };
        let [xx, xy, xz, yy, yz, zz] = inertial.inertia.each_ref().map(Expr::from);
        let inertia = [
            [xx, xy.clone(), xz.clone()],
            [xy, yy, yz.clone()],
            [xz, yz, zz],
        ];
        let parameter =
            |name: &str, shape, value| declared(&format!("{frame}_{name}"), shape, Some(value));
        let com = vector(&inertial.origin.position);
        let parameters = vec![
            parameter("mass", ShapeKind::Scalar, (&inertial.mass).into()),
            parameter("com", ShapeKind::Vector(3), com),
            parameter("inertia", ShapeKind::Symmetric(3), inertia.into()),
        ];
        self.draft
            .statement(&inertial.range, ItemKind::Param(parameters));
    }
}

/// Returns the inertia in link axes: R I Rᵀ, multiplied out if R only permutes and flips axes.
fn inertia(inertial: &Inertial) -> Expr {
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
            matrix(&rows.each_ref().map(|row| row.each_ref()))
        }
        None => turned(matrix(&rows), &inertial.origin.rotation),
    }
}

/// Returns `R * I * transpose(R)`.
fn turned(inertia: Expr, rotation: &Rotation) -> Expr {
    match rotation.expr() {
        Some(turn) => &turn * inertia * call("transpose", [turn]),
        None => inertia,
    }
}

/// Returns `diag(a, b, c)`, or the rows of the matrix.
fn matrix(rows: &[[&Decimal; 3]; 3]) -> Expr {
    let is_diagonal = (0..3).all(|i| (0..3).all(|j| i == j || rows[i][j].is_zero()));
    if is_diagonal {
        return diagonal([rows[0][0], rows[1][1], rows[2][2]]);
    }
    rows.map(Expr::from).into()
}
