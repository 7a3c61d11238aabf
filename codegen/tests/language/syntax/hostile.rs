//! Hostile inputs: none may panic, overflow the stack or take long.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::accepted::FREE_BODY;
use super::parsed;
use hamel_codegen::render::{render, to_compile_errors};
use hamel_language::syntax::Places;
use hamel_language::syntax::{canonical, parse_text};

/// Returns the first message about an expression.
fn message(expression: &str) -> String {
    let text = format!("system S {{ let x = {expression}; }}");
    match parse_text(&text) {
        Ok(_) => "accepted".to_owned(),
        Err(errors) => {
            assert!(!render(&errors, "a.eom", &text, true).is_empty());
            errors[0].message.clone()
        }
    }
}

/// Uses the stack size of build scripts and of the command line.
#[test]
fn deep_nesting_is_refused() {
    let deep = std::thread::Builder::new().stack_size(8 << 20);
    let thread = deep.spawn(nesting_ends_at_64).expect("a thread");
    thread.join().expect("refused");
}

fn nesting_ends_at_64() {
    for (open, close) in [
        ("(", ")"),
        ("[", "]"),
        ("f(", ")"),
        ("a[", "]"),
        ("-(", ")"),
        ("a^(", ")"),
        ("if a < b {", "} else { 2 }"),
        ("if 1 < 2 { 1 } else {", "}"),
        ("if (", ") < 2 { 1 } else { 2 }"),
    ] {
        let nested = |depth: usize| format!("{}1{}", open.repeat(depth), close.repeat(depth));
        assert_eq!(message(&nested(63)), "accepted", "{open}");
        assert_eq!(
            message(&nested(64)),
            "brackets are nested more than 64 deep",
            "{open}"
        );
        assert_eq!(
            message(&nested(20_000)),
            "brackets are nested more than 64 deep",
            "{open}"
        );
        assert_eq!(
            message(&open.repeat(20_000)),
            "brackets are nested more than 64 deep",
            "{open}"
        );
    }
    let chain = |length: usize| format!("{}{{ 1 }}", "if a < b { 1 } else ".repeat(length));
    assert_eq!(message(&chain(400)), "accepted");
    assert_eq!(message(&chain(20_000)), "more than 500 operands in a row");
    for start in ["if ", "if - if 2 * ", "if a < if "] {
        let text = start.repeat(20_000);
        assert_eq!(message(&text), "choices are nested more than 64 deep");
    }
    let depth = 3_000;
    let text = format!(
        "system S {{ let x = {}1{}; }}",
        "(".repeat(depth),
        ")".repeat(depth)
    );
    let tokens = text.parse().unwrap();
    assert_eq!(canonical(&tokens).len(), text.len() + 2 * depth + 1);
    assert_eq!(
        hamel_language::syntax::parse_tokens(tokens)
            .1
            .unwrap_err()
            .len(),
        1
    );
}

#[test]
fn long_chains_are_refused() {
    for operator in ["+", "-", "*", "/", "^"] {
        let chain = |operands: usize| vec!["a"; operands].join(operator);
        assert_eq!(message(&chain(500)), "accepted", "{operator}");
        assert_eq!(
            message(&chain(501)),
            "more than 500 operands in a row",
            "{operator}"
        );
        assert_eq!(
            message(&chain(20_000)),
            "more than 500 operands in a row",
            "{operator}"
        );
    }
    let before = |signs: usize| format!("{}a", "-".repeat(signs));
    assert_eq!(message(&before(500)), "accepted");
    assert_eq!(message(&before(501)), "more than 500 operands in a row");
    assert_eq!(message(&before(10_000)), "more than 500 operands in a row");
    assert_eq!(message(&format!("a{}", ".T".repeat(599))), "accepted");
    assert_eq!(
        message(&format!("a{}", ".T".repeat(600))),
        "the expression is more than 600 operations deep"
    );
    assert_eq!(
        message(&format!("a{}", "[1]".repeat(10_000))),
        "the expression is more than 600 operations deep"
    );
    let nest = (0..60).fold("a".to_owned(), |inner, _| {
        format!("({inner}{})", "+a".repeat(499))
    });
    assert_eq!(
        message(&nest),
        "the expression is more than 600 operations deep"
    );
    assert_eq!(message(&format!("[{}]", "a,".repeat(10_000))), "accepted");
}

