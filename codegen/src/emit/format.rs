//! Layout of files: the short lines are laid out as the printer would, which prints the rest.

use super::lines::{Line, NotRust, WIDTH, entries, row, run, skeleton};
use super::plain;

/// The text as it is written to files.
///
/// # Errors
/// Where it is no Rust.
pub fn formatted(text: &str) -> Result<String, NotRust> {
    let skeleton = skeleton(text)?;
    let mut whole = String::with_capacity(2 * text.len());
    for line in prettyplease::unparse(&skeleton.file).lines() {
        let statement = line.trim_start();
        match run(statement).and_then(|number| skeleton.taken.get(number)) {
            Some(run) => {
                let indent = line.len() - statement.len();
                for line in run {
                    line.write(&mut whole, indent)?;
                }
            }
            None => {
                whole.push_str(line);
                whole.push('\n');
            }
        }
    }
    Ok(whole)
}

impl Line<'_> {
    fn write(&self, text: &mut String, indent: usize) -> Result<(), NotRust> {
        match self {
            Line::Plain(line) => push(text, indent, &[line]),
            Line::Docs(line) => push(text, indent, &[line.trim_end_matches(' ')]),
            Line::Attribute(before, list, after) => {
                write_attribute(text, indent, before, list, after);
            }
            Line::Guard(condition, statement) => {
                push(text, indent, &[condition, " {"]);
                push(text, indent + 4, &[statement]);
                push(text, indent, &["}"]);
            }
            Line::List(before, list, after) => {
                let start = text.len();
                write_list(text, indent, before, list, after);
                // A list is taken apart, so what is left is parsed again.
                if !plain::is_value(&text[start..]) {
                    return Err(NotRust {
                        why: "a list was laid out wrongly".into(),
                        line: Some(format!("{before}{list}{after}")),
                    });
                }
            }
        }
        Ok(())
    }
}

/// An attribute in one line, or an entry a line.
fn write_attribute(text: &mut String, indent: usize, before: &str, list: &str, after: &str) {
    if indent + before.len() + list.len() + after.len() <= WIDTH {
        return push(text, indent, &[before, list, after]);
    }
    push(text, indent, &[before]);
    let mut rest = entries(list).peekable();
    while let Some(entry) = rest.next() {
        let comma = if rest.peek().is_some() { "," } else { "" };
        push(text, indent + 4, &[entry, comma]);
    }
    push(text, indent, &[after]);
}

/// A list in one line, or an entry a line; rows that are too long likewise.
fn write_list(text: &mut String, indent: usize, before: &str, list: &str, after: &str) {
    let width = before.len() + list.len() + after.len();
    if indent + width <= WIDTH {
        return push(text, indent, &[before, list, after]);
    }
    push(text, indent, &[before]);
    let mut rest = entries(list).peekable();
    while let Some(entry) = rest.next() {
        // The comma of the last entry is written only if the list is broken.
        let comma = usize::from(rest.peek().is_some());
        match row(entry) {
            Some(row) if indent + 4 + entry.len() + comma > WIDTH => {
                push(text, indent + 4, &["["]);
                for entry in entries(row) {
                    push(text, indent + 8, &[entry, ","]);
                }
                push(text, indent + 4, &["],"]);
            }
            _ => push(text, indent + 4, &[entry, ","]),
        }
    }
    push(text, indent, &[after]);
}

