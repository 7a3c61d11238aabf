//! Layout of the generated text.
//!
//! Most lines are short statements that already look as the printer would leave them, guards, and
//! results in one line. Runs of these are taken out while the rest is parsed and printed, and put back
//! laid out as the printer would: parsing them would take most of the time.

/// The longest line of the printer.
const WIDTH: usize = 89;
/// How far statements of a method are set in.
const INDENT: usize = 8;
/// Longer statements may be broken by the printer.
const SHORT: usize = WIDTH - INDENT - 1;
/// What a run of lines leaves behind; the printer keeps it as it is.
const MARK: &str = "let hamel_line_";

/// The text as it is written to files; as it is where it is no Rust.
pub fn formatted(text: &str) -> String {
    let mut taken = Vec::new();
    let mut skeleton = String::with_capacity(text.len() / 2);
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let Some(first) = line_of(line) else {
            skeleton.push_str(line);
            skeleton.push('\n');
            continue;
        };
        skeleton.push_str(&format!("{MARK}{};\n", taken.len()));
        let mut run = vec![first];
        while let Some(next) = lines.peek().and_then(|line| line_of(line)) {
            run.push(next);
            lines.next();
        }
        taken.push(run);
    }
    let Ok(file) = syn::parse_file(&skeleton) else {
        return text.to_string();
    };
    let mut whole = String::with_capacity(2 * text.len());
    for line in prettyplease::unparse(&file).lines() {
        let statement = line.trim_start();
        let number = statement.strip_prefix(MARK);
        let number = number.and_then(|rest| rest.strip_suffix(';')?.parse::<usize>().ok());
        match number.and_then(|number| taken.get(number)) {
            Some(run) => {
                let indent = line.len() - statement.len();
                run.iter().for_each(|taken| taken.write(&mut whole, indent));
            }
            None => {
                whole.push_str(line);
                whole.push('\n');
            }
        }
    }
    whole
}

/// A line whose layout is known.
enum Line<'a> {
    /// It stays.
    Plain(&'a str),
    /// A condition with one statement.
    Guard(&'a str, &'a str),
    /// What stands before a list, the list, what stands behind it.
    List(&'a str, &'a str, &'a str),
}

/// How a line is laid out, where that is known without parsing it.
fn line_of(line: &str) -> Option<Line<'_>> {
    if is_plain(line) {
        return Some(Line::Plain(line));
    }
    if let Some((condition, rest)) = line.split_once(" { ")
        && condition.starts_with("if !")
        && is_simple(condition)
        && condition.len() + 2 <= SHORT
        && let Some(statement) = rest.strip_suffix(" }")
        && statement.starts_with("return Err(")
        && statement.ends_with(");")
        && statement.len() + 4 <= SHORT
    {
        return Some(Line::Guard(condition, statement));
    }
    for (before, after) in [("[", "]"), ("Ok([", "])")] {
        if let Some(list) = line.strip_prefix(before)
            && let Some(list) = list.strip_suffix(after)
            && !list.is_empty()
            && entries(list).all(|entry| match entry.strip_prefix('[') {
                Some(row) => row
                    .strip_suffix(']')
                    .is_some_and(|row| entries(row).all(is_entry)),
                None => is_entry(entry),
            })
        {
            return Some(Line::List(before, list, after));
        }
    }
    None
}

impl Line<'_> {
    fn write(&self, text: &mut String, indent: usize) {
        match self {
            Line::Plain(line) => push(text, indent, &[line]),
            Line::Guard(condition, statement) => {
                push(text, indent, &[condition, " {"]);
                push(text, indent + 4, &[statement]);
                push(text, indent, &["}"]);
            }
            Line::List(before, list, after) => {
                let width = before.len() + list.len() + after.len();
                if indent + width <= WIDTH {
                    return push(text, indent, &[before, list, after]);
                }
                push(text, indent, &[before]);
                let mut rest = entries(list).peekable();
                while let Some(entry) = rest.next() {
                    // The comma of the last entry is written only if the list is broken.
                    let comma = usize::from(rest.peek().is_some());
                    match entry.strip_prefix('[') {
                        Some(row) if indent + 4 + entry.len() + comma > WIDTH => {
                            push(text, indent + 4, &["["]);
                            for entry in entries(row.trim_end_matches(']')) {
                                push(text, indent + 8, &[entry, ","]);
                            }
                            push(text, indent + 4, &["],"]);
                        }
                        _ => push(text, indent + 4, &[entry, ","]),
                    }
                }
                push(text, indent, &[after]);
            }
        }
    }
}

/// One line.
fn push(text: &mut String, indent: usize, parts: &[&str]) {
    text.extend(std::iter::repeat_n(' ', indent));
    parts.iter().for_each(|part| text.push_str(part));
    text.push('\n');
}

/// The entries of a list, rows whole.
fn entries(list: &str) -> impl Iterator<Item = &str> {
    let mut depth = 0_i32;
    let mut after_comma = false;
    let parts = list.split(move |c: char| {
        let ends = c == ',' && depth == 0;
        depth += i32::from(matches!(c, '[' | '(')) - i32::from(matches!(c, ']' | ')'));
        ends
    });
    parts.map(move |part| {
        let entry = if after_comma {
            part.strip_prefix(' ').unwrap_or(part)
        } else {
            part
        };
        after_comma = true;
        entry
    })
}

/// Whether a line is one short statement in which there is nothing to lay out.
fn is_plain(line: &str) -> bool {
    let starts = |word: &str| line.starts_with(word);
    line.len() <= SHORT
        && (starts("let ") || starts("slots[") || starts("out[") || starts("*out "))
        && line.ends_with(';')
        && is_simple(&line[..line.len() - 1])
}

/// Whether an entry of a list is a value; lists of numbers are laid out in another way.
fn is_entry(text: &str) -> bool {
    text.len() <= SHORT / 2
        && text.starts_with(|c: char| c.is_ascii_alphabetic() || matches!(c, '-' | '_'))
        && is_simple(text)
}

/// Whether there is nothing in an expression that is laid out: no blocks, lists, or operators of types.
fn is_simple(text: &str) -> bool {
    let mut previous = b' ';
    text.bytes().all(|byte| {
        let index =
            byte != b'[' || previous.is_ascii_alphanumeric() || matches!(previous, b'_' | b']');
        previous = byte;
        index && !matches!(byte, b'{' | b'}' | b'|' | b'#' | b'"' | b';')
    })
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
        assert_eq!(formatted(text), printed(text));
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
                     if !a.is_positive() {{ return Err(::hamel::Singular {{ pivot: {count} }}); }}\nOk({list})\n}}\n\
                     fn g(&self) -> C {{\nlet a = k[1];\n{list}\n}}\n}}\n"
                );
                assert_eq!(formatted(&text), printed(&text));
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
            assert_eq!(formatted(&text), printed(&text));
        }
    }

    #[test]
    fn what_is_no_rust_stays() {
        assert_eq!(formatted("fn ("), "fn (");
    }
}
