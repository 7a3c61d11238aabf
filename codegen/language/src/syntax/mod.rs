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
//! | `reuse`, `path` | statements that stand for others, and the names that these have |
//! | `files` | included texts, and tables in files |
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
mod files;
mod invariant;
mod joint;
mod load;
mod number;
mod parse;
pub mod path;
mod reuse;
mod scan;
mod statement;
pub mod suggest;
mod table;
mod tokens;
mod words;
pub mod written;

pub use files::read_files;
pub use tokens::Places;

pub use joint::{field_name as joint_field, kind_name as joint_kind};

pub(crate) use body::fields_of as body_fields;
pub use expression::MAX_DEPTH;
pub(crate) use joint::{endings as joint_endings, fields_of as joint_fields, kinds as joint_kinds};
pub(crate) use words::forms as statement_forms;

/// Parses a description given as tokens; places in it are places of these tokens.
pub fn parse_tokens(tokens: TokenStream) -> (Places, Result<ast::System, Vec<Diagnostic>>) {
    let (tokens, places) = tokens::of_stream(tokens);
    let mut parsed = parse(&tokens);
    if let Ok(system) = &mut parsed {
        system.origins = ast::Origins::behind(tokens.len());
    }
    (places, parsed)
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
            Ok(mut system) if errors.is_empty() => {
                system.origins = ast::Origins::behind(text.len());
                return Ok(system);
            }
            Ok(_) => {}
            Err(more) => errors.extend(more),
        }
    }
    errors.truncate(cursor::MAX_ERRORS);
    Err(errors)
}

/// One spelling for all sources of the same tokens, to be hashed: the tokens joined by single spaces.
///
/// Layout and plain comments do not count; doc comments do, however their text was quoted.
pub fn canonical(tokens: &TokenStream) -> String {
    tokens::canonical(tokens)
}
