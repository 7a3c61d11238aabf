//! Reads elements, attributes and numbers of XML, with the place of whatever is missing or unreadable.

use super::unrecognized::Unrecognized;
use crate::angle::{Angle, Rotation};
use crate::decimal::Decimal;
use crate::problem::Problems;
use crate::robot::{Cleaned, Named, Origin};
use roxmltree::{Attribute, Document, Error, Node, ParsingOptions, TextPos};
use std::ops::Range;

/// Largest length that is read as 0 on its own, as a fraction of the tolerance: 1e-15 m by default. It matters for
/// positions whose entries are all tiny.
const ALONE: f64 = 1e-6;

/// Text that is not XML: its place, the message and the remedy.
pub(super) type Malformed = (Range<usize>, String, String);

/// Parses XML; an error comes with its place.
pub(super) fn parse(text: &str) -> Result<Document<'_>, Malformed> {
    let options = ParsingOptions {
        // Some exporters write a document type declaration; external entities are not read.
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(text, options).map_err(|error| {
        let begin = match error {
            // An error at the end of the text has no place of its own, so it is shown at the last character.
            Error::UnexpectedEndOfStream | Error::UnclosedRootNode | Error::NoRootNode => {
                let last = text.trim_end().char_indices().next_back();
                last.map_or(0, |(offset, _)| offset)
            }
            _ => offset(text, error.pos()),
        };
        let rest = text.get(begin..).unwrap_or("");
        let width = rest.chars().next().map_or(0, char::len_utf8);
        let range = begin..begin + width;
        if rest.starts_with("<?xml") && text.get(..begin).is_some_and(|before| !before.is_empty()) {
            let message = "the XML declaration `<?xml …?>` is not at the very start of the file";
            let help = "remove what stands before it, blank lines included";
            return (begin..begin + 5, message.into(), help.into());
        }
        match &error {
            Error::UnknownNamespace(prefix, _) => (
                begin..begin + prefix.len().min(rest.len()),
                format!("the prefix `{prefix}` is not declared"),
                format!(
                    "declare it in the outermost element: `<robot name=\"…\" xmlns:{prefix}=\"{}\">`",
                    space(prefix)
                ),
            ),
            Error::UnknownEntityReference(..) | Error::MalformedEntityReference(_) => (
                range,
                "`&` begins an entity here, but no entity has this name".into(),
                "write `&amp;` for the character `&` itself".into(),
            ),
            _ => {
                // The place is reported separately.
                let message = error.to_string();
                let message = match message.rfind(" at ") {
                    Some(end) if message.ends_with(|c: char| c.is_ascii_digit()) => &message[..end],
                    _ => &message,
                };
                (
                    range,
                    format!("this is not well-formed XML: {message}"),
                    "fix it here, or a little before".into(),
                )
            }
        }
    })
}

/// Returns the usual namespace of a prefix, to suggest it; any other text would do.
fn space(prefix: &str) -> String {
    match prefix {
        "drake" => "http://drake.mit.edu".into(),
        prefix => format!("http://playerstage.sourceforge.net/gazebo/xmlschema/#{prefix}"),
    }
}

/// Returns the byte offset of a line and column.
fn offset(text: &str, place: TextPos) -> usize {
    let line = place.row.saturating_sub(1) as usize;
    let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    let rest = text.get(start..).unwrap_or("");
    let column = place.col.saturating_sub(1) as usize;
    let within = rest.char_indices().nth(column);
    (start + within.map_or(0, |(offset, _)| offset)).min(text.len())
}

/// Returns the range of the opening `<name` of an element.
pub(super) fn tag(text: &str, node: &Node<'_, '_>) -> Range<usize> {
    let start = node.range().start;
    let rest = text.get(start..).unwrap_or("");
    let length = rest.find(|c: char| c.is_whitespace() || c == '>' || c == '/');
    start..start + length.unwrap_or(rest.len())
}

/// Returns the name of an element as it is written, with its prefix.
pub(super) fn written<'a>(text: &'a str, node: &Node<'_, 'a>) -> &'a str {
    let name = text
        .get(tag(text, node))
        .and_then(|tag| tag.strip_prefix('<'));
    // Elements that come from an entity are written elsewhere.
    name.filter(|name| name.ends_with(node.tag_name().name()))
        .unwrap_or(node.tag_name().name())
}

