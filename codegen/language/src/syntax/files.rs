//! Files that a description refers to: included statements, and tables.

use proc_macro2::TokenStream;

use super::ast::{Item, ItemKind, Origins, Source, Span, System};
use super::cursor::MAX_ERRORS;
use super::tokens::{self, Kind, Token};
use super::{parse, scan, table};
use crate::diagnostics::Diagnostic;

/// Largest depth of nested includes.
const MOST_NESTED: usize = 16;

/// Largest total size of all included texts, in bytes.
const MOST_BYTES: usize = 1 << 24;

/// Function that returns the text of a file, given its path relative to the description.
type Open<'a> = dyn FnMut(&str) -> std::io::Result<String> + 'a;

/// Replaces references to files by their contents: included statements, and the points of tables. `open` returns the
/// text of a file, given its path relative to the description. Returns the texts in the order in which they were read.
///
/// A file that is included twice is read only at its first include. Paths in a file are relative to that file.
pub fn read_files(
    system: &mut System,
    open: &mut Open<'_>,
) -> Result<Vec<String>, Vec<Diagnostic>> {
    let mut reader = Reader {
        open,
        origins: std::mem::take(&mut system.origins),
        within: Vec::new(),
        known: Vec::new(),
        bytes: 0,
        texts: Vec::new(),
        errors: Vec::new(),
    };
    let items = std::mem::take(&mut system.items);
    system.items = reader.items(items, "");
    let errors = reader.errors;
    system.origins = reader.origins;
    match errors.is_empty() {
        true => Ok(reader.texts),
        false => Err(system.origins.located_all(errors)),
    }
}

struct Reader<'a, 'b> {
    open: &'a mut Open<'b>,
    origins: Origins,
    /// Files that are being read, each with the span of the statement that includes it.
    within: Vec<(String, Span)>,
    /// All files included so far.
    known: Vec<String>,
    bytes: usize,
    texts: Vec<String>,
    errors: Vec<Diagnostic>,
}

impl Reader<'_, '_> {
    /// Replaces the file references in statements. Paths are relative to `folder`.
    fn items(&mut self, items: Vec<Item>, folder: &str) -> Vec<Item> {
        let mut all = Vec::new();
        for mut item in items {
            match &mut item.kind {
                ItemKind::Include(name, span) => {
                    let name = joined(folder, name);
                    match self.included(&name, *span) {
                        Ok(items) => all.extend(items),
                        Err(errors) => self.errors.extend(errors),
                    }
                    continue;
                }
                ItemKind::Table(found) => self.table(&mut found.source, folder),
                ItemKind::Component(component) => {
                    let items = std::mem::take(&mut component.items);
                    component.items = self.items(items, folder);
                }
                ItemKind::Repeat(repeat) => {
                    let items = std::mem::take(&mut repeat.items);
                    repeat.items = self.items(items, folder);
                }
                _ => {}
            }
            all.push(item);
        }
        all
    }

    fn included(&mut self, name: &str, span: Span) -> Result<Vec<Item>, Vec<Diagnostic>> {
        if let Some((_, first)) = self.within.iter().find(|(file, _)| file == name) {
            let error = Diagnostic::new(span, format!("`{name}` includes itself"));
            return Err(vec![
                error
                    .help("move what both files need to a third file, and include it in both")
                    .note(*first, "it is being read since here"),
            ]);
        }
        if self.within.len() >= MOST_NESTED {
            let message = format!("files include one another more than {MOST_NESTED} deep");
            return Err(vec![
                Diagnostic::new(span, message).help("include the files side by side instead"),
            ]);
        }
        if self.known.iter().any(|known| known == name) {
            return Ok(Vec::new());
        }
        let text = (self.open)(name).map_err(|error| {
            let error = Diagnostic::new(span, format!("cannot read `{name}`: {error}"));
            vec![error.help("the path of a file starts at the folder of its description")]
        })?;
        self.bytes += text.len();
        let start = match self.bytes <= MOST_BYTES {
            true => self.origins.include(name, &text, span),
            false => None,
        };
        let Some(start) = start else {
            let error = Diagnostic::new(span, "the included texts are too long");
            return Err(vec![
                error.help(format!("they may have {MOST_BYTES} bytes")),
            ]);
        };
        self.known.push(name.to_owned());
        let items = statements(&text, start)?;
        self.texts.push(text);
        self.within.push((name.to_owned(), span));
        let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder);
        let items = self.items(items, folder);
        self.within.pop();
        Ok(items)
    }

    fn table(&mut self, source: &mut Source, folder: &str) {
        let Source::File(name, span) = source else {
            return;
        };
        let (name, span) = (joined(folder, name), *span);
        let read = (self.open)(&name).map_err(|error| {
            Diagnostic::new(span, format!("cannot read `{name}`: {error}"))
                .help("the path of a table starts at the folder of its description")
        });
        let points = read.and_then(|text| {
            let points = table::read(&text, &name, span)?;
            self.texts.push(text);
            Ok(points)
        });
        match points {
            Ok(points) => *source = Source::Points(points, span),
            Err(error) => self.errors.push(error),
        }
    }
}

