//! The target of a path: a file that is replaced, or a stream that is written to.

use crate::reason::Reason;
use crate::stream::Stream;
use std::fs::{self, Metadata};
use std::io::ErrorKind;
use std::path::{Path, PathBuf, is_separator};

/// Largest number of symbolic links from a path to its file, as in the Linux kernel.
const MOST_LINKS: usize = 40;

/// The target of a path.
pub enum Target {
    /// A regular file that exists, or a file that does not exist yet.
    File {
        /// Its path, without symbolic links.
        place: PathBuf,
        /// Metadata of the file, if it exists.
        known: Option<Metadata>,
    },
    /// A device, pipe or descriptor, which is written to.
    Stream(Stream),
}

impl Target {
    /// Follows symbolic links to the target of a path; the error says why it cannot be written.
    pub fn of(path: &Path) -> Result<Target, Reason> {
        let mut path = path.to_path_buf();
        for _ in 0..=MOST_LINKS {
            let folder_only = path.to_string_lossy().ends_with(is_separator);
            let (Some(name), false) = (path.file_name(), folder_only) else {
                return Err(Reason::FolderName);
            };
            let folder = match path.parent() {
                Some(parent) if !parent.as_os_str().is_empty() => parent,
                _ => Path::new("."),
            };
            let folder = folder.canonicalize().map_err(|source| Reason::Parent {
                folder: folder.to_path_buf(),
                source,
            })?;
            let place = folder.join(name);
            if let Some(stream) = Stream::descriptor(&folder, &place) {
                return stream.map(Target::Stream);
            }
            match fs::symlink_metadata(&place) {
                Err(error) if error.kind() == ErrorKind::NotFound => {
                    return Ok(Target::File { place, known: None });
                }
                Err(error) => return Err(error.into()),
                Ok(known) if known.is_symlink() => {
                    let link = fs::read_link(&place)?;
                    path = folder.join(link);
                }
                Ok(known) if known.is_file() => {
                    let known = Some(known);
                    return Ok(Target::File { place, known });
                }
                Ok(known) => return Stream::of(place, known.file_type()).map(Target::Stream),
            }
        }
        Err(Reason::EndlessLinks)
    }
}
