//! A description that was read, as the page shows it: names, the start, and what was said with its places.

use hamel_cli::{Captured, Mark, Names, Session};
use serde_json::{Value, json};

/// Names and the start of a description.
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
        "methods": Session::methods(),
        "start": { "params": start.params, "x": start.x, "xi": start.xi, "u": start.u },
    })
}

/// Errors and warnings at their places in a text, counted as JavaScript counts.
pub fn marks(said: &Captured, text: &str) -> Vec<Value> {
    said.marks.iter().map(|mark| marked(mark, text)).collect()
}

fn marked(mark: &Mark, text: &str) -> Value {
    let place = |span: std::ops::Range<usize>| [span.start, span.end].map(|at| units(text, at));
    let said = &mark.diagnostic;
    let notes = said.notes.iter().map(|(span, label)| {
        let range = span.range().map(place);
        json!({ "range": range, "label": label })
    });
    json!({
        "severity": if mark.is_error { "error" } else { "warning" },
        "range": said.span.range().map(place),
        "message": said.message,
        "help": said.help,
        "notes": notes.collect::<Vec<Value>>(),
    })
}

/// UTF-16 units before a byte; a place inside of a character, or behind the text, is the next one that there is.
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
