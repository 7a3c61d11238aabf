//! Draws public items of a crate at random, with the first lines of their documentation, for the test of names that
//! `docs/names.md` describes.

use crate::root;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Items in one test.
const DRAWN: usize = 10;

/// Prints items of the crate in a folder: the same ones for the same seed.
///
/// # Errors
///
/// Sources that cannot be read, and a folder without public items.
pub fn print(package: &str, seed: u64) -> io::Result<bool> {
    let mut files = Vec::new();
    find(&root().join(package).join("src"), &mut files)?;
    files.sort();
    let mut items = Vec::new();
    for file in files {
        let text = fs::read_to_string(&file)?;
        let place = file
            .strip_prefix(root())
            .unwrap_or(&file)
            .display()
            .to_string();
        items.extend(
            public_items(&text)
                .into_iter()
                .map(|(line, item)| (format!("{place}:{line}"), item)),
        );
    }
    if items.is_empty() {
        return Err(io::Error::other(format!("{package} has no public items")));
    }
    let mut random = seed.wrapping_mul(2).wrapping_add(1);
    for number in 1..=DRAWN.min(items.len()) {
        // Multiplier of Knuth's MMIX; the upper bits are the random ones.
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let drawn = (random >> 33) as usize % items.len();
        let (place, item) = items.swap_remove(drawn);
        println!(
            "{number:2}. {}\n    {}\n    ({place})",
            item.declaration, item.summary
        );
    }
    Ok(true)
}

/// A public item as a reader of an index sees it.
struct Item {
    declaration: String,
    summary: String,
}

/// The public items of a source with their lines, in order; fields and items of tests are left out.
fn public_items(text: &str) -> Vec<(usize, Item)> {
    let (mut items, mut owner, mut documentation) = (Vec::new(), None, Vec::new());
    for (index, line) in text.lines().enumerate() {
        if line == "#[cfg(test)]" {
            break;
        } else if line.starts_with("impl") || line.starts_with("pub trait ") {
            owner = owner_of(line);
        } else if line == "}" {
            owner = None;
        }
        let line = line.trim_start();
        if let Some(rest) = line.strip_prefix("///") {
            documentation.push(rest.trim());
        } else if !line.starts_with("#[") {
            let declared = line.strip_prefix("pub ").and_then(declaration);
            if let (Some((kind, name)), Some(summary)) = (declared, first_sentence(&documentation))
            {
                let owner = owner.filter(|owner| line.starts_with("pub ") && *owner != name);
                let path = owner.map_or(name.to_string(), |owner| format!("{owner}::{name}"));
                items.push((
                    index + 1,
                    Item {
                        declaration: format!("{kind} {path}"),
                        summary,
                    },
                ));
            }
            documentation.clear();
        }
    }
    items
}

/// The kind and the name of an item, from its declaration without `pub`.
fn declaration(text: &str) -> Option<(&str, &str)> {
    const KINDS: [&str; 8] = [
        "fn", "struct", "enum", "trait", "type", "static", "mod", "const",
    ];
    let words: Vec<&str> = text
        .split(|letter: char| !letter.is_alphanumeric() && letter != '_')
        .filter(|word| !word.is_empty())
        .take(4)
        .collect();
    // Fields have no kind in front; in `const fn f` the later kind counts.
    words.first().filter(|word| KINDS.contains(word))?;
    let place = words
        .iter()
        .take(3)
        .rposition(|word| KINDS.contains(word))?;
    Some((words[place], words.get(place + 1)?))
}

/// The type of an `impl` block, or the name of a trait.
fn owner_of(line: &str) -> Option<&str> {
    let after = line.split(" for ").last()?;
    let after = after.strip_prefix("pub trait ").unwrap_or(after);
    let after = match after.strip_prefix("impl<") {
        Some(generics) => generics.split_once("> ")?.1,
        None => after.strip_prefix("impl ").unwrap_or(after),
    };
    after
        .split(|letter: char| !letter.is_alphanumeric() && letter != '_')
        .next()
}

/// The first sentence of a documentation.
fn first_sentence(lines: &[&str]) -> Option<String> {
    let paragraph: Vec<&str> = lines
        .iter()
        .copied()
        .take_while(|line| !line.is_empty())
        .collect();
    let text = paragraph.join(" ");
    let end = text.find(". ").map_or(text.len(), |place| place + 1);
    (!text.is_empty()).then(|| text[..end].to_string())
}

/// All Rust sources below a folder.
fn find(folder: &Path, found: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            find(&path, found)?;
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::public_items;

    #[test]
    fn items_have_their_names_and_summaries() {
        let text = "/// Adds two\n/// numbers. Wraps.\n///\n/// More.\n#[must_use]\npub const fn add(a: u8) {}\n/// Hidden.\nfn own() {}\npub fn bare() {}\nimpl<T: Clone> From<T> for Sum<T> {\n    /// Takes.\n    pub fn take() {}\n}\n";
        let found: Vec<_> = public_items(text)
            .into_iter()
            .map(|(line, item)| (line, item.declaration, item.summary))
            .collect();
        let expected = [
            (6, "fn add", "Adds two numbers."),
            (12, "fn Sum::take", "Takes."),
        ];
        let expected =
            expected.map(|(line, item, summary)| (line, item.to_string(), summary.to_string()));
        assert_eq!(found, expected);
    }
}
