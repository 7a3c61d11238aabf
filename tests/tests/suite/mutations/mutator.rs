//! Mutations of descriptions, token by token and statement by statement.

use crate::models::models;
use crate::wrong_descriptions::{without_expected, wrong_descriptions};
use hamel_codegen::algebra::residue_pair;
use std::path::Path;

/// Words, numbers and signs that fixtures may lack.
const WORDS: &[&str] = &[
    "0",
    "1",
    "-1",
    "2",
    "3",
    "0.5",
    "1/3",
    "64",
    "65",
    "1e400",
    "1e-400",
    "1e308",
    "1e401",
    "9223372036854775808",
    "-9223372036854775808",
    "1000",
    "1001",
    "0.1e1",
    "1_0",
    "1f64",
    "0x1",
    "+",
    "-",
    "*",
    "/",
    "^",
    "=",
    ".",
    ",",
    ";",
    ":",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "==",
    "%",
    "pi",
    "world",
    "sqrt",
    "log",
    "exp",
    "sin",
    "cos",
    "tan",
    "atan2",
    "norm",
    "abs",
    "sign",
    "min",
    "max",
    "clamp",
    "hypot",
    "if",
    "else",
    "<",
    ">=",
    "table",
    "linear",
    "pchip",
    "extrapolate",
    "hold",
    "error",
    "dot",
    "cross",
    "outer",
    "hat",
    "vee",
    "diag",
    "trace",
    "identity",
    "transpose",
    "rotx",
    "rpy",
    "axis_angle",
    "rot",
    "qmul",
    "pose",
    "inverse",
    "vec3",
    "vec64",
    "mat3",
    "mat64",
    "sym3",
    "sym64",
    "R1",
    "R3",
    "R64",
    "S1",
    "S3",
    "SO3",
    "SE3",
    "about",
    "com",
    "origin",
    "on",
    "at",
    "in",
    "body",
    "constraint",
    "invariant",
    "joint",
    "include",
    "component",
    "part",
    "for",
    "extern",
    "fn",
    ">",
    "prescribe",
    "state",
    "~",
    "frame",
    "i",
    "n",
    "_dot",
    "..",
    "pub",
    "system",
    "c",
    "s",
    "T",
    "R",
    "p",
    "é",
    "\"",
    "'",
    "#",
    "///",
    "//",
    "/*",
    "*/",
    "r#a",
    "\u{0}",
    "\u{202e}",
    "𝒙",
    "ω̂",
];

/// Pseudo-random choices.
pub struct Random(residue_pair::Random);

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(residue_pair::Random::new(
            seed.wrapping_mul(0x9e37_79b9_7f4a_7c15),
        ))
    }

    /// Returns a number below a nonzero bound.
    fn below(&mut self, bound: usize) -> usize {
        (self.0.bits() % bound.max(1) as u64) as usize
    }
}

/// Returns the tokens of a text without comments; joined by blanks, they form an equivalent text.
pub fn tokens(text: &str) -> Vec<String> {
    let mut tokens: Vec<String> = Vec::new();
    for line in text.lines() {
        let code = line.split("//").next().unwrap_or_default();
        let code = code.replace("..", " .. ");
        let mut word = String::new();
        for letter in code.chars().chain([' ']) {
            let number = word.starts_with(|c: char| c.is_ascii_digit());
            if letter.is_alphanumeric() || letter == '_' || (letter == '.' && number) {
                word.push(letter);
                continue;
            }
            tokens.extend((!word.is_empty()).then(|| std::mem::take(&mut word)));
            tokens.extend((!letter.is_whitespace()).then(|| letter.to_string()));
        }
    }
    tokens
}

/// Descriptions to start from, and all their tokens.
pub struct Corpus {
    all: Vec<Vec<String>>,
    /// Indices of correct ones that are generated quickly.
    quick: Vec<usize>,
    words: Vec<String>,
}

impl Corpus {
    /// Reads all fixtures.
    pub fn read() -> Self {
        let mut texts = Vec::new();
        let mut right = 0;
        for folder in ["models", "models/external", "models/reuse", "wrong"] {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
            let paths = match folder {
                "wrong" => wrong_descriptions(&path),
                _ => models(&path),
            };
            for path in paths {
                let text = std::fs::read_to_string(path).expect("readable");
                texts.push(without_expected(&text));
            }
            if folder != "wrong" {
                right = texts.len();
            }
        }
        // Rotations make a description expensive.
        let dear = |text: &String| ["SO3", "SE3"].iter().any(|kind| text.contains(kind));
        let quick = (0..right).filter(|&i| !dear(&texts[i])).collect();
        let all: Vec<Vec<String>> = texts.iter().map(|text| tokens(text)).collect();
        let mut words: Vec<String> = all.iter().flatten().cloned().collect();
        words.sort();
        words.dedup();
        words.extend(WORDS.iter().map(|word| word.to_string()));
        Corpus { all, quick, words }
    }

