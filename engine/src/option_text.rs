//! Splits options that are lists into items that keep their places, for error messages.

use crate::error::Error;
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::syntax::ast::Span;
use std::ops::Range;

/// Part of the text of a command-line option, without surrounding spaces, which knows its place for errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece<'a> {
    /// Text of the part.
    pub text: &'a str,
    /// Byte offset in the option's text.
    pub start: usize,
}

impl<'a> Piece<'a> {
    /// Takes the whole text of an option; fails if its brackets do not match.
    pub fn of(text: &'a str) -> Result<Self, Diagnostic> {
        let mut open: Vec<(char, usize)> = Vec::new();
        for (place, letter) in text.char_indices() {
            let wrong = |message: String| {
                Diagnostic::new(Span::new(place..place + letter.len_utf8()), message)
            };
            match letter {
                '(' | '[' | '{' => open.push((closing(letter), place)),
                ')' | ']' | '}' => match open.pop() {
                    Some((wanted, _)) if wanted == letter => {}
                    Some((wanted, _)) => {
                        return Err(wrong(format!("expected `{wanted}` before `{letter}`")));
                    }
                    None => return Err(wrong(format!("`{letter}` closes nothing"))),
                },
                '"' | '\'' | '/' if letter != '/' || text[place..].starts_with("//") => {
                    return Err(wrong(format!("`{letter}` has no meaning here")));
                }
                _ => {}
            }
        }
        match open.pop() {
            Some((wanted, place)) => Err(Diagnostic::new(
                Span::new(place..place + 1),
                format!("`{wanted}` is missing"),
            )),
            None => Ok(Piece { text, start: 0 }.trimmed()),
        }
    }

    /// Returns the range of the part.
    pub fn span(&self) -> Span {
        Span::new(self.start..self.start + self.text.len())
    }

    /// Creates an error at this part.
    pub fn wrong(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(self.span(), message)
    }

    /// Moves an error in the text of this part to its place in the option.
    pub fn moved(&self, error: Diagnostic) -> Diagnostic {
        let place = error.span.range();
        let place = place.map(|at| Span::new(at.start + self.start..at.end + self.start));
        Diagnostic {
            span: place.unwrap_or_else(|| self.span()),
            ..error
        }
    }

    /// Takes a range of this part, without surrounding spaces.
    pub fn part(&self, range: Range<usize>) -> Self {
        let start = self.start + range.start;
        let text = self.text.get(range).unwrap_or("");
        Piece { text, start }.trimmed()
    }

    fn trimmed(self) -> Self {
        let spaces = self.text.len() - self.text.trim_start().len();
        Piece {
            text: self.text.trim(),
            start: self.start + spaces,
        }
    }

    /// Returns the parts between separators outside brackets.
    pub fn split(&self, separator: char) -> Vec<Self> {
        let mut from = 0;
        let mut parts = Vec::new();
        for place in self.outside() {
            if self.text[place..].starts_with(separator) {
                parts.push(self.part(from..place));
                from = place + separator.len_utf8();
            }
        }
        parts.push(self.part(from..self.text.len()));
        parts
    }

    /// Returns the sides of an equation: the parts between `=` outside brackets that belong to no `==`, `<=` or `>=`.
    pub fn sides(&self) -> Vec<Self> {
        let bytes = self.text.as_bytes();
        let is_sign = |place: usize| bytes.get(place).is_some_and(|sign| b"<>=!".contains(sign));
        let (mut from, mut parts) = (0, Vec::new());
        for place in self.outside() {
            if bytes[place] == b'=' && !is_sign(place + 1) && (place == 0 || !is_sign(place - 1)) {
                parts.push(self.part(from..place));
                from = place + 1;
            }
        }
        parts.push(self.part(from..self.text.len()));
        parts
    }

    /// Returns the byte offsets of characters outside brackets.
    pub fn outside(&self) -> Vec<usize> {
        let mut depth = 0_usize;
        let mut places = Vec::new();
        for (place, letter) in self.text.char_indices() {
            match letter {
                '(' | '[' | '{' => depth += 1,
                ')' | ']' | '}' => depth = depth.saturating_sub(1),
                _ if depth == 0 => places.push(place),
                _ => {}
            }
        }
        places
    }

    /// Splits `NAME(…)` into the name and the text in the brackets.
    pub fn call(&self) -> Option<(Self, Self)> {
        let open = self.text.find('(')?;
        let name = self.part(0..open);
        let is_word = |text: &str| text.chars().all(|c| c.is_alphanumeric() || c == '_');
        // Nothing may follow the bracket that closes the first one.
        let outside = self.outside();
        let whole = self.text.ends_with(')') && outside.iter().all(|place| *place < open);
        let one = self.text[open..]
            .char_indices()
            .scan(0_i32, |depth, (place, letter)| {
                *depth += match letter {
                    '(' | '[' | '{' => 1,
                    ')' | ']' | '}' => -1,
                    _ => 0,
                };
                Some((*depth, place))
            });
        let closed = one.into_iter().find(|(depth, _)| *depth == 0)?.1 + open;
        let alone = closed + 1 == self.text.len();
        (whole && alone && !name.text.is_empty() && is_word(name.text))
            .then(|| (name, self.part(open + 1..closed)))
    }
}

fn closing(letter: char) -> char {
    match letter {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}

/// Creates the error of an option from all errors in its text.
pub fn invalid_option(option: &str, text: &str, errors: &[Diagnostic]) -> Error {
    Error::Argument {
        option: option.into(),
        text: text.into(),
        diagnostics: errors.to_vec(),
    }
}

#[cfg(test)]
mod tests {
    use super::Piece;

    #[test]
    fn items_stand_between_separators_outside_of_brackets() {
        let text = " a = f(1; 2) ;b= [3;4] ; ";
        let piece = Piece::of(text).expect("brackets belong together");
        let parts: Vec<(&str, usize)> =
            piece.split(';').iter().map(|p| (p.text, p.start)).collect();
        assert_eq!(parts, [("a = f(1; 2)", 1), ("b= [3;4]", 14), ("", 24)]);
        let call = Piece::of("max( norm(w) )").expect("brackets").call();
        let call = call.map(|(name, inner)| (name.text, inner.text, inner.start));
        assert_eq!(call, Some(("max", "norm(w)", 5)));
        for no_call in ["max(a) + max(b)", "end", "(a)", "max(a)b", "2 max(a)"] {
            assert_eq!(
                Piece::of(no_call).expect("brackets").call(),
                None,
                "{no_call}"
            );
        }
    }

    #[test]
    fn brackets_that_do_not_belong_together_have_a_place() {
        let place = |text| Piece::of(text).map_err(|e| e.span.range().map(|r| r.start));
        assert_eq!(place("a(b]"), Err(Some(3)));
        assert_eq!(place("a(b"), Err(Some(1)));
        assert_eq!(place("ü)"), Err(Some(2)));
        assert_eq!(place("a // b"), Err(Some(2)));
        assert!(place("a / b").is_ok());
    }
}
