//! Warnings about the robots of `example-robot-data` as they are, and about all misspelt words in them.

use crate::installed::installed;
use hamel_codegen::urdf::{Options, import};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Elements that are read, in the order of the trials.
const WORDS: [&str; 14] = [
    "joint",
    "link",
    "inertial",
    "mass",
    "inertia",
    "origin",
    "parent",
    "child",
    "axis",
    "dynamics",
    "mimic",
    "limit",
    "transmission",
    "gazebo",
];

/// Number of misspelt words for each element of each robot.
fn trials() -> usize {
    match std::env::var("HAMEL_ATTACK").as_deref() {
        Ok("full") => 40,
        Ok("more") => 8,
        _ => 1,
    }
}

/// Xorshift with a fixed seed: the same words in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 16) % bound as u64) as usize
    }
}

/// All URDF files below a folder with their texts, sorted.
fn robots(folder: &Path) -> Vec<(String, String)> {
    let mut open = vec![folder.to_path_buf()];
    let mut found: Vec<PathBuf> = Vec::new();
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|end| end == "urdf") {
                found.push(path);
            }
        }
    }
    found.sort();
    let read = found.into_iter().map(|path| {
        let name = path.file_name().expect("a file").to_string_lossy();
        let text = std::fs::read_to_string(&path).expect("a text");
        (name.into_owned(), text)
    });
    read.collect()
}

/// Elements that change the motion are named; elements outside the equations cause no warnings.
#[test]
fn what_is_said_of_robots() {
    let Some(folder) = installed() else {
        eprintln!("robots are not read: tests/robots/install.sh installs their URDF");
        return;
    };
    let mut said: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (name, text) in robots(&folder) {
        let options = Options {
            name: Some("robot".into()),
            ..Options::default()
        };
        let Ok(imported) = import(&text, &options) else {
            said.entry("refused".into()).or_default().push(name);
            continue;
        };
        for warning in &imported.warnings {
            // Places and names depend on the robot.
            let words = warning.message.split(", here and at").next();
            let message = words.unwrap_or("").to_string();
            let general = message.contains("not part of URDF")
                || message.contains("left out")
                || message.contains("no name");
            if general {
                said.entry(message).or_default().push(name.clone());
            }
        }
    }
    let lines: Vec<String> = said
        .iter()
        .map(|(message, names)| format!("{message}\n    {}", names.join(" ")))
        .collect();
    insta::assert_snapshot!(lines.join("\n"));
}

/// With one misspelt element a robot is refused, or the new word is named in one warning.
#[test]
fn misspelt_elements_are_never_lost() {
    let Some(folder) = installed() else {
        eprintln!("robots are not misspelt: tests/robots/install.sh installs their URDF");
        return;
    };
    let mut random = Random(0x0005_eed5_7d0b_07a1);
    let mut tried = 0;
    for (name, text) in robots(&folder) {
        for word in WORDS {
            let opening = format!("<{word}");
            let places: Vec<usize> = text
                .match_indices(&opening)
                .map(|(place, _)| place)
                .filter(|&place| !inside(&text, place))
                .filter(|&place| {
                    let after = text[place + opening.len()..].chars().next();
                    after.is_some_and(|c| c.is_whitespace() || c == '>' || c == '/')
                })
                .collect();
            if places.is_empty() {
                continue;
            }
            for _ in 0..trials() {
                let place = places[random.below(places.len())];
                let at = 1 + random.below(word.len());
                let mut wrong = word.to_string();
                wrong.insert(at, 'q');
                let broken = misspelt(&text, place, word, &wrong);
                tried += 1;
                let Ok(found) = import(&broken, &Options::default()) else {
                    continue;
                };
                let quoted = format!("`<{wrong}>`");
                let named = found
                    .warnings
                    .iter()
                    .filter(|warning| warning.message.contains(&quoted));
                let lines: Vec<usize> = named.map(|warning| warning.line).collect();
                let line = text[..place].matches('\n').count() + 1;
                assert_eq!(lines, [line], "{name}: {wrong}");
            }
        }
    }
    assert!(tried > 300, "{tried} words");
}

/// Whether a place is in a comment, or in an element that is not part of the equations.
fn inside(text: &str, place: usize) -> bool {
    let before = &text[..place];
    let open = |start: &str, end: &str| match before.rfind(start) {
        Some(at) => !before[at..].contains(end),
        None => false,
    };
    open("<!--", "-->")
        || ["visual", "collision", "collision_checking", "self_filter"].iter().any(|name| {
            open(&format!("<{name}>"), &format!("</{name}>"))
                || open(&format!("<{name} "), &format!("</{name}>"))
        })
        // Elements read by other programs; sensors have poses too, and joints of old Gazebo are named as a whole.
        || ["sensor", "plugin", "ros2_control", "joint:hinge", "joint:slider"].iter().any(|name| {
            open(&format!("<{name} "), &format!("</{name}>"))
        })
}

/// The text with another word in one opening tag and in the matching closing tag.
fn misspelt(text: &str, place: usize, word: &str, wrong: &str) -> String {
    let end = place + text[place..].find('>').expect("a tag ends");
    let closing = format!("</{word}>");
    let mut broken = text.to_string();
    if !text[..end].ends_with('/') {
        let closed = end + text[end..].find(&closing).expect("an element ends");
        broken.replace_range(closed..closed + closing.len(), &format!("</{wrong}>"));
    }
    broken.replace_range(place + 1..place + 1 + word.len(), wrong);
    broken
}
