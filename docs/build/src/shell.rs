//! The folder in which the commands of a page run: it has the descriptions of the repository, the files that pages speak of
//! and do not make, and what the page itself has made.

use std::fs;
use std::io::{Error, Result};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of one page.
pub struct Shell {
    /// Where commands run.
    pub folder: PathBuf,
    /// The folders of programs, `hamel` in the first.
    path: String,
}

impl Shell {
    /// A new folder; `program` is what answers to the name `hamel`.
    ///
    /// # Errors
    /// Files that cannot be read or written.
    pub fn new(root: &Path, folder: &Path, program: &Path) -> Result<Self> {
        if folder.exists() {
            fs::remove_dir_all(folder)?;
        }
        let programs = folder.join("bin");
        fs::create_dir_all(&programs)?;
        std::os::unix::fs::symlink(program, programs.join("hamel"))?;
        for given in fs::read_dir(root.join("docs/book/given"))? {
            let given = given?;
            fs::copy(given.path(), folder.join(given.file_name()))?;
        }
        for shared in ["examples", "tests"] {
            copy(&root.join(shared), &folder.join(shared))?;
        }
        let others = std::env::var("PATH").unwrap_or_default();
        Ok(Shell {
            folder: folder.to_owned(),
            path: format!("{}:{others}", programs.display()),
        })
    }

    /// What a script prints.
    ///
    /// # Errors
    /// The script and what it says, where a command fails.
    pub fn run(&self, script: &str) -> Result<String> {
        let done = Command::new("sh")
            .args(["-e", "-c", script])
            .current_dir(&self.folder)
            .env("PATH", &self.path)
            .output()?;
        if !done.status.success() {
            let said = String::from_utf8_lossy(&done.stderr);
            return Err(Error::other(format!("{script}\n{said}")));
        }
        Ok(String::from_utf8_lossy(&done.stdout).into_owned())
    }
}

/// The descriptions and tables below a folder.
fn copy(from: &Path, to: &Path) -> Result<()> {
    for entry in fs::read_dir(from)? {
        let path = entry?.path();
        let place = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() {
            copy(&path, &place)?;
        } else if path
            .extension()
            .is_some_and(|end| end == "eom" || end == "csv")
        {
            fs::create_dir_all(to)?;
            fs::copy(&path, &place)?;
        }
    }
    Ok(())
}
