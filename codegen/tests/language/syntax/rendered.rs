//! The rendering of errors: underlined in a text, and as errors of the compiler.

use hamel_codegen::render::{render, to_compile_errors};
use hamel_language::diagnostics::Diagnostic;
use hamel_language::syntax::Places;
use hamel_language::syntax::ast::Span;
use hamel_language::syntax::parse_text;

#[test]
fn rendered() {
    let text = "system S {\n\tparam é = 1, m = 2 x;\n    rate r =\n        R ** 2;\n    body on f { mass 1; mass 2; }\n}\n";
    let errors = parse_text(text).expect_err("faults");
    insta::assert_snapshot!(render(&errors, "free.eom", text, false), @r#"
    error: expected `;` after `2`, found `x`
     --> free.eom:2:21
      |
    2 |     param é = 1, m = 2 x;
      |                        ^
      |
      = help: a product is written with `*`; a statement ends with `;`

    error: `**` is not an operator
     --> free.eom:4:11
      |
    4 |         R ** 2;
      |           ^^
      |
      = help: a power is written with `^`

    error: `mass` is given twice for one body
     --> free.eom:5:25
      |
    5 |     body on f { mass 1; mass 2; }
      |                 ----    ^^^^
      |                 |
      |                 first given here
      |
      = help: remove one of them; one frame may carry several bodies

    3 errors
    "#);
    assert!(render(&errors, "free.eom", text, true).contains("\u{1b}["));
}

#[test]
fn rendered_with_byte_order_mark_and_carriage_returns() {
    let text = "\u{feff}sytem S {\r\n}\r\n";
    let errors = parse_text(text).expect_err("faults");
    insta::assert_snapshot!(render(&errors, "free.eom", text, false), @r#"
    error: expected `system`, found `sytem`
     --> free.eom:1:1
      |
    1 | sytem S {
      | ^^^^^
      |
      = help: a description is written `system Name { … }`

    1 error
    "#);
}

#[test]
fn rendered_over_lines_and_without_a_place() {
    let text = "system S {\n    let a = v[\n        1, 2,\n        3,\n    ];\n}\n";
    let mut errors = parse_text(text).expect_err("faults");
    let nowhere = Span::NOWHERE;
    let error =
        Diagnostic::new(errors[0].span, "several lines").note(nowhere, "a note without a place");
    errors.push(error);
    errors.push(Diagnostic::new(nowhere, "somewhere").help("look for it"));
    insta::assert_snapshot!(render(&errors, "free.eom", text, false), @r#"
    error: somewhere
    --> free.eom:1:1
     = help: look for it

    error: expected one index or two
     --> free.eom:2:14
      |
    2 |       let a = v[
      |  ______________^
    3 | |         1, 2,
    4 | |         3,
    5 | |     ];
      | |_____^
      |
      = help: components are written `v[i]` and `M[i, j]`, numbered from 1

    error: several lines
     --> free.eom:2:14
      |
    2 |       let a = v[
      |  ______________^
    3 | |         1, 2,
    4 | |         3,
    5 | |     ];
      | |_____^
      |
      = note: a note without a place

    3 errors
    "#);
}

#[test]
fn as_errors_of_the_compiler() {
    let text = "system S { rate r; let x = \"\"; }";
    let errors = parse_text(text).expect_err("faults");
    insta::assert_snapshot!(to_compile_errors(&errors, &Places::default()).to_string(), @r#"
    :: core :: compile_error ! { "expected `=`, found `;`\nhelp: a rate is written `rate r = R * v;`" } :: core :: compile_error ! { "a string is not a value: `\"\"`\nhelp: values are made of numbers, names and arrays" }
    "#);
}
