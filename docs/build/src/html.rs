//! Checks the pages that mdBook has made: each link leads to an existing file and place, and a page loads nothing from
//! the network.

use std::collections::BTreeSet;
use std::fs;
use std::io::Result;
use std::path::{Path, PathBuf};

/// Returns the broken links, each with its page, and the number of all links.
///
/// # Errors
/// If a page cannot be read.
pub fn broken(folder: &Path) -> Result<(Vec<String>, usize)> {
    let mut open = vec![folder.to_owned()];
    let (mut wrong, mut links) = (Vec::new(), 0);
    while let Some(path) = open.pop() {
        if path.is_dir() {
            for entry in fs::read_dir(&path)? {
                open.push(entry?.path());
            }
            continue;
        }
        // Skips the error page of a server, whose links are relative to the root of a site.
        if path.extension().is_none_or(|end| end != "html") || path.ends_with("404.html") {
            continue;
        }
        let text = fs::read_to_string(&path)?;
        for (attribute, target) in targets(&text) {
            links += 1;
            if let Some(why) = wrong_in(&path, attribute, target, &text) {
                wrong.push(format!("{}: {target}: {why}", path.display()));
            }
        }
    }
    Ok((wrong, links))
}

/// Returns the values of `href` and `src` in a page.
fn targets(text: &str) -> Vec<(&str, &str)> {
    let mut found = Vec::new();
    for tag in text.split('<').skip(1) {
        let Some((tag, _)) = tag.split_once('>') else {
            continue;
        };
        for attribute in ["href", "src"] {
            let begin = format!(" {attribute}=\"");
            let value = tag
                .split_once(&*begin)
                .and_then(|(_, rest)| rest.split_once('"'));
            if let Some((value, _)) = value {
                let kind = if tag.starts_with("a ") {
                    "a"
                } else {
                    attribute
                };
                found.push((kind, value));
            }
        }
    }
    found
}

fn wrong_in(page: &Path, kind: &str, target: &str, text: &str) -> Option<&'static str> {
    if target.contains("://") {
        return (kind != "a").then_some("is loaded from the network");
    }
    if target.starts_with("data:") || target.starts_with("mailto:") {
        return None;
    }
    let (file, place) = target.split_once('#').unwrap_or((target, ""));
    let path: PathBuf = match file {
        "" => page.to_owned(),
        file => page.parent()?.join(file),
    };
    if !path.exists() {
        return Some("there is no such file");
    }
    if place.is_empty() || path.extension().is_none_or(|end| end != "html") {
        return None;
    }
    let other = if path == page {
        text.to_owned()
    } else {
        fs::read_to_string(&path).ok()?
    };
    (!ids(&other).contains(place)).then_some("there is no such place on the page")
}

fn ids(text: &str) -> BTreeSet<&str> {
    let found = text.split(" id=\"").skip(1);
    found
        .filter_map(|rest| rest.split_once('"').map(|(id, _)| id))
        .collect()
}
