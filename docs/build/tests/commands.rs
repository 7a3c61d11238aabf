//! The README and the book: the commands of each page run in order and unchanged, in a folder that contains only the
//! files made by the page and the descriptions of the repository; recipes print the numbers of their formulas; links are
//! valid; every chapter is in the table of contents.

use std::f64::consts::PI;
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

/// The numbers for which the recipes give formulas are those that their commands print.
#[test]
fn recipes_print_what_their_formulas_say() {
    let g = 9.81_f64;
    let slope = 0.2_f64;
    let path = (2.0 + (PI * 0.01).powi(2) / 12.0) / (0.3 * g);
    let creep = 0.01 * (slope.tan() / 0.3).atanh();
    let (beta, omega) = (30.0, 39_100_f64.sqrt());
    let angle = (2.0 * beta * omega).atan2(omega * omega - beta * beta);
    let restitution = (-beta / omega * (PI - angle)).exp();
    let pull = 75.0 * g + ((75.0 * g).powi(2) + 2.0 * 90.0 * 75.0 * g * 15.0).sqrt();
    let (fall, swing) = ((30.0 * g).sqrt(), (90.0 / 75.0_f64).sqrt());
    let lowest = fall / g + (PI - (fall * swing / g).atan()) / swing;
    let terminal = (2.0 * 0.145 * g / (1.2 * 0.4 * PI * 0.0365_f64.powi(2))).sqrt();
    let falls = g * 3.0 / terminal;
    let drop = terminal.powi(2) / g * falls.cosh().ln();
    let current = 20.0 * g * 0.05 / (30.0 * 0.06);
    let lift = 0.05 * (24.0 - 0.5 * current) / (30.0 * 0.06);
    let rope = (3.0 / (2.0 * g)).atan();
    let sway = g * 6.0 / (3.0 * rope.cos() * (4.0 + 2.0 * rope.sin().powi(2)));
    let door = 2.0 / (2.0 * 6.75);
    // The larger eigenvalue of the side motion of the car at a speed.
    let car = |u: f64| {
        let front = 0.9 * 1200.0 * g / 2.0 * 10.0 * 1.3;
        let (sum, moment) = (1.8 * front / u, 1.3 * 0.2 * front / u);
        let (side, yaw) = (-sum / 1200.0, -1.3 * 1.3 * sum / 1500.0);
        let determinant = side * yaw - (u + moment / 1200.0) * moment / 1500.0;
        let trace = side + yaw;
        (trace + (trace * trace - 4.0 * determinant).sqrt()) / 2.0
    };
    // A part of the block, the word that its line contains, the place of the number in the line, the formula.
    let claims = [
        ("block.eom --until", "x", 1, path),
        ("block.eom --at", "x_dot", 1, creep),
        ("bristle.eom", "z", 1, 2.0 * g * slope.sin() / 1e5),
        ("bristle.eom", "friction", 2, -2.0 * g * slope.sin()),
        ("stop.eom", "x_dot", 1, -restitution),
        ("backlash.eom", "w1", 1, -0.6),
        ("backlash.eom", "w2", 1, 0.4),
        ("bungee.eom", "z", 1, -15.0 - pull / 90.0),
        ("bungee.eom", "pull", 2, pull),
        ("bungee.eom", "t", 2, lowest),
        ("ball.eom", "v", 3, -terminal * falls.tanh()),
        ("ball.eom", "r", 3, -drop),
        ("road.eom", "amplitude", 2, 0.02),
        ("slow.json", "", 0, car(30.0)),
        ("quick.json", "", 0, car(40.0)),
        ("winch.eom", "i", 1, current),
        ("winch.eom", "lift", 2, lift),
        ("pid.eom --until", "z", 1, 1.0),
        ("pid.eom --until", "integral", 1, 10.0 * g),
        ("gyro.eom", "error", 2, -0.09),
        ("gyro.eom", "felt", 1, 0.3),
        ("gyro.eom", "radial", 2, -2.4),
        ("cylinder.eom", "x_dot", 1, 0.1),
        ("cylinder.eom", "pb", 1, 1.44e6),
        ("cylinder.eom", "pa", 1, (20_000.0 + 1728.0 + 200.0) / 2e-3),
        ("trim crane.eom", "rope", 1, -rope),
        ("trim crane.eom", "±", 1, sway.sqrt()),
        ("trim crane.eom", "F", 1, 1000_f64.sqrt()),
        ("door.eom", "±", 0, -door),
        ("door.eom", "±", 2, (4.0 / 6.75 - door * door).sqrt()),
    ];
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("recipes");
    let program = Path::new(env!("CARGO_BIN_EXE_hamel-book"));
    let mut printed = Vec::new();
    for name in ["forces", "drives", "index"] {
        let page = root().join(format!("docs/book/src/recipes/{name}.md"));
        let text = fs::read_to_string(page).expect("a page");
        let shell = Shell::new(&root(), &folder.join(name), program).expect("a folder");
        for block in blocks(&text, "sh") {
            printed.push((block.to_owned(), shell.run(&own(block)).expect("it runs")));
        }
    }
    for (part, word, place, formula) in claims {
        let block = printed.iter().find(|(block, _)| block.contains(part));
        let (_, text) = block.unwrap_or_else(|| panic!("no block has {part}"));
        let lines = text.lines().map(|line| line.split_whitespace().collect());
        let has = |words: &Vec<&str>| word.is_empty() || words.contains(&word);
        let numbers = lines
            .filter(has)
            .filter_map(|words| words.get(place)?.parse().ok());
        // Six digits are printed.
        let agrees = |number: f64| (number - formula).abs() <= 6e-6 * formula.abs();
        assert!(
            numbers.into_iter().any(agrees),
            "{part} {word}: {formula}\n{text}"
        );
    }
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
