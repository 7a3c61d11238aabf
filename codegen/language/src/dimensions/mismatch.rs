//! Equations between dimensions of values, and the errors where they fail.

use super::form::{Form, Term};
use super::value::Value;
use super::walk::Walk;
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Expr, ExprKind, Span};
use crate::units::Dimension;

/// Largest number of notes at declarations of names in an expression.
const MOST_NOTES: usize = 3;

/// Help for every error about dimensions.
const HELP: &str = "check the units; a plain number has no dimension as a factor: a quantity is written with its unit, as in `0.5 [m]`";

impl<'a> Walk<'a> {
    /// Demands that two values have the same dimensions, and returns these. `message` says what is wrong, from
    /// descriptions of both.
    pub fn same(
        &mut self,
        (a, left): (&Value, &'a Expr),
        (b, right): (&Value, &'a Expr),
        message: impl Fn(&str, &str) -> String,
    ) -> Value {
        self.equate(a, b, right.span, |walk, first, second| {
            let (first, second) = (
                walk.unknowns.describe(first),
                walk.unknowns.describe(second),
            );
            let mut notes = vec![(left.span, first.clone())];
            walk.sources(left, &mut notes);
            walk.sources(right, &mut notes);
            let error = Diagnostic::new(right.span, message(&first, &second)).help(HELP);
            noted(error, notes)
        })
    }

    /// Demands that two dimensions within one expression are the same, and returns them.
    pub fn joined(
        &mut self,
        a: &Value,
        b: &Value,
        expr: &'a Expr,
        message: impl Fn(&str, &str) -> String,
    ) -> Term {
        let joined = self.equate(a, b, expr.span, |walk, first, second| {
            let (first, second) = (
                walk.unknowns.describe(first),
                walk.unknowns.describe(second),
            );
            let mut notes = Vec::new();
            walk.sources(expr, &mut notes);
            noted(
                Diagnostic::new(expr.span, message(&first, &second)).help(HELP),
                notes,
            )
        });
        joined.at(0).clone()
    }

    /// Demands that the entries of a value have given dimensions. `what` names the value: "a mass".
    pub fn fits(&mut self, expr: &'a Expr, value: &Value, what: &str, wanted: &Value) {
        self.given(expr, value, (what, None), wanted);
    }

    /// Demands the same of a value that is given to something, and shows the place from which this has its dimension.
    pub fn given(
        &mut self,
        expr: &'a Expr,
        value: &Value,
        (what, to): (&str, Option<&str>),
        wanted: &Value,
    ) {
        self.equate(wanted, value, expr.span, |walk, wanted, found| {
            let found = walk.unknowns.describe(found);
            let mut notes: Vec<_> = to.and_then(|name| walk.source(name)).into_iter().collect();
            walk.sources(expr, &mut notes);
            let message = match wanted.as_known() {
                Some(wanted) if wanted.is_one() => {
                    format!("{what} is a number or an angle, but this is {found}")
                }
                Some(wanted) => format!("{what} is in [{wanted}], but this is {found}"),
                None => format!(
                    "{what} is {}, but this is {found}",
                    walk.unknowns.describe(wanted)
                ),
            };
            noted(Diagnostic::new(expr.span, message).help(HELP), notes)
        });
    }

    /// Demands that all entries of a value have one dimension.
    pub fn wants(&mut self, expr: &'a Expr, value: &Value, what: &str, wanted: &Dimension) {
        self.fits(
            expr,
            value,
            what,
            &Value::uniform(value.shape, Term::of(wanted.clone())),
        );
    }

    /// Equates the dimensions of two values entry by entry, and reports the first pair that cannot agree.
    fn equate(
        &mut self,
        a: &Value,
        b: &Value,
        at: Span,
        error: impl FnOnce(&Self, &Form, &Form) -> Diagnostic,
    ) -> Value {
        let mut wrong = None;
        let unknowns = &mut self.unknowns;
        let joined = a.zip(b, |a, b| {
            unknowns.unify(a, b, at).unwrap_or_else(|mismatch| {
                wrong.get_or_insert(mismatch);
                a.clone()
            })
        });
        if let Some(mismatch) = wrong {
            let error = error(self, &mismatch.first, &mismatch.second);
            self.report.push_once(error);
        }
        joined
    }

    /// Returns the place from which a name has its dimension: its unit, its value, or an equation.
    fn source(&self, name: &str) -> Option<(Span, String)> {
        let Term::Quantity(form) = self.names.get(name)?.at(0) else {
            return None;
        };
        let place = self.places.get(name).copied();
        let place = place.or_else(|| self.unknowns.place(form))?;
        Some((
            place,
            format!("`{name}` is {}", self.unknowns.describe(form)),
        ))
    }

    /// Collects the places from which the names in an expression have their dimensions.
    pub fn sources(&self, expr: &'a Expr, notes: &mut Vec<(Span, String)>) {
        match &expr.kind {
            ExprKind::Quantity(quantity) => {
                notes.push((quantity.unit.span, quantity.unit.dimension.describe()));
                return;
            }
            ExprKind::Name(name) if !self.locals.contains_key(name.as_str()) => {
                notes.extend(self.source(name));
            }
            _ => {}
        }
        expr.parts()
            .into_iter()
            .for_each(|part| self.sources(part, notes));
    }
}

/// Adds notes, each place once, and no more than can be read.
fn noted(error: Diagnostic, notes: Vec<(Span, String)>) -> Diagnostic {
    let mut seen = vec![error.span.range()];
    notes.into_iter().fold(error, |error, (span, label)| {
        match seen.contains(&span.range()) || seen.len() > MOST_NOTES {
            true => error,
            false => {
                seen.push(span.range());
                error.note(span, label)
            }
        }
    })
}
