//! Every mechanism of the gallery is derived without a warning, its identities hold, its run conserves the quantities
//! that the file lists, and its section has a picture, counts and a remark.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use hamel_book::gallery::{Exhibit, exhibits, for_all};
use hamel_book::shell::Shell;
use hamel_engine::{OpenOptions, RunArrays, Session, Simulation, Stepping, WarningTexts};

/// Smallest number of mechanisms.
const MIN_MECHANISMS: usize = 24;
/// Largest size of all pictures, in bytes.
const MAX_PICTURE_BYTES: usize = 1_200_000;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Checks an exhibit; returns the errors, and its picture if there is a shell to run the commands.
fn seen(exhibit: &Exhibit, shell: Option<&Shell>) -> (Vec<String>, String) {
    let mut wrong = run(exhibit);
    let Some(shell) = shell else {
        return (wrong, String::new());
    };
    if let Err(error) = shell.run(&format!("hamel check {}", exhibit.file())) {
        wrong.push(error.to_string());
    }
    let shown = match exhibit.shown(shell) {
        Ok(shown) => shown,
        Err(error) => return (vec![error.to_string()], String::new()),
    };
    wrong.extend(picture(&shown.picture));
    if !shown
        .counts
        .iter()
        .any(|(name, flops, _)| *name == "accelerations" && *flops > 0)
    {
        wrong.push("its operations are not counted".into());
    }
    let section = exhibit.section(&shown);
    let parts = ["![", &exhibit.remark, "| operations of |", "hamel simulate"];
    for part in parts {
        if !section.contains(part) {
            wrong.push(format!("its section has no `{part}`"));
        }
    }
    let wrong = wrong
        .into_iter()
        .map(|what| format!("{}: {what}", exhibit.file()));
    (wrong.collect(), shown.picture)
}

/// Checks its run; returns the errors.
fn run(exhibit: &Exhibit) -> Vec<String> {
    let until = exhibit
        .run
        .strip_prefix("--until ")
        .and_then(|time| time.parse().ok());
    let Some(until) = until else {
        return vec![format!(
            "`{}` says nothing but the length of a run",
            exhibit.run
        )];
    };
    let path = root().join(exhibit.file());
    let warnings = Arc::new(WarningTexts::default());
    let session = match Session::open(&path, &OpenOptions::default(), warnings.clone()) {
        Ok(session) => session,
        Err(error) => return vec![error.to_string()],
    };
    let warnings = warnings.take();
    let mut wrong = Vec::new();
    if !warnings.is_empty() {
        wrong.push(warnings);
    }
    let start = session.start();
    let simulation = Simulation::new(Stepping::until(until));
    let motion = match session.simulate(&start, &simulation) {
        Ok(run) => RunArrays::of(&run),
        Err(error) => return vec![error.to_string()],
    };
    wrong.extend(motion.failure.as_ref().map(ToString::to_string));
    for (name, most) in &exhibit.keeps {
        match change(&motion, name) {
            None => wrong.push(format!("`{name}` is no quantity of the run")),
            Some(change) if change <= *most => {}
            Some(change) => wrong.push(format!("`{name}` changes by {change:e}, not by {most:e}")),
        }
    }
    let last = motion.x.rchunks(start.x.len()).next().unwrap_or_default();
    let moved = last.iter().zip(&start.x).any(|(x, start)| x != start);
    if !moved || exhibit.keeps.is_empty() {
        wrong.push("nothing moves, or nothing is kept".into());
    }
    wrong
}

/// Returns the largest change of a quantity, relative to its largest initial entry, or absolute if that is almost zero.
fn change(motion: &RunArrays, name: &str) -> Option<f64> {
    if name == "energy" {
        return Some(motion.energy_deviation);
    }
    let all = motion.invariants.iter().chain(&motion.outputs);
    let (_, shape, values) = all.into_iter().find(|(known, ..)| known == name)?;
    let entries = shape.entries();
    let first = values.get(..entries)?;
    let scale = first
        .iter()
        .fold(0.0, |most: f64, entry| most.max(entry.abs()));
    let scale = if scale > 1e-6 { scale } else { 1.0 };
    let away = values
        .chunks(entries)
        .flat_map(|values| values.iter().zip(first));
    let largest = away
        .map(|(value, first)| (value - first).abs())
        .fold(
            0.0,
            |a: f64, b| {
                if b.is_nan() { f64::NAN } else { a.max(b) }
            },
        );
    Some(largest / scale)
}

