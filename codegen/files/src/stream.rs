//! Targets that are written to and not replaced: devices, pipes, file descriptors.

use crate::reason::Reason;
use std::fs::{self, File, FileType, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A target that is written to and not replaced.
pub enum Stream {
    /// Standard output of this process.
    Output,
    /// Standard error of this process.
    Error,
    /// Another descriptor of a process that refers to a regular file; bytes are appended.
    Descriptor(PathBuf),
    /// A device such as `/dev/null`.
    Device(PathBuf),
    /// A pipe, by its name or by a descriptor.
    #[cfg_attr(not(unix), allow(dead_code))]
    Pipe(PathBuf),
}

impl Stream {
    /// Returns the target of a path that the kernel lists as a file descriptor; `None` for other paths.
    pub fn descriptor(folder: &Path, place: &Path) -> Option<Result<Stream, Reason>> {
        let own = format!("/proc/{}/fd", std::process::id());
        let fixed = folder == Path::new(&own) || folder == Path::new("/dev/fd");
        if !fixed && !folder.starts_with("/proc") {
            return None;
        }
        match place.file_name().and_then(|name| name.to_str()) {
            Some("1") if fixed => return Some(Ok(Stream::Output)),
            Some("2") if fixed => return Some(Ok(Stream::Error)),
            _ => {}
        }
        Some(match fs::metadata(place) {
            Err(error) => Err(error.into()),
            Ok(known) if known.is_file() => Ok(Stream::Descriptor(place.to_path_buf())),
            Ok(known) => Stream::of(place.to_path_buf(), known.file_type()),
        })
    }

    /// Returns the target of a path that is not a regular file, by its type.
    #[cfg(unix)]
    pub fn of(place: PathBuf, of: FileType) -> Result<Stream, Reason> {
        use std::os::unix::fs::FileTypeExt;
        if of.is_dir() {
            Err(Reason::Folder)
        } else if of.is_fifo() {
            Ok(Stream::Pipe(place))
        } else if of.is_char_device() {
            Ok(Stream::Device(place))
        } else if of.is_socket() {
            Err(Reason::Socket)
        } else {
            Err(Reason::Disk)
        }
    }

    /// Returns the target of a path that is not a regular file, by its type.
    #[cfg(not(unix))]
    pub fn of(place: PathBuf, of: FileType) -> Result<Stream, Reason> {
        if of.is_dir() {
            Err(Reason::Folder)
        } else {
            Ok(Stream::Device(place))
        }
    }

    /// Writes bytes after the existing content.
    pub fn write(self, bytes: &[u8]) -> Result<(), Reason> {
        let whole = |mut to: Box<dyn Write>| {
            to.write_all(bytes)?;
            to.flush()
        };
        let written = match self {
            Stream::Output => whole(Box::new(io::stdout())),
            Stream::Error => whole(Box::new(io::stderr())),
            Stream::Descriptor(place) => {
                let file = OpenOptions::new().append(true).open(place);
                file.and_then(|file| whole(Box::new(file)))
            }
            Stream::Device(place) => {
                let file = OpenOptions::new().write(true).open(place);
                file.and_then(|file| whole(Box::new(file)))
            }
            Stream::Pipe(place) => whole(Box::new(pipe(&place)?)),
        };
        written.map_err(|error| match error.kind() {
            ErrorKind::BrokenPipe => Reason::ReaderGone,
            _ => Reason::Io(error),
        })
    }
}

/// Opens a pipe that has a reader. It does not block if there is none, and returns an error instead.
#[cfg(unix)]
fn pipe(place: &Path) -> Result<File, Reason> {
    use rustix::fs::{OFlags, fcntl_setfl};
    use rustix::io::Errno;
    use std::os::unix::fs::OpenOptionsExt;
    let flags = OFlags::NONBLOCK.bits().cast_signed();
    let file = OpenOptions::new()
        .write(true)
        .custom_flags(flags)
        .open(place)
        .map_err(|error| match error.raw_os_error() {
            Some(code) if code == Errno::NXIO.raw_os_error() => Reason::NoReader,
            _ => Reason::Io(error),
        })?;
    // From here on, writing may block as long as there is a reader.
    fcntl_setfl(&file, OFlags::empty()).map_err(io::Error::from)?;
    Ok(file)
}

#[cfg(not(unix))]
fn pipe(place: &Path) -> Result<File, Reason> {
    Ok(OpenOptions::new().write(true).open(place)?)
}
