//! Scan of the raw text of a file, before it is split into tokens.
//!
//! This finds unbalanced brackets and characters that are not part of the language while their places are still known;
//! the tokeniser would stop at the first of them. Comments and strings are skipped.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{LexError, TokenStream};

use super::ast::Span;
use super::cursor::MAX_ERRORS;
use super::tokens::{MAX_NESTING, too_deep};
use crate::diagnostics::Diagnostic;

/// Characters that have an equivalent in the language, with that equivalent.
const SPELLINGS: [(char, &str); 14] = [
    ('×', "*"),
    ('·', "*"),
    ('⋅', "*"),
    ('∙', "*"),
    ('∗', "*"),
    ('÷', "/"),
    ('−', "-"),
    ('–', "-"),
    ('²', "^2"),
    ('³', "^3"),
    ('½', "1/2"),
    ('¼', "1/4"),
    ('√', "sqrt"),
    ('→', "="),
];

/// Result of a scan.
pub(super) struct Scan {
    /// The errors, in the order of the text.
    pub errors: Vec<Diagnostic>,
    /// The text with every refused character replaced by others of the same length, or `None` if its brackets, comments
    /// or strings do not close.
    pub readable: Option<String>,
}

/// An error, placed by byte offset.
struct Finding {
    at: usize,
    message: String,
    help: String,
    /// Another place, with its label.
    note: Option<(usize, &'static str)>,
}

/// Scans a text.
pub(super) fn scan(text: &str) -> Scan {
    let mut scanner = Scanner {
        text,
        ..Scanner::default()
    };
    let balanced = scanner.run();
    let place = |at: usize| Span::new(at..at + 1);
    let errors = scanner.findings.iter().map(|finding| {
        let error = match finding.message.as_str() {
            "" => too_deep(place(finding.at)),
            message => Diagnostic::new(place(finding.at), message).help(&finding.help),
        };
        match finding.note {
            Some((at, label)) => error.note(place(at), label),
            None => error,
        }
    });
    let errors = errors.collect();
    let readable = balanced.then(|| substitute(text, &scanner.replaced));
    Scan { errors, readable }
}

/// Returns the error for a text that passed the scan but cannot be split into tokens.
pub(super) fn unreadable(error: &LexError) -> Diagnostic {
    #[cfg(feature = "files")]
    let place = Span::new(error.span().byte_range());
    #[cfg(not(feature = "files"))]
    let place = (Span::NOWHERE, error).0;
    Diagnostic::new(place, "the text cannot be read from here on").help("check the spelling here")
}

/// State of the scan.
#[derive(Default)]
struct Scanner<'a> {
    text: &'a str,
    at: usize,
    open: Vec<(usize, char)>,
    findings: Vec<Finding>,
    /// Offsets of refused characters, each with the text that replaces it.
    replaced: BTreeMap<usize, &'static str>,
    /// Non-ASCII characters that are known to be allowed in names.
    letters: BTreeSet<char>,
}