/// Joins a folder and a path. Resolves `.` and, where possible, `..`.
fn joined(folder: &str, name: &str) -> String {
    if name.starts_with('/') || name.contains(':') {
        return name.to_owned();
    }
    let folder = folder.split('/').filter(|_| !folder.is_empty());
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.chain(name.split('/')) {
        match (part, parts.last()) {
            (".", _) => {}
            ("..", Some(last)) if *last != ".." && !last.is_empty() => _ = parts.pop(),
            _ => parts.push(part),
        }
    }
    match parts.is_empty() {
        true => name.to_owned(),
        false => parts.join("/"),
    }
}

/// Parses the statements of a text whose first byte has the place `start`.
fn statements(text: &str, start: usize) -> Result<Vec<Item>, Vec<Diagnostic>> {
    let scanned = scan::scan(text);
    let mut errors = scanned.errors;
    for error in &mut errors {
        error.span = error.span.later(start);
        error
            .notes
            .iter_mut()
            .for_each(|(span, _)| *span = span.later(start));
    }
    let mut items = Vec::new();
    if let Some(readable) = scanned.readable {
        match readable.parse::<TokenStream>() {
            Ok(stream) => {
                let (mut tokens, _) = tokens::of_stream(stream);
                place(&mut tokens, &readable, start);
                let parsed = tokens::check_depth(&tokens).map_err(|error| vec![error]);
                match parsed.and_then(|()| parse::statements(&tokens)) {
                    Ok(found) => items = found,
                    Err(more) => errors.extend(more),
                }
            }
            Err(error) => {
                let mut error = scan::unreadable(&error);
                error.span = error.span.later(start);
                errors.push(error);
            }
        }
    }
    errors.truncate(MAX_ERRORS);
    match errors.is_empty() {
        true => Ok(items),
        false => Err(errors),
    }
}

/// Assigns tokens their spans in a text, in which they appear in this order, separated by blanks and comments. This is
/// necessary because the compiler does not tell a macro where the tokens of a text are.
fn place(tokens: &mut [Token], text: &str, start: usize) {
    let mut at = 0;
    let mut last = Span::new(start..start);
    // A doc comment is a single piece of text in the file, but expands into six tokens of an attribute.
    let mut docs = 0_usize;
    for index in 0..tokens.len() {
        let opens_docs = matches!(tokens[index].kind, Kind::Punct('#'))
            && tokens
                .get(index + 3)
                .is_some_and(|token| token.kind == Kind::Punct('='))
            && skipped(text, at, false).is_some_and(|at| !text[at..].starts_with('#'));
        if opens_docs {
            docs = 6;
        }
        let token = &mut tokens[index];
        if docs > 0 {
            docs -= 1;
            token.span = last;
            continue;
        }
        let Some(begin) = skipped(text, at, true) else {
            token.span = last;
            continue;
        };
        if !token.text.is_empty() && text[begin..].starts_with(token.text.as_str()) {
            at = begin + token.text.len();
            last = Span::new(start + begin..start + at);
        }
        token.span = last;
    }
}

/// Returns the position after blanks and comments. If `docs`, doc comments are skipped as well.
fn skipped(text: &str, from: usize, docs: bool) -> Option<usize> {
    let mut at = from;
    loop {
        let rest = text.get(at..)?;
        let blank = rest.len()
            - rest
                .trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}')
                .len();
        at += blank;
        let rest = &rest[blank..];
        let doc = rest.starts_with("///") && !rest.starts_with("////")
            || rest.starts_with("/**") && !rest.starts_with("/***") && !rest.starts_with("/**/");
        if rest.is_empty() {
            return None;
        } else if doc && !docs {
            // A doc comment comes next.
            return Some(at);
        } else if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
        } else if rest.starts_with("/*") {
            at += comment(rest);
        } else {
            return Some(at);
        }
    }
}

/// Returns the length of a block comment, including nested ones.
fn comment(text: &str) -> usize {
    let (mut at, mut depth) = (0, 0_usize);
    while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
        if rest.starts_with("/*") {
            depth += 1;
            at += 2;
        } else if rest.starts_with("*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += rest.chars().next().map_or(1, char::len_utf8);
        }
    }
    text.len()
}
