//! The place in the list of tokens, and how an unexpected token is reported.

use proc_macro2::Delimiter;

use super::ast::{Ident, Span};
use super::tokens::{Kind, Token, closing};
use super::words::{CLAUSES, CONNECTIVES, RUST_WORDS, is_statement};
use crate::diagnostics::Diagnostic;

/// Errors reported for one description; what follows is rarely read.
pub(super) const MAX_ERRORS: usize = 100;

/// A part of the description, or the error that ends its statement.
pub(super) type Parsed<T> = Result<T, Diagnostic>;

/// The tokens, the place among them, and the errors so far.
pub(super) struct Cursor<'a> {
    /// All tokens; the last is the end.
    tokens: &'a [Token],
    /// The index of the next token.
    at: usize,
    /// Where the next statement starts, if the current one turned out to lack its `;`.
    resume: Option<usize>,
    /// How many choices the next token is in: their conditions have no brackets that would bound them.
    pub choices: usize,
    /// The errors of the statements that were given up.
    pub errors: Vec<Diagnostic>,
}

impl<'a> Cursor<'a> {
    /// At the first token of a list that [`flatten`](super::tokens::flatten) made.
    pub fn new(tokens: &'a [Token]) -> Self {
        Cursor {
            tokens,
            at: 0,
            resume: None,
            choices: 0,
            errors: Vec::new(),
        }
    }

    /// The next token but `ahead`.
    fn ahead(&self, ahead: usize) -> &'a Token {
        // The list is never empty: it ends with the end.
        let last = self.tokens.len() - 1;
        &self.tokens[(self.at + ahead).min(last)]
    }

    /// The next token.
    pub fn peek(&self) -> &'a Token {
        self.ahead(0)
    }

    /// The region of the next token.
    pub fn here(&self) -> Span {
        self.peek().span
    }

    /// The region of the token before.
    pub fn before(&self) -> Span {
        self.previous().span
    }

    fn previous(&self) -> &'a Token {
        &self.tokens[self.at.saturating_sub(1)]
    }

    /// Takes the next token.
    pub fn bump(&mut self) -> &'a Token {
        let token = self.peek();
        if token.kind != Kind::End {
            self.at += 1;
        }
        token
    }

    /// The index of the next token, to recover from.
    pub fn mark(&self) -> usize {
        self.at
    }

    /// Whether the next token is this word.
    pub fn is_word(&self, word: &str) -> bool {
        let token = self.peek();
        token.kind == Kind::Word && token.text == word
    }

    /// Whether the next token is a word at all.
    pub fn is_any_word(&self) -> bool {
        self.peek().kind == Kind::Word
    }

    /// Whether the next token is this character.
    pub fn is_punct(&self, c: char) -> bool {
        self.peek().kind == Kind::Punct(c)
    }

    /// Whether the next token opens this kind of bracket.
    pub fn is_open(&self, delimiter: Delimiter) -> bool {
        matches!(self.peek().kind, Kind::Open(found, _) if found == delimiter)
    }

    /// Whether the token after the next opens a parenthesis.
    pub fn is_call(&self) -> bool {
        matches!(self.ahead(1).kind, Kind::Open(Delimiter::Parenthesis, _))
    }

    /// Whether the token after the next opens a bracket.
    pub fn is_indexed(&self) -> bool {
        matches!(self.ahead(1).kind, Kind::Open(Delimiter::Bracket, _))
    }

    /// Whether a name with a counter in brackets is next: `leg[i in`.
    pub fn starts_array(&self) -> bool {
        let [counter, word] = [self.ahead(2), self.ahead(3)];
        self.is_indexed() && counter.kind == Kind::Word && word.text == "in"
    }

    /// A word that begins with `_`, where it is next.
    pub fn next_ending(&self) -> Option<&'a str> {
        let token = self.peek();
        let begins = token.text.len() > 1 && token.text.starts_with('_');
        (token.kind == Kind::Word && begins).then_some(token.text.as_str())
    }

    /// Takes a word that begins with `_`, where it is next.
    pub fn ending(&mut self) -> Option<&'a str> {
        let ending = self.next_ending();
        self.at += usize::from(ending.is_some());
        ending
    }

    /// Whether the token after the next is one of these characters or words.
    pub fn is_followed_by(&self, characters: &[char], words: &[&str]) -> bool {
        let token = self.ahead(1);
        match token.kind {
            Kind::Punct(c) => characters.contains(&c),
            Kind::Word => words.contains(&token.text.as_str()),
            _ => false,
        }
    }

    /// Whether the next token closes a bracket or is the end.
    pub fn is_end(&self) -> bool {
        matches!(self.peek().kind, Kind::Close(_) | Kind::End)
    }

    /// Whether the next token is one of the words that end an expression.
    pub fn is_connective(&self) -> bool {
        is_connective(self.peek())
    }

    /// Takes this word if it is next.
    pub fn eat_word(&mut self, word: &str) -> bool {
        let found = self.is_word(word);
        self.at += usize::from(found);
        found
    }

    /// Takes this character if it is next.
    pub fn eat_punct(&mut self, c: char) -> bool {
        let found = self.is_punct(c);
        self.at += usize::from(found);
        found
    }

    /// Takes an opening bracket if it is next.
    pub fn eat_open(&mut self, delimiter: Delimiter) -> bool {
        let found = self.is_open(delimiter);
        self.at += usize::from(found);
        found
    }

    /// Takes this word.
    pub fn expect_word(&mut self, word: &str) -> Parsed<()> {
        if self.eat_word(word) {
            Ok(())
        } else {
            Err(self.unexpected(&format!("`{word}`")))
        }
    }

    /// Takes this character.
    pub fn expect_punct(&mut self, c: char) -> Parsed<()> {
        if self.eat_punct(c) {
            Ok(())
        } else {
            Err(self.unexpected(&format!("`{c}`")))
        }
    }

    /// Takes a closing bracket, where commas may continue the list.
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

    /// Takes the `=` of a statement.
    pub fn assign(&mut self) -> Parsed<()> {
        self.expect_punct('=')?;
        if self.is_punct('=') {
            let span = self.before().to(self.here());
            return Err(Diagnostic::new(span, "`==` is not an operator")
                .help("an equation is written with `=`"));
        }
        Ok(())
    }

    /// Takes a name; `of` says what it names.
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

    /// Takes a name that nothing else can stand for: a field, a shape, a choice between words.
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

    /// Takes the `;` of a statement; `expression` says whether more of an expression could stand in its place.
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

    /// Whether the next two tokens are the start of a statement, and no names.
    pub fn starts_statement(&self) -> bool {
        let follows = self.ahead(1);
        // `spring stiffness force length 2 …`: what is called as a statement stands before a part of one.
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

    /// The error for a token in the place of something else.
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
                    "`{}` is a word of the language and can name nothing",
                    found.text
                ))
            }
            _ => error,
        }
    }

    /// Goes on behind the statement that starts at an index: after its `;`, or the braces that end it.
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
                    // A choice goes on behind its first braces.
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

/// How a transpose is written.
const TRANSPOSE: &str = "a transpose is written `transpose(M)` or `M.T`";

/// What to do about a token where an expression could go on.
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

/// Refuses names that the generated code could not have.
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

/// A token as messages quote it.
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

/// A text short enough for a message.
pub(super) fn shown(text: &str) -> String {
    /// Longer texts are cut.
    const LONGEST: usize = 40;
    if text.chars().count() <= LONGEST {
        return text.to_owned();
    }
    let start: String = text.chars().take(LONGEST).collect();
    format!("{start}…")
}