impl<'a> Scanner<'a> {
    /// Scans the text. Returns whether brackets, comments and strings close.
    fn run(&mut self) -> bool {
        if self.text.starts_with('\u{feff}') {
            self.at = '\u{feff}'.len_utf8();
        }
        let mut previous = ' ';
        while let Some(c) = self.rest().chars().next() {
            if self.findings.len() >= MAX_ERRORS {
                return false;
            }
            let start = self.at;
            let proceed = match c {
                '/' if self.rest().starts_with("//") => {
                    self.at += self.rest().find('\n').unwrap_or(self.rest().len());
                    true
                }
                '/' if self.rest().starts_with("/*") => self.block_comment(),
                '"' => self.string(),
                '\'' => {
                    self.quote(previous);
                    true
                }
                ';' => {
                    self.unclosed();
                    self.at += 1;
                    true
                }
                '(' | '[' | '{' => self.opened(c),
                ')' | ']' | '}' => self.closed(c),
                _ if self.is_name(c) => {
                    let rest = self.rest();
                    let end = rest.find(|c: char| !self.is_name(c)).unwrap_or(rest.len());
                    self.at += end;
                    let raw = matches!(&rest[..end], "r" | "br" | "cr");
                    if raw && self.rest().trim_start_matches('#').starts_with('"') {
                        self.raw_string()
                    } else {
                        true
                    }
                }
                _ => {
                    self.other(c);
                    true
                }
            };
            if !proceed {
                return false;
            }
            // The last character of a comment or blank counts as the previous one, so that a quote after it does not
            // follow a value.
            previous = self.text[start..self.at].chars().next_back().unwrap_or(c);
        }
        if let Some(&(at, bracket)) = self.open.last() {
            self.find(
                at,
                format!("unclosed `{bracket}`"),
                format!("close it with `{}`", counterpart(bracket)),
            );
            return false;
        }
        true
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn find(&mut self, at: usize, message: impl Into<String>, help: impl Into<String>) {
        self.findings.push(Finding {
            at,
            message: message.into(),
            help: help.into(),
            note: None,
        });
    }

    fn block_comment(&mut self) -> bool {
        let start = self.at;
        let mut depth = 0_usize;
        while let Some(next) = self.rest().find(['/', '*']) {
            self.at += next;
            if self.rest().starts_with("/*") {
                depth += 1;
                self.at += 2;
            } else if self.rest().starts_with("*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return true;
                }
            } else {
                self.at += 1;
            }
        }
        self.find(start, "unclosed comment", "close it with `*/`");
        false
    }

    fn string(&mut self) -> bool {
        let start = self.at;
        self.at += 1;
        while let Some(next) = self.rest().find(['"', '\\']) {
            let escaped = self.rest()[next..].starts_with('\\');
            self.at += next + 1;
            if !escaped {
                return true;
            }
            self.at += self.rest().chars().next().map_or(0, char::len_utf8);
        }
        self.find(
            start,
            "unclosed string",
            "values are made of numbers, names and arrays: remove the quote",
        );
        false
    }

    fn raw_string(&mut self) -> bool {
        let start = self.at;
        let hashes = self.rest().len() - self.rest().trim_start_matches('#').len();
        self.at += hashes + 1;
        let end = format!("\"{}", "#".repeat(hashes));
        match self.rest().find(&end) {
            Some(next) => {
                self.at += next + end.len();
                true
            }
            None => {
                self.find(
                    start,
                    "unclosed string",
                    "values are made of numbers, names and arrays: remove the quote",
                );
                false
            }
        }
    }

    /// Reports, at a `;`, parentheses and brackets that are still open and that nothing in the next statement closes.
    ///
    /// The text from the bracket to the `;` is left out, so that the other statements can be parsed.
    fn unclosed(&mut self) {
        let braced = self
            .open
            .iter()
            .rposition(|(_, bracket)| *bracket == '{')
            .map_or(0, |brace| brace + 1);
        let Some(&(at, bracket)) = self.open.get(braced) else {
            return;
        };
        let rest = &self.rest()[1..];
        let next = &rest[..rest.find([';', '{', '}']).unwrap_or(rest.len())];
        if next.matches([')', ']']).count() > next.matches(['(', '[']).count() {
            return;
        }
        self.open.truncate(braced);
        let value = self.text[..at]
            .chars()
            .next_back()
            .is_some_and(is_end_of_value);
        let left_out = self.text[at..self.at]
            .char_indices()
            .map(|(offset, _)| (at + offset, ""));
        self.replaced.extend(left_out);
        if !value {
            self.replaced.insert(at, "0");
        }
        self.find(
            at,
            format!("unclosed `{bracket}`"),
            format!("close it with `{}`", counterpart(bracket)),
        );
    }

