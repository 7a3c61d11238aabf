//! Tokens in one flat list, so that neither deep nor malformed nesting uses stack.

use proc_macro2::{Delimiter, Literal, Span as TokenSpan, TokenStream, TokenTree, token_stream};

use super::ast::Span;
use crate::diagnostics::Diagnostic;

/// Largest nesting depth of brackets in a description.
pub(super) const MAX_NESTING: usize = 64;

/// Kinds of tokens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A word.
    Word,
    /// A number, or a literal that does not exist in the language.
    Literal,
    /// The text of a doc comment, decoded.
    Doc,
    /// One character of punctuation.
    Punct(char),
    /// An opening bracket, with the index of the closing one.
    Open(Delimiter, usize),
    /// A closing bracket.
    Close(Delimiter),
    /// The end marker after the last token.
    End,
}

/// One token.
#[derive(Clone, Debug)]
pub(super) struct Token {
    /// Kind of the token.
    pub kind: Kind,
    /// Text as written. Without quotes for a doc comment; empty for invisible brackets and the end.
    pub text: String,
    /// Position in the source.
    pub span: Span,
}

/// Compiler spans of a macro's input, by token number. Token numbers are the places in its description.
#[derive(Clone, Debug, Default)]
pub struct Places(Vec<TokenSpan>);

impl Places {
    fn add(&mut self, span: TokenSpan) -> Span {
        self.0.push(span);
        Span::new(self.0.len() - 1..self.0.len())
    }

    /// Returns the first and the last token of a region, or the macro call if the region has no place.
    pub fn ends(&self, span: Span) -> (TokenSpan, TokenSpan) {
        let at = |index: Option<usize>| index.and_then(|index| self.0.get(index).copied());
        let range = span.range();
        let first = at(range.as_ref().map(|range| range.start));
        let last = at(range.and_then(|range| range.end.checked_sub(1)));
        let call = TokenSpan::call_site;
        (first.unwrap_or_else(call), last.unwrap_or_else(call))
    }
}

/// Flattens the tokens of a text. Their spans are byte ranges.
#[cfg(feature = "files")]
pub(super) fn of_text(stream: TokenStream) -> Vec<Token> {
    flatten(stream, &mut |span| Span::new(span.byte_range()))
}

/// Flattens the tokens of a macro's input. Their spans are token numbers, which [`Places`] resolves.
pub(super) fn of_stream(stream: TokenStream) -> (Vec<Token>, Places) {
    let mut places = Places::default();
    let tokens = flatten(stream, &mut |span| places.add(span));
    (tokens, places)
}

/// Lists the tokens in source order, followed by an end marker.
///
/// The compiler puts invisible brackets around what a `macro_rules!` matched. These are kept if they contain an
/// operator, since they then group like parentheses. Elsewhere, as around a doc comment, a path or nothing at all, they
/// are dropped.
fn flatten(stream: TokenStream, place: &mut dyn FnMut(TokenSpan) -> Span) -> Vec<Token> {
    let mut tokens: Vec<Token> = Vec::new();
    let mut outer: Vec<Frame> = Vec::new();
    let mut inner = stream.into_iter();
    loop {
        let (kind, text, span) = match inner.next() {
            Some(TokenTree::Group(group)) => {
                let delimiter = group.delimiter();
                let seen = delimiter != Delimiter::None || has_operator(group.stream());
                let frame = Frame {
                    rest: std::mem::replace(&mut inner, group.stream().into_iter()),
                    open: seen.then_some(tokens.len()),
                    delimiter,
                    close: group.span_close(),
                };
                outer.push(frame);
                if !seen {
                    continue;
                }
                // The index of the closing bracket is filled in when the bracket closes.
                (
                    Kind::Open(delimiter, 0),
                    opening(delimiter).to_owned(),
                    group.span_open(),
                )
            }
            Some(TokenTree::Ident(ident)) => (Kind::Word, ident.to_string(), ident.span()),
            Some(TokenTree::Punct(punct)) => (
                Kind::Punct(punct.as_char()),
                punct.as_char().to_string(),
                punct.span(),
            ),
            Some(TokenTree::Literal(literal)) => {
                let span = literal.span();
                match doc_text(&tokens, &literal) {
                    Some(text) => (Kind::Doc, text, span),
                    None => (Kind::Literal, literal.to_string(), span),
                }
            }
            None => match outer.pop() {
                Some(frame) => {
                    inner = frame.rest;
                    let Some(open) = frame.open else {
                        continue;
                    };
                    let close = tokens.len();
                    if let Some(open) = tokens.get_mut(open) {
                        open.kind = Kind::Open(frame.delimiter, close);
                    }
                    (
                        Kind::Close(frame.delimiter),
                        closing(frame.delimiter).to_owned(),
                        frame.close,
                    )
                }
                None => break,
            },
        };
        let span = place(span);
        tokens.push(Token { kind, text, span });
    }
    let span = tokens.last().map_or(Span::NOWHERE, |token| token.span);
    tokens.push(Token {
        kind: Kind::End,
        text: String::new(),
        span,
    });
    tokens
}

