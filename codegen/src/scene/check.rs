//! Checks of a scene when it is built: it must not contain numbers that are not finite, expressions that are too deep,
//! or invalid names.
//!
//! Anything that cannot be written as text is stored in the scene as a name that no valid text contains. So its
//! position in the printed scene is that of the error.

use super::{Scene, SceneError};
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::visit::{Visit, parts, visit};
use crate::syntax::ast::{Counter, Expr, ExprKind, Ident, Item, ItemKind, Span, System, Target};
use crate::syntax::{MAX_DEPTH, parse_text};
use hamel_language::expression::{INFINITE, NO_NUMBER};

/// Placeholder for an expression that is too deep. It is a name that no valid text contains.
const TOO_DEEP: &str = "((deeper))";

fn named(name: &str) -> Expr {
    Expr {
        kind: ExprKind::Name(name.to_string()),
        span: Span::NOWHERE,
    }
}

/// Returns the scene of a system's statements, if its text reads back as the same statements.
pub(super) fn checked(system: &System) -> Result<Scene, SceneError> {
    let text = crate::syntax::print::print_description(system);
    // Docs may contain anything, one line each.
    let docs = text.split_inclusive('\n').take(system.docs.len());
    let mut errors = strange(&text, docs.map(str::len).sum());
    match parse_text(&text) {
        Ok(read) if errors.is_empty() && read == *system => {
            let system = read;
            return Ok(Scene { system, text });
        }
        Ok(read) => {
            let of_a_number = |span: Span| errors.iter().any(|error| inside(error.span, span));
            let same = system.items.len() == read.items.len();
            let both = system.items.iter().zip(&read.items);
            let differing = both.filter(|(ours, read)| ours != read);
            let differing = differing.map(|(_, read)| read.span);
            let differing = differing.filter(|span| !of_a_number(*span));
            let mut places: Vec<Span> = differing.collect();
            if !same {
                // After the first difference, statements are no longer compared with their counterparts.
                places.truncate(1);
            }
            if places.is_empty() && errors.is_empty() {
                places.push(read.name.span);
            }
            errors.extend(places.into_iter().map(|place| {
                Diagnostic::new(place, "this statement has a name of more than one word")
                    .help("names are made of letters, digits and `_`")
            }));
        }
        Err(more) => errors.extend(more),
    }
    Err(SceneError::new(errors, &text))
}

fn inside(inner: Span, outer: Span) -> bool {
    let both = inner.range().zip(outer.range());
    both.is_some_and(|(inner, outer)| outer.start <= inner.start && inner.end <= outer.end)
}

/// Returns an error for each placeholder in a text; the first `docs` bytes, which are documentation, do not count.
fn strange(text: &str, docs: usize) -> Vec<Diagnostic> {
    let all = |of: &'static str| {
        let found = text.match_indices(of).filter(move |(at, _)| *at >= docs);
        found.map(move |(at, _)| at..at + of.len())
    };
    let number = |range| {
        Diagnostic::new(
            Span::new(range),
            "a number that is not finite was given here",
        )
        .help("numbers of a description are finite: check where the program computes this one")
    };
    let deep = |range| {
        let message =
            format!("an expression that is more than {MAX_DEPTH} operations deep was given here");
        Diagnostic::new(Span::new(range), message)
            .help("name parts of it with `define`, and use their names")
    };
    let numbers = all(NO_NUMBER).chain(all(INFINITE)).map(number);
    numbers.chain(all(TOO_DEEP).map(deep)).collect()
}

/// Replaces expressions that are too deep for recursive functions.
pub(super) fn cut(item: &mut Item) {
    visit(item, &mut Cut);
    let counted = |counter: &mut Counter| {
        Cut.expr(&mut counter.first);
        Cut.expr(&mut counter.last);
    };
    match &mut item.kind {
        ItemKind::Repeat(repeat) => counted(&mut repeat.counter),
        ItemKind::Part(part) => {
            part.counter.iter_mut().for_each(counted);
            let values = part.arguments.iter_mut().map(|one| &mut one.value);
            values.for_each(|value| Cut.expr(value));
        }
        ItemKind::Component(component) => {
            let parameters = component.parameters.iter_mut();
            let defaults = parameters.filter_map(|one| one.default.as_mut());
            defaults.for_each(|value| Cut.expr(value));
        }
        _ => {}
    }
}

struct Cut;

impl Visit for Cut {
    fn declares(&mut self, _: &mut Ident, _: bool) {}
    fn uses(&mut self, _: &mut Ident) {}
    fn target(&mut self, _: &mut Target) {}
    fn place(&mut self, _: &mut Span) {}

    fn expr(&mut self, expr: &mut Expr) {
        if !is_deep(expr) {
            return;
        }
        // Taken apart piece by piece, since dropping the whole would be recursive.
        let mut rest = vec![std::mem::replace(expr, named(TOO_DEEP))];
        while let Some(mut piece) = rest.pop() {
            let pieces = parts(&mut piece);
            rest.extend(
                pieces
                    .into_iter()
                    .map(|part| std::mem::replace(part, named(""))),
            );
        }
    }
}

fn is_deep(expr: &Expr) -> bool {
    let mut level = vec![expr];
    for _ in 0..MAX_DEPTH {
        level = level.iter().flat_map(|expr| expr.parts()).collect();
        if level.is_empty() {
            return false;
        }
    }
    true
}
