//! What is legal XML and is not what was meant: misspelt names, numbers in other units.

use super::xml::{Reader, tag};
use crate::decimal::Decimal;
use crate::tree::near;
use roxmltree::Node;
use std::ops::Range;

/// Angles above a turn (rad), with room for roundings.
const TURN: f64 = 6.5;
/// Lengths that no robot has (m).
const FAR: f64 = 100.0;

/// A property that URDF does not know: its name, its element, its first place, how often it stands.
#[derive(Debug)]
pub(super) struct Strange {
    name: String,
    element: String,
    range: Range<usize>,
    help: String,
    count: usize,
}

impl<'a> Reader<'a, '_, '_> {
    /// Notes attributes that an element does not have in URDF.
    pub(super) fn attributes(&mut self, node: &Node<'_, 'a>, known: &[&str], help: &str) {
        let element = node.tag_name().name();
        for attribute in node.attributes() {
            let name = attribute.name();
            if known.contains(&name) {
                continue;
            }
            let noted = self.strange.iter_mut();
            let same = |s: &&mut Strange| s.name == name && s.element == element;
            match noted.into_iter().find(same) {
                Some(strange) => strange.count += 1,
                None => self.strange.push(Strange {
                    name: name.to_string(),
                    element: element.to_string(),
                    range: attribute.range(),
                    help: match near(name, known.iter().copied()) {
                        Some(near) => format!("did you mean `{near}`?"),
                        None => help.to_string(),
                    },
                    count: 1,
                }),
            }
        }
    }

    /// Warns of elements whose name is nearly one that URDF knows here; others are those of other
    /// programs.
    pub(super) fn elements(&mut self, node: &Node<'_, 'a>, known: &[&str]) {
        for child in node.children().filter(Node::is_element) {
            let name = child.tag_name().name();
            if known.contains(&name) {
                continue;
            }
            if let Some(near) = near(name, known.iter().copied()) {
                self.warnings.push(
                    &tag(self.text, &child),
                    format!(
                        "`<{name}>` is nothing that `<{}>` has in URDF, and is left out",
                        node.tag_name().name()
                    ),
                    format!("did you mean `<{near}>`?"),
                );
            }
        }
    }

    /// Warns of the properties that were noted, each once.
    pub(super) fn tell(&mut self) {
        for strange in std::mem::take(&mut self.strange) {
            let Strange { name, element, .. } = &strange;
            let more = match strange.count {
                1 => String::new(),
                2 => ", here and at one more place".to_string(),
                count => format!(", here and at {} more places", count - 1),
            };
            self.warnings.push(
                &strange.range,
                format!("`{name}` is no property of `<{element}>` in URDF, and is left out{more}"),
                strange.help,
            );
        }
    }

    /// Warns of angles and lengths that look like degrees and millimetres.
    pub(super) fn units(&mut self, numbers: &[Decimal; 3], range: &Range<usize>, angles: bool) {
        let most = if angles { TURN } else { FAR };
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
                format!("the length {text} m is more than {FAR} m"),
                "lengths are in metres".to_string(),
            ),
        };
        self.warnings.push(range, message, help);
    }
}
