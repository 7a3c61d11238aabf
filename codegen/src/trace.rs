//! Every statement of the generated code with the quantity that it serves, the equation, and the place in the description.

use crate::emit::trace::{AnnotatedStatement, FunctionStatements, annotated_statements};
use crate::generate::Generated;
use crate::program::provenance::Origin;
use std::collections::HashMap;
use std::rc::Rc;

/// A place in a description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Included file; `None` for the description itself.
    pub file: Option<String>,
    /// Line, counted from 1.
    pub line: usize,
    /// Column in characters, counted from 1.
    pub column: usize,
}

/// The places of statements in the text from which a system was derived.
#[derive(Debug)]
pub struct Places<'a> {
    generated: &'a Generated,
    text: &'a str,
    /// Statements of one quantity share their origin.
    known: HashMap<*const Origin, Option<Place>>,
}

impl<'a> Places<'a> {
    /// Prepares the search in the text from which a system was derived: that of the description, or of the URDF file.
    pub fn of(generated: &'a Generated, text: &'a str) -> Self {
        Places {
            generated,
            text,
            known: HashMap::new(),
        }
    }

    /// Returns the place of the statement of the description that a generated statement belongs to; `None` if the
    /// description has no text.
    pub fn place(&mut self, traced: &AnnotatedStatement) -> Option<Place> {
        let origin = traced.origin.as_ref()?;
        let place = || place(self.generated, self.text, origin);
        let known = self.known.entry(Rc::as_ptr(origin));
        known.or_insert_with(place).clone()
    }
}

impl Generated {
    /// Traces the generated functions, as [`crate::builder::written`] prints them.
    pub fn trace(&self) -> Vec<FunctionStatements> {
        annotated_statements(&self.program)
    }
}

fn place(generated: &Generated, text: &str, origin: &Origin) -> Option<Place> {
    let (span, included) = generated.model.origins.written_at(origin.span);
    if let Some((included, range)) = included {
        let (line, column) = included.line(range.start);
        return Some(Place {
            file: Some(included.name.clone()),
            line,
            column,
        });
    }
    let before = text.get(..span.range()?.start)?;
    if text.is_empty() {
        return None;
    }
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    Some(Place {
        file: None,
        line: before.matches('\n').count() + 1,
        column: before[start..].chars().count() + 1,
    })
}
