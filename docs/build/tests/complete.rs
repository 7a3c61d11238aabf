//! The reference is complete: it has all statements, functions, joints, options and errors of the code.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use hamel_book::build::{Book, pages};
use hamel_book::errors::{examples, sites};
use hamel_book::lists::{arguments, help, spelling, subcommands};
use hamel_book::page::{blocks, section};
use hamel_book::rare::RARE;
use hamel_codegen::functions::FunctionId;
use hamel_codegen::generate::from_file;
use hamel_codegen::render::render;
use hamel_codegen::vocabulary;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns the pages of the reference as written, and with their directives expanded.
fn reference() -> (String, String) {
    let root = root();
    let book = Book::new(&root, Path::new(""));
    let (mut written, mut built) = (String::new(), String::new());
    for (path, text) in pages(&root).expect("pages") {
        if path.starts_with("reference") {
            built += &book.page(&path, &text, Path::new("")).expect("a page");
            written += &text;
        }
    }
    (written, built)
}

/// Every statement has a section with its grammar, an example of its use, and its errors.
#[test]
fn every_statement_has_a_section() {
    let (written, _) = reference();
    let mut missing = Vec::new();
    for (word, _) in vocabulary::statements() {
        let Some(section) = section(&written, word) else {
            missing.push(format!("`{word}` has no section"));
            continue;
        };
        let begins = |block: &&str| block.split_whitespace().any(|found| found == word);
        let has = [
            (blocks(section, "ebnf").iter().any(begins), "no grammar"),
            (
                blocks(section, "eom").iter().any(begins),
                "no example of it",
            ),
            (
                section.contains(&format!("<!-- errors: {word} -->")),
                "no errors",
            ),
        ];
        let lacks = has.iter().filter(|(found, _)| !found);
        missing.extend(lacks.map(|(_, what)| format!("`{word}` has {what}")));
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

/// Every section is about an existing statement.
#[test]
fn no_section_is_about_a_statement_that_does_not_exist() {
    let (written, _) = reference();
    let known: BTreeSet<&str> = vocabulary::statements().map(|(word, _)| word).collect();
    for rest in written.split("<!-- errors: ").skip(1) {
        let word = rest.split(" -->").next().unwrap_or_default();
        assert!(word == "system" || known.contains(word), "{word}");
    }
}

#[test]
fn joints_and_bodies_are_complete() {
    let (written, _) = reference();
    let of = |word: &str| section(&written, word).expect("a section").to_owned();
    let (joint, body) = (of("joint"), of("body"));
    for kind in vocabulary::kinds_of_joints() {
        assert!(joint.contains(&format!("| `{kind}")), "the joint {kind}");
    }
    for (field, _) in vocabulary::fields_of_joints() {
        assert!(joint.contains(&format!("| `{field} ")), "{field} of joints");
    }
    for (field, _) in vocabulary::fields_of_bodies() {
        assert!(body.contains(&format!("| `{field} ")), "{field} of bodies");
    }
}

#[test]
fn functions_and_options_are_complete() {
    let (_, built) = reference();
    for (name, _) in vocabulary::functions() {
        assert!(built.contains(&format!("| `{name}` |")), "{name}");
    }
    for id in FunctionId::ALL {
        let name = id.row().name;
        assert!(built.contains(&format!("| `{name}` |")), "{name}");
    }
    let mut options = 0;
    for command in subcommands() {
        let heading = format!("## `hamel {}`", command.get_name());
        assert!(built.contains(&heading), "{heading}");
        assert!(command.get_about().is_some(), "{heading}");
        for argument in arguments(&command) {
            let spelling = spelling(argument);
            assert!(built.contains(&format!("| `{spelling}` |")), "{spelling}");
            assert!(!help(argument).is_empty(), "{heading} {spelling}");
            options += 1;
        }
    }
    assert!(options > 50, "{options}");
}

/// The examples are complete descriptions, which the generator accepts without warnings.
#[test]
fn examples_of_the_reference_are_derived() {
    let folder = root().join("docs/book/given");
    let open = &mut |name: &str| std::fs::read_to_string(folder.join(name));
    let (mut count, mut wrong) = (0, String::new());
    for (path, text) in pages(&root()).expect("pages") {
        for block in blocks(&text, "eom") {
            count += 1;
            let name = path.display().to_string();
            match from_file(block, open) {
                Ok(generated) => {
                    for warning in &generated.model.warnings {
                        wrong += &format!("{name}: {}\n{block}\n", warning.message);
                    }
                }
                Err(errors) => wrong += &render(&errors, &name, block, false),
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
    assert!(count >= vocabulary::statements().count(), "{count}");
}

/// Every place in the generator that creates a message has an example on the page of errors, or an entry among the rare
/// ones.
#[test]
fn every_error_has_an_example() {
    let examples = examples(&root());
    let seen: BTreeSet<_> = examples.iter().map(|example| &example.site).collect();
    let sites = sites(&root(), "codegen");
    let mut missing = Vec::new();
    let mut used = BTreeSet::new();
    for (site, code) in sites.iter().filter(|(site, _)| !seen.contains(site)) {
        let row = (0..RARE.len()).find(|row| {
            let (file, words, ..) = RARE[*row];
            !used.contains(row) && site.0.ends_with(file) && code.contains(words)
        });
        match row {
            Some(row) => drop(used.insert(row)),
            None => missing.push(format!("{}:{}: {code}", site.0, site.1)),
        }
    }
    let unknown: Vec<_> = seen
        .iter()
        .filter(|site| !sites.contains_key(**site))
        .collect();
    assert!(unknown.is_empty(), "{unknown:?}");
    assert!(
        missing.is_empty(),
        "{} have no example:\n{}",
        missing.len(),
        missing.join("\n")
    );
    let idle = (0..RARE.len()).filter(|row| !used.contains(row));
    let idle: Vec<_> = idle.map(|row| (RARE[row].0, RARE[row].1)).collect();
    assert!(
        idle.is_empty(),
        "these have an example, or are gone: {idle:?}"
    );
    for example in &examples {
        assert!(!example.help.is_empty(), "{}", example.shown);
    }
}
