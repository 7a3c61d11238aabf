//! Records the output of the command line for every description of the repository, and compares two records.
//!
//! A change that only moves or renames code leaves a record unchanged, except for names and comments of emitted
//! functions:
//!
//! ```text
//! cargo xtask record target/before     # then change the code, build, and
//! cargo xtask record target/after
//! cargo xtask compare target/before target/after
//! ```
//!
//! The program is `target/release/hamel`, or the value of `HAMEL_BIN`.

use crate::root;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Folders with descriptions, relative to the root of the repository.
const FOLDERS: [&str; 5] = [
    "examples",
    "tests/models",
    "tests/wrong",
    "tests/reference/robots",
    "target/robots",
];

/// The reports for each description: the name of a file, and the arguments before and after the description.
const REPORTS: [(&str, &[&str], &[&str]); 9] = [
    ("ops.json", &["ops", "--format", "json"], &[]),
    ("check.txt", &["check"], &[]),
    ("tables.txt", &["tables"], &[]),
    ("eval.json", &["eval"], &[]),
    ("linearize.json", &["linearize", "--format", "json"], &[]),
    ("simulate.txt", &["simulate"], &["--until", "0.1"]),
    ("draw.svg", &["draw"], &[]),
    ("code.rs", &["emit"], &[]),
    ("code.c", &["emit", "--language", "c"], &[]),
];

/// Writes a record to a folder that does not exist yet.
///
/// # Errors
///
/// If a file cannot be read or written, or the program cannot be run.
pub fn record(out: &Path) -> io::Result<()> {
    let program = std::env::var_os("HAMEL_BIN").map_or_else(
        || root().join("target/release/hamel"),
        |path| root().join(path),
    );
    let mut descriptions = Vec::new();
    for folder in FOLDERS {
        find(&root().join(folder), &mut descriptions)?;
    }
    descriptions.sort();
    fs::create_dir(out)?;
    let next = AtomicUsize::new(0);
    let work = || -> io::Result<()> {
        while let Some(path) = descriptions.get(next.fetch_add(1, Ordering::Relaxed)) {
            report(&program, path, out)?;
        }
        Ok(())
    };
    let workers = thread::available_parallelism()?.get();
    thread::scope(|scope| {
        let running: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        running.into_iter().try_for_each(|worker| {
            let panicked = || Err(io::Error::other("a worker panicked"));
            worker.join().unwrap_or_else(|_| panicked())
        })
    })
}

/// Finds all descriptions and robots below a folder, which need not exist.
fn find(folder: &Path, found: &mut Vec<PathBuf>) -> io::Result<()> {
    if !folder.is_dir() {
        return Ok(());
    }
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            find(&path, found)?;
        } else if path.extension() == Some(OsStr::new("eom"))
            || path.extension() == Some(OsStr::new("urdf"))
        {
            found.push(path);
        }
    }
    Ok(())
}

/// Runs every command on a description, and writes its output and exit status.
fn report(program: &Path, description: &Path, out: &Path) -> io::Result<()> {
    let name = description.strip_prefix(root()).unwrap_or(description);
    let folder = out.join(name.to_string_lossy().replace(['/', '\\'], "+"));
    fs::create_dir(&folder)?;
    for (file, before, after) in REPORTS {
        let ran = Command::new(program)
            .args(before)
            .arg(name)
            .args(after)
            .current_dir(root())
            .output()?;
        let status = ran.status.code().unwrap_or(-1);
        let mut text = format!("exit status {status}\n").into_bytes();
        text.extend(ran.stdout);
        text.extend(b"--- standard error\n");
        text.extend(ran.stderr);
        fs::write(folder.join(file), text)?;
    }
    Ok(())
}

/// Prints every report that differs between two records; returns whether there is none.
///
/// Emitted functions are compared without comments and with local names numbered by first occurrence; all other reports
/// are compared byte by byte.
///
/// # Errors
///
/// If a file cannot be read.
pub fn compare(before: &Path, after: &Path) -> io::Result<bool> {
    let (before, after) = (reports(before)?, reports(after)?);
    let mut differing = 0;
    for name in before
        .keys()
        .chain(after.keys().filter(|name| !before.contains_key(*name)))
    {
        let why = match (before.get(name), after.get(name)) {
            (Some(old), Some(new)) => difference(name, old, new)?,
            (Some(_), None) => Some("only before".to_owned()),
            _ => Some("only after".to_owned()),
        };
        if let Some(why) = why {
            println!("{name}: {why}");
            differing += 1;
        }
    }
    println!("{} reports, {differing} differ", before.len());
    Ok(differing == 0)
}

/// Returns the reports of a record by their names.
fn reports(record: &Path) -> io::Result<BTreeMap<String, PathBuf>> {
    let mut found = BTreeMap::new();
    for folder in fs::read_dir(record)? {
        let folder = folder?;
        for file in fs::read_dir(folder.path())? {
            let file = file?;
            let name = format!(
                "{}/{}",
                folder.file_name().to_string_lossy(),
                file.file_name().to_string_lossy()
            );
            found.insert(name, file.path());
        }
    }
    Ok(found)
}

