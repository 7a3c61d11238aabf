//! Writes files atomically: a file is written as a whole or not at all.
//!
#![doc = include_str!("../README.md")]
//!
//! # Guarantees
//!
//! [`write()`] writes a temporary file next to the target, flushes it to the disk, and renames it to the target. So the
//! target never contains half a text, and a full disk or a killed process leaves the old file as it was. The file keeps
//! its permissions and, where that is allowed, its owner. A symbolic link stays, and the file to which it leads is
//! replaced. Other hard links to the old file keep the old text.
//!
//! Only regular files are replaced. Devices, descriptors such as `/dev/stdout`, and pipes that have a reader are
//! written to; folders and everything else are refused.

pub mod number;
mod reason;
mod replace;
mod stream;
mod target;

pub use reason::Reason;
use std::error::Error;
use std::fmt;
use std::fs;
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};
use target::Target;

/// The error that a file was not written, with its path and the reason.
#[derive(Debug)]
pub struct Unwritten {
    /// Path of the file.
    pub path: PathBuf,
    /// Reason why it was not written.
    pub reason: Reason,
}

impl fmt::Display for Unwritten {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot write {}: {}", self.path.display(), self.reason)
    }
}

impl Error for Unwritten {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.reason.source()
    }
}

/// Writes a text to a file.
///
/// # Errors
/// If it cannot be written; an old file is then as it was.
pub fn write(path: &Path, text: &str) -> Result<(), Unwritten> {
    write_bytes(path, text.as_bytes())
}

/// Writes bytes, which need not be text, to a file.
///
/// # Errors
/// As [`write()`].
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Unwritten> {
    let unwritten = |reason: Reason| Unwritten {
        path: path.to_path_buf(),
        reason,
    };
    match Target::of(path).map_err(unwritten)? {
        Target::File { place, known } => replace::replace(&place, known.as_ref(), bytes),
        Target::Stream(stream) => stream.write(bytes),
    }
    .map_err(unwritten)
}

/// Whether a file contains exactly this text. Anything but a regular file is not read, since it may never end.
///
/// # Errors
/// If there is no such regular file, or it cannot be read.
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
    // Reads no more than is compared, in case the file grows meanwhile.
    let most = metadata.len() + 1;
    fs::File::open(path)?.take(most).read_to_end(&mut known)?;
    Ok(known == text.as_bytes())
}

/// Writes a text unless the file contains it already, in which case its modification time stays.
///
/// # Errors
/// As [`write()`].
pub fn update(path: &Path, text: &str) -> Result<(), Unwritten> {
    match holds(path, text) {
        Ok(true) => Ok(()),
        _ => write(path, text),
    }
}
