//! Expressions as text: printing and parsing are inverse.

use hamel_language::syntax::ast::{Conserved, ItemKind};
use hamel_language::syntax::written::{conditions, written};

#[test]
fn expressions_read_as_they_were_written() {
    for text in [
        "a - (b + c) * 2 - -d^2",
        "(a + b) / (c / 2)",
        "dot(R.T * [0, 0, 1.25], s[1] * w)",
        "(a^2)^3",
        "-(a + b)",
        "-0.05 * a",
        "if a < b + 1 { [a, 2] } else { -v }",
        "a + dot(v, (velocity(f, p) in g)^2)",
        "(acceleration(f, [0, 0, 1]) in body)[1] * 2",
        "2 * (if a <= -b { a } else if c >= d { b } else { if_1 })^2 - x",
        "if (if a > b { a } else { b }) > c { if a > 0 { 1 } else { 2 } } else { (if a > b { a } else { b })[1] }",
    ] {
        let system = format!("system S {{ invariant e = {text} when F[2] = 0, k = {text}; }}");
        let parsed = hamel_language::syntax::parse_text(&system).expect("correct");
        let Some(ItemKind::Invariant {
            conserved: Conserved::Value(value),
            when,
            ..
        }) = parsed.items.first().map(|item| &item.kind)
        else {
            panic!("an invariant");
        };
        assert_eq!(written(value), text);
        assert_eq!(conditions(when), format!("F[2] = 0, k = {text}"));
    }
}