/// Describes the first difference of two reports, if any.
fn difference(name: &str, old: &Path, new: &Path) -> io::Result<Option<String>> {
    let (old, new) = (fs::read(old)?, fs::read(new)?);
    if old == new {
        return Ok(None);
    }
    let (old, new) = (String::from_utf8_lossy(&old), String::from_utf8_lossy(&new));
    if name.contains("/code.") {
        return Ok(different_function(&old, &new));
    }
    let lines = old.lines().zip(new.lines());
    let place = lines.take_while(|(a, b)| a == b).count();
    let line = |text: &str| text.lines().nth(place).unwrap_or("(end)").to_owned();
    Ok(Some(format!(
        "line {}\n  - {}\n  + {}",
        place + 1,
        line(&old),
        line(&new)
    )))
}

/// Returns the first function whose normal form differs, if any.
fn different_function(old: &str, new: &str) -> Option<String> {
    let (old, new) = (functions(old), functions(new));
    let place = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
    match (old.get(place), new.get(place)) {
        (None, None) => None,
        (Some(gone), None) => Some(format!("a function is gone: {}", start(gone))),
        (None, Some(added)) => Some(format!("a function is new: {}", start(added))),
        (Some(a), Some(b)) => {
            let place = a.iter().zip(b).take_while(|(a, b)| a == b).count();
            let from = place.saturating_sub(8);
            let part = |tokens: &[String]| {
                let end = tokens.len().min(place + 8);
                tokens.get(from..end).unwrap_or_default().join(" ")
            };
            Some(format!(
                "body {}\n  - {}\n  + {}",
                start(a),
                part(a),
                part(b)
            ))
        }
    }
}

fn start(tokens: &[String]) -> String {
    tokens[..tokens.len().min(12)].join(" ")
}

/// Returns the function bodies of a source, `{ … }` from the first brace that follows a closing parenthesis or a return
/// type, as tokens in which each word is replaced by the number of its first occurrence.
///
/// Names of operations are kept: a changed call is a changed body.
fn functions(source: &str) -> Vec<Vec<String>> {
    let tokens = tokens(source);
    let mut bodies = Vec::new();
    let mut depth = 0_usize;
    let mut body: Vec<&str> = Vec::new();
    for token in &tokens {
        if token == "{" {
            depth += 1;
        }
        if depth > 0 {
            body.push(token);
        }
        if token == "}" {
            depth = depth.saturating_sub(1);
            if depth == 0 {
                bodies.push(normalised(&body));
                body.clear();
            }
        }
    }
    bodies
}

/// Numbers the local words of tokens. A word before `(` or after `.` or `::` is an operation.
fn normalised(tokens: &[&str]) -> Vec<String> {
    let mut numbers: BTreeMap<&str, usize> = BTreeMap::new();
    let mut result = Vec::with_capacity(tokens.len());
    for (place, &token) in tokens.iter().enumerate() {
        let before = place.checked_sub(1).and_then(|place| tokens.get(place));
        let after = tokens.get(place + 1);
        let is_word = token.starts_with(|c: char| c.is_alphabetic() || c == '_');
        let is_operation = after == Some(&"(") || matches!(before, Some(&("." | ":")));
        if is_word && !is_operation {
            let next = numbers.len();
            let number = numbers.entry(token).or_insert(next);
            result.push(format!("_{number}"));
        } else {
            result.push(token.to_owned());
        }
    }
    result
}

/// Splits Rust or C into words, numbers and single signs, without comments, attributes and white space.
fn tokens(source: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if rest.starts_with("#[") || rest.starts_with("#!") {
            rest.find(']').map_or(rest.len(), |end| end + 1)
        } else if is_part(first) {
            let length = rest.find(|c| !is_part(c)).unwrap_or(rest.len());
            tokens.push(rest[..length].to_owned());
            length
        } else {
            if !first.is_whitespace() {
                tokens.push(first.to_string());
            }
            first.len_utf8()
        };
        rest = &rest[length..];
    }
    tokens
}

fn is_part(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

#[cfg(test)]
mod tests {
    use super::{different_function, tokens};

    #[test]
    fn names_and_comments_do_not_count() {
        let old = "fn f(a: f64) -> f64 { let t1 = a * 2.0; /* twice */ t1.sqrt() }";
        let new = "#[inline]\nfn f(b: f64) -> f64 {\n // the double\n let twice = b * 2.0;\n twice.sqrt() }";
        assert_eq!(different_function(old, new), None);
    }

    #[test]
    fn operations_numbers_and_order_count() {
        let old = "fn f(a: f64) { let t1 = a * 2.0; t1.sqrt() }";
        for new in [
            "fn f(a: f64) { let t1 = a * 3.0; t1.sqrt() }",
            "fn f(a: f64) { let t1 = a + 2.0; t1.sqrt() }",
            "fn f(a: f64) { let t1 = a * 2.0; t1.abs() }",
            "fn f(a: f64) { let t1 = a * 2.0; a.sqrt() }",
            "",
        ] {
            assert!(different_function(old, new).is_some(), "{new}");
        }
    }

    #[test]
    fn tokens_end_at_signs() {
        assert_eq!(tokens("x1=y[2];"), ["x1", "=", "y", "[", "2", "]", ";"]);
    }
}
