//! The errors of the generator: example descriptions, the messages for them, and the places in the generator that
//! create these messages.
//!
//! The examples are the descriptions in `tests/wrong`, whose messages another test locks, and those in
//! `docs/book/errors`, which cover the rest.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use crate::lists::cell;
use crate::rare::RARE;
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::generate::from_file;
use hamel_codegen::render::{render, warnings};
use hamel_codegen::vocabulary::statements;

/// A place in the generator that creates a message: file, line and column.
pub type Site = (String, u32, u32);

/// An error or a warning, with a description that causes it.
#[derive(Clone, Debug)]
pub struct Example {
    /// The place in the generator that creates the message.
    pub site: Site,
    /// The message.
    pub message: String,
    /// The help: a remedy.
    pub help: String,
    /// The keyword of the statement with the error.
    pub statement: &'static str,
    /// The message with its context, as users see it.
    pub shown: String,
}

/// Returns all examples, in the order of their files.
pub fn examples(root: &Path) -> Vec<Example> {
    let mut files: Vec<PathBuf> = Vec::new();
    let entries = |folder: PathBuf| {
        let entries = fs::read_dir(folder).into_iter().flatten();
        entries.filter_map(|entry| Some(entry.ok()?.path()))
    };
    for folder in entries(root.join("tests/wrong")).chain([root.join("docs/book/errors")]) {
        files.extend(entries(folder));
    }
    files.retain(|path| path.extension().is_some_and(|end| end == "eom"));
    files.sort();
    let mut found = Vec::new();
    for path in files {
        let text = fs::read_to_string(&path).unwrap_or_default();
        // Comments that begin with `//~` state the errors for a test.
        let lines = text.split_inclusive('\n');
        let text: String = lines
            .filter(|line| !line.trim_start().starts_with("//~"))
            .collect();
        let folder = path.parent().unwrap_or(root).to_owned();
        let open = &mut |name: &str| fs::read_to_string(folder.join(name));
        match from_file(&text, open) {
            Err(errors) => found.extend(errors.iter().map(|error| example(error, &text, false))),
            Ok(generated) => {
                let list = generated.model.warnings.iter();
                found.extend(list.map(|warning| example(warning, &text, true)));
            }
        }
    }
    found
}

fn example(error: &Diagnostic, text: &str, warning: bool) -> Example {
    let site = error.site;
    let list = std::slice::from_ref(error);
    let rendered = match warning {
        true => warnings(list, "description.eom", text, false),
        false => render(list, "description.eom", text, false),
    };
    let shown = rendered
        .split_once("\n\n")
        .map_or(&*rendered, |(shown, _)| shown);
    let place = error.span.range().map_or(0, |range| range.start);
    Example {
        site: (site.file().to_owned(), site.line(), site.column()),
        message: error.message.clone(),
        help: error.help.clone().unwrap_or_default(),
        statement: statement_at(text, place),
        shown: shown.to_owned(),
    }
}

/// Selects the shortest example for every site and statement, by statement in the order of the language.
fn shortest(examples: &[Example]) -> Vec<(&'static str, Vec<&Example>)> {
    let mut kept: BTreeMap<(&str, &Site), &Example> = BTreeMap::new();
    for example in examples {
        let place = kept
            .entry((example.statement, &example.site))
            .or_insert(example);
        if example.shown.len() < place.shown.len() {
            *place = example;
        }
    }
    let words = ["system"]
        .into_iter()
        .chain(statements().map(|(word, _)| word));
    words
        .map(|word| {
            let of_word = kept.iter().filter(|((statement, _), _)| *statement == word);
            (word, of_word.map(|(_, example)| *example).collect())
        })
        .collect()
}

/// Renders the errors of a statement as a collapsible table.
pub fn of_statement(examples: &[Example], word: &str) -> String {
    let all = shortest(examples);
    let list = all.iter().find(|(statement, _)| *statement == word);
    let list = list.map_or(&[][..], |(_, list)| list);
    let mut text = format!(
        "<details>\n<summary>Errors and warnings ({})</summary>\n\n",
        list.len()
    );
    text += "| message | what to do |\n|---|---|\n";
    for example in list {
        let _ = writeln!(
            text,
            "| {} | {} |",
            cell(&example.message),
            cell(&example.help)
        );
    }
    let _ = write!(
        text,
        "\n[With their places in a text](errors.md#{word})\n\n</details>"
    );
    text
}

/// Renders all errors with their descriptions, by statement, and the errors without an example.
pub fn all(examples: &[Example]) -> String {
    let mut text = String::new();
    for (word, list) in shortest(examples) {
        if list.is_empty() {
            continue;
        }
        let _ = writeln!(text, "## `{word}`\n");
        for example in list {
            let _ = writeln!(text, "```text\n{}\n```\n", example.shown.trim_end());
        }
    }
    text += "## Without an example\n\n| message | when |\n|---|---|\n";
    for (_, _, message, when) in RARE {
        let _ = writeln!(text, "| {} | {when} |", cell(message));
    }
    text
}

/// Returns the first word of the statement at an offset; `system` outside of all statements.
fn statement_at(text: &str, place: usize) -> &'static str {
    let mut found = "system";
    let mut first = true;
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let code = line.split("//").next().unwrap_or_default();
        let mut word = None;
        for (offset, c) in code.char_indices().chain([(code.len(), ';')]) {
            if at + offset > place && word.is_none() {
                return found;
            }
            if c.is_alphanumeric() || c == '_' {
                word.get_or_insert(offset);
                continue;
            }
            if let Some(begin) = word.take()
                && first
            {
                let known = statements().find(|(known, _)| *known == &code[begin..offset]);
                found = known.map_or(found, |(known, _)| known);
                first = false;
            }
            first |= matches!(c, ';' | '{' | '}') && offset < code.len();
        }
        at += line.len();
    }
    found
}

/// Lines of code shown before a site.
const LINES_BEFORE: usize = 14;
/// Lines of code shown after it.
const LINES_AFTER: usize = 5;

/// Finds the sites below a folder where sources create messages, each with the code around it.
pub fn sites(root: &Path, folder: &str) -> BTreeMap<Site, String> {
    let mut found = BTreeMap::new();
    let mut open = vec![PathBuf::from(folder)];
    while let Some(path) = open.pop() {
        if root.join(&path).is_dir() {
            let entries = fs::read_dir(root.join(&path)).into_iter().flatten();
            let names = entries.filter_map(|entry| Some(entry.ok()?.file_name()));
            open.extend(
                names
                    .map(|name| path.join(name))
                    .filter(|path| !path.ends_with("tests")),
            );
            continue;
        }
        let tests = path.file_stem().is_some_and(|name| name == "tests");
        let text = fs::read_to_string(root.join(&path)).unwrap_or_default();
        if tests || path.extension().is_none_or(|end| end != "rs") {
            continue;
        }
        let code = text
            .split("#[cfg(test)]\nmod tests {")
            .next()
            .unwrap_or_default();
        for (row, line) in (1..).zip(code.lines()) {
            let Some(column) = line.find("Diagnostic::new(") else {
                continue;
            };
            if line.trim_start().starts_with("//") {
                continue;
            }
            let first = (row as usize).saturating_sub(LINES_BEFORE);
            let near: Vec<&str> = code
                .lines()
                .skip(first)
                .take(LINES_BEFORE + LINES_AFTER)
                .collect();
            let rest = near.join(" ");
            found.insert(
                (path.display().to_string(), row, column as u32 + 1),
                rest.split_whitespace().collect::<Vec<_>>().join(" "),
            );
        }
    }
    found
}
