//! The parser: from text or tokens to a syntax tree with source positions.
//!
//! A macro passes the compiler's tokens; the text of a `.eom` file is split into tokens of the same kind. One parser
//! then serves both. This stage resolves nothing: names, shapes and units are checked later. It guarantees that every
//! node carries its span, that no input overflows the stack, and that a description with several faulty statements gets
//! an error for each.
//!
//! | file | owns |
//! |---|---|
//! | `ast` | the syntax tree |
//! | `scan` | the raw text of a file: brackets, and characters that no token can contain |
//! | `tokens` | the flat list of tokens, and its canonical spelling |
//! | `cursor` | the position in that list, and errors for unexpected tokens |
//! | `blocks` | the contents of braces, doc comments |
//! | `parse` | the system, statement after statement, and error recovery |
//! | `statement`, `declaration`, `table`, `body`, `joint`, `load` | the statements |
//! | `reuse`, `path` | components, parts and loops, and names with indices and parts |
//! | `files` | included texts, and tables in files |
//! | `expression`, `number`, `unit` | values |
//! | `written`, `print` | the text of expressions and of descriptions |
//! | `words` | the words of the language |
//! | `suggest` | "did you mean" suggestions |

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
pub mod print;
mod reuse;
mod scan;
mod statement;
pub mod suggest;
mod table;
mod tokens;
mod unit;
mod words;
pub mod written;

pub use files::read_files;
pub use tokens::Places;

pub use joint::{field_name as joint_field, kind_name as joint_kind};

pub(crate) use body::fields_of as body_fields;
pub use expression::MAX_DEPTH;
pub(crate) use joint::{endings as joint_endings, fields_of as joint_fields, kinds as joint_kinds};
pub(crate) use words::forms as statement_forms;

/// Parses a description given as tokens. Spans in the result are token numbers, which the returned [`Places`] resolve.
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

/// Parses a description given as text, such as a `.eom` file. Spans in the result are byte ranges of the text.
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

/// Returns the exact value of a decimal literal, or `None` if the text is none.
pub(crate) fn number_value(text: &str) -> Option<num_rational::BigRational> {
    number::value(text, text).ok()
}

/// Returns one spelling for all sources with the same tokens, for hashing: the tokens joined by single spaces.
///
/// Layout and plain comments do not count; doc comments do, in whichever form they were written.
pub fn canonical(tokens: &TokenStream) -> String {
    tokens::canonical(tokens)
}
