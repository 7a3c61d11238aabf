//! The README and the book: the commands of each page run in order and unchanged, in a folder that contains only the
//! files made by the page and the descriptions of the repository; links are valid; every chapter is in the table of
//! contents.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use hamel_book::page::{CRATES, blocks, own};
use hamel_book::shell::Shell;

/// Largest number of lines of a README.
const MAX_README_LINES: usize = 150;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns README and chapters, with their texts.
fn pages() -> Vec<(PathBuf, String)> {
    let root = root();
    let chapters = hamel_book::build::pages(&root).expect("the book");
    let chapters = chapters
        .into_iter()
        .map(|(path, text)| (root.join("docs/book/src").join(path), text));
    let others = ["README.md", "bindings/python/README.md"].map(|name| root.join(name));
    let others = others.map(|path| (path.clone(), fs::read_to_string(path).expect("a page")));
    chapters.chain(others).collect()
}

#[test]
fn commands_run_as_they_stand() {
    let pages = pages();
    let next = AtomicUsize::new(0);
    // Pages are independent.
    let ran = std::thread::scope(|scope| {
        let workers = [(); 2].map(|()| {
            let work = || std::iter::from_fn(|| pages.get(next.fetch_add(1, Relaxed)));
            scope.spawn(move || work().map(|(page, text)| run(page, text)).collect())
        });
        let ran = workers.map(|worker| -> Vec<[usize; 2]> { worker.join().expect("all run") });
        ran.concat()
    });
    let [commands, made] = [0, 1].map(|i| ran.iter().map(|counts| counts[i]).sum::<usize>());
    assert!(made > 0 || !everything(), "no page makes a crate");
    assert!(commands > 25, "{commands}");
}

/// Whether to make the crates of pages, and all members of sweeps: with `HAMEL_ATTACK`, as in `cargo xtask ci`.
fn everything() -> bool {
    std::env::var_os("HAMEL_ATTACK").is_some()
}

/// Runs the commands of a page; returns the numbers of calls of `hamel` and of crates made.
fn run(page: &Path, text: &str) -> [usize; 2] {
    let program = Path::new(env!("CARGO_BIN_EXE_hamel-book"));
    let mut script: String = blocks(text, "sh").into_iter().map(own).collect();
    // Runs a tenth of the members of sweeps.
    if !everything() {
        script = script.replace("000 --until", "00 --until");
    }
    // Crates are compiled from scratch, together with the generator.
    let crates = match everything() {
        true => blocks(text, CRATES).concat(),
        false => String::new(),
    };
    if script.is_empty() && crates.is_empty() {
        return [0, 0];
    }
    let name = page.strip_prefix(root()).expect("of the repository");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("book");
    let shell = Shell::new(&root(), &folder.join(name.with_extension("")), program);
    let shell = shell.expect("a folder");
    if let Err(error) = shell.run(&script) {
        panic!("{}:\n{error}", page.display());
    }
    if !crates.is_empty() {
        // The crates of all pages share a folder.
        static ONE: Mutex<()> = Mutex::new(());
        let _one = ONE.lock().expect("no page panics with its crates");
        let printed = shell.run_beside(&crates);
        let printed = printed.unwrap_or_else(|error| panic!("{}:\n{error}", page.display()));
        assert!(
            !printed.is_empty(),
            "{}: the crate says nothing",
            page.display()
        );
    }
    [
        script.matches("hamel ").count(),
        usize::from(!crates.is_empty()),
    ]
}

/// Every block of a page is compiled or run by some test.
#[test]
fn nothing_is_only_shown() {
    let programs = fs::read_to_string(root().join("docs/build/src/lib.rs")).expect("the library");
    let python =
        fs::read_to_string(root().join("bindings/python/tests/test_pages.py")).expect("tests");
    let mut wrong = Vec::new();
    for (page, text) in pages() {
        let root = root();
        let name = page.strip_prefix(&root).expect("of the repository");
        let name = name.display().to_string();
        let fences = text.lines().filter_map(|line| line.strip_prefix("```"));
        for kind in fences.step_by(2) {
            let held = match kind {
                // By `commands_run_as_they_stand`, and by tests/complete.rs.
                "sh" | CRATES | "eom" | "ebnf" => true,
                "toml" => name == "README.md" && text.contains("path = \"../hamel/runtime\""),
                // By the doc tests of this crate.
                "rust" | "rust,no_run" => {
                    programs.contains(name.strip_prefix("docs/").unwrap_or(&name))
                }
                // By tests/emitted/tests/c.rs.
                "c" => name == "docs/book/src/front-ends.md",
                // By bindings/python/tests/test_pages.py and tests/sweep/readers.py.
                "python" => python.contains(&name) || name == "docs/book/src/ensembles.md",
                _ => false,
            };
            if !held {
                wrong.push(format!("{name}: {kind:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn links_lead_somewhere() {
    let mut links = 0;
    for (page, text) in pages() {
        for rest in text.split("](").skip(1) {
            let target = rest.split([')', '#']).next().unwrap_or_default();
            if target.is_empty() || target.contains("://") {
                continue;
            }
            let folder = page.parent().expect("a folder");
            assert!(folder.join(target).exists(), "{}: {target}", page.display());
            links += 1;
        }
    }
    assert!(links > 20, "{links}");
}

#[test]
fn every_chapter_is_listed() {
    let folder = root().join("docs/book/src");
    let list = fs::read_to_string(folder.join("SUMMARY.md")).expect("a list");
    for (page, _) in pages() {
        let Ok(name) = page.strip_prefix(&folder) else {
            continue;
        };
        let name = name.display().to_string();
        assert!(
            name == "SUMMARY.md" || list.contains(&format!("({name})")),
            "{name}"
        );
    }
}

#[test]
fn the_readme_is_short() {
    let text = fs::read_to_string(root().join("README.md")).expect("a README");
    assert!(text.lines().count() <= MAX_README_LINES);
}
