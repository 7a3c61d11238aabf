//! Reasons why a file is not written.

use std::error::Error;
use std::fmt;
use std::io;
use std::path::PathBuf;

/// Reason why a file is not written.
#[derive(Debug)]
pub enum Reason {
    /// The path ends like that of a folder.
    FolderName,
    /// The target is a folder.
    Folder,
    /// The folder of the file cannot be found.
    Parent {
        /// The folder.
        folder: PathBuf,
        /// Error of the search.
        source: io::Error,
    },
    /// Symbolic links lead to one another without end.
    EndlessLinks,
    /// The target is a socket.
    Socket,
    /// The target is a block device, or a special file of another kind.
    Disk,
    /// The target is a pipe that no process reads from.
    NoReader,
    /// The process that read from the pipe has ended.
    ReaderGone,
    /// The folder does not accept a temporary file.
    NoTemporaryFile(io::Error),
    /// Opening, writing, or renaming failed.
    Io(io::Error),
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reason::FolderName => f.write_str("it names a folder"),
            Reason::Folder => f.write_str("it is a folder"),
            Reason::Parent { folder, source } => {
                write!(f, "its folder {}: {source}", folder.display())
            }
            Reason::EndlessLinks => f.write_str("its symbolic links lead nowhere"),
            Reason::Socket => f.write_str("it is a socket"),
            Reason::Disk => f.write_str("it is a disk or the like"),
            Reason::NoReader => f.write_str("it is a pipe that nobody reads from"),
            Reason::ReaderGone => f.write_str("its reader is gone"),
            Reason::NoTemporaryFile(error) => write!(f, "no file can be made beside it: {error}"),
            Reason::Io(error) => error.fmt(f),
        }
    }
}

impl Error for Reason {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Reason::Parent { source: error, .. }
            | Reason::NoTemporaryFile(error)
            | Reason::Io(error) => Some(error),
            _ => None,
        }
    }
}

impl From<io::Error> for Reason {
    fn from(error: io::Error) -> Self {
        Reason::Io(error)
    }
}
