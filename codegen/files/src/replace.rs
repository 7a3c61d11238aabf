//! Replaces a regular file in one step.

use crate::reason::Reason;
use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, Write};
use std::path::Path;
use tempfile::Builder;

/// Writes bytes to a new file and gives it the path `place`; `known` describes the present file, if there is one.
pub fn replace(place: &Path, known: Option<&Metadata>, bytes: &[u8]) -> Result<(), Reason> {
    let Some(folder) = place.parent() else {
        return Err(Reason::Folder);
    };
    if known.is_some() {
        // A file that is write-protected must not be replaced either.
        OpenOptions::new().write(true).open(place)?;
    }
    let mut builder = Builder::new();
    builder.prefix(".hamel-").suffix(".tmp");
    for_everybody(&mut builder);
    let mut file = builder
        .tempfile_in(folder)
        .map_err(Reason::NoTemporaryFile)?;
    file.write_all(bytes)?;
    if let Some(known) = known {
        keep(file.as_file(), known)?;
    }
    file.as_file().sync_all()?;
    file.persist(place).map_err(|error| error.error)?;
    // Flushes the folder as well, which contains the new name, on systems that can do this. The file is
    // complete in any case.
    if cfg!(unix) {
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
    Ok(())
}

/// Gives new files the permissions that the user's umask leaves, as for any other file.
#[cfg(unix)]
fn for_everybody(builder: &mut Builder) {
    use std::fs::Permissions;
    use std::os::unix::fs::PermissionsExt;
    builder.permissions(Permissions::from_mode(0o666));
}

#[cfg(not(unix))]
fn for_everybody(_: &mut Builder) {}

/// Gives a new file the owner and the permissions of the old one, as far as possible.
fn keep(file: &File, known: &Metadata) -> io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt, fchown};
        let new = file.metadata()?;
        if (new.uid(), new.gid()) != (known.uid(), known.gid()) {
            // Only privileged users may give files away; for others, the file belongs to its writer.
            let _ = fchown(file, Some(known.uid()), Some(known.gid()));
        }
    }
    file.set_permissions(known.permissions())
}
