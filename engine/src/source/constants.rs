//! Replaces values of constants: `hamel ops --const n=100 rope.eom` reads the text with `const n = 100`.

use hamel_codegen::syntax::ast::{Declaration, Expr, ItemKind, System};
use hamel_codegen::syntax::parse_text;
use hamel_codegen::syntax::suggest::closest;
use std::fmt;

/// Error in a new value of a constant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ConstantProblem {
    /// The value is no expression.
    NoExpression,
    /// The description has no such constant.
    Unknown {
        /// The constant whose name is closest.
        closest: Option<String>,
        /// All constants.
        known: Vec<String>,
    },
}

impl fmt::Display for ConstantProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ConstantProblem::NoExpression => f.write_str("the value is not an expression"),
            ConstantProblem::Unknown { closest, known } => match (closest, known.as_slice()) {
                (Some(meant), _) => write!(f, "no such constant; did you mean `{meant}`?"),
                (None, []) => f.write_str("the description has no constants"),
                (None, known) => write!(
                    f,
                    "no such constant; the constants are {}",
                    known.join(", ")
                ),
            },
        }
    }
}

impl std::error::Error for ConstantProblem {}

/// Returns the text of a description with another value of a constant. A description that cannot be parsed is left
/// unchanged: its errors are reported later.
pub fn given(text: &str, name: &str, value: &str) -> Result<String, ConstantProblem> {
    let Ok(system) = parse_text(text) else {
        return Ok(text.to_string());
    };
    let number = parse_text(&format!("system S {{ const c = {value}; }}"));
    // The value must be a single expression: one statement with one constant, and nothing after it.
    let alone = |system: System| system.items.len() == 1 && constants(&system).count() == 1;
    if !number.is_ok_and(alone) {
        return Err(ConstantProblem::NoExpression);
    }
    let found = constants(&system).find(|constant| constant.name.name == name);
    let place = found.and_then(|constant| constant.value.as_ref().and_then(place));
    let Some(place) = place else {
        let names: Vec<&str> = constants(&system).map(|c| c.name.name.as_str()).collect();
        return Err(ConstantProblem::Unknown {
            closest: closest(name, names.iter().copied()).map(String::from),
            known: names.into_iter().map(String::from).collect(),
        });
    };
    Ok(format!(
        "{}{value}{}",
        &text[..place.start],
        &text[place.end..]
    ))
}

/// Returns the constants of the description itself, without those of its components.
fn constants(system: &System) -> impl Iterator<Item = &Declaration> {
    let lists = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Const(list) => Some(list),
        _ => None,
    });
    lists.flatten()
}

fn place(value: &Expr) -> Option<std::ops::Range<usize>> {
    value.span.range()
}

#[cfg(test)]
mod tests {
    use super::given;

    const TEXT: &str = "system S { const n = 2 * 4, l = 1; component A { const k = 1; } coord q; }";

    #[test]
    fn a_value_is_replaced_and_nothing_else() {
        let longer = TEXT.replace("2 * 4", "100");
        assert_eq!(given(TEXT, "n", "100"), Ok(longer));
        assert_eq!(given("no text", "n", "100"), Ok("no text".into()));
    }

    #[test]
    fn what_is_no_constant_is_refused() {
        let refused = |name: &str, value: &str| {
            let problem = given(TEXT, name, value).expect_err("refused");
            problem.to_string()
        };
        assert_eq!(
            refused("k", "1"),
            "no such constant; the constants are n, l"
        );
        assert_eq!(refused("n", "1; coord p"), "the value is not an expression");
        assert_eq!(refused("n", "1, m = 2"), "the value is not an expression");
        assert_eq!(refused("n", ""), "the value is not an expression");
        let none = given("system S { coord q; }", "n", "1").expect_err("refused");
        assert_eq!(none.to_string(), "the description has no constants");
    }
}