    /// Returns a mutated description; `quick` prefers those that are cheap to generate.
    pub fn mutate(&self, random: &mut Random, quick: bool) -> String {
        let index = if quick && random.below(4) > 0 {
            self.quick[random.below(self.quick.len())]
        } else {
            random.below(self.all.len())
        };
        let mut tokens = self.all[index].clone();
        for _ in 0..1 + random.below(4) {
            self.step(&mut tokens, random);
        }
        let mut text = tokens.join(" ");
        if random.below(50) == 0 {
            self.bytes(&mut text, random);
        }
        text
    }

    fn step(&self, tokens: &mut Vec<String>, random: &mut Random) {
        let at = random.below(tokens.len());
        let end = (at + 1 + random.below(3)).min(tokens.len());
        let word = self.words[random.below(self.words.len())].clone();
        match random.below(10) {
            0 => drop(tokens.drain(at.min(end)..end)),
            1 => {
                let copy = tokens[at.min(end)..end].to_vec();
                tokens.splice(at.min(tokens.len())..at.min(tokens.len()), copy);
            }
            2 if !tokens.is_empty() => {
                let other = random.below(tokens.len());
                tokens.swap(at, other);
            }
            3 => tokens.insert(at, word),
            // A word for a word, a number for a number, a sign for a sign: the text usually remains correct.
            4..=6 if !tokens.is_empty() => {
                let kind = |token: &str| {
                    let first = token.chars().next().unwrap_or(' ');
                    (first.is_alphabetic(), first.is_ascii_digit())
                };
                let alike = |token: &&String| kind(token) == kind(&tokens[at]);
                let source = if random.below(2) == 0 {
                    &*tokens
                } else {
                    &self.words
                };
                let source: Vec<&String> = source.iter().filter(alike).collect();
                if let Some(&word) = source.get(random.below(source.len())) {
                    tokens[at] = word.clone();
                }
            }
            7 => self.statement(tokens, random),
            8 => {
                let other = &self.all[random.below(self.all.len())];
                let statements = statements(other);
                if let Some(range) = statements.get(random.below(statements.len())) {
                    let own = self::statements(tokens);
                    let place = own
                        .get(random.below(own.len()))
                        .map_or(tokens.len(), |r| r.start);
                    tokens.splice(place..place, other[range.clone()].to_vec());
                }
            }
            _ if !tokens.is_empty() => tokens[at] = word,
            _ => tokens.push(word),
        }
    }

    /// Deletes, duplicates or moves a whole statement.
    fn statement(&self, tokens: &mut Vec<String>, random: &mut Random) {
        let all = statements(tokens);
        let Some(range) = all.get(random.below(all.len())).cloned() else {
            return;
        };
        let copy = tokens[range.clone()].to_vec();
        let action = random.below(3);
        if action < 2 {
            tokens.drain(range);
        }
        if action > 0 {
            let all = statements(tokens);
            let place = all
                .get(random.below(all.len()))
                .map_or(tokens.len(), |r| r.start);
            tokens.splice(place..place, copy);
        }
    }

    /// Overwrites, inserts and deletes characters anywhere.
    fn bytes(&self, text: &mut String, random: &mut Random) {
        let mut letters: Vec<char> = text.chars().collect();
        for _ in 0..1 + random.below(8) {
            let at = random.below(letters.len());
            let letter = char::from_u32(random.below(0x300) as u32).unwrap_or('?');
            match random.below(3) {
                0 => letters.insert(at, letter),
                1 if !letters.is_empty() => letters[at] = letter,
                _ => letters.truncate(letters.len() - random.below(2).min(letters.len())),
            }
        }
        *text = letters.into_iter().collect();
    }
}

/// Returns the statements of a system, each up to a `;` or `}`.
fn statements(tokens: &[String]) -> Vec<std::ops::Range<usize>> {
    let start = tokens
        .iter()
        .position(|token| token == "{")
        .map_or(0, |open| open + 1);
    let mut all = Vec::new();
    let mut first = start;
    let mut depth = 0usize;
    for (at, token) in tokens.iter().enumerate().skip(start) {
        match token.as_str() {
            "{" => depth += 1,
            "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 && matches!(token.as_str(), ";" | "}") {
            all.push(first..at + 1);
            first = at + 1;
        }
    }
    // The last one ends the system.
    all.pop();
    all
}
