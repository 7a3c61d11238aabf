//! Files that are written whole or not at all.
//!
#![doc = include_str!("../README.md")]
//!
//! # What is guaranteed
//!
//! [`write()`] writes a temporary file next to the target, brings it to the disk, and gives it the target's name: at no
//! moment does the name stand for half a text, and a full disk or a kill leaves the old file as it was. The file keeps
//! its permissions and, where that is allowed, its owner. A symbolic link stays, and the file that it leads to is
//! replaced. Other hard links to the old file keep the old text.
//!
//! Only regular files are replaced. Devices, descriptors such as `/dev/stdout`, and pipes that somebody reads from are
//! written to; folders and everything else are refused.

mod replace;
mod stream;
mod target;

use std::fmt;
use std::fs;
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};
use target::Target;

/// Why a file was not written.
#[derive(Debug)]
pub struct Unwritten {
    path: PathBuf,
    why: String,
}

impl fmt::Display for Unwritten {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot write {}: {}", self.path.display(), self.why)
    }
}

impl std::error::Error for Unwritten {}

/// Writes a text.
///
/// # Errors
/// Where it cannot be written; an old file is then as it was.
pub fn write(path: &Path, text: &str) -> Result<(), Unwritten> {
    write_bytes(path, text.as_bytes())
}

/// Writes what is no text.
///
/// # Errors
/// As [`write()`].
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Unwritten> {
    let unwritten = |why: String| Unwritten {
        path: path.to_path_buf(),
        why,
    };
    match Target::of(path).map_err(unwritten)? {
        Target::File { place, known } => replace::replace(&place, known.as_ref(), bytes),
        Target::Stream(stream) => stream.write(bytes),
    }
    .map_err(unwritten)
}

/// Whether a file holds this text and nothing else. What is no file is not read, as it may never end.
///
/// # Errors
/// Where there is no such file, or it cannot be read.
pub fn holds(path: &Path, text: &str) -> io::Result<bool> {
    let metadata = fs::metadata(path)?;
    if metadata.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if !metadata.is_file() {
        return Err(io::Error::other("it is no regular file"));
    }
    if metadata.len() != text.len() as u64 {
        return Ok(false);
    }
    let mut known = Vec::with_capacity(text.len());
    // No more than would be compared, should the file grow meanwhile.
    let most = metadata.len() + 1;
    fs::File::open(path)?.take(most).read_to_end(&mut known)?;
    Ok(known == text.as_bytes())
}

/// Writes a text unless the file holds it already: its time of change then stays.
///
/// # Errors
/// As [`write()`].
pub fn update(path: &Path, text: &str) -> Result<(), Unwritten> {
    match holds(path, text) {
        Ok(true) => Ok(()),
        _ => write(path, text),
    }
}
