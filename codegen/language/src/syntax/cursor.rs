//! Position in the list of tokens, and errors for unexpected tokens.

use proc_macro2::Delimiter;

use super::ast::{Ident, Span};
use super::tokens::{Kind, Token, closing};
use super::words::{CLAUSES, CONNECTIVES, RUST_WORDS, is_statement};
use crate::diagnostics::Diagnostic;

/// Largest number of errors reported for one description; more are rarely read.
pub(super) const MAX_ERRORS: usize = 100;

/// A parsed part of the description, or the error that ends its statement.
pub(super) type Parsed<T> = Result<T, Diagnostic>;

/// The tokens, the current position, and the errors so far.
pub(super) struct Cursor<'a> {
    /// All tokens; the last is the end marker.
    tokens: &'a [Token],
    /// Index of the next token.
    at: usize,
    /// Start of the next statement, if the current one turned out to lack its `;`.
    resume: Option<usize>,
    /// Number of choices around the next token. Their nesting needs its own bound because conditions have no brackets.
    pub choices: usize,
    /// Errors of the statements that were skipped.
    pub errors: Vec<Diagnostic>,
}

impl<'a> Cursor<'a> {
    /// Creates a cursor at the first token of a list from [`flatten`](super::tokens::flatten).
    pub fn new(tokens: &'a [Token]) -> Self {
        Cursor {
            tokens,
            at: 0,
            resume: None,
            choices: 0,
            errors: Vec::new(),
        }
    }

