//! Nothing that changes the motion is lost silently: unknown words at random places, at every level, get one warning
//! each; a misspelt known word is an error or gets a warning.

use hamel_import::{Imported, Options, import};
use roxmltree::{Document, Node};
use std::collections::BTreeSet;
use std::ops::Range;

const EVERY_LEVEL: &str = include_str!("files/every_level.urdf");

/// Elements whose contents are not compared with the list: they are not part of the equations, or consist of one word.
const APART: [&str; 18] = [
    "visual",
    "collision",
    "material",
    "ray",
    "plugin",
    "hardware",
    "calibration",
    "mechanicalReduction",
    "gear_ratio",
    "lateral_friction",
    "hardwareInterface",
    "type",
    "mu1",
    "implicitSpringDamper",
    "turnGravityOff",
    "gravity",
    "kinematic",
    "inertia_scaling",
];

/// Number of trials of each kind.
fn trials() -> usize {
    match std::env::var("HAMEL_ATTACK").as_deref() {
        Ok("full") => 10_000,
        Ok("more") => 4_000,
        _ => 600,
    }
}

/// An xorshift generator with a fixed seed, so that every run has the same words.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 16) % bound as u64) as usize
    }

    fn word(&mut self) -> String {
        const LETTERS: &[u8] = b"abcdefghijklmnopqrstuvwxyz_ABCXYZ";
        let length = 3 + self.below(9);
        let tail = (0..length).map(|_| char::from(LETTERS[self.below(LETTERS.len())]));
        // No program uses words that begin like this.
        "qz".chars().chain(tail).collect()
    }

    /// Returns a word with one letter inserted, removed, swapped or changed in case.
    fn misspelt(&mut self, word: &str) -> String {
        let mut letters: Vec<char> = word.chars().collect();
        let start = word.rfind(':').map_or(0, |colon| colon + 1);
        let at = start + self.below(letters.len() - start);
        match self.below(4) {
            0 => letters.insert(at, 'q'),
            1 if letters.len() > start + 1 => {
                letters.remove(at);
            }
            2 if at + 1 < letters.len() => letters.swap(at, at + 1),
            _ => {
                letters[at] = match letters[at].is_uppercase() {
                    true => letters[at].to_ascii_lowercase(),
                    false => letters[at].to_ascii_uppercase(),
                }
            }
        }
        letters.into_iter().collect()
    }
}

fn read(text: &str) -> Imported {
    match import(text, &Options::default()) {
        Ok(imported) => imported,
        Err(problems) => panic!("{problems:?}\n{text}"),
    }
}

/// The description without its comments.
fn statements(imported: &Imported) -> Vec<String> {
    let text = imported.text();
    let lines = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    lines.map(str::to_string).collect()
}

/// Returns the elements whose contents are compared with the list.
fn elements<'a>(document: &'a Document<'a>) -> Vec<Node<'a, 'a>> {
    let apart = |node: Node<'_, '_>| {
        let above = |name| {
            node.parent_element()
                .is_some_and(|up| up.has_tag_name(name))
        };
        let name = node.tag_name().name();
        APART.contains(&name)
            || above("link") && name == "origin"
            || above("ros2_control") && name != "transmission"
    };
    let all = document.descendants().filter(Node::is_element);
    all.filter(|node| !node.ancestors().any(apart)).collect()
}

/// Returns the range of the name in an opening tag.
fn name(text: &str, node: &Node<'_, '_>) -> Range<usize> {
    let start = node.range().start + 1;
    let length = text[start..].find(|c: char| c.is_whitespace() || c == '>' || c == '/');
    start..start + length.expect("a tag ends")
}

fn line(text: &str, byte: usize) -> usize {
    text[..byte].matches('\n').count() + 1
}

/// The base is read correctly: the trials cannot lose anything that it lacks.
#[test]
fn the_base_of_the_trials_holds_every_level() {
    let imported = read(EVERY_LEVEL);
    for part in [
        "damping 0.4;",
        "armature 0.0001 * 100^2 + 0.002;",
        "stiffness 3; rest 0.2;",
        "spherical on fore",
        "position(pin_1)[3] = position(pin_2)[3],",
        "dot(pin_1.R * [0, 1, 0], pin_2.R * [1, 0, 0]) = 0;",
        "position(ball_constraint_1)[3] = position(ball_constraint_2)[3];",
        "spring stiffness 7 length 0.3 from [0.1, 0, 0] on world to [0, 0, 0.2] on upper;",
        "damper coefficient 0.5 from",
    ] {
        assert!(
            imported.text().contains(part),
            "{part}\n{}",
            imported.text()
        );
    }
}

