//! A description with outputs that it does not have itself: what is kept of members is derived with everything else.

use super::keep::{Item, Kept, OPTION};
use super::text::refused;
use crate::failure::Failure;
use crate::source::Source;
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::generate::Generated;
use hamel_codegen::syntax::ast::Span;
use hamel_codegen::syntax::parse_text;
use std::ops::Range;

/// The output of an item by its place.
pub fn name(item: usize) -> String {
    format!("hamel_keep_{}", item + 1)
}

/// Derives a description with an output for each item that is kept; what is wrong with an expression is shown in the
/// text of the option.
pub fn derive(source: &Source, option: &str, kept: &[Kept]) -> Result<Generated, Failure> {
    // What is wrong with the description itself, and its warnings.
    source.model()?;
    let mut more = String::from("\n");
    // Where expressions stand, and statements around them, with the places in the option that they are of.
    let mut places: Vec<(Range<usize>, Range<usize>)> = Vec::new();
    let mut statements = Vec::new();
    for (index, (piece, item)) in kept.iter().enumerate() {
        let Item::Of(_, sides) = item else {
            continue;
        };
        let begin = more.len();
        more.push_str(&format!("output {} = ", name(index)));
        for (number, side) in sides.iter().enumerate() {
            more.push_str(if number == 0 { "" } else { " - " });
            more.push_str(if sides.len() > 1 { "(" } else { "" });
            let length = side.text.len();
            places.push((
                more.len()..more.len() + length,
                side.start..side.start + length,
            ));
            more.push_str(side.text);
            more.push_str(if sides.len() > 1 { ")" } else { "" });
        }
        more.push_str(";\n");
        let whole = piece.start..piece.start + piece.text.len();
        statements.push((begin..more.len(), whole));
    }
    places.extend(statements);
    let Some((end, text)) = with(&source.text, &more) else {
        return source.derive_all();
    };
    let errors = match source.saying(text).try_derive_all() {
        Ok(generated) => return Ok(generated),
        Err(errors) => errors,
    };
    let moved = |span: Span| {
        let range = span.range()?;
        let (first, last) = (range.start.checked_sub(end)?, range.end - end);
        let inside =
            |(place, _): &&(Range<usize>, Range<usize>)| place.start <= first && last <= place.end;
        let (place, of) = places.iter().find(inside)?;
        Some(match of.len() == place.len() {
            true => Span::new(first - place.start + of.start..last - place.start + of.start),
            false => Span::new(of.clone()),
        })
    };
    let own: Vec<Diagnostic> = errors
        .iter()
        .filter_map(|error| own(error, &moved))
        .collect();
    if !own.is_empty() {
        return Err(refused(OPTION, option, &own));
    }
    source.derive_all()?;
    Err(source.refused(&errors))
}

/// An error that is about the option.
fn own(error: &Diagnostic, moved: &dyn Fn(Span) -> Option<Span>) -> Option<Diagnostic> {
    let span = moved(error.span)?;
    let notes = error.notes.iter();
    let notes = notes.filter_map(|(span, label)| Some((moved(*span)?, label.clone())));
    Some(Diagnostic {
        span,
        notes: notes.collect(),
        ..error.clone()
    })
}

/// The description with more statements at its end, and where they stand.
fn with(text: &str, more: &str) -> Option<(usize, String)> {
    let statements = |text: &str| parse_text(text).ok().map(|system| system.items.len());
    let known = statements(text)?;
    let ends = text.match_indices('}').map(|(place, _)| place).rev();
    // A bracket in a comment behind the description ends nothing.
    let marker = "\nlet hamel_end = 0;\n";
    for end in ends {
        let marked = format!("{}{marker}{}", &text[..end], &text[end..]);
        if statements(&marked).is_some_and(|found| found > known) {
            return Some((end, format!("{}{more}{}", &text[..end], &text[end..])));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::with;

    #[test]
    fn statements_are_added_before_the_bracket_that_ends_the_description() {
        let text = "system S { coord q; // }\n param m = 1; } // }\n/* } */";
        let (end, longer) = with(text, "\noutput a = q;\n").expect("a description");
        assert_eq!(end, text.find("} // }").expect("its end"));
        assert_eq!(
            longer,
            "system S { coord q; // }\n param m = 1; \noutput a = q;\n} // }\n/* } */"
        );
        assert_eq!(with("system S {", "output a = 1;"), None);
    }
}