    /// Returns the token `ahead` places after the next one.
    fn ahead(&self, ahead: usize) -> &'a Token {
        // The list is never empty: it contains at least the end marker.
        let last = self.tokens.len() - 1;
        &self.tokens[(self.at + ahead).min(last)]
    }

    /// Returns the next token.
    pub fn peek(&self) -> &'a Token {
        self.ahead(0)
    }

    /// Returns the span of the next token.
    pub fn here(&self) -> Span {
        self.peek().span
    }

    /// Returns the span of the previous token.
    pub fn before(&self) -> Span {
        self.previous().span
    }

    fn previous(&self) -> &'a Token {
        &self.tokens[self.at.saturating_sub(1)]
    }

    /// Consumes the next token.
    pub fn bump(&mut self) -> &'a Token {
        let token = self.peek();
        if token.kind != Kind::End {
            self.at += 1;
        }
        token
    }

    /// Returns the index of the next token, for [`recover`](Self::recover).
    pub fn mark(&self) -> usize {
        self.at
    }

    /// Returns whether the next token is this word.
    pub fn is_word(&self, word: &str) -> bool {
        let token = self.peek();
        token.kind == Kind::Word && token.text == word
    }

    /// Returns whether the next token is a word.
    pub fn is_any_word(&self) -> bool {
        self.peek().kind == Kind::Word
    }

    /// Returns whether the next token is this character.
    pub fn is_punct(&self, c: char) -> bool {
        self.peek().kind == Kind::Punct(c)
    }

    /// Returns whether the next token opens this kind of bracket.
    pub fn is_open(&self, delimiter: Delimiter) -> bool {
        matches!(self.peek().kind, Kind::Open(found, _) if found == delimiter)
    }

    /// Returns whether the token after the next opens a parenthesis.
    pub fn is_call(&self) -> bool {
        matches!(self.ahead(1).kind, Kind::Open(Delimiter::Parenthesis, _))
    }

    /// Returns whether the token after the next opens a bracket.
    pub fn is_indexed(&self) -> bool {
        matches!(self.ahead(1).kind, Kind::Open(Delimiter::Bracket, _))
    }

    /// Returns the two tokens after the next one.
    pub fn inside(&self) -> (&'a Token, &'a Token) {
        (self.ahead(1), self.ahead(2))
    }

    /// Returns whether a name with a counter in brackets is next: `leg[i in`.
    pub fn starts_array(&self) -> bool {
        let [counter, word] = [self.ahead(2), self.ahead(3)];
        self.is_indexed() && counter.kind == Kind::Word && word.text == "in"
    }

    /// Returns the next token if it is a word that begins with `_`.
    pub fn next_ending(&self) -> Option<&'a str> {
        let token = self.peek();
        let begins = token.text.len() > 1 && token.text.starts_with('_');
        (token.kind == Kind::Word && begins).then_some(token.text.as_str())
    }

    /// Consumes the next token if it is a word that begins with `_`.
    pub fn ending(&mut self) -> Option<&'a str> {
        let ending = self.next_ending();
        self.at += usize::from(ending.is_some());
        ending
    }

    /// Returns whether the token after the next is one of these characters or words.
    pub fn is_followed_by(&self, characters: &[char], words: &[&str]) -> bool {
        let token = self.ahead(1);
        match token.kind {
            Kind::Punct(c) => characters.contains(&c),
            Kind::Word => words.contains(&token.text.as_str()),
            _ => false,
        }
    }

    /// Returns whether the next token closes a bracket or is the end.
    pub fn is_end(&self) -> bool {
        matches!(self.peek().kind, Kind::Close(_) | Kind::End)
    }

    /// Returns whether the next token is one of the words that end an expression.
    pub fn is_connective(&self) -> bool {
        is_connective(self.peek())
    }

    /// Consumes this word if it is next. Returns whether it was.
    pub fn eat_word(&mut self, word: &str) -> bool {
        let found = self.is_word(word);
        self.at += usize::from(found);
        found
    }

    /// Consumes this character if it is next. Returns whether it was.
    pub fn eat_punct(&mut self, c: char) -> bool {
        let found = self.is_punct(c);
        self.at += usize::from(found);
        found
    }

    /// Consumes an opening bracket if it is next. Returns whether it was.
    pub fn eat_open(&mut self, delimiter: Delimiter) -> bool {
        let found = self.is_open(delimiter);
        self.at += usize::from(found);
        found
    }

    /// Consumes this word; an error if it is not next.
    pub fn expect_word(&mut self, word: &str) -> Parsed<()> {
        if self.eat_word(word) {
            Ok(())
        } else {
            Err(self.unexpected(&format!("`{word}`")))
        }
    }

    /// Consumes this character; an error if it is not next.
    pub fn expect_punct(&mut self, c: char) -> Parsed<()> {
        if self.eat_punct(c) {
            Ok(())
        } else {
            Err(self.unexpected(&format!("`{c}`")))
        }
    }

    /// Consumes a closing bracket; an error if it is not next. `separator` says whether a comma could stand here
    /// instead.
    pub fn expect_close(&mut self, delimiter: Delimiter, separator: bool) -> Parsed<()> {
        if self.peek().kind == Kind::Close(delimiter) {
            self.at += 1;
            return Ok(());
        }
        let bracket = match closing(delimiter) {
            "" => "the end of what the macro matched".to_owned(),
            bracket => format!("`{bracket}`"),
        };
        let separated = if separator { "`,` or " } else { "" };
        let error = self.unexpected(&format!("{separated}{bracket}"));
        Err(match operator_help(self.peek()) {
            Some(help) => error.help(help),
            None => error,
        })
    }

    /// Consumes the `=` of a statement.
    pub fn assign(&mut self) -> Parsed<()> {
        self.expect_punct('=')?;
        if self.is_punct('=') {
            let span = self.before().to(self.here());
            return Err(Diagnostic::new(span, "`==` is not an operator")
                .help("an equation is written with `=`"));
        }
        Ok(())
    }

    /// Consumes a name. `of` describes the named thing, for messages.
    pub fn name(&mut self, of: &str) -> Parsed<Ident> {
        let token = self.peek();
        let span = self.here();
        if token.kind != Kind::Word || is_connective(token) {
            return Err(self.unexpected(&format!("the name of {of}")));
        }
        check_name(token, span)?;
        self.at += 1;
        Ok(Ident {
            name: token.text.clone(),
            span,
        })
    }

    /// Consumes a word where Rust's keywords are allowed, too: a field, a shape, a choice between words.
    pub fn word(&mut self, expected: &str) -> Parsed<Ident> {
        let token = self.peek();
        if token.kind != Kind::Word || is_connective(token) {
            return Err(self.unexpected(expected));
        }
        let span = self.here();
        self.at += 1;
        Ok(Ident {
            name: token.text.clone(),
            span,
        })
    }

    /// Consumes the `;` of a statement. `expression` says whether an expression could continue in its place.
    pub fn end(&mut self, expression: bool) -> Parsed<()> {
        if self.eat_punct(';') {
            return Ok(());
        }
        let after = self.previous();
        let message = format!("expected `;` after {}", quoted(after));
        let next = self.peek();
        let statement = next.kind == Kind::Word && is_statement(&next.text);
        if self.is_end() || statement || next.kind == Kind::Punct('#') {
            self.resume = Some(self.at);
            return Err(Diagnostic::new(self.before(), message).help("end the statement with `;`"));
        }
        let error = Diagnostic::new(self.here(), format!("{message}, found {}", quoted(next)));
        Err(match operator_help(next) {
            Some(help) if expression => error.help(help),
            _ => error,
        })
    }

    /// Returns whether the next two tokens start a statement rather than being names.
    pub fn starts_statement(&self) -> bool {
        let follows = self.ahead(1);
        // `spring stiffness force length 2 …`: here `force` is a name, since `length` is a clause of the current
        // statement.
        let clause = CLAUSES.contains(&follows.text.as_str())
            && !matches!(
                self.ahead(2).kind,
                Kind::Punct('=' | ':' | ';' | '~' | ',' | '.')
            );
        self.is_any_word()
            && is_statement(&self.peek().text)
            && follows.kind == Kind::Word
            && !is_connective(follows)
            && !clause
    }

    /// Returns the error for a token found in the place of something else.
    pub fn unexpected(&mut self, expected: &str) -> Diagnostic {
        let found = self.peek();
        if self.starts_statement() {
            self.resume = Some(self.at);
            return Diagnostic::new(
                self.here(),
                format!(
                    "expected {expected}, found the next statement `{}`",
                    found.text
                ),
            );
        }
        let error = Diagnostic::new(
            self.here(),
            format!("expected {expected}, found {}", quoted(found)),
        );
        match found.kind {
            Kind::Punct('\'') => error.help(TRANSPOSE),
            Kind::Word if is_connective(found) && expected.starts_with("the name") => {
                error.help(format!(
                    "`{}` is a word of the language and cannot be a name",
                    found.text
                ))
            }
            _ => error,
        }
    }

    /// Skips the statement that starts at an index, up to and including its `;` or the braces that end it.
    pub fn recover(&mut self, start: usize) {
        let resume = self.resume.take();
        let mut at = start;
        loop {
            if resume == Some(at) && at > start {
                break;
            }
            let Some(token) = self.tokens.get(at) else {
                break;
            };
            match token.kind {
                Kind::Open(delimiter, close) => {
                    at = close + 1;
                    // A choice continues after its first braces.
                    let next = self.tokens.get(at).filter(|token| token.text != "else");
                    let next = next.map(|token| token.kind);
                    if delimiter == Delimiter::Brace && next == Some(Kind::Punct(';')) {
                        at += 1;
                        break;
                    }
                    if delimiter == Delimiter::Brace
                        && matches!(next, Some(Kind::Word | Kind::Punct('#')))
                    {
                        break;
                    }
                }
                Kind::Punct(';') => {
                    at += 1;
                    break;
                }
                Kind::Close(_) | Kind::End => break,
                _ => at += 1,
            }
        }
        self.at = at;
    }
}

