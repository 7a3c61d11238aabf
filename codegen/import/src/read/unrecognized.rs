//! Warnings about legal XML that is not understood or probably not meant: names that are not on the closed list,
//! numbers in other units.

use super::schema::{Element, Level};
use super::xml::{Reader, property, tag, written};
use crate::decimal::Decimal;
use crate::tree::near;
use roxmltree::Node;
use std::ops::Range;

/// Namespace of attributes that locate the schema of a file.
const SCHEMA: &str = "http://www.w3.org/2001/XMLSchema-instance";
/// Largest plausible angle (rad): a full turn, with room for rounding.
const MAX_ANGLE: f64 = 6.5;
/// Largest plausible length (m).
const MAX_LENGTH: f64 = 100.0;

/// A note about something that is not on the closed list: message, first place, and number of occurrences.
#[derive(Debug)]
pub(super) struct Unrecognized {
    message: String,
    range: Range<usize>,
    help: String,
    count: usize,
}

impl<'a> Reader<'a, '_, '_> {
    /// Notes attributes and child elements that are not on the list, recursively.
    pub(super) fn compare(&mut self, node: &Node<'_, 'a>, level: &'static Level) {
        let element = written(self.text, node);
        for attribute in node.attributes() {
            let name = property(self.text, &attribute);
            if level.attributes.contains(&name) || attribute.namespace() == Some(SCHEMA) {
                continue;
            }
            let near = near(name, level.attributes.iter().copied());
            self.note(
                attribute.range(),
                format!("`{name}` is not a property of `<{element}>` in URDF and is left out"),
                near.map_or_else(
                    || level.help.to_string(),
                    |near| format!("did you mean `{near}`?"),
                ),
            );
        }
        for child in node.children().filter(Node::is_element) {
            let name = written(self.text, &child);
            match level.find(name) {
                Some(Element::Read(level)) => self.compare(&child, level),
                Some(Element::Apart) => {}
                Some(Element::Unless(words, _)) if is_idle(&child, words) => {}
                Some(Element::Unless(_, help)) => self.note(
                    tag(self.text, &child),
                    format!("`<{name}>` changes the motion but is left out"),
                    (*help).to_string(),
                ),
                None => {
                    let near = near(name, level.names());
                    self.note(
                        tag(self.text, &child),
                        format!(
                            "`<{name}>` is not an element of `<{element}>` in URDF and is left out"
                        ),
                        near.map_or_else(
                            || level.help.to_string(),
                            |near| format!("did you mean `<{near}>`?"),
                        ),
                    );
                }
            }
        }
    }

    /// Adds a note, once for all places with the same message.
    pub(super) fn note(&mut self, range: Range<usize>, message: String, help: String) {
        let mut noted = self.unrecognized.iter_mut();
        match noted.find(|unrecognized| unrecognized.message == message) {
            Some(unrecognized) => unrecognized.count += 1,
            None => self.unrecognized.push(Unrecognized {
                message,
                range,
                help,
                count: 1,
            }),
        }
    }

    /// Turns all notes into warnings.
    pub(super) fn warn_of_unrecognized(&mut self) {
        for unrecognized in std::mem::take(&mut self.unrecognized) {
            let more = match unrecognized.count {
                1 => String::new(),
                2 => ", here and at one more place".to_string(),
                count => format!(", here and at {} more places", count - 1),
            };
            let message = format!("{}{more}", unrecognized.message);
            self.warnings
                .push(&unrecognized.range, message, unrecognized.help);
        }
    }

    /// Warns of angles and lengths that look like degrees and millimetres.
    pub(super) fn units(&mut self, numbers: &[Decimal; 3], range: &Range<usize>, angles: bool) {
        let most = if angles { MAX_ANGLE } else { MAX_LENGTH };
        let Some(large) = numbers.iter().find(|number| number.value.abs() > most) else {
            return;
        };
        let text = &large.text;
        let (message, help) = match angles {
            true => (
                format!("the angle {text} rad is more than a turn"),
                format!(
                    "angles are in radians: {text}° would be {}",
                    large.value.to_radians()
                ),
            ),
            false => (
                format!("the length {text} m is more than {MAX_LENGTH} m"),
                "lengths are in metres".to_string(),
            ),
        };
        self.warnings.push(range, message, help);
    }
}

/// Whether the value of an element equals one of the words, as text or as numbers. The value is its text, or else all
/// of its attributes.
fn is_idle(node: &Node<'_, '_>, words: &[&str]) -> bool {
    let same = |said: &str| {
        let numbers = numbers(said);
        words.iter().any(|word| {
            said.eq_ignore_ascii_case(word) || numbers.is_some() && numbers == self::numbers(word)
        })
    };
    match node.text().map(str::trim) {
        Some(said) if !said.is_empty() => same(said),
        _ => {
            let mut attributes = node.attributes().map(|attribute| attribute.value().trim());
            node.attributes().len() > 0 && attributes.all(same)
        }
    }
}

/// Parses a text of numbers; `None` if it has anything else.
fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split_whitespace()
        .map(|word| word.parse().ok())
        .collect()
}
