//! Tables of values: `table thrust = [(0, 0), (0.2, 1.1)] linear extrapolate hold;`.

use super::curve::Curve;
use super::expression::Evaluator;
use super::scope::Scope;
use crate::algebra::graph::Graph;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::syntax::ast::{Expr, ItemKind, Source, System, Table};
use num_rational::BigRational;

/// Largest number of points of a table.
const MOST_POINTS: usize = 200;

/// Reads all tables of a description; those in error are stored as `None`.
pub fn declare(system: &System, graph: &mut Graph, scope: &mut Scope, report: &mut Report) {
    for item in &system.items {
        if let ItemKind::Table(table) = &item.kind
            && !scope.tables.contains_key(&table.name.name)
        {
            let curve = Evaluator::new(graph, scope, report).curve(table);
            scope.tables.insert(table.name.name.clone(), curve);
        }
    }
}

impl Evaluator<'_> {
    fn curve(&mut self, table: &Table) -> Option<Curve> {
        let (points, span) =
            match &table.source {
                Source::Points(points, span) => (points, *span),
                Source::File(name, span) => {
                    let message = format!("the folder of `{name}` is not known");
                    return self.error(Diagnostic::new(*span, message).help(
                        "generate from a file, or write the points here: `= [(0, 0), (1, 2)]`",
                    ));
                }
            };
        let mut all = Vec::new();
        for (argument, value) in points {
            let pair = (self.number_of(argument), self.number_of(value));
            all.push(pair.0.zip(pair.1));
        }
        let all = all.into_iter().collect::<Option<Vec<_>>>()?;
        if !(2..=MOST_POINTS).contains(&all.len()) {
            let count = all.len();
            let plural = if count == 1 { "" } else { "s" };
            return self.error(
                Diagnostic::new(span, format!("this table has {count} point{plural}"))
                    .help(format!("a table has from 2 to {MOST_POINTS} points")),
            );
        }
        let mut increasing = Some(());
        for (k, pair) in all.windows(2).enumerate() {
            if let ([(a, _), (b, _)], [(before, _), (here, _)]) = (pair, &points[k..k + 2])
                && a >= b
            {
                increasing = None;
                let message = format!(
                    "the arguments of a table have to increase: point {} is not beyond point {}",
                    k + 2,
                    k + 1
                );
                let error = Diagnostic::new(here.span, message)
                    .help("sort the points by their first numbers, and remove duplicates");
                let error = match table.source {
                    Source::Points(..) if here.span.range() != before.span.range() => {
                        error.note(before.span, "the point before")
                    }
                    _ => error,
                };
                self.report.push(error);
            }
        }
        increasing?;
        let (knots, values) = all.into_iter().unzip();
        Some(Curve::new(knots, values, table.between, table.beyond))
    }

    /// Reads an entry of a table.
    fn number_of(&mut self, expr: &Expr) -> Option<BigRational> {
        let edge = self.scalar(expr)?;
        match self.graph.as_rational(edge) {
            Some(number) => Some(number),
            None => self.error(
                Diagnostic::new(
                    expr.span,
                    "an entry of a table has to be a number known at build time",
                )
                .help(
                    "write a number or a `const`; scale the table for a parameter: `p * thrust(a)`",
                ),
            ),
        }
    }

    /// Returns the value of a table at an argument.
    pub(super) fn table(
        &mut self,
        name: &str,
        curve: Option<&Curve>,
        arguments: &[Expr],
    ) -> Option<Value> {
        let [argument] = arguments else { return None };
        let at = self.scalar(argument)?;
        let curve = curve?;
        let number = self.graph.as_rational(at);
        if number.is_some_and(|number| !curve.reaches(&number)) {
            let message = format!("the table `{name}` has no value here");
            return self.error(
                Diagnostic::new(argument.span, message)
                    .help("the argument is beyond its points: add some, or extrapolate"),
            );
        }
        Some(Value::Scalar(curve.value(self.graph, at)))
    }
}