#[test]
fn words_that_are_not_on_the_list_are_named_once() {
    let base = read(EVERY_LEVEL);
    let document = Document::parse(EVERY_LEVEL).expect("XML");
    let elements = elements(&document);
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut levels = BTreeSet::new();
    for _ in 0..trials() {
        let node = &elements[random.below(elements.len())];
        let word = random.word();
        let end = name(EVERY_LEVEL, node).end;
        let mut text = EVERY_LEVEL.to_string();
        let (place, quoted) = if random.below(2) == 0 {
            text.insert_str(end, &format!(" {word}='0.5'"));
            (end, format!("`{word}`"))
        } else {
            let inside = format!("<{word} value='2'>3</{word}>");
            let tag = node.range().start + EVERY_LEVEL[node.range()].find('>').expect("a tag ends");
            let place = match EVERY_LEVEL[..tag].ends_with('/') {
                true => {
                    let whole = &EVERY_LEVEL[name(EVERY_LEVEL, node)];
                    text.replace_range(tag - 1..=tag, &format!(">{inside}</{whole}>"));
                    tag
                }
                false => {
                    text.insert_str(tag + 1, &inside);
                    tag + 1
                }
            };
            (place, format!("`<{word}>`"))
        };
        levels.insert(EVERY_LEVEL[name(EVERY_LEVEL, node)].to_string());
        // Text that is a number of an element must not follow another element.
        let found = match import(&text, &Options::default()) {
            Ok(found) => found,
            Err(problems) => {
                let said = problems
                    .iter()
                    .all(|problem| problem.message.contains("not a number"));
                assert!(said && node.text().is_some(), "{problems:?}\n{text}");
                continue;
            }
        };
        let named = found
            .warnings
            .iter()
            .filter(|warning| warning.message.contains(&quoted));
        let lines: Vec<usize> = named.map(|warning| warning.line).collect();
        assert_eq!(
            lines,
            [line(EVERY_LEVEL, place)],
            "{word}: {:?}",
            found.warnings
        );
        assert_eq!(found.warnings.len(), base.warnings.len() + 1, "{word}");
        let comment = format!("// - {}: {quoted} is", lines[0]);
        let text = found.text();
        assert!(text.contains(&comment), "{comment}\n{text}");
        assert_eq!(statements(&found), statements(&base), "{word}");
    }
    let all: BTreeSet<String> = elements
        .iter()
        .map(|node| EVERY_LEVEL[name(EVERY_LEVEL, node)].to_string())
        .collect();
    assert_eq!(levels, all);
}

#[test]
fn misspelt_words_are_errors_or_named() {
    let document = Document::parse(EVERY_LEVEL).expect("XML");
    let inside = elements(&document);
    // The name of an element is a word of the parent element.
    let all = document.descendants().filter(Node::is_element);
    let around = |node: &Node<'_, '_>| node.parent_element().is_none_or(|up| inside.contains(&up));
    let elements: Vec<Node<'_, '_>> = all.filter(around).collect();
    let known: BTreeSet<&str> = document
        .descendants()
        .flat_map(|node| {
            let own = node
                .is_element()
                .then(|| &EVERY_LEVEL[name(EVERY_LEVEL, &node)]);
            own.into_iter()
                .chain(node.attributes().map(|attribute| attribute.name()))
        })
        .chain(["mu", "id", "gravity", "pose"])
        .collect();
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    for _ in 0..trials() {
        let node = &elements[random.below(elements.len())];
        let attributes: Vec<_> = node.attributes().collect();
        let mut text = EVERY_LEVEL.to_string();
        let word;
        if random.below(2) == 0 && !attributes.is_empty() && inside.contains(node) {
            let attribute = &attributes[random.below(attributes.len())];
            word = random.misspelt(attribute.name());
            text.replace_range(attribute.range_qname(), &word);
        } else {
            let range = name(EVERY_LEVEL, node);
            word = random.misspelt(&EVERY_LEVEL[range.clone()]);
            let closing = format!("</{}>", &EVERY_LEVEL[range.clone()]);
            let end = node.range().end;
            if EVERY_LEVEL[node.range()].ends_with(&closing) {
                text.replace_range(end - closing.len()..end, &format!("</{word}>"));
            }
            text.replace_range(range, &word);
        }
        // Sensors of old files have a separate namespace.
        if known.contains(word.as_str()) || word.starts_with("sensor:") {
            continue;
        }
        match import(&text, &Options::default()) {
            Err(problems) => assert!(!problems.is_empty()),
            Ok(found) => {
                let quoted = [format!("`{word}`"), format!("`<{word}>`")];
                let says = |message: &str| quoted.iter().any(|word| message.contains(word));
                let named = found
                    .warnings
                    .iter()
                    .filter(|warning| says(&warning.message));
                assert!(named.count() >= 1, "{word}: {:?}\n{text}", found.warnings);
            }
        }
    }
}

/// Words of the dialects that do not change the motion give no warning; with values that do, they give one.
#[test]
fn words_that_change_nothing_are_quiet() {
    let quiet = read(EVERY_LEVEL).warnings.len();
    for (before, after) in [
        ("<turnGravityOff>false</", "<turnGravityOff>true</"),
        ("<gravity>1</", "<gravity>0</"),
        ("<kinematic>0</", "<kinematic>1</"),
        (
            "<inertia_scaling value=\"1.0\"",
            "<inertia_scaling value=\"3\"",
        ),
        (
            "<origin xyz=\"0 0 0\" rpy=\"0 -0 0\"/>",
            "<origin xyz=\"0 0 0.1\" rpy=\"0 -0 0\"/>",
        ),
        ("libgazebo_ros_control.so", "libLiftDragPlugin.so"),
        ("<mimicJoint>follower<", "<mimicJoint>elbow<"),
    ] {
        let text = EVERY_LEVEL.replacen(before, after, 1);
        assert_ne!(text, EVERY_LEVEL, "{before}");
        let warnings = read(&text).warnings;
        assert_eq!(warnings.len(), quiet + 1, "{after}: {warnings:?}");
    }
}

/// Drake's planar joints move in the plane across z.
#[test]
fn planar_joints_of_drake() {
    let joint = |axis: &str| {
        let text = EVERY_LEVEL.replace("type=\"ball\">", &format!("type=\"planar\">{axis}"));
        read(&text)
    };
    let (plain, same) = (joint(""), joint("<axis xyz=\"0 0 1\"/>"));
    let other = joint("<axis xyz=\"1 0 0\"/>");
    assert!(
        plain
            .text()
            .contains("joint wrist: planar [0, 0, 1] on fore moves hand")
    );
    assert_eq!(statements(&plain), statements(&same));
    assert_eq!(statements(&plain), statements(&other));
    let counts = [&plain, &same, &other].map(|read| read.warnings.len());
    assert_eq!(counts, [counts[0], counts[0], counts[0] + 1]);
}
