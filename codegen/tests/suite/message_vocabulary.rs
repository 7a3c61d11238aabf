//! Messages contain only names that the user wrote and words of the language, no internal names of the generator.
//! Checked for wrong descriptions, and for correct ones with randomly misspelt names.

use crate::common::{Random, attack};
use crate::models::models;
use crate::wrong_descriptions::{without_expected, wrong_descriptions};
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::functions::FunctionId;
use hamel_codegen::generate::from_text;
use hamel_codegen::vocabulary;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Shorter names are placeholders in proposals, such as `rate q = v;`.
const MAX_PLACEHOLDER_LETTERS: usize = 4;

/// Suffixes of names derived from joints, functions and keywords of Rust.
const SUFFIXES: [&str; 13] = [
    "dot", "r", "R", "v", "w", "d", "p", "1", "2", "slopes", "twist", "body", "",
];

/// Words of proposals that are placeholders for what the user would write.
const PROPOSAL_WORDS: &str = "DEFAULT EXPRESSION LOWER NAME Name UPPER argument error f64 false file foot force from ground knee left link mat3
    mount name number path pchip point rate sym2 sym3 system then torque true values vec2 vec3 vecN when with y_slopes";

/// Returns the identifiers of a text.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
    words.filter(|word| word.starts_with(|c: char| c.is_alphabetic() || c == '_'))
}

/// Returns the words of the language.
fn vocabulary_words() -> &'static BTreeSet<String> {
    static ALL: OnceLock<BTreeSet<String>> = OnceLock::new();
    ALL.get_or_init(|| {
        let mut texts = vec![PROPOSAL_WORDS.to_string()];
        let two = |(word, form): (&str, &str)| format!("{word} {form}");
        texts.extend(vocabulary::statements().map(two));
        texts.extend(vocabulary::kinds_of_joints().map(String::from));
        texts.extend(vocabulary::fields_of_joints().map(two));
        texts.extend(vocabulary::fields_of_bodies().map(two));
        texts.extend(vocabulary::functions().map(|(word, form)| format!("{word} {form}")));
        texts.extend(FunctionId::ALL.iter().map(|id| id.name().to_string()));
        texts
            .iter()
            .flat_map(|text| words(text))
            .map(String::from)
            .collect()
    })
}

/// Returns the names in backticks that are neither from the text nor from the language.
fn foreign(error: &Diagnostic, text: &str) -> Vec<String> {
    let written: BTreeSet<&str> = words(text).collect();
    let is_known = |word: &str| written.contains(word) || vocabulary_words().contains(word);
    let of_joint = |word: &str| {
        let mut rest = word;
        while let Some((front, back)) = rest.rsplit_once('_') {
            if !SUFFIXES.contains(&back) {
                return false;
            }
            if front.is_empty() || is_known(front) {
                return true;
            }
            rest = front;
        }
        false
    };
    let notes = error.notes.iter().map(|(_, note)| note.as_str());
    let said = [Some(error.message.as_str()), error.help.as_deref()];
    let said = said.into_iter().flatten().chain(notes);
    let quoted = said.flat_map(|text| text.split('`').skip(1).step_by(2));
    quoted
        .flat_map(words)
        .filter(|word| word.len() >= MAX_PLACEHOLDER_LETTERS || word.contains('_') && *word != "_")
        .filter(|word| !is_known(word) && !of_joint(word))
        .map(|word| {
            format!(
                "`{word}` in “{}; {}”",
                error.message,
                error.help.as_deref().unwrap_or("")
            )
        })
        .collect()
}

fn faults(name: &str, text: &str) -> Vec<String> {
    let errors = from_text(text).err().unwrap_or_default();
    let foreign = errors.iter().flat_map(|error| foreign(error, text));
    foreign.map(|what| format!("{name}: {what}")).collect()
}

fn texts(folder: &str, list: fn(&Path) -> Vec<PathBuf>) -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let paths = list(&root.join(folder));
    let read = |path: &PathBuf| {
        let name = path.file_name()?.to_string_lossy().into_owned();
        Some((name, without_expected(&std::fs::read_to_string(path).ok()?)))
    };
    paths.iter().filter_map(read).collect()
}

#[test]
fn messages_name_what_was_written() {
    let mut all = Vec::new();
    let wrong = texts("tests/wrong", wrong_descriptions);
    for (name, text) in [wrong, texts("docs/book/errors", models)].concat() {
        all.extend(faults(&name, &text));
    }
    assert!(all.is_empty(), "{}:\n{}", all.len(), all.join("\n"));
}

/// Misspells a name of a correct description in one place.
fn misspelt(text: &str, random: &mut Random) -> String {
    let names: Vec<&str> = words(text).collect();
    let name = names[random.below(names.len())];
    let place = name.as_ptr() as usize - text.as_ptr() as usize;
    let other = match random.below(5) {
        0 => format!("{name}_dot"),
        1 => format!("{name}dot"),
        2 => format!("{name}{name}"),
        3 => name.chars().skip(1).chain(['k']).collect(),
        _ => names[random.below(names.len())].to_string(),
    };
    format!("{}{other}{}", &text[..place], &text[place + name.len()..])
}

#[test]
fn misspelt_names_are_answered_by_those_that_were_written() {
    let all: Vec<(String, String)> = texts("tests/models", models)
        .into_iter()
        .filter(|(_, text)| text.len() < 1500)
        .collect();
    attack(120, 20_000, |seed| {
        let mut random = Random::new(0xa11a5 + seed);
        let (name, text) = &all[random.below(all.len())];
        faults(name, &misspelt(text, &mut random))
    });
}

/// Proposes the velocity of a coordinate where its rate is called by another name.
#[test]
fn a_rate_that_has_a_name_is_proposed() {
    let system = |more: &str| {
        format!(
            "system Q {{ coord x, y: R2; velocity v, w: vec2; rate x = v, y = w; kinetic v^2 + dot(w, w); {more} }}"
        )
    };
    for (more, coordinate, velocity) in [
        ("generalized force v = -0.1 * x_dot;", "x", "v"),
        ("start x_dot = 1;", "x", "v"),
        ("output s = xdot;", "x", "v"),
        ("output s = dot(y_dot, y);", "y", "w"),
        ("dissipation dx^2;", "x", "v"),
    ] {
        let text = system(more);
        let errors = from_text(&text).expect_err(more);
        let help = errors[0].help.as_deref();
        let expected = format!("the rate of `{coordinate}` is `{velocity}`");
        assert_eq!(
            help,
            Some(expected.as_str()),
            "{more}: {}",
            errors[0].message
        );
    }
}
