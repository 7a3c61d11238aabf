//! Measures the size and the layout of the repository, and compares them with the bounds that keep it readable.

use crate::root;
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A measure of the repository.
struct Measure {
    name: &'static str,
    value: usize,
    /// The value that the repository is meant to have at most.
    target: usize,
    /// The value that a change may leave at most; larger than the target where that is not reached yet.
    bound: usize,
}

/// Prints all measures beside their targets, and whether all of them are within their bounds.
///
/// # Errors
///
/// Files that cannot be read, and git that cannot be run.
pub fn print() -> io::Result<bool> {
    let mut all_within = true;
    println!("{:58} {:>8} {:>8}", "", "value", "target");
    for measure in measures()? {
        let Measure {
            name,
            value,
            target,
            bound,
        } = measure;
        let remark = match (value <= target, value <= bound) {
            (true, _) => "",
            (false, true) => "  above the target",
            (false, false) => "  ABOVE THE BOUND",
        };
        println!("{name:58} {value:8} {target:8}{remark}");
        all_within &= value <= bound;
    }
    Ok(all_within)
}

fn measures() -> io::Result<Vec<Measure>> {
    let files = tracked_files()?;
    let manifests: Vec<(&Path, String)> = files
        .iter()
        .filter(|file| file.ends_with("Cargo.toml"))
        .map(|file| Ok((file.as_path(), read(file)?)))
        .collect::<io::Result<_>>()?;
    let with_section = |section: &str| {
        let tables = |text: &String| {
            text.lines()
                .filter(|line| line.starts_with(section))
                .count()
        };
        manifests
            .iter()
            .map(|(_, text)| tables(text))
            .sum::<usize>()
    };
    let entries: BTreeSet<_> = files.iter().filter_map(|file| file.iter().next()).collect();
    let is_test_package =
        |file: &Path| file.starts_with("tests") || file.starts_with("codegen/tests");
    let published: Vec<&Path> = manifests
        .iter()
        .filter(|(file, text)| {
            text.contains("[package]")
                && !text.contains("publish = false")
                && file.parent().is_some()
        })
        .filter_map(|(file, _)| file.parent())
        .collect();
    let crates = published
        .iter()
        .map(|folder| sources(&files, folder))
        .collect::<io::Result<Vec<_>>>()?;
    let lines = |text: &String| text.lines().count();
    let sizes: Vec<usize> = crates
        .iter()
        .map(|texts| texts.iter().map(lines).sum())
        .collect();
    let snapshots = files
        .iter()
        .filter(|file| file.extension().is_some_and(|ending| ending == "snap"));
    let snapshots = snapshots
        .map(|file| Ok(read(file)?.lines().count()))
        .sum::<io::Result<usize>>()?;
    let mut included = 0;
    for file in files.iter().filter(|file| is_rust(file)) {
        if !file.iter().any(|part| part == "tests" || part == "benches") {
            let text = read(file)?;
            included += text
                .lines()
                .filter(|line| line.starts_with("#[path = "))
                .count();
        }
    }
    let text_errors = crates
        .iter()
        .flatten()
        .flat_map(|text| text.lines())
        .filter(|line| has_text_error(line))
        .count();
    let short = crates
        .iter()
        .flatten()
        .filter(|text| text.lines().count() < 40)
        .count();
    let measure = |name, value, target, bound| Measure {
        name,
        value,
        target,
        bound,
    };
    Ok(vec![
        measure("workspaces", with_section("[workspace]"), 3, 3),
        measure(
            "packages of tests",
            manifests
                .iter()
                .filter(|(file, _)| is_test_package(file))
                .count(),
            5,
            5,
        ),
        measure(
            "tables of profiles in manifests",
            with_section("[profile."),
            8,
            8,
        ),
        measure("entries of the root folder", entries.len(), 24, 24),
        measure(
            "lines of published sources",
            sizes.iter().sum(),
            104_000,
            135_600,
        ),
        measure(
            "lines of the largest crate",
            sizes.iter().copied().max().unwrap_or_default(),
            26_000,
            28_900,
        ),
        measure("lines of snapshots", snapshots, 16_000, 16_000),
        measure("`#[path]` outside of tests", included, 0, 0),
        measure(
            "errors that are texts, `Result<_, String>`, in published crates",
            text_errors,
            0,
            0,
        ),
        measure("published files of fewer than 40 lines", short, 40, 40),
    ])
}

/// The files that git knows, from the root of the repository.
fn tracked_files() -> io::Result<Vec<PathBuf>> {
    let output = Command::new("git")
        .arg("ls-files")
        .current_dir(root())
        .output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let files: Vec<PathBuf> = text
        .lines()
        .map(PathBuf::from)
        .filter(|file| root().join(file).exists())
        .collect();
    if files.is_empty() {
        return Err(io::Error::other("git lists no files"));
    }
    Ok(files)
}

fn read(file: &Path) -> io::Result<String> {
    fs::read_to_string(root().join(file))
}

fn is_rust(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending == "rs")
}

/// The texts of the sources of a crate: those in `src`.
fn sources(files: &[PathBuf], package: &Path) -> io::Result<Vec<String>> {
    let folder = package.join("src");
    files
        .iter()
        .filter(|file| is_rust(file) && file.starts_with(&folder))
        .map(|file| read(file))
        .collect()
}

/// Whether a line has a result whose error is a text.
fn has_text_error(line: &str) -> bool {
    let code = line.split("//").next().unwrap_or_default();
    code.contains("Result<") && code.contains(", String>")
}