#[test]
fn garbage_is_refused() {
    let size = 1_000_000;
    let mut texts = vec![
        String::new(),
        "\u{feff}".to_owned(),
        "\r".to_owned(),
        "\0".to_owned(),
        "}".to_owned(),
    ];
    for part in [
        "a",
        "(",
        ")",
        "[{(",
        "]",
        "-",
        "'",
        "\"",
        "\\",
        "`",
        "#",
        "#!",
        "///",
        "/*",
        "//",
        "r#\"",
        "r#",
        "'a",
        "\\'",
        "é",
        "∂",
        "𝟘",
        "×",
        "\0",
        ";",
        "; ",
        "=",
        "1",
        "1.",
        "1e",
        "a.",
        "param ",
        "param ;",
        "body on f {",
        "b'",
        "\r",
        "system S {",
        "^",
        "a^",
        "\u{301}",
        "(/*ERROR*/)",
        "#[doc]",
        "rate x = ",
    ] {
        texts.push(part.repeat(size / part.len() / 50));
        texts.push(format!(
            "system S {{ {} }}",
            part.repeat(size / part.len() / 50)
        ));
        texts.push(format!("system S {{ {part} }}"));
        texts.push(format!("system S {{ let x = {part}"));
    }
    texts.push("a".repeat(size));
    texts.push(format!("system S {{ {} }}", "é'(∂".repeat(size / 8)));
    texts.push(format!("system S {{ {} }}", "let a = ; ".repeat(size / 10)));
    for text in texts {
        // Some of these texts are blank.
        let Err(errors) = parse_text(&text) else {
            continue;
        };
        assert!((1..=100).contains(&errors.len()), "{}", errors.len());
        let shown = render(&errors[..errors.len().min(3)], "a.eom", &text, false);
        assert!(shown.contains("error"));
        to_compile_errors(&errors, &Places::default());
    }
}

#[test]
fn at_most_a_hundred_errors() {
    let text = format!("system S {{ {} }}", "rate r; ".repeat(1000));
    assert_eq!(parse_text(&text).expect_err("faults").len(), 100);
    let text = format!("system S {{ body on f {{ {} }} }}", "mess m; ".repeat(1000));
    assert_eq!(parse_text(&text).expect_err("faults").len(), 100);
}

/// Tokens to insert at wrong places.
const MISPLACED_TOKENS: [&str; 36] = [
    "(", ")", "[", "]", "{", "}", ";", ",", ".", ":", "=", "+", "-", "*", "/", "^", "'", "\"", "#",
    "!", "at", "on", "in", "about", "param", "rate", "body", "system", "1e-3", "0x1", "\\", "∂",
    "é", "\n", "//", "/*",
];

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400,
        rng_seed: RngSeed::Fixed(0x4a3e1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn mutated_descriptions_do_not_panic(
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0..4_u8, 0..MISPLACED_TOKENS.len()), 1..8)
    ) {
        let mut parts: Vec<&str> = FREE_BODY.split_inclusive(|c: char| !c.is_alphanumeric()).collect();
        for (place, edit, odd) in edits {
            let at = place.index(parts.len());
            match edit {
                0 => { parts.remove(at); }
                1 => parts.insert(at, MISPLACED_TOKENS[odd]),
                2 => parts[at] = MISPLACED_TOKENS[odd],
                _ => parts.swap(at, odd),
            }
        }
        let text = parts.concat();
        if let Err(errors) = parse_text(&text) {
            prop_assert!(!errors.is_empty());
            prop_assert!(render(&errors, "a.eom", &text, false).contains("error"));
        }
    }

    #[test]
    fn any_text_does_not_panic(text in "\\PC{0,60}") {
        for text in [text.clone(), format!("system S {{ let x = {text}; }}")] {
            if let Err(errors) = parse_text(&text) {
                prop_assert!(render(&errors, "a.eom", &text, false).contains("error"));
            }
        }
    }
}

#[test]
fn the_limits_leave_room_for_drop_and_debug() {
    let nested = format!("{}a{}", "(".repeat(63), "^2)".repeat(63));
    let system = parsed(&format!("system S {{ let x = {nested}; }}"));
    assert!(format!("{system:?}").len() > 63);
}