/// Checks a picture: it is well-formed, has parts, and its ellipses and texts are within its view box.
fn picture(text: &str) -> Vec<String> {
    let document = match roxmltree::Document::parse(text) {
        Ok(document) => document,
        Err(error) => return vec![format!("its picture is no XML: {error}")],
    };
    let size = document
        .root_element()
        .attribute("viewBox")
        .unwrap_or_default();
    let size: Vec<f64> = size
        .split(' ')
        .filter_map(|word| word.parse().ok())
        .collect();
    let [_, _, width, height] = size[..] else {
        return vec!["its picture has no view box".into()];
    };
    let number = |node: roxmltree::Node, name: &str| -> f64 {
        let value = node.attribute(name).and_then(|value| value.parse().ok());
        value.unwrap_or(f64::NAN)
    };
    let mut wrong = Vec::new();
    let mut parts = 0;
    let named = |node: &roxmltree::Node| node.has_tag_name("ellipse") || node.has_attribute("cx");
    for node in document.descendants().filter(named) {
        if node.has_tag_name("radialGradient") {
            continue;
        }
        parts += 1;
        let radii = if node.has_tag_name("circle") {
            ["r", "r"]
        } else {
            ["rx", "ry"]
        };
        let turn = node.attribute("transform").unwrap_or_default();
        let turn = turn
            .trim_start_matches("rotate(")
            .split(' ')
            .next()
            .unwrap_or_default();
        let (s, c) = turn.parse().unwrap_or(0.0_f64).to_radians().sin_cos();
        let [a, b] = radii.map(|name| number(node, name));
        let (x, y) = (number(node, "cx"), number(node, "cy"));
        let (right, up) = ((a * c).hypot(b * s), (a * s).hypot(b * c));
        let inside = x - right >= 0.0 && x + right <= width && y - up >= 0.0 && y + up <= height;
        if !inside {
            wrong.push(format!("an ellipse at {x}, {y} is not within its picture"));
        }
    }
    for node in document
        .descendants()
        .filter(|node| node.has_tag_name("text"))
    {
        let (x, y) = (number(node, "x"), number(node, "y"));
        if !(x >= 0.0 && x < width && y >= 0.0 && y < height) {
            wrong.push(format!("a text at {x}, {y} is not within its picture"));
        }
    }
    if parts == 0 || text.contains("NaN") || text.contains("inf") {
        wrong.push("its picture shows nothing, or no numbers".into());
    }
    wrong
}

#[test]
fn every_mechanism_of_the_gallery_holds() {
    let root = root();
    let exhibits = exhibits(&root).expect("the gallery");
    assert!(exhibits.len() >= MIN_MECHANISMS, "{}", exhibits.len());
    let titles: BTreeSet<&str> = exhibits.iter().map(|exhibit| &*exhibit.title).collect();
    assert_eq!(titles.len(), exhibits.len(), "two are called alike");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("gallery");
    let program = Path::new(env!("CARGO_BIN_EXE_hamel-book"));
    let shell = Shell::new(&root, &folder, program).expect("a folder");
    // Checks every run, and the commands of every third mechanism, or of all with `HAMEL_ATTACK`.
    let apart = if std::env::var_os("HAMEL_ATTACK").is_some() {
        1
    } else {
        3
    };
    let shown: BTreeSet<&str> = titles.iter().copied().step_by(apart).collect();
    let all = for_all(&exhibits, |exhibit| {
        seen(exhibit, shown.contains(&*exhibit.title).then_some(&shell))
    });
    let wrong: Vec<String> = all.iter().flat_map(|(wrong, _)| wrong.clone()).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let bytes: usize = all.iter().map(|(_, picture)| picture.len()).sum();
    assert!(bytes <= MAX_PICTURE_BYTES, "{bytes} bytes of pictures");
}

#[test]
fn what_a_file_does_not_say_is_missed() {
    let whole = "/// A thing: made of parts.\n/// It moves.\n// remark: Why.\n// draw: --time 1\n// run: --until 1\n// keeps: energy 1e-8\npub system A {}\n";
    let exhibit = Exhibit::of("a", whole).expect("an exhibit");
    assert_eq!(
        (&*exhibit.title, &*exhibit.about),
        ("A thing", "Made of parts. It moves.")
    );
    assert_eq!(exhibit.keeps, [("energy".to_owned(), 1e-8)]);
    for part in [
        "/// It moves.\n",
        ": made",
        "// remark: Why.\n",
        "// keeps: energy 1e-8\n",
        " 1e-8",
    ] {
        assert!(
            Exhibit::of("a", &whole.replace(part, "")).is_err(),
            "{part}"
        );
    }
}
