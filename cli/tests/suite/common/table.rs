//! Reads the shards of a sweep as a table, and creates folders for them.

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// All rows of a folder, sorted by index.
#[derive(Debug, PartialEq)]
pub struct Table {
    /// Names of the numbers, `index` first.
    pub names: Vec<String>,
    /// Numbers; `None` where a member has no result.
    pub rows: Vec<Vec<Option<f64>>>,
    /// Reasons of failures.
    pub errors: Vec<Option<String>>,
}

impl Table {
    /// Reads all shards.
    pub fn read(folder: &Path) -> Self {
        let mut names = Vec::new();
        let mut rows: Vec<(Vec<Option<f64>>, Option<String>)> = Vec::new();
        for path in shards(folder) {
            let file = File::open(&path).expect("a shard");
            let reader = SerializedFileReader::new(file).expect("Parquet");
            for row in reader.get_row_iter(None).expect("rows") {
                let row = row.expect("a row");
                let mut error = None;
                let mut numbers = Vec::new();
                names.clear();
                for (name, field) in row.get_column_iter() {
                    match field {
                        Field::Str(text) => error = Some(text.clone()),
                        _ if name == "error" => {}
                        Field::Long(number) => numbers.push(Some(*number as f64)),
                        Field::Double(number) => numbers.push(Some(*number)),
                        Field::Null => numbers.push(None),
                        other => panic!("{name}: {other:?}"),
                    }
                    if name != "error" {
                        names.push(name.clone());
                    }
                }
                rows.push((numbers, error));
            }
        }
        rows.sort_by(|(a, _), (b, _)| a[0].partial_cmp(&b[0]).expect("numbers"));
        let (rows, errors) = rows.into_iter().unzip();
        Table {
            names,
            rows,
            errors,
        }
    }

    /// A column that may have missing values.
    pub fn optional(&self, name: &str) -> Vec<Option<f64>> {
        let place = self.names.iter().position(|known| known == name);
        let place = place.unwrap_or_else(|| panic!("no {name} in {:?}", self.names));
        self.rows.iter().map(|row| row[place]).collect()
    }

    /// A column without missing values.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let all = self.optional(name);
        all.into_iter().map(|value| value.expect(name)).collect()
    }
}

/// The shards in a folder, sorted.
pub fn shards(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let is_shard = |path: &PathBuf| path.extension().is_some_and(|end| end == "parquet");
    let mut paths: Vec<PathBuf> = paths.filter(is_shard).collect();
    paths.sort();
    paths
}

/// A folder for one test, which does not exist yet.
pub fn fresh(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("sweep")
        .join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.parent().expect("a folder")).expect("a folder");
    folder
}