    /// Handles a quote. After a value it is meant as a transpose and refused; a character literal is left to the
    /// parser.
    fn quote(&mut self, previous: char) {
        let start = self.at;
        self.at += 1;
        if !is_end_of_value(previous) {
            let mut chars = self.rest().chars();
            let content = chars.next();
            if content != Some('\\')
                && let (Some(content), Some('\'')) = (content, chars.next())
            {
                self.at += content.len_utf8() + 1;
                return;
            }
        }
        self.replaced.insert(start, "");
        self.find(
            start,
            "`'` is not an operator",
            "a transpose is written `transpose(M)` or `M.T`",
        );
    }

    fn opened(&mut self, bracket: char) -> bool {
        self.open.push((self.at, bracket));
        if self.open.len() > MAX_NESTING {
            self.find(self.at, "", "");
            return false;
        }
        self.at += 1;
        true
    }

    fn closed(&mut self, bracket: char) -> bool {
        match self.open.pop() {
            Some((_, open)) if counterpart(open) == bracket => {
                self.at += 1;
                return true;
            }
            Some((at, open)) => self.findings.push(Finding {
                at: self.at,
                message: format!("expected `{}`, found `{bracket}`", counterpart(open)),
                help: format!("close the `{open}` first"),
                note: Some((at, "opened here")),
            }),
            None => self.find(
                self.at,
                format!("`{bracket}` closes nothing"),
                "remove it, or open it before",
            ),
        }
        false
    }

    fn other(&mut self, c: char) {
        let at = self.at;
        self.at += c.len_utf8();
        if let Some((_, spelling)) = SPELLINGS.iter().find(|(other, _)| *other == c) {
            // A character with an equivalent operator is read as that operator, so that the statement causes no second
            // error.
            let operator = spelling.len() == 1;
            self.replaced
                .insert(at, if operator { spelling } else { "" });
            self.find(at, not_part(c), format!("write `{spelling}`"));
            return;
        }
        let blank = c.is_whitespace() || matches!(c, '\u{200e}' | '\u{200f}');
        let operator = c.is_ascii_punctuation() && !matches!(c, '\\' | '`');
        if !blank && !operator {
            self.replaced.insert(at, "");
            self.find(at, not_part(c), "remove it");
        }
    }

    /// Returns whether a name may contain a character: letters, digits, and marks such as the dot of `q̇`.
    fn is_name(&mut self, c: char) -> bool {
        if c.is_ascii() || c.is_whitespace() {
            return c.is_ascii_alphanumeric() || c == '_';
        }
        if self.letters.contains(&c) {
            return true;
        }
        // Asks the tokeniser.
        let blank = matches!(c, '\u{200e}' | '\u{200f}');
        let letter = !blank && format!("a{c}").parse::<TokenStream>().is_ok();
        if letter {
            self.letters.insert(c);
        }
        letter
    }
}

/// Returns the message for a character that no token contains.
fn not_part(c: char) -> String {
    let shown = if c == '\\' {
        c.to_string()
    } else {
        c.escape_debug().to_string()
    };
    format!("the character `{shown}` is not part of the language")
}

/// Returns whether a value may end with this character, so that what follows continues it.
fn is_end_of_value(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | ')' | ']' | '\'')
}

/// Returns the closing bracket for an opening one.
fn counterpart(bracket: char) -> char {
    match bracket {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}

/// Replaces refused characters, keeping all others at their offsets.
fn substitute(text: &str, replaced: &BTreeMap<usize, &'static str>) -> String {
    let mut readable = String::with_capacity(text.len());
    for (at, c) in text.char_indices() {
        match replaced.get(&at) {
            Some(other) if c != '\n' => {
                readable.push_str(other);
                readable.push_str(blank(c.len_utf8() - other.len()));
            }
            _ => readable.push(c),
        }
    }
    readable
}

/// Returns blanks of this many bytes, as a single character if there is one of that length.
fn blank(bytes: usize) -> &'static str {
    match bytes {
        0 => "",
        1 => " ",
        2 => "\u{a0}",
        3 => "\u{2003}",
        _ => "\u{a0}\u{a0}",
    }
}
