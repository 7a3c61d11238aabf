//! The state of a path after a file was written there, or was refused.
#![cfg(unix)]

use hamel_files::{holds, update, write};
use std::fs::{self, File, Permissions};
use std::io::Read;
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};

/// Creates an empty folder for one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder.canonicalize().expect("a folder")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> = entries
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    names
}

fn why(path: &Path) -> String {
    write(path, "new").expect_err("refused").to_string()
}

fn pipe(path: &Path) {
    let made = Command::new("mkfifo").arg(path).status();
    assert!(made.expect("mkfifo").success());
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).expect("readable")
}

#[test]
fn files_are_made_and_replaced() {
    let folder = folder("made");
    let path = folder.join("a.txt");
    write(&path, "one").expect("written");
    assert_eq!(read(&path), "one");
    write(&path, "two").expect("written");
    assert_eq!(read(&path), "two");
    assert_eq!(names(&folder), ["a.txt"]);
}

#[test]
fn new_files_have_the_permissions_that_others_have() {
    let folder = folder("mask");
    File::create(folder.join("plain")).expect("a file");
    write(&folder.join("written"), "").expect("written");
    let mode = |name: &str| fs::metadata(folder.join(name)).expect("a file").mode();
    assert_eq!(mode("written"), mode("plain"));
}

#[test]
fn permissions_stay() {
    let folder = folder("permissions");
    let path = folder.join("a");
    for mode in [0o600, 0o644, 0o755, 0o640] {
        fs::write(&path, "old").expect("a file");
        fs::set_permissions(&path, Permissions::from_mode(mode)).expect("own");
        write(&path, "new").expect("written");
        assert_eq!(read(&path), "new");
        assert_eq!(fs::metadata(&path).expect("a file").mode() & 0o7777, mode);
    }
}

#[test]
fn links_stay_and_what_they_lead_to_is_replaced() {
    let folder = folder("links");
    fs::create_dir(folder.join("sub")).expect("a folder");
    fs::write(folder.join("sub/real"), "old").expect("a file");
    symlink("sub/real", folder.join("first")).expect("a link");
    symlink(folder.join("first"), folder.join("second")).expect("a link");
    symlink("sub/none", folder.join("dangling")).expect("a link");
    symlink("round", folder.join("round")).expect("a link");
    write(&folder.join("second"), "new").expect("written");
    assert_eq!(read(&folder.join("sub/real")), "new");
    write(&folder.join("dangling"), "made").expect("written");
    assert_eq!(read(&folder.join("sub/none")), "made");
    for link in ["first", "second", "dangling"] {
        let known = fs::symlink_metadata(folder.join(link)).expect("a link");
        assert!(known.is_symlink(), "{link}");
    }
    assert!(why(&folder.join("round")).ends_with("its symbolic links lead nowhere"));
    assert_eq!(names(&folder.join("sub")), ["none", "real"]);
}

#[test]
fn what_is_no_file_is_refused_with_its_reason() {
    let folder = folder("refused");
    pipe(&folder.join("pipe"));
    fs::write(folder.join("file"), "").expect("a file");
    fs::create_dir(folder.join("sub")).expect("a folder");
    let _socket = std::os::unix::net::UnixListener::bind(folder.join("socket")).expect("a socket");
    for (name, reason) in [
        ("pipe", "it is a pipe that nobody reads from"),
        ("sub", "it is a folder"),
        ("sub/", "it names a folder"),
        ("new/", "it names a folder"),
        ("sub/..", "it names a folder"),
        ("socket", "it is a socket"),
        ("none/a", "No such file or directory (os error 2)"),
        ("file/a", "Not a directory (os error 20)"),
    ] {
        let said = why(&folder.join(name));
        assert!(
            said.starts_with("cannot write ") && said.ends_with(reason),
            "{said}"
        );
    }
    assert_eq!(why(Path::new("/")), "cannot write /: it names a folder");
    assert_eq!(names(&folder), ["file", "pipe", "socket", "sub"]);
}

#[cfg(target_os = "linux")]
#[test]
fn devices_are_written_to_and_stay() {
    use std::os::unix::fs::FileTypeExt;
    write(Path::new("/dev/null"), "text").expect("written");
    let full = why(Path::new("/dev/full"));
    assert!(full.contains("No space left on device"), "{full}");
    for device in ["/dev/null", "/dev/full"] {
        let known = fs::symlink_metadata(device).expect("a device");
        assert!(known.file_type().is_char_device(), "{device}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn descriptors_are_written_behind_what_is_there() {
    use std::os::fd::AsRawFd;
    let path = folder("descriptors").join("log");
    fs::write(&path, "old\n").expect("a file");
    let file = File::options().append(true).open(&path).expect("a file");
    for folder in ["/dev/fd", "/proc/self/fd"] {
        write(
            &Path::new(folder).join(file.as_raw_fd().to_string()),
            "new\n",
        )
        .expect("written");
    }
    assert_eq!(read(&path), "old\nnew\nnew\n");
}

#[test]
fn pipes_with_a_reader_are_written_to() {
    let path = folder("pipes").join("pipe");
    pipe(&path);
    let text = "a line\n".repeat(100_000);
    std::thread::scope(|scope| {
        let reader = scope.spawn(|| {
            let mut text = String::new();
            let mut file = File::open(&path).expect("a pipe");
            file.read_to_string(&mut text).expect("text");
            text
        });
        // Writing fails until the pipe has a reader.
        while write(&path, &text).is_err() {
            std::thread::yield_now();
        }
        assert!(reader.join().expect("no panic") == text);
    });
}

#[test]
fn what_holds_the_text_already_is_not_touched() {
    let folder = folder("same");
    let path = folder.join("a");
    assert!(holds(&path, "text").is_err());
    update(&path, "text").expect("written");
    let before = fs::metadata(&path).expect("a file");
    update(&path, "text").expect("there");
    assert_eq!(fs::metadata(&path).expect("a file").ino(), before.ino());
    assert!(holds(&path, "text").expect("a file"));
    for other in ["test", "tex", "texts", ""] {
        assert!(!holds(&path, other).expect("a file"));
    }
    update(&path, "next").expect("written");
    assert_eq!(read(&path), "next");
    pipe(&folder.join("pipe"));
    // Reading the pipe would block forever.
    assert!(holds(&folder.join("pipe"), "text").is_err());
    assert!(holds(&folder, "text").is_err());
}

/// A reader during concurrent writes sees one text or the other.
#[test]
fn readers_never_see_half_a_text() {
    let path = folder("race").join("a");
    let texts = ["a".repeat(1 << 16), "b".repeat(1 << 17)];
    write(&path, &texts[0]).expect("written");
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let writers = texts.each_ref().map(|text| {
            scope.spawn(|| (0..100).for_each(|_| write(&path, text).expect("written")))
        });
        let reader = scope.spawn(|| {
            while !done.load(Ordering::Relaxed) {
                let text = read(&path);
                assert!(texts.contains(&text), "{} bytes", text.len());
            }
        });
        for writer in writers {
            writer.join().expect("no panic");
        }
        done.store(true, Ordering::Relaxed);
        reader.join().expect("whole texts");
    });
}
