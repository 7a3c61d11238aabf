//! Parsing of expressions.
//!
//! ```text
//! sum      = product (("+" | "-") product)*
//! product  = sign (("*" | "/") sign)*
//! sign     = "-"* power
//! power    = postfix ("^" "-"* postfix)*              to the right: a^b^c = a^(b^c), and -a^b = -(a^b)
//! postfix  = primary ("." name | "[" sum ("," sum)* "]")*
//! primary  = number [unit] | name | name "(" list ")" ["in" name] | "(" sum ")" | "[" list "]" | choice
//! choice   = "if" sum ("<" | "<=" | ">" | ">=") sum "{" sum "}" "else" (choice | "{" sum "}")
//! ```
//!
//! Recursion happens only at brackets, whose nesting is bounded before parsing starts. Chains are parsed by loops;
//! their length is bounded because later stages walk the resulting tree recursively.

mod choice;

use proc_macro2::Delimiter;

use super::ast::{BinaryOp, Expr, ExprKind, Ident, Quantity, Span};
use super::cursor::{Cursor, Parsed, check_name, shown};
use super::number;
use super::path;
use super::tokens::Kind;
use super::unit;
use crate::diagnostics::Diagnostic;

/// Largest number of operands in a chain of operators of one precedence.
const MAX_OPERANDS: usize = 500;

/// Largest depth of an expression tree: a longest chain, plus the depth of its operands.
pub const MAX_DEPTH: usize = 600;

/// Depth of a quantity in SI: a number times a power of π.
const QUANTITY: usize = 3;

/// An expression and the depth of its tree.
struct Node {
    expr: Expr,
    depth: usize,
}

/// A list of expressions, and the depth of the deepest one.
#[derive(Default)]
pub(super) struct List {
    pub entries: Vec<Expr>,
    depth: usize,
}

/// Parses an expression, up to the first token that cannot continue it.
pub(super) fn expression(cursor: &mut Cursor<'_>) -> Parsed<Expr> {
    sum(cursor).map(|node| node.expr)
}

fn sum(cursor: &mut Cursor<'_>) -> Parsed<Node> {
    chain(
        cursor,
        [('+', BinaryOp::Add), ('-', BinaryOp::Sub)],
        product,
    )
}

fn product(cursor: &mut Cursor<'_>) -> Parsed<Node> {
    chain(cursor, [('*', BinaryOp::Mul), ('/', BinaryOp::Div)], sign)
}

