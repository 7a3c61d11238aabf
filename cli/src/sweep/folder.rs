//! The folder of a sweep: its manifest, its shards, and the locks that keep two processes from the same work.

use super::manifest::Manifest;
use super::shard::Footer;
use crate::failure::{self, Failure};
use crate::parse::Expected;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::path::{Path, PathBuf};

/// Readers of tables skip names that begin with a dot or `_`.
const MANIFEST: &str = "_sweep.json";
const LOCK: &str = ".lock";
const LOCK_OF_PARTS: &str = ".lock-part-";
const LOCK_OF_MANIFEST: &str = ".lock-manifest";
/// Prefix and suffix of unfinished files, as in `hamel-files`.
const UNFINISHED: (&str, &str) = (".hamel-", ".tmp");

/// A part of the shards: every N-th one, beginning with the i-th.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// i, from 1.
    pub number: u64,
    /// N.
    pub of: u64,
}

impl Part {
    /// All shards.
    pub const ALL_SHARDS: Part = Part { number: 1, of: 1 };

    /// Returns whether a shard belongs to this part.
    pub fn has(self, shard: u64) -> bool {
        shard % self.of == self.number - 1
    }

    /// Returns whether both parts have a shard in common.
    fn overlaps(self, other: Part) -> bool {
        let (mut a, mut b) = (self.of, other.of);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        self.number % a == other.number % a
    }

    /// Parses `i/N`.
    pub fn read(text: &str) -> Result<Self, Expected> {
        let numbers = text.split_once('/');
        let numbers = numbers.and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
        match numbers {
            Some((number, of)) if (1..=of).contains(&number) => Ok(Part { number, of }),
            _ => Err(Expected::Part),
        }
    }
}

/// A folder to which this process may write the shards of a part.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    /// Locks, held as long as the folder.
    _locks: Vec<File>,
}

impl Folder {
    /// Locks a part of a folder, and writes the manifest if the folder is new.
    pub fn take(path: &Path, manifest: &Manifest, part: Part) -> Result<Self, Failure> {
        fs::create_dir_all(path).map_err(|error| unwritable(path, &error))?;
        let locks = lock(path, part)?;
        let _while_compared = {
            let file = lock_file(path, LOCK_OF_MANIFEST)?;
            let place = path.join(LOCK_OF_MANIFEST);
            file.lock().map_err(|error| unwritable(&place, &error))?;
            file
        };
        let place = path.join(MANIFEST);
        match read_manifest(path)? {
            Some(there) => {
                let differences = manifest.differences(&there);
                if !differences.is_empty() {
                    let about = format!(
                        "{} is the folder of another sweep: choose another folder, or give the options of that sweep again",
                        path.display()
                    );
                    return Err(Failure::usages(&about, &differences));
                }
            }
            None if !shards(path)?.is_empty() => {
                return Err(Failure::usage(format!(
                    "{} has shards but no {MANIFEST} that describes them: choose another folder",
                    path.display()
                )));
            }
            None => failure::write(&place, &manifest.text)?,
        }
        if part == Part::ALL_SHARDS {
            remove_unfinished(path);
        }
        Ok(Folder {
            path: path.to_path_buf(),
            _locks: locks,
        })
    }

    /// Path of the file of a shard.
    pub fn place(&self, shard: u64) -> PathBuf {
        self.path.join(shard_name(shard))
    }
}

/// Returns the manifest of a folder, if there is one.
pub fn read_manifest(path: &Path) -> Result<Option<Manifest>, Failure> {
    let place = path.join(MANIFEST);
    let text = match fs::read_to_string(&place) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => {
            let message = format!("cannot read {}: {error}", place.display());
            return Err(Failure::usage(message));
        }
    };
    let manifest = Manifest::read(&text);
    let manifest = manifest.map_err(|why| Failure::usage(format!("{}: {why}", place.display())))?;
    Ok(Some(manifest))
}

/// The finished work of a sweep.
#[derive(Clone, Debug, Default)]
pub struct Finished {
    /// Finished shards.
    pub shards: Vec<u64>,
    /// Number of their members.
    pub members: u64,
    /// Number of members that failed.
    pub failed: u64,
}

/// Inspects all shards of a folder; fails if one does not belong to the sweep.
pub fn find_finished(path: &Path, manifest: &Manifest) -> Result<Finished, Failure> {
    let mut finished = Finished::default();
    let mut wrong = Vec::new();
    for shard in shards(path)? {
        let name = shard_name(shard);
        let mut refuse = |why: String| {
            wrong.push(format!("{name}: {why}; remove it to compute it again"));
        };
        let range = match shard < manifest.shards() {
            true => manifest.range(shard),
            false => {
                refuse(format!("the sweep has {} shards", manifest.shards()));
                continue;
            }
        };
        match Footer::read(&path.join(&name)) {
            Err(why) => refuse(format!("it cannot be read: {why}")),
            Ok(footer) if footer.sweep.as_deref() != Some(manifest.text.as_str()) => {
                refuse("it belongs to another sweep".into());
            }
            Ok(footer) if footer.members != range.end - range.start => {
                refuse(format!("it has {} members", footer.members));
            }
            Ok(footer) => {
                finished.shards.push(shard);
                finished.members += footer.members;
                finished.failed += footer.failed;
            }
        }
    }
    match wrong.is_empty() {
        true => Ok(finished),
        false => Err(Failure::usages(&path.display().to_string(), &wrong)),
    }
}

