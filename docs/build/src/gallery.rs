//! The gallery: the descriptions of `examples/gallery` with their pictures, operation counts and commands.
//!
//! Each file begins with two lines about the mechanism, followed by its remark and options:
//!
//! ```text
//! /// Its name: what it is made of.
//! /// Its motion.
//! // remark: What is interesting about it, for readers of the two lines.
//! // draw: the options of `hamel draw`
//! // run: the options of `hamel simulate`
//! // keeps: the constants of this run, each with its largest relative change, as in `energy 1e-8, place 1e-9`
//! ```

use std::fmt::Write;
use std::fs;
use std::io::{Error, Result};
use std::num::NonZero;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::shell::Shell;

/// The folder of the descriptions.
pub const FOLDER: &str = "examples/gallery";

/// A description of the gallery.
#[derive(Clone, Debug)]
pub struct Exhibit {
    /// The name of its file, without the extension.
    pub name: String,
    /// The name of the mechanism.
    pub title: String,
    /// Its parts and its motion.
    pub about: String,
    /// The remark on the mechanism.
    pub remark: String,
    /// The options of `hamel draw`.
    pub draw: String,
    /// The options of `hamel simulate`.
    pub run: String,
    /// The quantities that are constant in this run, each with its largest relative change.
    pub keeps: Vec<(String, f64)>,
    /// The description without the lines above.
    pub text: String,
}

/// The results of the commands that show an exhibit.
pub struct ShownExhibit {
    /// Its picture.
    pub picture: String,
    /// Names of functions, each with its operations and its pairs of sine and cosine.
    pub counts: Vec<(&'static str, u64, u64)>,
}

/// The functions whose operations are shown, each with its label.
const COUNTED_FUNCTIONS: [(&str, &str); 4] = [
    ("accel", "accelerations"),
    ("inverse_dynamics", "forces"),
    ("mass_matrix", "mass matrix"),
    ("linearize", "linearisation"),
];

impl Exhibit {
    /// Reads the header of a file.
    ///
    /// # Errors
    /// If a part of it is missing.
    pub fn of(name: &str, file: &str) -> Result<Self> {
        let wrong = |what: &str| Error::other(format!("{FOLDER}/{name}.eom: {what}"));
        let mut lines = file.lines();
        let mut about = || lines.next().and_then(|line| line.strip_prefix("/// "));
        let (Some(first), Some(second)) = (about(), about()) else {
            return Err(wrong(
                "the first two lines say what it is, each behind `///`",
            ));
        };
        let said = |key: &str| {
            let begin = format!("// {key}: ");
            let found = file.lines().find_map(|line| line.strip_prefix(&begin));
            found.ok_or_else(|| wrong(&format!("a line `{begin}…` is missing")))
        };
        let (title, made) = first
            .split_once(": ")
            .ok_or_else(|| wrong("the first line is a name, a colon, and what it is made of"))?;
        let keeps = said("keeps")?.split(", ").map(|word| {
            let (name, change) = word.split_once(' ')?;
            Some((name.to_owned(), change.parse().ok()?))
        });
        let keeps: Option<Vec<(String, f64)>> = keeps.collect();
        let head = ["remark", "draw", "run", "keeps"].map(|key| format!("// {key}: "));
        let rest = file
            .lines()
            .filter(|line| !head.iter().any(|head| line.starts_with(head)));
        Ok(Exhibit {
            name: name.into(),
            title: title.into(),
            about: format!("{} {second}", capital(made)),
            remark: said("remark")?.into(),
            draw: said("draw")?.into(),
            run: said("run")?.into(),
            keeps: keeps
                .ok_or_else(|| wrong("`keeps` is a list as in `energy 1e-8, place 1e-9`"))?,
            text: rest.collect::<Vec<_>>().join("\n"),
        })
    }

    /// Returns the path of its file relative to the root of the repository.
    pub fn file(&self) -> String {
        format!("{FOLDER}/{}.eom", self.name)
    }

