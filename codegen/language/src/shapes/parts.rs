//! Shapes of parts and entries: `q.c`, `M.T`, `v[k]`, `M[i, j]`.

use super::infer::Inference;
use super::shape::{Shape, Shaped};
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Expr, Ident, Span};
use num_traits::ToPrimitive;

impl<'a> Inference<'a> {
    /// Returns the shape of a part, by its name.
    pub fn field(&mut self, base: &'a Expr, field: &Ident) -> Option<Shaped> {
        let shape = self.of(base)?.shape;
        let circle = self.is_circle(base);
        let help = match (shape, field.name.as_str()) {
            (Shape::Vector(_), "c" | "s") if circle => return Some(Shaped::of(Shape::Scalar)),
            (Shape::Matrix(rows, columns), "T") => {
                return Some(Shaped::of(Shape::Matrix(columns, rows)));
            }
            (Shape::Pose, "R") => return Some(Shaped::of(Shape::TURN)),
            (Shape::Pose, "p") => return Some(Shaped::of(Shape::Vector(3))),
            (Shape::Vector(_), _) if circle => {
                "an S1 coordinate has `.c` and `.s`, its cosine and sine"
            }
            (Shape::Vector(_), "T") => "write `dot(a, b)` or `outer(a, b)`",
            (Shape::Vector(_), _) => "entries are written `v[1]`, `v[2]`, …",
            (Shape::Matrix(..), _) => {
                "a matrix has `.T`, its transpose; entries are written `M[1, 2]`"
            }
            (Shape::Pose, _) => "a pose has `.R` and `.p`",
            (Shape::Scalar, _) => "a scalar has no parts",
        };
        let message = format!("{} has no part `.{}`", shape.describe(), field.name);
        self.error(Diagnostic::new(field.span, message).help(help))
    }

    /// Returns the shape of an entry, or of a row of a matrix.
    pub fn index(&mut self, base: &'a Expr, indices: &'a [Expr], span: Span) -> Option<Shaped> {
        let value = self.of(base);
        let places: Vec<Option<usize>> = indices.iter().map(|index| self.place(index)).collect();
        let value = value?;
        let places = places.into_iter().collect::<Option<Vec<usize>>>()?;
        let mut within = |which: usize, length: usize, what: &str| {
            let place = places[which];
            if (1..=length).contains(&place) {
                return Some(place - 1);
            }
            let whole = value.shape.describe();
            let message = format!("index {place} is out of range: {whole} has {length} {what}");
            let error = Diagnostic::new(indices[which].span, message);
            self.error(error.help(format!("indices run from 1 to {length}")))
        };
        let (shape, first) = match (value.shape, places.len()) {
            (Shape::Vector(n), 1) => (Shape::Scalar, within(0, n, "entries")?),
            (Shape::Matrix(rows, columns), 1) => {
                (Shape::Vector(columns), within(0, rows, "rows")? * columns)
            }
            (Shape::Matrix(rows, columns), 2) => {
                let (row, column) = (within(0, rows, "rows"), within(1, columns, "columns"));
                (Shape::Scalar, row? * columns + column?)
            }
            (Shape::Pose, _) => {
                let error = Diagnostic::new(span, "a pose cannot be indexed");
                return self.error(error.help("its parts are `.R` and `.p`, as in `f.p[1]`"));
            }
            (shape, count) => {
                let plural = if count == 1 { "index" } else { "indices" };
                let message = format!("{} cannot take {count} {plural}", shape.describe());
                return self.error(
                    Diagnostic::new(span, message)
                        .help("a vector takes one index, a matrix one (for a row) or two"),
                );
            }
        };
        let count = match shape {
            Shape::Vector(n) => n,
            _ => 1,
        };
        Some(value.part(shape, first..first + count))
    }

    /// Evaluates an index to a whole number.
    fn place(&mut self, index: &'a Expr) -> Option<usize> {
        let found = self.of(index)?;
        if found.shape != Shape::Scalar {
            return self.wrong(index.span, "an index", "a scalar", found.shape);
        }
        let number = found.as_number().filter(|number| number.is_integer());
        let place = number.and_then(|number| number.to_integer().to_usize());
        if place.is_some() {
            return place;
        }
        let message = "an index has to be a whole number known at build time";
        self.error(Diagnostic::new(index.span, message).help("indices start at 1"))
    }
}