/// File name of a shard.
fn shard_name(shard: u64) -> String {
    format!("shard-{shard:06}.parquet")
}

/// Returns the numbers of all shards in a folder, sorted.
fn shards(path: &Path) -> Result<Vec<u64>, Failure> {
    let unreadable =
        |error: std::io::Error| Failure::usage(format!("cannot read {}: {error}", path.display()));
    let mut numbers = Vec::new();
    for entry in fs::read_dir(path).map_err(unreadable)? {
        let name = entry.map_err(unreadable)?.file_name();
        let number = name.to_str().and_then(|name| {
            let number = name.strip_prefix("shard-")?.strip_suffix(".parquet")?;
            number
                .parse()
                .ok()
                .filter(|number| shard_name(*number) == name)
        });
        numbers.extend(number);
    }
    numbers.sort_unstable();
    Ok(numbers)
}

/// Locks a part, so that no other process can lock a part that shares a shard with it.
fn lock(path: &Path, part: Part) -> Result<Vec<File>, Failure> {
    let busy = || {
        Failure::usage(format!(
            "{}: another process is computing {}",
            path.display(),
            match part {
                Part::ALL_SHARDS => "this sweep, or a part of it".into(),
                Part { number, of } => format!("part {number}/{of} of this sweep, or all of it"),
            }
        ))
    };
    let tried = |place: &Path, result: Result<(), TryLockError>| match result {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err(busy()),
        Err(TryLockError::Error(error)) => Err(unwritable(place, &error)),
    };
    let all = lock_file(path, LOCK)?;
    if part == Part::ALL_SHARDS {
        tried(&path.join(LOCK), all.try_lock())?;
        return Ok(vec![all]);
    }
    tried(&path.join(LOCK), all.try_lock_shared())?;
    let name = format!("{LOCK_OF_PARTS}{}-{}", part.number, part.of);
    let own = lock_file(path, &name)?;
    tried(&path.join(&name), own.try_lock())?;
    // Parts of other divisions.
    let entries = fs::read_dir(path).map_err(|error| unwritable(path, &error))?;
    for entry in entries.flatten() {
        let other = entry.file_name();
        let other = other.to_str().and_then(|name| {
            let (number, of) = name.strip_prefix(LOCK_OF_PARTS)?.split_once('-')?;
            Part::read(&format!("{number}/{of}")).ok()
        });
        if let Some(other) = other.filter(|other| *other != part && part.overlaps(*other)) {
            let name = format!("{LOCK_OF_PARTS}{}-{}", other.number, other.of);
            tried(&path.join(&name), lock_file(path, &name)?.try_lock())?;
        }
    }
    Ok(vec![all, own])
}

fn lock_file(path: &Path, name: &str) -> Result<File, Failure> {
    let place = path.join(name);
    let mut options = OpenOptions::new();
    let opened = options
        .write(true)
        .create(true)
        .truncate(false)
        .open(&place);
    opened.map_err(|error| unwritable(&place, &error))
}

fn unwritable(path: &Path, error: &std::io::Error) -> Failure {
    Failure::usage(format!("cannot write {}: {error}", path.display()))
}

/// Removes unfinished files: no other process writes to the folder now.
fn remove_unfinished(path: &Path) {
    let (before, behind) = UNFINISHED;
    for entry in fs::read_dir(path).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with(before) && name.ends_with(behind) {
            // A file that cannot be removed does no harm.
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Part;

    #[test]
    fn parts_share_shards_or_do_not() {
        for (a, b) in (1..=6).flat_map(|a| (1..=6).map(move |b| (a, b))) {
            for (i, j) in (1..=a).flat_map(|i| (1..=b).map(move |j| (i, j))) {
                let (one, other) = (Part { number: i, of: a }, Part { number: j, of: b });
                let shared = (0..60).any(|shard| one.has(shard) && other.has(shard));
                assert_eq!(one.overlaps(other), shared, "{one:?} {other:?}");
            }
        }
        for text in ["0/3", "4/3", "1", "a/b", "-1/2", "1/2/3"] {
            assert!(Part::read(text).is_err(), "{text}");
        }
        assert_eq!(Part::read("1/1"), Ok(Part::ALL_SHARDS));
    }
}
