//! Adds outputs to a description, so that the expressions that a sweep keeps or that a run watches for events are
//! derived with everything else.

use super::Source;
use crate::error::Error;
use crate::option_text::{Piece, invalid_option};
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::generate::Generated;
use hamel_codegen::syntax::ast::{ItemKind, Span};
use hamel_codegen::syntax::parse_text;
use std::ops::Range;

/// Prefix of the names of added outputs.
const PREFIX: &str = "hamel_keep_";

/// Output that is added to a description, such as an option's expression, under a generated name; its value may be the
/// difference of two expressions.
pub struct AddedOutput<'a> {
    /// Name.
    pub name: String,
    /// The part of the option's text that requests the output.
    pub whole: Piece<'a>,
    /// The expression, or the two expressions whose difference is the output.
    pub sides: Vec<Piece<'a>>,
}

impl AddedOutput<'_> {
    /// Returns whether an error lies in the text of this output.
    fn has(&self, error: &Diagnostic) -> bool {
        let whole = self.whole.start..self.whole.start + self.whole.text.len();
        let range = error.span.range();
        range.is_some_and(|range| whole.start <= range.start && range.end <= whole.end)
    }
}

/// Returns the name of the output that is added for an item, by the item's index.
pub fn name(item: usize) -> String {
    format!("{PREFIX}{}", item + 1)
}

/// Returns whether an output was added, by its name.
pub fn is_added(name: &str) -> bool {
    name.starts_with(PREFIX)
}

/// Derives a description with more outputs. Errors in an expression are shown in the text of the option, together with
/// `wrong`, the errors already found there. `try_derive` derives a text without showing its errors.
pub fn derive(
    source: &Source,
    (option, said): (&str, &str),
    added: &[AddedOutput],
    mut wrong: Vec<Diagnostic>,
    try_derive: impl Fn(&Source) -> Result<Generated, Vec<Diagnostic>>,
) -> Result<Generated, Error> {
    // Report errors and warnings of the description itself first.
    source.model()?;
    let of = |added: &[&AddedOutput]| {
        let extended = Extended::of(source, added);
        let errors = match try_derive(&source.with_text(extended.text.clone())) {
            Ok(generated) => return Ok(generated),
            Err(errors) => errors,
        };
        let own: Vec<Diagnostic> = errors
            .iter()
            .filter_map(|e| extended.relocate_error(e))
            .collect();
        Err((own, errors))
    };
    let mut left: Vec<&AddedOutput> = added.iter().collect();
    let (own, errors) = match of(&left) {
        Ok(generated) if wrong.is_empty() => return Ok(generated),
        Ok(_) => Default::default(),
        Err(errors) => errors,
    };
    if !own.is_empty() {
        // Names are not resolved while another expression cannot be parsed.
        left.retain(|added| !own.iter().any(|error| added.has(error)));
        if !left.is_empty()
            && let Err((more, _)) = of(&left)
        {
            wrong.extend(more);
        }
        wrong.extend(own);
    }
    if wrong.is_empty() {
        source.derive_default_functions()?;
        return Err(source.description_error(&errors));
    }
    wrong.sort_by_key(|error| error.span.range().map(|range| range.start));
    Err(invalid_option(option, said, &wrong))
}

/// Description with more outputs at its end.
struct Extended {
    text: String,
    /// Offset at which the added outputs begin.
    end: usize,
    /// Ranges of the expressions, and of the statements around them, each with its range in the option.
    places: Vec<(Range<usize>, Range<usize>)>,
}

impl Extended {
    fn of(source: &Source, added: &[&AddedOutput]) -> Self {
        let mut more = String::from("\n");
        let mut places: Vec<(Range<usize>, Range<usize>)> = Vec::new();
        let mut statements = Vec::new();
        let outputs = Outputs::of(&source.text);
        for AddedOutput { name, whole, sides } in added {
            let begin = more.len();
            more.push_str(&format!("output {name} = "));
            for (number, side) in sides.iter().enumerate() {
                more.push_str(if number == 0 { "" } else { " - " });
                more.push_str(if sides.len() > 1 { "(" } else { "" });
                let substituted = outputs.substitute(side.text);
                let text = substituted.as_deref().unwrap_or(side.text);
                if substituted.is_none() {
                    let place = more.len()..more.len() + text.len();
                    places.push((place, side.start..side.start + text.len()));
                }
                more.push_str(text);
                more.push_str(if sides.len() > 1 { ")" } else { "" });
            }
            more.push_str(";\n");
            let whole = whole.start..whole.start + whole.text.len();
            statements.push((begin..more.len(), whole));
        }
        places.extend(statements);
        // A text that was parsed before has an end.
        let (end, text) = with(&source.text, &more).unwrap_or_else(|| (0, source.text.clone()));
        Extended { text, end, places }
    }

