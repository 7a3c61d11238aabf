//! Layout of the generated text.
//!
//! Most lines are short statements that already look as the printer would leave them. They are taken out
//! while the rest is parsed and printed, and put back: parsing them would take most of the time.

/// Longer statements may be broken by the printer.
const SHORT: usize = 72;
/// What a statement leaves behind; the printer keeps it as it is.
const MARK: &str = "let hamel_line_";

/// The text as it is written to files; as it is where it is no Rust.
pub fn formatted(text: &str) -> String {
    let mut taken = Vec::new();
    let mut skeleton = String::with_capacity(text.len());
    for line in text.lines() {
        if is_plain(line) {
            skeleton.push_str(&format!("{MARK}{};\n", taken.len()));
            taken.push(line);
        } else {
            skeleton.push_str(line);
            skeleton.push('\n');
        }
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
            Some(plain) => {
                whole.push_str(&line[..line.len() - statement.len()]);
                whole.push_str(plain);
            }
            None => whole.push_str(line),
        }
        whole.push('\n');
    }
    whole
}

/// Whether a line is one short statement in which there is nothing to lay out.
fn is_plain(line: &str) -> bool {
    let laid_out = |c: char| matches!(c, '{' | '}' | '[' | ']' | '|' | '#' | '/' | '"');
    line.len() <= SHORT
        && line.starts_with("let ")
        && line.ends_with(';')
        && line.matches(';').count() == 1
        && !line.contains(laid_out)
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
    fn what_is_no_rust_stays() {
        assert_eq!(formatted("fn ("), "fn (");
    }
}
