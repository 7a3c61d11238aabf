//! Printing of expressions: one spelling for all sources with the same tokens.

use super::ast::{BinaryOp, Condition, Expr, ExprKind, Target};
use num_rational::BigRational;
use num_traits::Signed;

/// Largest number of decimal places of a number printed as a decimal. Literals have no more.
const MOST_PLACES: usize = 400;

/// A number with more zeros than this after its decimal point is printed with an exponent.
const LEADING_ZEROS: usize = 4;

/// Prints an expression in the syntax of the language, with no more parentheses than necessary.
pub fn written(expr: &Expr) -> String {
    match &expr.kind {
        ExprKind::Number(number) => match &number.spelling {
            Some(spelling) => spelling.to_string(),
            None => decimal(&number.value),
        },
        ExprKind::Quantity(quantity) => {
            let number = written(&quantity.number);
            format!("{number} [{}]", quantity.unit.text)
        }
        ExprKind::Name(name) => name.clone(),
        ExprKind::Field(base, field) => format!("{}.{}", tight(base, 5), field.name),
        ExprKind::Index(base, indices) => format!("{}[{}]", tight(base, 5), list(indices)),
        ExprKind::Call(function, arguments) => format!("{}({})", function.name, list(arguments)),
        ExprKind::InAxes(call, frame) => format!("{} in {}", written(call), written(frame)),
        ExprKind::Neg(inner) => format!("-{}", tight(inner, 3)),
        ExprKind::If(choice) => {
            let (sign, then) = (choice.comparison.sign(), written(&choice.then));
            let (left, right) = (tight(&choice.left, 1), tight(&choice.right, 1));
            let otherwise = written(&choice.otherwise);
            let otherwise = match choice.otherwise.kind {
                ExprKind::If(_) => otherwise,
                _ => format!("{{ {otherwise} }}"),
            };
            format!("if {left} {sign} {right} {{ {then} }} else {otherwise}")
        }
        ExprKind::Array(items) => format!("[{}]", list(items)),
        ExprKind::Binary(op, left, right) => {
            let (sign, own) = match op {
                BinaryOp::Add => (" + ", 1),
                BinaryOp::Sub => (" - ", 1),
                BinaryOp::Mul => (" * ", 2),
                BinaryOp::Div => (" / ", 2),
                BinaryOp::Pow => ("^", 4),
            };
            // Operators of equal precedence group from the left, except powers, which get parentheses.
            let power = *op == BinaryOp::Pow;
            let first = tight(left, own + u8::from(power));
            format!("{first}{sign}{}", tight(right, own + 1))
        }
    }
}

/// Prints the left side of a statement such as `rate` or `start`: `X.p`, `w[3]`.
pub fn target(target: &Target) -> String {
    let mut text = target.name.name.clone();
    if let Some(field) = &target.field {
        text.push('.');
        text.push_str(&field.name);
    }
    if !target.entry.is_empty() {
        let indices: Vec<String> = target.entry.iter().map(i64::to_string).collect();
        text.push_str(&format!("[{}]", indices.join(", ")));
    }
    text
}

/// Prints an equation: `a = b`.
pub fn equation(left: &Expr, right: &Expr) -> String {
    format!("{} = {}", written(left), written(right))
}

/// Prints the conditions of a claim: `F = 0, tau = 0`.
pub fn conditions(when: &[Condition]) -> String {
    let one = |c: &Condition| format!("{} = {}", written(&c.target), written(&c.value));
    when.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Prints expressions separated by commas.
pub fn list(items: &[Expr]) -> String {
    items.iter().map(written).collect::<Vec<_>>().join(", ")
}

/// Prints an expression, in parentheses if it binds less tightly than `wanted`.
fn tight(expr: &Expr, wanted: u8) -> String {
    let binds = match &expr.kind {
        ExprKind::If(_) | ExprKind::InAxes(..) => 0,
        ExprKind::Binary(BinaryOp::Add | BinaryOp::Sub, ..) => 1,
        ExprKind::Binary(BinaryOp::Mul | BinaryOp::Div, ..) => 2,
        ExprKind::Neg(_) => 3,
        ExprKind::Binary(BinaryOp::Pow, ..) => 4,
        _ => 5,
    };
    if binds < wanted {
        format!("({})", written(expr))
    } else {
        written(expr)
    }
}

/// Prints a number as a decimal if it has a finite one, with an exponent if that is shorter, and otherwise as a
/// quotient.
fn decimal(number: &BigRational) -> String {
    if number.is_integer() {
        return number.to_string();
    }
    let sign = if number.is_negative() { "-" } else { "" };
    let ten = BigRational::from_integer(10.into());
    let mut scaled = number.abs();
    for places in 1..=MOST_PLACES {
        scaled *= &ten;
        if scaled.is_integer() {
            let digits = scaled.to_integer().to_string();
            if places > digits.len() + LEADING_ZEROS {
                let exponent = places + 1 - digits.len();
                let (first, rest) = digits.split_at(1);
                let point = if rest.is_empty() { "" } else { "." };
                return format!("{sign}{first}{point}{rest}e-{exponent}");
            }
            let digits = format!("{digits:0>width$}", width = places + 1);
            let (whole, part) = digits.split_at(digits.len() - places);
            return format!("{sign}{whole}.{part}");
        }
    }
    format!("({} / {})", number.numer(), number.denom())
}
