//! Comments of C, whatever stands in them.

use crate::docs::spelled;

/// Lines as a comment of documentation, set in.
pub fn documentation(lines: &[String], indent: usize) -> String {
    block("/**", lines, indent)
}

/// Lines as a comment.
pub fn plain(lines: &[String]) -> String {
    block("/*", lines, 0)
}

/// One line of documentation, set in.
pub fn line(text: &str, indent: usize) -> String {
    format!("{:indent$}/** {} */\n", "", tame(text))
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

/// A line without what begins or ends a comment, trigraphs, and what is no text.
fn tame(line: &str) -> String {
    let line = line.trim_end().trim_start_matches(' ');
    let line: String = line.chars().filter(|c| !c.is_control()).collect();
    let mut text = String::new();
    let mut last = ' ';
    for letter in spelled(&line).chars() {
        if matches!((last, letter), ('*', '/') | ('/', '*') | ('?', '?')) {
            text.push(' ');
        }
        text.push(letter);
        last = letter;
    }
    text
}