/// Syntax of a transpose, for messages.
const TRANSPOSE: &str = "a transpose is written `transpose(M)` or `M.T`";

/// Returns help for a token found where an expression could continue.
fn operator_help(found: &Token) -> Option<&'static str> {
    match found.kind {
        Kind::Word if is_connective(found) => None,
        Kind::Word | Kind::Literal | Kind::Open(..) => {
            Some("a product is written with `*`; a statement ends with `;`")
        }
        Kind::Punct('\'') => Some(TRANSPOSE),
        Kind::Punct('<' | '>') => {
            Some("numbers are compared in a choice: `if a < b { c } else { d }`")
        }
        Kind::Punct('%' | '&' | '|' | '!' | '~' | '@') => {
            Some("the operators are `+`, `-`, `*`, `/` and `^`")
        }
        _ => None,
    }
}

fn is_connective(token: &Token) -> bool {
    token.kind == Kind::Word && CONNECTIVES.contains(&token.text.as_str())
}

/// Refuses names that the generated code cannot use.
pub(super) fn check_name(token: &Token, span: Span) -> Parsed<()> {
    if let Some(name) = token.text.strip_prefix("r#") {
        return Err(
            Diagnostic::new(span, format!("`r#{name}` is a raw identifier"))
                .help(format!("choose a plain name, such as `{name}_`")),
        );
    }
    if RUST_WORDS.contains(&token.text.as_str()) {
        let name = token.text.trim_start_matches('_');
        return Err(Diagnostic::new(
            span,
            format!("`{}` is a word of Rust and cannot be a name", token.text),
        )
        .help(if name.is_empty() {
            "choose a name with letters".to_owned()
        } else {
            format!("choose another name, such as `{name}_`")
        }));
    }
    Ok(())
}

/// Quotes a token for a message.
pub(super) fn quoted(token: &Token) -> String {
    match token.kind {
        Kind::End => "the end of the input".to_owned(),
        Kind::Open(Delimiter::None, _) | Kind::Close(Delimiter::None) => {
            "a group of tokens".to_owned()
        }
        Kind::Doc => "a doc comment".to_owned(),
        _ => format!("`{}`", shown(&token.text)),
    }
}

/// Shortens a text for a message.
pub(super) fn shown(text: &str) -> String {
    /// Longer texts are cut.
    const LONGEST: usize = 40;
    if text.chars().count() <= LONGEST {
        return text.to_owned();
    }
    let start: String = text.chars().take(LONGEST).collect();
    format!("{start}…")
}