/// One line.
fn push(text: &mut String, indent: usize, parts: &[&str]) {
    text.extend(std::iter::repeat_n(' ', indent));
    parts.iter().for_each(|part| text.push_str(part));
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::formatted;

    /// The printer alone, which the short way must not differ from.
    fn printed(text: &str) -> String {
        prettyplease::unparse(&syn::parse_file(text).expect("Rust"))
    }

    #[test]
    fn short_statements_come_back_as_the_printer_leaves_them() {
        let text = "impl A {\nfn f(&self, x: &[f64; 2]) -> f64 {\nlet a = x[0] * 2.0;\nlet b = a.mul_add(a, -a);\nlet (s, c) = b.sin_cos();\nlet very_long_name_of_a_value = (a + b) * (s - c) * (a - b) * (s + c) * (a + s) * (b + c);\n// a remark\nvery_long_name_of_a_value\n}\n}\n";
        assert_eq!(formatted(text), Ok(printed(text)));
    }

    #[test]
    fn guards_and_lists_are_broken_where_the_printer_breaks_them() {
        for count in 1..40 {
            let names: Vec<String> = (0..count).map(|i| format!("-t{}", i * i)).collect();
            let row = format!("[{}]", names.join(", "));
            let short = format!("[{}]", names[..1 + count / 2].join(", "));
            for list in [
                row.clone(),
                format!("[{row}]"),
                format!("[{short}, {row}, {row}]"),
            ] {
                let text = format!(
                    "impl A {{\nfn f(&self) -> B {{\nslots[3] = x[0][1] / a;\n\
                     if !a.is_positive() {{ return ::core::result::Result::Err(::hamel::Singular::inertia(\"v{count}\")); }}\n::core::result::Result::Ok({list})\n}}\n\
                     fn g(&self) -> C {{\nlet a = k[1];\n{list}\n}}\n}}\n"
                );
                assert_eq!(formatted(&text), Ok(printed(&text)));
            }
        }
    }

    #[test]
    fn statements_of_any_length_come_back_as_the_printer_leaves_them() {
        for count in 1..40 {
            let name = "n".repeat(count);
            let text = format!(
                "impl A {{\nfn f(&self) {{\nlet {name} = {name}[0].mul_add(-{name}, x[{count}]);\nlet b = {name} * x[0];\n}}\n}}\n"
            );
            assert_eq!(formatted(&text), Ok(printed(&text)));
        }
    }

    #[test]
    fn rows_that_end_in_an_index_keep_their_bracket() {
        for last in ["k[15]", "x[0][1]", "-k[3]", "self.a[2]"] {
            for count in 0..40 {
                let row = format!("[{}{last}]", "some_value, ".repeat(count));
                for list in [format!("[{row}]"), format!("[{row}, {row}, [{last}]]"), row] {
                    let text =
                        format!("impl A {{\nfn f(&self) -> B {{\nlet a = 2.0;\n{list}\n}}\n}}\n");
                    assert_eq!(formatted(&text), Ok(printed(&text)));
                }
            }
        }
    }

    #[test]
    fn attributes_and_documentation_come_back_as_the_printer_leaves_them() {
        for count in 1..12 {
            let lints = "clippy::some_lint, ".repeat(count);
            let text = format!(
                "/// A structure, `x` and \"y\".\n///\n///   - set in, with a tail   \n#[rustfmt::skip]\n\
                 #[allow({lints}dead_code, reason = \"of use\")]\n#[allow({lints}dead_code, reason = \"a, b (c)\")]\n\
                 #[derive(Clone, Debug)]\n#[cfg(feature = \"a\")]\npub struct A {{\n/// A field: 'ω' \\ a.\npub a: f64,\n}}\n\
                 #[rustfmt::skip]\nimpl A {{\n//// A remark.\n/// A method.\n#[allow({lints}dead_code)]\n#[must_use]\nfn f(&self) {{\nlet a = 2.0;\n}}\n}}\n"
            );
            assert_eq!(formatted(&text), Ok(printed(&text)));
        }
    }

    #[test]
    fn what_is_no_rust_is_refused() {
        for text in [
            "/// Nothing is documented.\n",
            "#[must_use]\n",
            "#[allow(dead_code]\nfn f() {}\n",
            "#[allow(a, reason = \"b)]\nfn f() {}\n",
            "fn (",
            "fn f() {\nlet a = no value for node 3;\n}\n",
            "fn f() {\nlet a = k[3;\n}\n",
            "fn f() -> A {\n[a, k[3]\n}\n",
            "fn f() -> A {\n[a, b]\nlet a = b;\n}\n",
            "fn f() -> A {\nlet a = b;\n[[a, b], [c, type]]\n}\n",
        ] {
            assert!(formatted(text).is_err(), "{text}");
        }
    }
}
