//! The target of a path: a file that is replaced, or a stream that is written to.

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
    pub fn of(path: &Path) -> Result<Target, String> {
        let mut path = path.to_path_buf();
        for _ in 0..=MOST_LINKS {
            let folder_only = path.to_string_lossy().ends_with(is_separator);
            let (Some(name), false) = (path.file_name(), folder_only) else {
                return Err("it names a folder".into());
            };
            let folder = match path.parent() {
                Some(parent) if !parent.as_os_str().is_empty() => parent,
                _ => Path::new("."),
            };
            let folder = folder
                .canonicalize()
                .map_err(|error| format!("its folder {}: {error}", folder.display()))?;
            let place = folder.join(name);
            if let Some(stream) = Stream::descriptor(&folder, &place) {
                return stream.map(Target::Stream);
            }
            match fs::symlink_metadata(&place) {
                Err(error) if error.kind() == ErrorKind::NotFound => {
                    return Ok(Target::File { place, known: None });
                }
                Err(error) => return Err(error.to_string()),
                Ok(known) if known.is_symlink() => {
                    let link = fs::read_link(&place).map_err(|error| error.to_string())?;
                    path = folder.join(link);
                }
                Ok(known) if known.is_file() => {
                    let known = Some(known);
                    return Ok(Target::File { place, known });
                }
                Ok(known) => return Stream::of(place, known.file_type()).map(Target::Stream),
            }
        }
        Err("its symbolic links lead nowhere".into())
    }
}