/// Returns the name of an attribute as it is written, with its prefix.
pub(super) fn property<'a>(text: &'a str, attribute: &Attribute<'_, 'a>) -> &'a str {
    let name = text.get(attribute.range_qname());
    name.unwrap_or(attribute.name())
}

/// Reads elements, and collects errors and warnings about them.
pub(super) struct Reader<'a, 'p, 't> {
    pub(super) text: &'a str,
    pub(super) tolerance: f64,
    pub(super) errors: &'p mut Problems<'t>,
    pub(super) warnings: &'p mut Problems<'t>,
    pub(super) cleaned: Vec<Cleaned>,
    pub(super) unrecognized: Vec<Unrecognized>,
}

impl<'a> Reader<'a, '_, '_> {
    /// Finds the only child of a name; a second one is an error.
    pub(super) fn child<'d>(&mut self, node: &Node<'d, 'a>, name: &str) -> Option<Node<'d, 'a>> {
        let text = self.text;
        let mut found = node
            .children()
            .filter(|child| child.is_element() && written(text, child) == name);
        let first = found.next();
        for second in found {
            self.errors.push(
                &tag(self.text, &second),
                format!(
                    "more than one `<{name}>` in one `<{}>`",
                    node.tag_name().name()
                ),
                "remove one of them",
            );
        }
        first
    }

    /// Finds the only child of a name; it is an error if there is none.
    pub(super) fn required<'d>(
        &mut self,
        node: &Node<'d, 'a>,
        name: &str,
        form: &str,
    ) -> Option<Node<'d, 'a>> {
        let found = self.child(node, name);
        if found.is_none() {
            self.errors.push(
                &tag(self.text, node),
                format!("`<{}>` without `<{name}>`", node.tag_name().name()),
                format!("add `{form}`"),
            );
        }
        found
    }

    /// Finds a mandatory attribute.
    pub(super) fn attribute<'d>(
        &mut self,
        node: &Node<'d, 'a>,
        name: &str,
    ) -> Option<Attribute<'d, 'a>> {
        let found = node.attribute_node(name);
        if found.is_none() {
            let element = node.tag_name().name();
            self.errors.push(
                &tag(self.text, node),
                format!("`<{element}>` without `{name}`"),
                format!("write `<{element} {name}=\"…\">`"),
            );
        }
        found
    }

    /// Reads a name, which must not be empty.
    pub(super) fn name(&mut self, node: &Node<'_, 'a>, attribute: &str) -> Option<Named> {
        let found = self.attribute(node, attribute)?;
        let named = Named {
            name: found.value().trim().to_string(),
            range: found.range_value(),
        };
        if named.name.is_empty() {
            self.errors.push(
                &found.range(),
                format!("`{attribute}` is empty"),
                "give it a name",
            );
            return None;
        }
        Some(named)
    }

    /// Reads the robot's name, which may be missing if the system gets another name.
    pub(super) fn robot_name(&mut self, root: &Node<'_, 'a>, other: bool) -> Option<Named> {
        let found = root.attribute_node("name");
        let empty = found.is_none_or(|name| name.value().trim().is_empty());
        if !(other && empty) {
            return self.name(root, "name");
        }
        let range = found.map_or_else(|| tag(self.text, root), |name| name.range());
        let help = "write `<robot name=\"…\">`";
        self.warnings.push(&range, "the robot has no name", help);
        Some(Named {
            name: String::new(),
            range,
        })
    }

    /// Reads a mandatory number.
    pub(super) fn number(&mut self, node: &Node<'_, 'a>, attribute: &str) -> Option<Decimal> {
        let found = self.attribute(node, attribute)?;
        self.decimal(found.value().trim(), &found.range_value())
    }

    /// Reads an optional number.
    pub(super) fn optional(&mut self, node: &Node<'_, 'a>, attribute: &str) -> Option<Decimal> {
        let found = node.attribute_node(attribute)?;
        self.decimal(found.value().trim(), &found.range_value())
    }

    pub(super) fn decimal(&mut self, written: &str, range: &Range<usize>) -> Option<Decimal> {
        let number = Decimal::parse(written);
        if number.is_none() {
            let (message, help) = match written.parse::<f64>() {
                _ if written.contains("${") => (
                    format!("`{written}` is not a number"),
                    "this is a property of xacro: expand the file first, `xacro FILE > robot.urdf`",
                ),
                // Parsed by Rust but not by `Decimal`, whose exponents are bounded.
                Ok(value) if value.abs() < 1.0 && !written.contains("inf") => (
                    format!("`{written}` is closer to 0 than any quantity of a robot"),
                    "write 0 for zero; other numbers have an absolute value above 1e-300",
                ),
                Ok(value)
                    if value.abs() > 1.0 && written.starts_with(|c: char| !c.is_alphabetic()) =>
                {
                    (
                        format!("`{written}` is larger than any quantity of a robot"),
                        "numbers have an absolute value below 1e300 and at most 200 digits",
                    )
                }
                _ => (
                    format!("`{written}` is not a number"),
                    "numbers are finite decimals, as in `0.25` or `1e-3`",
                ),
            };
            self.errors.push(range, message, help);
        }
        number
    }

    /// Reads three numbers separated by blanks.
    pub(super) fn vector(&mut self, found: &Attribute<'_, 'a>) -> Option<[Decimal; 3]> {
        let range = found.range_value();
        let words: Vec<&str> = found.value().split_whitespace().collect();
        let [a, b, c] = words.as_slice() else {
            self.errors.push(
                &range,
                format!("expected three numbers, found {}", words.len()),
                format!("write `{}=\"0 0 0\"`, separated by blanks", found.name()),
            );
            return None;
        };
        let numbers = [a, b, c].map(|word| self.decimal(word, &range));
        let [Some(a), Some(b), Some(c)] = numbers else {
            return None;
        };
        Some([a, b, c])
    }

    /// Reads `<origin xyz rpy>`, all of it optional; `None` if it cannot be read.
    pub(super) fn origin(&mut self, node: &Node<'_, 'a>) -> Option<Origin> {
        let Some(element) = self.child(node, "origin") else {
            return Some(Origin::identity());
        };
        self.pose(&element)
    }

    /// Reads a pose from `xyz` and `rpy` or `quat_xyzw` of an element; `None` if it cannot be read.
    pub(super) fn pose(&mut self, element: &Node<'_, 'a>) -> Option<Origin> {
        let mut origin = Origin::identity();
        let mut sound = true;
        if let Some(attribute) = element.attribute_node("xyz") {
            match self.vector(&attribute) {
                Some(mut position) => {
                    let range = attribute.range_value();
                    self.clean(&mut position, &range, self.tolerance * ALONE);
                    self.units(&position, &range, false);
                    origin.position = position;
                }
                None => sound = false,
            }
        }
        if let Some(attribute) = element.attribute_node("rpy") {
            match self.vector(&attribute) {
                Some(angles) => {
                    let range = attribute.range_value();
                    self.units(&angles, &range, true);
                    origin.rotation = Rotation(angles.map(|angle| self.angle(&angle, &range)));
                }
                None => sound = false,
            }
        }
        if let Some(attribute) = element.attribute_node("quat_xyzw") {
            match self.quaternion(&attribute, element.has_attribute("rpy")) {
                Some(rotation) => origin.rotation = rotation,
                None => sound = false,
            }
        }
        sound.then_some(origin)
    }

    /// Reads a rotation from a quaternion, as URDF 1.1 has it; its length need not be 1.
    fn quaternion(&mut self, attribute: &Attribute<'_, 'a>, second: bool) -> Option<Rotation> {
        let range = attribute.range_value();
        let words = attribute.value().split_whitespace();
        let entries: Vec<Decimal> = words.filter_map(Decimal::parse).collect();
        let count = attribute.value().split_whitespace().count();
        let values: Vec<f64> = entries.iter().map(|entry| entry.value).collect();
        let (&[x, y, z, w], 4) = (values.as_slice(), count) else {
            self.errors.push(
                &range,
                format!("expected four numbers, found {}", entries.len()),
                "write `quat_xyzw=\"0 0 0 1\"`, the scalar last",
            );
            return None;
        };
        if second {
            self.errors.push(
                &range,
                "a pose has both `rpy` and `quat_xyzw`",
                "remove one of them",
            );
            return None;
        }
        let Some(angles) = angles([x, y, z, w]) else {
            let message = "the quaternion is zero";
            let help = "write `quat_xyzw=\"0 0 0 1\"` for no rotation";
            self.errors.push(&range, message, help);
            return None;
        };
        Some(Rotation(angles.map(|angle| {
            let written = Decimal::parse(&format!("{angle:?}")).unwrap_or_else(Decimal::zero);
            Angle::read(&written, self.tolerance)
        })))
    }

    fn angle(&mut self, number: &Decimal, range: &Range<usize>) -> Angle {
        let angle = Angle::read(number, self.tolerance);
        if matches!(angle, Angle::Right(_)) && !number.is_zero() {
            self.changed(number, &angle.expr().to_string(), range);
        }
        angle
    }

    /// Sets entries to 0 that are negligible against the largest one, and those of at most `nothing` in size. The
    /// absolute bound `nothing` is for lengths only: a direction has no scale, and an inertia may be arbitrarily
    /// small.
    pub(super) fn clean<const N: usize>(
        &mut self,
        entries: &mut [Decimal; N],
        range: &Range<usize>,
        nothing: f64,
    ) {
        let largest = entries
            .iter()
            .fold(0.0, |most: f64, entry| most.max(entry.value.abs()));
        let bound = nothing.max(self.tolerance * largest);
        for entry in entries {
            let size = entry.value.abs();
            if !entry.is_zero() && size <= bound {
                self.changed(entry, "0", range);
                *entry = Decimal::zero();
            }
        }
    }

    fn changed(&mut self, number: &Decimal, read: &str, range: &Range<usize>) {
        self.cleaned.push(Cleaned {
            range: range.clone(),
            written: number.text.clone(),
            read: read.to_string(),
        });
    }
}