/// Parses operands joined by left-associative operators of one precedence.
fn chain(
    cursor: &mut Cursor<'_>,
    operators: [(char, BinaryOp); 2],
    operand: fn(&mut Cursor<'_>) -> Parsed<Node>,
) -> Parsed<Node> {
    let mut left = operand(cursor)?;
    let mut operands = 1;
    while let Some(&(sign, op)) = operators.iter().find(|(sign, _)| cursor.is_punct(*sign)) {
        operands += 1;
        check_operands(cursor, operands)?;
        cursor.bump();
        if sign == '*' && cursor.is_punct('*') {
            let span = cursor.before().to(cursor.here());
            return Err(Diagnostic::new(span, "`**` is not an operator")
                .help("a power is written with `^`"));
        }
        let right = operand(cursor)?;
        left = binary(op, left, right)?;
    }
    Ok(left)
}

fn sign(cursor: &mut Cursor<'_>) -> Parsed<Node> {
    let signs = signs(cursor)?;
    let value = power(cursor)?;
    negate(signs, value)
}

/// Parses the minus signs before an operand.
fn signs(cursor: &mut Cursor<'_>) -> Parsed<Vec<Span>> {
    let mut signs = Vec::new();
    while cursor.is_punct('-') {
        signs.push(cursor.here());
        check_operands(cursor, signs.len())?;
        cursor.bump();
    }
    Ok(signs)
}

fn negate(signs: Vec<Span>, value: Node) -> Parsed<Node> {
    signs.into_iter().rev().try_fold(value, |value, sign| {
        let span = sign.to(value.expr.span);
        node(ExprKind::Neg(Box::new(value.expr)), span, value.depth)
    })
}

fn power(cursor: &mut Cursor<'_>) -> Parsed<Node> {
    let mut right = postfix(cursor)?;
    let mut bases = Vec::new();
    while cursor.is_punct('^') {
        check_operands(cursor, bases.len() + 2)?;
        cursor.bump();
        let signs = signs(cursor)?;
        bases.push((right, signs));
        right = postfix(cursor)?;
    }
    while let Some((base, signs)) = bases.pop() {
        right = binary(BinaryOp::Pow, base, negate(signs, right)?)?;
    }
    Ok(right)
}

fn postfix(cursor: &mut Cursor<'_>) -> Parsed<Node> {
    let mut value = primary(cursor)?;
    loop {
        let span = value.expr.span;
        // In a range such as `1..n`, the first dot ends the expression.
        let range = cursor.is_punct('.') && cursor.is_followed_by(&['.'], &[]);
        let (part, depth) = if !range && cursor.eat_punct('.') {
            let field = field(cursor)?;
            if let ExprKind::Number(_) = value.expr.kind {
                return Err(no_part(span.to(field.span)));
            }
            (ExprKind::Field(Box::new(value.expr), field), value.depth)
        } else if cursor.is_open(Delimiter::Bracket) {
            if let ExprKind::Number(_) = value.expr.kind {
                return Err(no_part(cursor.here()));
            }
            let indices = indices(cursor)?;
            let indexed = ExprKind::Index(Box::new(value.expr), indices.entries);
            let end = cursor.before();
            let expr = Expr {
                kind: indexed,
                span: span.to(end),
            };
            let named = cursor.next_ending();
            let named = named.and_then(|ending| path::with_ending(&expr, ending, cursor.here()));
            if let Some(expr) = named {
                cursor.bump();
                value.expr = expr;
                continue;
            }
            (expr.kind, value.depth.max(indices.depth))
        } else {
            return Ok(value);
        };
        value = node(part, span.to(cursor.before()), depth)?;
    }
}

fn no_part(span: Span) -> Diagnostic {
    Diagnostic::new(span, "a number has no parts").help("a product is written with `*`")
}

fn field(cursor: &mut Cursor<'_>) -> Parsed<Ident> {
    if cursor.peek().kind == Kind::Literal {
        let index = shown(&cursor.peek().text);
        return Err(Diagnostic::new(
            cursor.here(),
            format!("expected the name of a part, found `{index}`"),
        )
        .help("components are numbered from 1, in brackets: `v[1]`"));
    }
    cursor.word("the name of a part")
}

/// Parses one or two indices, with their brackets.
pub(super) fn indices(cursor: &mut Cursor<'_>) -> Parsed<List> {
    let open = cursor.here();
    cursor.bump();
    let indices = list(cursor, Delimiter::Bracket)?;
    if !matches!(indices.entries.len(), 1 | 2) {
        return Err(
            Diagnostic::new(open.to(cursor.before()), "expected one index or two")
                .help("components are written `v[i]` and `M[i, j]`, numbered from 1"),
        );
    }
    Ok(indices)
}

/// Parses expressions up to and including the closing bracket.
fn list(cursor: &mut Cursor<'_>, delimiter: Delimiter) -> Parsed<List> {
    let mut list = List::default();
    while !cursor.is_end() {
        let entry = sum(cursor)?;
        list.depth = list.depth.max(entry.depth);
        list.entries.push(entry.expr);
        if !cursor.eat_punct(',') {
            break;
        }
    }
    cursor.expect_close(delimiter, true)?;
    Ok(list)
}

fn primary(cursor: &mut Cursor<'_>) -> Parsed<Node> {
    let token = cursor.peek();
    let span = cursor.here();
    match token.kind {
        Kind::Literal => {
            let number = number::value(&token.text, &shown(&token.text))
                .map_err(|refusal| Diagnostic::new(span, refusal.message).help(refusal.help))?;
            cursor.bump();
            let number = node(ExprKind::Number(number.into()), span, 0)?;
            if !unit::is_next(cursor) {
                return Ok(number);
            }
            let quantity = Quantity::of(number.expr, unit::unit(cursor)?);
            let kind = ExprKind::Quantity(Box::new(quantity));
            node(kind, span.to(cursor.before()), QUANTITY)
        }
        Kind::Word if token.text == "if" => choice::choice(cursor),
        Kind::Word if cursor.is_call() && !cursor.is_connective() => {
            let function = cursor.name("a function")?;
            cursor.bump();
            let arguments = list(cursor, Delimiter::Parenthesis)?;
            let call = node(
                ExprKind::Call(function, arguments.entries),
                span.to(cursor.before()),
                arguments.depth,
            )?;
            in_axes(cursor, call)
        }
        Kind::Word if !cursor.is_connective() && !cursor.starts_statement() => {
            check_name(token, span)?;
            cursor.bump();
            node(ExprKind::Name(token.text.clone()), span, 0)
        }
        Kind::Open(Delimiter::Bracket, _) => {
            cursor.bump();
            let entries = list(cursor, Delimiter::Bracket)?;
            let span = span.to(cursor.before());
            if entries.entries.is_empty() {
                return Err(Diagnostic::new(span, "this array has no entries")
                    .help("a vector is written `[a, b, c]`, a matrix by rows `[[a, b], [c, d]]`"));
            }
            node(ExprKind::Array(entries.entries), span, entries.depth)
        }
        Kind::Open(delimiter @ (Delimiter::Parenthesis | Delimiter::None), _) => {
            cursor.bump();
            let mut inner = sum(cursor)?;
            if cursor.is_punct(',') {
                return Err(cursor
                    .unexpected("`)`")
                    .help("a vector is written `[a, b, c]`"));
            }
            cursor.expect_close(delimiter, false)?;
            inner.expr.span = span.to(cursor.before());
            Ok(inner)
        }
        _ => {
            let error = cursor.unexpected("an expression");
            Err(match token.kind {
                Kind::Punct('+') => error.help("write a term on both sides of `+`"),
                Kind::Punct('.') => error.help("numbers have a digit before their point: `0.5`"),
                Kind::Open(Delimiter::Brace, _) => {
                    error.help("parts of an expression are grouped with `(` and `)`")
                }
                _ => error,
            })
        }
    }
}

/// Parses an optional `in` after a call, as in `velocity(f) in g`, with the frame whose axes the components are in.
fn in_axes(cursor: &mut Cursor<'_>, call: Node) -> Parsed<Node> {
    if !cursor.eat_word("in") {
        return Ok(call);
    }
    let Ident { name, span } = path::path(cursor, "a frame")?;
    let whole = call.expr.span.to(span);
    let frame = Expr {
        kind: ExprKind::Name(name),
        span,
    };
    let kind = ExprKind::InAxes(Box::new(call.expr), Box::new(frame));
    node(kind, whole, call.depth)
}

fn binary(op: BinaryOp, left: Node, right: Node) -> Parsed<Node> {
    let span = left.expr.span.to(right.expr.span);
    let depth = left.depth.max(right.depth);
    node(
        ExprKind::Binary(op, Box::new(left.expr), Box::new(right.expr)),
        span,
        depth,
    )
}

/// Creates a node whose operands have depth `parts`, unless the tree becomes too deep.
fn node(kind: ExprKind, span: Span, parts: usize) -> Parsed<Node> {
    let depth = parts + 1;
    if depth > MAX_DEPTH {
        return Err(Diagnostic::new(
            span,
            format!("the expression is more than {MAX_DEPTH} operations deep"),
        )
        .help("name a part of it with `let`"));
    }
    Ok(Node {
        expr: Expr { kind, span },
        depth,
    })
}

fn check_operands(cursor: &Cursor<'_>, operands: usize) -> Parsed<()> {
    if operands > MAX_OPERANDS {
        return Err(Diagnostic::new(
            cursor.here(),
            format!("more than {MAX_OPERANDS} operands in a row"),
        )
        .help("name a part of it with `let`"));
    }
    Ok(())
}
