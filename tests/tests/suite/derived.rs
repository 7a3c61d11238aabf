//! The models of `models/` and `models/multibody/`, each derived once for all tests that use it.

use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::render::render;
use hamel_codegen::tables::{Table, Tables};
use std::path::Path;
use std::sync::{LazyLock, OnceLock};

/// A model and, once a test has requested it, its derivation.
pub struct Derived {
    pub name: String,
    pub text: String,
    once: OnceLock<Generated>,
    tables: OnceLock<Tables>,
}

impl Derived {
    pub fn generated(&self) -> &Generated {
        self.once.get_or_init(|| {
            from_text(&self.text).unwrap_or_else(|errors| {
                panic!("{}", render(&errors, &self.name, &self.text, false))
            })
        })
    }

    /// Returns all of its tables.
    pub fn tables(&self) -> &Tables {
        self.tables
            .get_or_init(|| self.generated().tables(&every_table()).expect("derivable"))
    }
}

/// Returns every kind of table.
fn every_table() -> Vec<Table> {
    let names = Table::names().into_iter();
    names
        .map(|name| Table::parse(name).expect("known"))
        .collect()
}

fn read(folder: &str) -> Vec<Derived> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "eom") {
            let name = path.file_stem().expect("a name").to_string_lossy();
            found.push(Derived {
                name: name.into_owned(),
                text: std::fs::read_to_string(&path).expect("readable"),
                once: OnceLock::new(),
                tables: OnceLock::new(),
            });
        }
    }
    found.sort_by(|a, b| a.name.cmp(&b.name));
    found
}

static MODELS: LazyLock<Vec<Derived>> = LazyLock::new(|| read("models"));
static MULTIBODY: LazyLock<Vec<Derived>> = LazyLock::new(|| read("models/multibody"));

/// Returns the models of `models/`, in the order of their names.
pub fn models() -> &'static [Derived] {
    assert!(MODELS.len() >= 60, "the models have gone");
    &MODELS
}

/// Returns the models of `models/` and `models/multibody/`, in the order of their names.
pub fn all() -> Vec<&'static Derived> {
    let mut all: Vec<&Derived> = models().iter().chain(MULTIBODY.iter()).collect();
    all.sort_by(|a, b| a.name.cmp(&b.name));
    all
}

/// Returns a model of `models/`.
pub fn model(name: &str) -> &'static Derived {
    let found = models().iter().find(|model| model.name == name);
    found.unwrap_or_else(|| panic!("no model `{name}`"))
}