    /// Draws the mechanism and counts its operations.
    ///
    /// # Errors
    /// If a command fails.
    pub fn shown(&self, shell: &Shell) -> Result<ShownExhibit> {
        let file = self.file();
        let picture = shell.run(&format!("hamel draw {file} {}", self.draw))?;
        let table = shell.run(&format!("hamel ops {file}"))?;
        let counts = COUNTED_FUNCTIONS.iter().filter_map(|(function, name)| {
            let mut rows = table
                .lines()
                .map(|line| line.split_whitespace().collect::<Vec<_>>());
            let row = rows.find(|row| row.first() == Some(function))?;
            // The columns: add, mul, div, sqrt, sincos, other, flops, unshared.
            Some((*name, row.get(7)?.parse().ok()?, row.get(5)?.parse().ok()?))
        });
        Ok(ShownExhibit {
            picture,
            counts: counts.collect(),
        })
    }

    /// Renders its section of the page.
    pub fn section(&self, shown: &ShownExhibit) -> String {
        let mut text = format!(
            "## {}\n\n![{}](gallery/{}.svg)\n\n{} {}\n\n",
            self.title, self.title, self.name, self.about, self.remark
        );
        let names = shown.counts.iter().map(|(name, ..)| format!(" {name} |"));
        let _ = writeln!(text, "| operations of |{}", names.collect::<String>());
        let _ = writeln!(text, "|---|{}", "---:|".repeat(shown.counts.len()));
        let flops = shown
            .counts
            .iter()
            .map(|(_, flops, _)| format!(" {flops} |"));
        let _ = writeln!(
            text,
            "| add, multiply, divide |{}",
            flops.collect::<String>()
        );
        let pairs = shown.counts.iter().map(|(.., pairs)| format!(" {pairs} |"));
        let _ = writeln!(text, "| sine and cosine |{}", pairs.collect::<String>());
        let file = self.file();
        let _ = write!(
            text,
            "\n```sh\nhamel simulate {file} {} --plot {name}.svg\nhamel draw {file} {} --out {name}.svg\n```\n\n\
             <details>\n<summary>The description</summary>\n\n```text\n{}\n```\n\n</details>\n\n",
            self.run,
            self.draw,
            self.text,
            name = self.name,
        );
        text
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters
        .next()
        .map(|letter| letter.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// Reads all exhibits, sorted by the names of their files.
///
/// # Errors
/// If a file cannot be read, or its header is incomplete.
pub fn exhibits(root: &Path) -> Result<Vec<Exhibit>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(root.join(FOLDER))? {
        let path = entry?.path();
        if path.extension().is_some_and(|end| end == "eom") {
            names.extend(
                path.file_stem()
                    .map(|name| name.to_string_lossy().into_owned()),
            );
        }
    }
    names.sort();
    let all = names.iter().map(|name| {
        let path = root.join(FOLDER).join(name).with_extension("eom");
        Exhibit::of(name, &fs::read_to_string(path)?)
    });
    all.collect()
}

/// Applies a function to every exhibit, on all cores, and returns the results in the order of the exhibits.
pub fn for_all<T: Send>(exhibits: &[Exhibit], act: impl Fn(&Exhibit) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, T)>> = Mutex::default();
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    std::thread::scope(|scope| {
        for _ in 0..cores {
            scope.spawn(|| {
                while let Some((index, exhibit)) = {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    exhibits.get(index).map(|exhibit| (index, exhibit))
                } {
                    let one = act(exhibit);
                    let mut done = done.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
                    done.push((index, one));
                }
            });
        }
    });
    let mut done = done
        .into_inner()
        .unwrap_or_else(|poisoned| poisoned.into_inner());
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, one)| one).collect()
}

/// Renders the sections of the page, and writes the pictures to a folder.
///
/// # Errors
/// If a command fails, or a file cannot be written.
pub fn sections(root: &Path, shell: &Shell, pictures: &Path) -> Result<String> {
    let exhibits = exhibits(root)?;
    fs::create_dir_all(pictures)?;
    let mut text = String::new();
    for (exhibit, shown) in exhibits
        .iter()
        .zip(for_all(&exhibits, |one| one.shown(shell)))
    {
        let shown = shown?;
        let picture = pictures.join(&exhibit.name).with_extension("svg");
        fs::write(picture, &shown.picture)?;
        text += &exhibit.section(&shown);
    }
    Ok(text)
}