    /// Moves an error in the extended description to its place in the option; `None` if it is elsewhere.
    fn relocate_error(&self, error: &Diagnostic) -> Option<Diagnostic> {
        let notes = error.notes.iter();
        let notes = notes.filter_map(|(span, label)| Some((self.relocate(*span)?, label.clone())));
        Some(Diagnostic {
            span: self.relocate(error.span)?,
            notes: notes.collect(),
            ..error.clone()
        })
    }

    fn relocate(&self, span: Span) -> Option<Span> {
        let range = span.range()?;
        let first = range.start.checked_sub(self.end)?;
        let last = range.end.checked_sub(self.end)?;
        let inside =
            |(place, _): &&(Range<usize>, Range<usize>)| place.start <= first && last <= place.end;
        let (place, of) = self.places.iter().find(inside)?;
        Some(match of.len() == place.len() {
            true => Span::new(first - place.start + of.start..last - place.start + of.start),
            false => Span::new(of.clone()),
        })
    }
}

/// The outputs of a description with their expressions, which replace their names in other expressions.
struct Outputs(Vec<(String, String)>);

impl Outputs {
    fn of(text: &str) -> Self {
        let system = parse_text(text).ok();
        let items = system.into_iter().flat_map(|system| system.items);
        let outputs = items.filter_map(|item| {
            let ItemKind::Output { name, value, .. } = item.kind else {
                return None;
            };
            let expression = format!("({})", text.get(value.span.range()?)?);
            let alone = parse_text(&format!("system S {{ output a = {expression}; }}"));
            alone.is_ok().then_some((name.name, expression))
        });
        Outputs(outputs.collect())
    }

    /// Replaces the names of outputs in an expression; `None` if it contains none.
    fn substitute(&self, expression: &str) -> Option<String> {
        let is_of_word = |letter: char| letter.is_alphanumeric() || letter == '_';
        let (mut text, mut rest, mut changed) = (String::new(), expression, false);
        while !rest.is_empty() {
            let begin = rest.find(is_of_word).unwrap_or(rest.len());
            let (before, word) = rest.split_at(begin);
            let (word, behind) = word.split_at(word.find(|c| !is_of_word(c)).unwrap_or(word.len()));
            text.push_str(before);
            rest = behind;
            // Parts of a path and functions are not outputs.
            let inside = before.ends_with('.') || rest.starts_with(['.', '(']);
            match self.0.iter().find(|(name, _)| name == word && !inside) {
                Some((_, output)) => {
                    text.push_str(output);
                    changed = true;
                }
                None => text.push_str(word),
            }
        }
        changed.then_some(text)
    }
}

/// Returns the description with more statements at its end, and their offset.
fn with(text: &str, more: &str) -> Option<(usize, String)> {
    let statements = |text: &str| parse_text(text).ok().map(|system| system.items.len());
    let known = statements(text)?;
    let ends = text.match_indices('}').map(|(place, _)| place).rev();
    // A bracket in a comment after the description ends nothing.
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
    use super::{Outputs, with};

    #[test]
    fn outputs_are_written_out() {
        let outputs =
            Outputs::of("system S { output a = (q + 1) * 2; output b_1 = [q, 1]; output c = q; }");
        assert_eq!(outputs.substitute("c").as_deref(), Some("(q)"));
        let of = |text| outputs.substitute(text);
        assert_eq!(
            of("2 * a - b_1[2]").as_deref(),
            Some("2 * ((q + 1) * 2) - ([q, 1])[2]")
        );
        for kept in ["ab + a_1", "a(1)", "s.a + a.b", "1 + 2", ""] {
            assert_eq!(of(kept), None, "{kept}");
        }
    }

    #[test]
    fn statements_are_added_before_the_bracket_that_ends_the_description() {
        let text = "system S { coord q; // }\n param m = 1; } // }\n/* } */";
        let (end, extended) = with(text, "\noutput a = q;\n").expect("a description");
        assert_eq!(end, text.find("} // }").expect("its end"));
        assert_eq!(
            extended,
            "system S { coord q; // }\n param m = 1; \noutput a = q;\n} // }\n/* } */"
        );
        assert_eq!(with("system S {", "output a = 1;"), None);
    }
}
