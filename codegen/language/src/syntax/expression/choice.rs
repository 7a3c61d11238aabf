//! Parsing of choices: `if a < b { c } else if d < e { f } else { g }`.
//!
//! Like chains of operators, a chain of `else if` is parsed by a loop rather than by recursion.

use super::{Node, check_operands, node, sum};
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Choice, Comparison, Expr, ExprKind, Span};
use crate::syntax::cursor::{Cursor, Parsed};
use crate::syntax::tokens::MAX_NESTING;
use proc_macro2::Delimiter;

/// Syntax of a choice, for messages.
const FORM: &str = "a choice is written `if a < b { c } else { d }`";

/// One `if` of a chain: its condition and the branch taken if it holds.
struct Case {
    span: Span,
    left: Expr,
    comparison: Comparison,
    right: Expr,
    then: Expr,
    depth: usize,
}

/// Parses a choice, with the cursor at its `if`.
pub(super) fn choice(cursor: &mut Cursor<'_>) -> Parsed<Node> {
    if cursor.choices >= MAX_NESTING {
        let message = format!("choices are nested more than {MAX_NESTING} deep");
        let error = Diagnostic::new(cursor.here(), message);
        return Err(error.help("name a part of it with `let`"));
    }
    cursor.choices += 1;
    let choice = cases(cursor);
    cursor.choices -= 1;
    choice
}

fn cases(cursor: &mut Cursor<'_>) -> Parsed<Node> {
    let mut cases = Vec::new();
    let last = loop {
        check_operands(cursor, cases.len() + 2)?;
        cases.push(case(cursor)?);
        if !cursor.eat_word("else") {
            let case = cases.last().map_or(cursor.here(), |case| case.span);
            return Err(
                Diagnostic::new(case.to(cursor.before()), "this `if` has no `else`")
                    .help("an expression needs a value everywhere: `if a < b { c } else { d }`"),
            );
        }
        if !cursor.is_word("if") {
            break branch(cursor)?;
        }
    };
    cases.into_iter().rev().try_fold(last, |otherwise, case| {
        let span = case.span.to(otherwise.expr.span);
        let depth = case.depth.max(otherwise.depth);
        let choice = Choice {
            left: case.left,
            comparison: case.comparison,
            right: case.right,
            then: case.then,
            otherwise: otherwise.expr,
        };
        node(ExprKind::If(Box::new(choice)), span, depth)
    })
}

/// `if a < b { c }`
fn case(cursor: &mut Cursor<'_>) -> Parsed<Case> {
    let span = cursor.here();
    cursor.bump();
    let left = sum(cursor)?;
    let comparison = comparison(cursor)?;
    let right = sum(cursor)?;
    let then = branch(cursor)?;
    Ok(Case {
        span,
        left: left.expr,
        comparison,
        right: right.expr,
        then: then.expr,
        depth: left.depth.max(right.depth).max(then.depth),
    })
}

fn comparison(cursor: &mut Cursor<'_>) -> Parsed<Comparison> {
    let span = cursor.here();
    let (strict, wide) = if cursor.eat_punct('<') {
        (Comparison::Less, Comparison::AtMost)
    } else if cursor.eat_punct('>') {
        (Comparison::Greater, Comparison::AtLeast)
    } else if cursor.is_punct('=') || cursor.is_punct('!') {
        return Err(
            Diagnostic::new(span, "numbers cannot be compared for equality").help(
                "rounding would decide the result: compare with `<`, `<=`, `>` or `>=`, such as `abs(a - b) < 1e-6`",
            ),
        );
    } else {
        return Err(cursor.unexpected("`<`, `<=`, `>` or `>=`").help(FORM));
    };
    Ok(match cursor.eat_punct('=') {
        true => wide,
        false => strict,
    })
}

/// `{ c }`
fn branch(cursor: &mut Cursor<'_>) -> Parsed<Node> {
    if cursor.is_punct('<') || cursor.is_punct('>') {
        return Err(
            Diagnostic::new(cursor.here(), "more than one comparison").help(
                "write one choice within another: `if a < b { if b < c { d } else { e } } else { e }`",
            ),
        );
    }
    if !cursor.eat_open(Delimiter::Brace) {
        return Err(cursor.unexpected("`{`").help(FORM));
    }
    let value = sum(cursor)?;
    if cursor.is_punct(';') {
        return Err(
            Diagnostic::new(cursor.here(), "a branch is an expression, without `;`").help(FORM),
        );
    }
    cursor.expect_close(Delimiter::Brace, false)?;
    Ok(value)
}
