//! Checks Y A = I on X if a description gives both Y and A, KR18 (6); an error shows the residual.

use super::declare::Declared;
use super::definitions::Row;
use super::rate::Rate;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::text::short;
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::System;

/// Longest residual that is shown as an expression.
const MOST: usize = 60;

/// Returns whether every given row of Y satisfies Y A = I; reports the first entry that differs in each row.
pub fn check(
    system: &System,
    graph: &mut Graph,
    declared: &Declared,
    rates: &[Option<Rate>],
    a: &[Vec<Edge>],
    rows: &[Option<Row>],
    report: &mut Report,
) -> bool {
    let mut agrees = true;
    for (i, row) in rows.iter().enumerate() {
        let Some(row) = row else { continue };
        for j in 0..declared.xi.len() {
            let column: Vec<Edge> = a.iter().map(|row| row[j]).collect();
            let entry = graph.dot(&row.entries, &column);
            let wanted = if i == j { graph.one() } else { graph.zero() };
            if entry == wanted {
                continue;
            }
            agrees = false;
            let shown = match short(graph, entry, MOST) {
                Some(text) => format!("is {text}, should be {}", u8::from(i == j)),
                None => format!(
                    "is an expression of the coordinates, should be {}",
                    u8::from(i == j)
                ),
            };
            let (defined, along) = (name(graph, declared, i), name(graph, declared, j));
            let message = format!("Y A differs from I: entry ({}, {}) {shown}", i + 1, j + 1);
            let help = match i == j {
                true => format!(
                    "the rates give `{defined}`, as defined here, a value other than `{along}`: make the rates or the definition agree"
                ),
                false => format!(
                    "the rates let `{along}` change what defines `{defined}`: make the rates or the definition agree"
                ),
            };
            let error = Diagnostic::new(row.span, message).help(help);
            let zero = graph.zero();
            let item = (0..a.len())
                .find(|&alpha| row.entries[alpha] != zero && a[alpha][j] != zero)
                .and_then(|alpha| rates[alpha])
                .and_then(|rate| system.items.get(rate.item));
            report.push(match item {
                Some(item) => error.note(item.span, "with this rate"),
                None => error,
            });
            break;
        }
    }
    agrees
}

fn name<'a>(graph: &'a Graph, declared: &Declared, i: usize) -> &'a str {
    let node = declared.xi[i].node();
    let symbol = graph.symbols().iter().find(|s| s.node == node);
    symbol.map_or("", |s| s.name.as_str())
}
