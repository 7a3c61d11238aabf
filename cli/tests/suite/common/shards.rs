//! Reads the bytes of the shards of a sweep.

use crate::table::shards;
use std::fs;
use std::path::{Path, PathBuf};

/// Names and bytes of the shards in a folder.
pub fn bytes(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let named = |path: PathBuf| {
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        (name, fs::read(path).expect("a shard"))
    };
    shards(folder).into_iter().map(named).collect()
}
