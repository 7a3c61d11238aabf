//! The language: from text or tokens to a placed description.
//!
//! A macro hands over the compiler's tokens, a `.eom` file is cut into tokens of the same kind; from there on one
//! parser serves both. Nothing is resolved here: names, shapes and units are the business of the model. What this stage
//! guarantees is that every node carries its span, that no input overflows the stack, and that a description with
//! several faulty statements gets an error for each.
//!
//! | file | owns |
//! |---|---|
//! | `ast` | the description as written |
//! | `scan` | the raw text of a file: brackets, and characters that no token has |
//! | `tokens` | the flat list of tokens, and its canonical spelling |
//! | `cursor` | the place in that list, and how an unexpected token is reported |
//! | `blocks` | what stands between braces, doc comments |
//! | `parse` | the system, statement after statement, and recovery |
//! | `statement`, `declaration`, `table`, `body`, `joint`, `load` | the statements |
//! | `expression`, `number` | values |
//! | `words` | the words of the language |
//! | `suggest` | the word that was probably meant |

use proc_macro2::TokenStream;

use crate::diagnostics::Diagnostic;

pub mod ast;
mod blocks;
mod body;
mod cursor;
mod declaration;
mod element;
mod expression;
mod invariant;
mod joint;
mod load;
mod number;
mod parse;
#[cfg(feature = "files")]
mod scan;
mod statement;
pub mod suggest;
mod table;
mod tokens;
mod words;
pub mod written;

#[cfg(all(test, feature = "files"))]
mod tests;

pub use tokens::Places;

pub(crate) use joint::{field_name as joint_field, kind_name as joint_kind};

/// Parses a description given as tokens; places in it are places of these tokens.
pub fn parse_tokens(tokens: TokenStream) -> (Places, Result<ast::System, Vec<Diagnostic>>) {
    let (tokens, places) = tokens::of_stream(tokens);
    (places, parse(&tokens))
}

fn parse(tokens: &[tokens::Token]) -> Result<ast::System, Vec<Diagnostic>> {
    tokens::check_depth(tokens).map_err(|error| vec![error])?;
    parse::system(tokens)
}

/// Parses a description given as text, such as a `.eom` file; places in it are bytes of the text.
#[cfg(feature = "files")]
pub fn parse_text(text: &str) -> Result<ast::System, Vec<Diagnostic>> {
    let scanned = scan::scan(text);
    let mut errors = scanned.errors;
    if let Some(readable) = scanned.readable {
        let parsed = match readable.parse::<TokenStream>() {
            Ok(tokens) => parse(&tokens::of_text(tokens)),
            Err(error) => Err(vec![scan::unreadable(&error)]),
        };
        match parsed {
            Ok(system) if errors.is_empty() => return Ok(system),
            Ok(_) => {}
            Err(more) => errors.extend(more),
        }
    }
    errors.truncate(cursor::MAX_ERRORS);
    Err(errors)
}

/// Reads the tables that stand in files, in the place of their names: `open` gives the text of a file by its name in
/// the description. The texts are returned in the order of the tables.
pub fn read_tables(
    system: &mut ast::System,
    open: &mut dyn FnMut(&str) -> std::io::Result<String>,
) -> Result<Vec<String>, Vec<Diagnostic>> {
    let (mut texts, mut errors) = (Vec::new(), Vec::new());
    for item in &mut system.items {
        let ast::ItemKind::Table(found) = &mut item.kind else {
            continue;
        };
        let ast::Source::File(name, span) = &found.source else {
            continue;
        };
        let (name, span) = (name.clone(), *span);
        let read = open(&name).map_err(|error| {
            Diagnostic::new(span, format!("cannot read `{name}`: {error}"))
                .help("the path of a table starts at the folder of its description")
        });
        let points = read.and_then(|text| {
            let points = table::read(&text, &name, span)?;
            texts.push(text);
            Ok(points)
        });
        match points {
            Ok(points) => found.source = ast::Source::Points(points, span),
            Err(error) => errors.push(error),
        }
    }
    match errors.is_empty() {
        true => Ok(texts),
        false => Err(errors),
    }
}

/// One spelling for all sources of the same tokens, to be hashed: the tokens joined by single spaces.
///
/// Layout and plain comments do not count; doc comments do, however their text was quoted.
pub fn canonical(tokens: &TokenStream) -> String {
    tokens::canonical(tokens)
}
