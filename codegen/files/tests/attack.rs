//! Writes random texts to random places: they are written completely, or refused without any change, and a write never
//! blocks. `HAMEL_ATTACK=full` tries a hundred times as many.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs::{self, Permissions};
use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::mpsc;
use std::time::Duration;

/// Number of places in the default run.
const CASES: u64 = 60;
/// Generous time limit for one text: the machine may be busy.
const PATIENCE: Duration = Duration::from_secs(60);

/// The generator SplitMix64.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n as u64) as usize
    }

    fn text(&mut self) -> String {
        let size = [0, 1, 100, 5000, 200_000][self.below(5)];
        let letters = ["a", "é", "\n", "{", "\u{1d4f6}"];
        (0..size)
            .map(|_| letters[self.below(letters.len())])
            .collect()
    }
}

/// Returns all entries below a folder: kinds, permissions, texts.
fn state(folder: &Path) -> BTreeMap<PathBuf, String> {
    let mut state = BTreeMap::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(path) = open.pop() {
        let known = fs::symlink_metadata(&path).expect("an entry");
        let of = known.file_type();
        let said = if of.is_dir() {
            let entries = fs::read_dir(&path).expect("a folder");
            open.extend(entries.map(|entry| entry.expect("an entry").path()));
            "folder".into()
        } else if of.is_symlink() {
            format!(
                "link to {}",
                fs::read_link(&path).expect("a link").display()
            )
        } else if of.is_fifo() {
            "pipe".into()
        } else {
            let mode = known.permissions().mode();
            format!("{mode:o} {}", fs::read_to_string(&path).expect("text"))
        };
        state.insert(path, said);
    }
    state
}

/// Creates a random place; returns the path to write to, and whether writing has to succeed.
fn place(random: &mut Random, folder: &Path) -> (PathBuf, bool) {
    let names = ["a.rs", "-", " ", "é\u{301}", ".hidden", "a\nb", "a;b$(c)"];
    let name = match random.below(8) {
        0 => "n".repeat(255),
        n => names[n - 1].to_string(),
    };
    let path = folder.join(&name);
    let file = |random: &mut Random, path: &Path| {
        fs::write(path, random.text()).expect("a file");
        let mode = [0o600, 0o644, 0o664, 0o755][random.below(4)];
        fs::set_permissions(path, Permissions::from_mode(mode)).expect("own");
    };
    match random.below(10) {
        0 => (path, true),
        1 | 2 => {
            file(random, &path);
            (path, true)
        }
        3 => {
            fs::create_dir(&path).expect("a folder");
            (path, false)
        }
        4 => {
            assert!(
                Command::new("mkfifo")
                    .arg("--")
                    .arg(&path)
                    .status()
                    .expect("mkfifo")
                    .success()
            );
            (path, false)
        }
        5 => (folder.join("missing").join("a"), false),
        6 => {
            let (mut last, links) = (path.clone(), 1 + random.below(45));
            if random.below(2) == 0 {
                file(random, &path);
            }
            for link in 0..links {
                let next = folder.join(format!("link{link}"));
                symlink(last.file_name().expect("a name"), &next).expect("a link");
                last = next;
            }
            (last, links <= 40)
        }
        7 => {
            symlink("two", folder.join("one")).expect("a link");
            symlink("one", folder.join("two")).expect("a link");
            (folder.join("one"), false)
        }
        8 => {
            fs::create_dir(folder.join("sub")).expect("a folder");
            symlink(folder.join("sub"), folder.join("link")).expect("a link");
            (folder.join("link").join(name), true)
        }
        _ => (folder.join("n".repeat(256)), false),
    }
}

#[test]
fn files_at_random_places() {
    let full = std::env::var("HAMEL_ATTACK").is_ok_and(|size| size == "full");
    let base = Path::new(env!("CARGO_TARGET_TMPDIR")).join("attack");
    for case in 0..CASES * if full { 100 } else { 1 } {
        let mut random = Random(case);
        let _ = fs::remove_dir_all(&base);
        fs::create_dir_all(&base).expect("a folder");
        let folder = base.canonicalize().expect("a folder");
        let (path, succeeds) = place(&mut random, &folder);
        let text = random.text();
        let before = state(&folder);
        let mode = fs::metadata(&path).map(|known| known.permissions());
        let (send, answer) = mpsc::channel();
        let (to, new) = (path.clone(), text.clone());
        std::thread::spawn(move || send.send(hamel_files::write(&to, &new)));
        let written = answer.recv_timeout(PATIENCE);
        let written = written.unwrap_or_else(|_| panic!("case {case}: {} hangs", path.display()));
        assert_eq!(
            written.is_ok(),
            succeeds,
            "case {case}: {} {written:?}",
            path.display()
        );
        let mut after = state(&folder);
        if succeeds {
            assert!(
                fs::read_to_string(&path).expect("a file") == text,
                "case {case}"
            );
            if let Ok(mode) = mode {
                let new = fs::metadata(&path).expect("a file").permissions();
                assert_eq!(new, mode, "case {case}");
            }
            let real = path.canonicalize().expect("a file");
            after.remove(&real);
            let mut before = before;
            before.remove(&real);
            assert!(after == before, "case {case}: {:?}", after.keys());
        } else {
            assert!(after == before, "case {case}: {:?}", after.keys());
        }
    }
}
