//! Writes all pages of the book, with their directives expanded, to a folder that mdBook reads.

use std::collections::BTreeMap;
use std::fs;
use std::io::{Error, Result};
use std::path::{Path, PathBuf};

use crate::errors::{Example, all, of_statement};
use crate::gallery;
use crate::lists;
use crate::page::{CRATES, blocks, directive, own};
use crate::shell::Shell;

/// Expands the directives of pages.
pub struct Book<'a> {
    root: &'a Path,
    program: &'a Path,
    examples: Vec<Example>,
}

/// Lists the files below a folder, by their paths relative to it.
fn below(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut open = vec![PathBuf::new()];
    let mut found = Vec::new();
    while let Some(path) = open.pop() {
        if folder.join(&path).is_dir() {
            for entry in fs::read_dir(folder.join(&path))? {
                open.push(path.join(entry?.file_name()));
            }
        } else {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Returns the pages of the book, by their paths relative to `docs/book/src`.
///
/// # Errors
/// If a page cannot be read.
pub fn pages(root: &Path) -> Result<BTreeMap<PathBuf, String>> {
    let source = root.join("docs/book/src");
    let files = below(&source)?.into_iter();
    files
        .filter(|path| path.extension().is_some_and(|end| end == "md"))
        .map(|path| Ok((path.clone(), fs::read_to_string(source.join(path))?)))
        .collect()
}

/// Writes the book to a folder; `program` is run wherever a command says `hamel`.
///
/// # Errors
/// If a command fails, or a file cannot be read or written.
pub fn build(root: &Path, to: &Path, program: &Path) -> Result<()> {
    let book = Book::new(root, program);
    if to.exists() {
        fs::remove_dir_all(to)?;
    }
    let source = root.join("docs/book/src");
    for path in below(&source)? {
        let place = to.join("src").join(&path);
        fs::create_dir_all(place.parent().unwrap_or(to))?;
        if path.extension().is_some_and(|end| end == "md") {
            let text = fs::read_to_string(source.join(&path))?;
            let text = book.page(&path, &text, to);
            let text =
                text.map_err(|error| Error::other(format!("{}: {error}", path.display())))?;
            fs::write(&place, text)?;
        } else {
            fs::copy(source.join(&path), &place)?;
        }
    }
    fs::copy(root.join("docs/book/book.toml"), to.join("book.toml"))?;
    Ok(())
}

impl<'a> Book<'a> {
    /// Prepares the book of a repository.
    pub fn new(root: &'a Path, program: &'a Path) -> Self {
        let examples = crate::errors::examples(root);
        Book {
            root,
            program,
            examples,
        }
    }

    /// Expands the directives of a page. The commands of a page are run only if one of its directives needs their
    /// output.
    ///
    /// # Errors
    /// If a command fails, or a picture was not made.
    pub fn page(&self, path: &Path, text: &str, to: &Path) -> Result<String> {
        let wants = |name: &str| {
            text.lines()
                .filter_map(directive)
                .any(|(found, _)| found == name)
        };
        let run = wants("output") || wants("picture") || wants("gallery");
        let name = path.with_extension("");
        let shell = match run {
            true => Some(Shell::new(
                self.root,
                &to.join("run").join(&name),
                self.program,
            )?),
            false => None,
        };
        let mut shown = blocks(text, "sh").into_iter();
        let mut crates = blocks(text, CRATES).into_iter();
        let (mut page, mut printed, mut code) = (String::new(), String::new(), false);
        for line in text.lines() {
            if let (Some((name, rest)), false) = (directive(line), code) {
                page += &match (name, &shell) {
                    ("output", _) => format!("```text\n{}\n```", printed.trim_end()),
                    ("picture", Some(shell)) => picture(shell, path, rest, to)?,
                    ("gallery", Some(shell)) => {
                        let beside = path.parent().unwrap_or(Path::new(""));
                        let pictures = to.join("src").join(beside).join("gallery");
                        gallery::sections(self.root, shell, &pictures)?
                    }
                    _ => self.list(name, rest),
                };
            } else {
                page += line;
            }
            page.push('\n');
            if line.starts_with("```") {
                code = !code;
            }
            if let (true, Some(shell)) = (line == "```sh", &shell) {
                printed = shell.run(&own(shown.next().unwrap_or_default()))?;
            }
            if let (Some(CRATES), Some(shell)) = (line.strip_prefix("```"), &shell) {
                printed = shell.run_beside(crates.next().unwrap_or_default())?;
            }
        }
        Ok(page)
    }

    fn list(&self, name: &str, rest: &str) -> String {
        match name {
            "expressions" => lists::expressions(),
            "functions" => lists::generated(),
            "options" => lists::options(),
            "errors" => of_statement(&self.examples, rest),
            _ => all(&self.examples),
        }
    }
}

/// Copies a picture next to its page, and returns the line that shows it.
fn picture(shell: &Shell, page: &Path, rest: &str, to: &Path) -> Result<String> {
    let (file, description) = rest.split_once(' ').unwrap_or((rest, ""));
    let stem = page.file_stem().unwrap_or_default().to_string_lossy();
    let name = format!("{stem}-{}", file.replace('/', "-"));
    let folder = to.join("src").join(page.parent().unwrap_or(Path::new("")));
    fs::copy(shell.folder.join(file), folder.join(&name))?;
    Ok(format!("![{description}]({name})"))
}