/// Returns roll, pitch and yaw of a quaternion; `None` if it is zero.
fn angles([x, y, z, w]: [f64; 4]) -> Option<[f64; 3]> {
    let norm = [x, y, z, w]
        .iter()
        .fold(0.0, |norm: f64, part| norm.hypot(*part));
    if norm == 0.0 {
        return None;
    }
    // cos(pitch/2) ± sin(pitch/2) times cosine and sine of (yaw ∓ roll)/2.
    let (difference, sum) = ((w + y, z - x), (w - y, z + x));
    let (plus, minus) = (difference.0.hypot(difference.1), sum.0.hypot(sum.1));
    let (difference, sum) = (difference.1.atan2(difference.0), sum.1.atan2(sum.0));
    let pitch = 2.0 * (plus - minus).atan2(plus + minus);
    Some([sum - difference, pitch, sum + difference])
}

#[cfg(test)]
mod tests {
    use super::angles;

    /// Quaternions of any length and sign give back roll, pitch and yaw, also at pitch ±π/2.
    #[test]
    fn quaternions_are_roll_pitch_and_yaw() {
        let product = |a: [f64; 4], b: [f64; 4]| {
            let ([x, y, z, w], [u, v, t, s]) = (a, b);
            [
                w * u + s * x + y * t - z * v,
                w * v + s * y + z * u - x * t,
                w * t + s * z + x * v - y * u,
                w * s - x * u - y * v - z * t,
            ]
        };
        let right = std::f64::consts::FRAC_PI_2;
        let turn = |roll: f64, pitch: f64, yaw: f64| {
            let [r, p, y] = [roll, pitch, yaw].map(|angle| (angle / 2.0).sin_cos());
            let about = [
                [r.0, 0.0, 0.0, r.1],
                [0.0, p.0, 0.0, p.1],
                [0.0, 0.0, y.0, y.1],
            ];
            product(about[2], product(about[1], about[0]))
        };
        for pitch in [0.0, 0.3, -1.2, right, -right, right - 1e-9] {
            for (roll, yaw) in [(0.0, 0.0), (0.4, -2.0), (-3.0, 1.5), (2.5, 3.0)] {
                let given = turn(roll, pitch, yaw);
                for scale in [1.0, -2.5] {
                    let found = angles(given.map(|part| scale * part));
                    let [roll, pitch, yaw] = found.expect("not zero");
                    let again = turn(roll, pitch, yaw);
                    let dot: f64 = (0..4).map(|i| given[i] * again[i]).sum();
                    let off: f64 = (0..4)
                        .map(|i| (given[i] - dot.signum() * again[i]).abs())
                        .fold(0.0, f64::max);
                    assert!(off < 1e-15, "{given:?} {again:?}");
                }
            }
        }
        assert_eq!(angles([0.0; 4]), None);
    }
}
