//! Diagnostics about rows that follow from the others, and about rows that contradict them.

use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::pfaffian::{Kind, Pfaffian};

/// Returns the error for a row that follows from the others and cannot be left out.
pub fn redundant_row_error(constraints: &[Pfaffian], row: usize, when: &str) -> Diagnostic {
    let error = Diagnostic::new(
        constraints[row].span,
        format!("this constraint is redundant{when}: it follows from the others"),
    )
    .help("remove it: its multiplier would be undetermined");
    match constraints.iter().enumerate().find(|(i, _)| *i != row) {
        Some((_, other)) => error.note(other.span, "one of the others"),
        None => error,
    }
}

/// Returns the error for a constraint row that demands a different velocity from the one that the other constraints
/// leave.
pub fn contradicting_row_error(constraints: &[Pfaffian], row: usize) -> Diagnostic {
    let message = "this row contradicts the others: it requires a velocity that they do not allow";
    let error = Diagnostic::new(constraints[row].span, message).help("remove one of them");
    match constraints.iter().enumerate().find(|(i, _)| *i != row) {
        Some((_, other)) => error.note(other.span, "one of the others"),
        None => error,
    }
}

/// Returns a warning for every equation of which rows were dropped, in the order of `dropped`.
pub fn dropped_row_warnings(constraints: &[Pfaffian], dropped: &[usize]) -> Vec<Diagnostic> {
    let mut equations: Vec<Vec<&Pfaffian>> = Vec::new();
    for row in dropped.iter().filter_map(|&place| constraints.get(place)) {
        let same = |other: &&mut Vec<&Pfaffian>| {
            let first = other.first();
            first.is_some_and(|first| {
                first.span.range() == row.span.range() && first.written == row.written
            })
        };
        match equations.iter_mut().find(same) {
            Some(rows) => rows.push(row),
            None => equations.push(vec![row]),
        }
    }
    let warnings = equations
        .iter()
        .filter_map(|rows| Some(dropped_rows_warning(rows.first()?, rows)));
    warnings.collect()
}

/// Returns the warning about dropped rows of one equation.
fn dropped_rows_warning(first: &Pfaffian, rows: &[&Pfaffian]) -> Diagnostic {
    let what = match first.kind {
        Kind::Inactive => "inactive velocity",
        Kind::Nonholonomic => "nonholonomic constraint",
        Kind::Loop => "loop",
        Kind::Drive { .. } => "prescribed motion",
    };
    let entries: Vec<&str> = rows.iter().map(|row| row.entry.as_str()).collect();
    let message = match entries[..] {
        [""] => format!("this {what} follows from the other constraints, and is left out"),
        [entry] => {
            format!("entry {entry} of this {what} follows from the other rows, and is left out")
        }
        _ => format!(
            "entries {} of this {what} follow from the other rows, and are left out",
            entries.join(", ")
        ),
    };
    let help = match entries[..] {
        [""] => "remove it: it adds nothing to the others",
        _ => "write the other entries one by one, as in `a[1] = b[1], a[2] = b[2]`",
    };
    Diagnostic::new(first.span, message).help(help)
}
