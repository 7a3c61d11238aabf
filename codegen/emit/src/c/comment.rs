//! Comments in C, safe for any text.

use crate::docs::escape_bidi_controls;

/// Prints lines as a documentation comment of C, `/** … */`, indented.
pub fn doc_comment(lines: &[String], indent: usize) -> String {
    let lines = lines.iter().flat_map(|line| line.split(['\n', '\r']));
    let lines = lines.map(|line| line.trim_start_matches(' ').to_owned());
    block("/**", &lines.collect::<Vec<_>>(), indent)
}

/// Prints lines as a plain comment of C, `/* … */`.
pub fn plain_comment(lines: &[String]) -> String {
    block("/*", lines, 0)
}

/// Prints one line as a documentation comment of C, `/** … */`, indented.
pub fn doc_comment_line(text: &str, indent: usize) -> String {
    format!("{:indent$}/** {} */\n", "", tame(text))
}

/// Prints one line as a plain C comment, `/* … */`.
pub fn plain_comment_line(text: &str) -> String {
    format!("/* {} */\n", tame(text))
}

fn block(start: &str, lines: &[String], indent: usize) -> String {
    let lines: Vec<String> = lines
        .iter()
        .flat_map(|line| line.split(['\n', '\r']))
        .map(tame)
        .collect();
    let mut text = format!("{:indent$}{start}\n", "");
    for line in lines {
        let space = if line.is_empty() { "" } else { " " };
        text.push_str(&format!("{:indent$} *{space}{line}\n", ""));
    }
    text.push_str(&format!("{:indent$} */\n", ""));
    text
}

/// Breaks up character pairs that begin or end a comment or form trigraphs, and removes control characters.
fn tame(line: &str) -> String {
    let line = line.trim_end();
    let line: String = line.chars().filter(|c| !c.is_control()).collect();
    let mut text = String::new();
    let mut last = ' ';
    for letter in escape_bidi_controls(&line).chars() {
        if matches!((last, letter), ('*', '/') | ('/', '*') | ('?', '?')) {
            text.push(' ');
        }
        text.push(letter);
        last = letter;
    }
    text
}
