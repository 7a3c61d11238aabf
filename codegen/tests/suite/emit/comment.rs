//! Comments in C, for any content.

use super::sample::pendulum;
use hamel_codegen::emit::c;

/// Returns the header of a program whose first function has this documentation.
fn header(docs: &[&str]) -> String {
    let mut program = pendulum();
    program.functions[0].docs = docs.iter().map(|&line| line.into()).collect();
    c::files(&program, &c::Options::default()).header
}

/// Returns a line of documentation in the form of a comment.
fn tame(line: &str) -> String {
    let header = header(&["This is the line:", line]);
    let (_, rest) = header.split_once(" * This is the line:\n").expect("it");
    let (line, _) = rest.split_once('\n').expect("its end");
    line.strip_prefix(" * ").expect("a line").to_owned()
}

#[test]
fn nothing_leaves_a_comment() {
    assert_eq!(tame("a */ b /* c"), "a * / b / * c");
    assert_eq!(tame("what??/"), "what? ?/");
    assert_eq!(tame("a\u{0}b\u{202e}"), "ab\\u{202e}");
    let header = header(&["a\nb", ""]);
    assert!(header.contains("\n/**\n * a\n * b\n *\n"), "{header}");
    // Every line is indented.
    let (_, rest) = header.split_once("\n    /**\n").expect("one");
    let (lines, _) = rest.split_once("\n     */\n").expect("its end");
    for line in lines.lines() {
        let rest = line.strip_prefix("     *").expect(line);
        let set = rest.is_empty() || rest.starts_with(' ') && rest.trim() == &rest[1..];
        assert!(set, "{line:?}");
    }
}
