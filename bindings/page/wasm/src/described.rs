//! JSON of an open description: names, the start, and diagnostics with their places.

use hamel_codegen::diagnostics::Diagnostic;
use hamel_engine::{Names, Reporter, Session, Warning, method};
use serde_json::{Value, json};
use std::sync::{Mutex, PoisonError};

/// Returns names and the start of a description.
pub fn described(session: &Session) -> Value {
    let start = session.start();
    let names = |names: Names| {
        let groups = names.groups.iter();
        let groups = groups.map(|(name, first, count)| json!([name, first, count]));
        json!({ "entries": names.entries, "groups": groups.collect::<Vec<Value>>() })
    };
    json!({
        "name": session.name(),
        "coordinates": names(session.coordinates()),
        "kinds": session.kinds(),
        "velocities": names(session.velocities()),
        "inputs": names(session.inputs()),
        "parameters": names(session.parameters()),
        "methods": method::names(),
        "start": { "params": start.params, "x": start.x, "xi": start.xi, "u": start.u },
    })
}

/// Collects the warnings of a description.
#[derive(Default)]
pub struct DescriptionWarnings {
    kept: Mutex<Kept>,
}

/// Warnings as a text, and where they are about.
#[derive(Clone, Default)]
struct Kept {
    text: String,
    warnings: Vec<Diagnostic>,
}

impl Reporter for DescriptionWarnings {
    fn warn(&self, warning: &Warning<'_>) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.text.push_str(&warning.to_string());
        if let Warning::Description { diagnostics, .. } = warning {
            kept.warnings.extend_from_slice(diagnostics);
        }
    }
}

impl DescriptionWarnings {
    fn kept(&self) -> Kept {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.clone()
    }

    /// Returns the warnings as a text.
    pub fn text(&self) -> String {
        self.kept().text
    }

    /// Warnings and errors at their places in a text, counted as JavaScript counts.
    pub fn marks(&self, errors: &[Diagnostic], text: &str) -> Vec<Value> {
        let warnings = self.kept().warnings;
        let warnings = warnings
            .iter()
            .map(|warning| mark("warning", warning, text));
        let errors = errors.iter().map(|error| mark("error", error, text));
        warnings.chain(errors).collect()
    }
}

fn mark(severity: &str, said: &Diagnostic, text: &str) -> Value {
    let place = |span: std::ops::Range<usize>| [span.start, span.end].map(|at| units(text, at));
    let notes = said.notes.iter().map(|(span, label)| {
        let range = span.range().map(place);
        json!({ "range": range, "label": label })
    });
    json!({
        "severity": severity,
        "range": said.span.range().map(place),
        "message": said.message,
        "help": said.help,
        "notes": notes.collect::<Vec<Value>>(),
    })
}

/// Counts UTF-16 units before a byte offset; one inside a character is rounded up, one beyond the text is its end.
fn units(text: &str, byte: usize) -> usize {
    let ahead = text.char_indices().take_while(|(at, _)| *at < byte);
    ahead.map(|(_, letter)| letter.len_utf16()).sum()
}

#[cfg(test)]
mod tests {
    use super::units;

    #[test]
    fn places_are_counted_as_javascript_counts_them() {
        let text = "γ𝔸b";
        let counted = [0, 2, 6, 7, 9].map(|byte| units(text, byte));
        assert_eq!(counted, [0, 1, 3, 4, 4]);
    }
}