/// A bracket whose contents are being listed.
struct Frame {
    rest: token_stream::IntoIter,
    /// Index of its opening token, if it has one.
    open: Option<usize>,
    delimiter: Delimiter,
    close: TokenSpan,
}

/// Returns whether a stream contains an operator or a choice outside of further brackets.
fn has_operator(stream: TokenStream) -> bool {
    stream.into_iter().any(|tree| match tree {
        TokenTree::Punct(punct) => "+-*/^<>".contains(punct.as_char()),
        TokenTree::Ident(ident) => ident == "if" || ident == "in",
        TokenTree::Group(_) => false,
        // `-1` is a single literal if a macro produced it.
        TokenTree::Literal(literal) => literal.to_string().starts_with('-'),
    })
}

/// Returns the text of a literal in `#[doc = …]`, or `None` for other literals.
fn doc_text(before: &[Token], literal: &Literal) -> Option<String> {
    let [.., open, doc, equal] = before else {
        return None;
    };
    let attribute = matches!(open.kind, Kind::Open(Delimiter::Bracket, _))
        && doc.kind == Kind::Word
        && doc.text == "doc"
        && equal.kind == Kind::Punct('=');
    if !attribute {
        return None;
    }
    let literal = TokenStream::from(TokenTree::Literal(literal.clone()));
    let text = syn::parse2::<syn::LitStr>(literal).ok()?.value();
    Some(text.replace("\r\n", "\n"))
}

/// Refuses brackets that are nested too deeply.
pub(super) fn check_depth(tokens: &[Token]) -> Result<(), Diagnostic> {
    let mut depth = 0_usize;
    for token in tokens {
        match token.kind {
            Kind::Open(..) => depth += 1,
            Kind::Close(_) => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > MAX_NESTING {
            return Err(too_deep(token.span));
        }
    }
    Ok(())
}

/// Returns the error for brackets that are nested too deeply.
pub(super) fn too_deep(span: Span) -> Diagnostic {
    Diagnostic::new(
        span,
        format!("brackets are nested more than {MAX_NESTING} deep"),
    )
    .help("name a part of it with `let`")
}

/// Joins all tokens with single spaces.
pub(super) fn canonical(stream: &TokenStream) -> String {
    let mut spelling = String::new();
    for token in of_stream(stream.clone()).0 {
        let text = if token.kind == Kind::Doc {
            format!("{:?}", token.text)
        } else {
            token.text
        };
        if !text.is_empty() {
            if !spelling.is_empty() {
                spelling.push(' ');
            }
            spelling.push_str(&text);
        }
    }
    spelling
}

/// Returns the spelling of an opening bracket.
fn opening(delimiter: Delimiter) -> &'static str {
    match delimiter {
        Delimiter::Parenthesis => "(",
        Delimiter::Bracket => "[",
        Delimiter::Brace => "{",
        Delimiter::None => "",
    }
}

/// Returns the spelling of a closing bracket.
pub(super) fn closing(delimiter: Delimiter) -> &'static str {
    match delimiter {
        Delimiter::Parenthesis => ")",
        Delimiter::Bracket => "]",
        Delimiter::Brace => "}",
        Delimiter::None => "",
    }
}
