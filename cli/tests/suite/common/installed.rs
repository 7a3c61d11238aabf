//! Locates the URDF files of the wheel `example-robot-data`, which `tests/robots/install.sh` installs below the target
//! folder.

use std::path::{Path, PathBuf};

/// The folder with the robots, if they are installed.
pub fn installed() -> Option<PathBuf> {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent()?;
    let libraries = std::fs::read_dir(target.join("robots/lib")).ok()?;
    let folders = libraries.filter_map(|entry| {
        let packages = entry.ok()?.path().join("site-packages");
        Some(packages.join("cmeel.prefix/share/example-robot-data/robots"))
    });
    folders.into_iter().find(|folder| folder.is_dir())
}
