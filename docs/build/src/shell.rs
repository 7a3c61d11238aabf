//! The folder in which the commands of a page run: it contains the descriptions of the repository, the files that pages
//! mention but do not make, and the files that the page has made.

use std::fs;
use std::io::{Error, Result};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The path of a clone of the repository, relative to a crate next to it.
const CLONE: &str = "../hamel/";

/// The folder of one page.
pub struct Shell {
    root: PathBuf,
    /// The working directory of the commands.
    pub folder: PathBuf,
    /// The search path of programs, with the folder of `hamel` first.
    path: String,
}

impl Shell {
    /// Creates the folder; `program` is run wherever a command says `hamel`.
    ///
    /// # Errors
    /// If a file cannot be read or written.
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
            root: root.canonicalize()?,
            folder: folder.to_owned(),
            path: format!("{}:{others}", programs.display()),
        })
    }

    /// Runs a script, and returns its output.
    ///
    /// # Errors
    /// If a command fails, with the script and its messages.
    pub fn run(&self, script: &str) -> Result<String> {
        self.done(script, &self.folder, &[])
    }

    /// Runs a script that makes crates next to a clone of the repository, `../hamel`, and returns its output. The
    /// crates are also copied to the folder of the page.
    ///
    /// The clone is this repository under its real path, so that everything that `lab/` has compiled is reused.
    /// The packages are those of this repository's lock file, and nothing is downloaded.
    ///
    /// # Errors
    /// If a command fails, with the script and its messages.
    pub fn run_beside(&self, script: &str) -> Result<String> {
        let place = self.root.join("target/book-crates");
        if place.exists() {
            fs::remove_dir_all(&place)?;
        }
        fs::create_dir_all(&place)?;
        // Otherwise, the crates would become members of this repository's workspace.
        fs::write(place.join("Cargo.toml"), "[workspace]\nresolver = \"3\"\n")?;
        fs::copy(self.root.join("Cargo.lock"), place.join("Cargo.lock"))?;
        let target = self.root.join("lab/target").display().to_string();
        let environment = [
            ("CARGO_TARGET_DIR", &*target),
            ("CARGO_NET_OFFLINE", "true"),
        ];
        let script = script.replace(CLONE, &format!("{}/", self.root.display()));
        let printed = self.done(&script, &place, &environment)?;
        for entry in fs::read_dir(&place)? {
            let made = entry?.path();
            let name = made.file_name().unwrap_or_default();
            if made.is_dir() {
                std::os::unix::fs::symlink(&made, self.folder.join(name))?;
            }
        }
        Ok(printed)
    }

    fn done(&self, script: &str, folder: &Path, environment: &[(&str, &str)]) -> Result<String> {
        let done = Command::new("sh")
            .args(["-e", "-c", script])
            .current_dir(folder)
            .env("PATH", &self.path)
            .envs(environment.iter().copied())
            .output()?;
        if !done.status.success() {
            let said = String::from_utf8_lossy(&done.stderr);
            return Err(Error::other(format!("{script}\n{said}")));
        }
        Ok(String::from_utf8_lossy(&done.stdout).into_owned())
    }
}

/// Copies the descriptions and tables below a folder.
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
