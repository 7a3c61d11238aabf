//! Folders of sweeps after a kill, a full disk, another process or a wrong file, and refused folders.

use crate::common::{hamel, text};
use crate::shards::bytes;
use crate::table::{Table, fresh, shards};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// Time limit for one command, generous because the machine may be busy.
const PATIENCE: Duration = Duration::from_secs(300);

fn model(name: &str) -> String {
    format!("{}/../tests/models/{name}.eom", env!("CARGO_MANIFEST_DIR"))
}

/// A sweep that takes long.
const SLOW: [&str; 11] = [
    "--vary",
    "start w = uniform(-1, 1)",
    "--members",
    "60",
    "--until",
    "1",
    "--seed",
    "3",
    "--shard-size",
    "4",
    "--threads=2",
];

fn arguments(model: &str, folder: &Path, options: &[&str]) -> Vec<String> {
    let folder = folder.display().to_string();
    let all = [&["sweep", model, "--out", &folder], options].concat();
    all.into_iter().map(String::from).collect()
}

fn sweep(folder: &Path, options: &[&str]) -> Output {
    let all = arguments(&model("heavy_top"), folder, options);
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    hamel(&all, "")
}

fn done(folder: &Path, options: &[&str]) -> String {
    let output = sweep(folder, options);
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

fn refused(folder: &Path, options: &[&str]) -> String {
    let output = sweep(folder, options);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stdout));
    text(&output.stderr)
}

fn status(folder: &Path) -> String {
    let output = hamel(&["sweep", "--status", &folder.display().to_string()], "");
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

/// A process that is killed when the test ends.
struct Running(Child);

impl Running {
    fn kill(&mut self) {
        self.0.kill().expect("it is killed");
        self.0.wait().expect("it has ended");
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn spawned(folder: &Path, options: &[&str]) -> Running {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hamel"));
    command.args(arguments(&model("heavy_top"), folder, options));
    let quiet = command.stdin(Stdio::null()).stdout(Stdio::null());
    Running(
        quiet
            .stderr(Stdio::null())
            .spawn()
            .expect("the command runs"),
    )
}

fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < PATIENCE, "{what} does not happen");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn changed(path: &PathBuf) -> SystemTime {
    let known = fs::metadata(path).expect("a shard");
    known.modified().expect("a time")
}

/// A sweep that was killed after some of its shards, and its options: the first step size at which it is slow enough.
fn killed(folder: &str) -> (PathBuf, Vec<&'static str>) {
    for step in ["1e-3", "1e-4", "1e-5"] {
        let (folder, options) = (fresh(folder), [&SLOW[..], &["--step", step]].concat());
        let mut child = spawned(&folder, &options);
        until("a shard", || shards(&folder).len() > 2);
        child.kill();
        if shards(&folder).len() < 15 {
            return (folder, options);
        }
    }
    panic!("it is over before it is killed, however short its steps are");
}

#[test]
fn a_killed_sweep_goes_on_where_it_was() {
    let (folder, options) = killed("killed");
    let whole = fresh("whole");
    done(&whole, &options);
    assert_eq!(Table::read(&whole).column("index").len(), 60);

    let known = shards(&folder);
    let times: Vec<SystemTime> = known.iter().map(changed).collect();
    let said = status(&folder);
    let of = format!("{} of 15", known.len());
    assert!(said.contains(&of) && said.contains("missing"), "{said}");
    // An unfinished file.
    fs::write(folder.join(".hamel-abc.tmp"), "half").expect("a file");

    let said = done(&folder, &options);
    let before = 4 * known.len();
    let wanted = format!(
        "{} members computed, 0 of them failed; {before} existed before",
        60 - before
    );
    assert!(said.contains(&wanted), "{said}");
    assert_eq!(
        times,
        known.iter().map(changed).collect::<Vec<SystemTime>>()
    );
    assert_eq!(bytes(&folder), bytes(&whole));
    assert!(!folder.join(".hamel-abc.tmp").exists());
    let said = done(&folder, &options);
    assert!(said.contains(" 0 members computed"), "{said}");
    let said = status(&folder);
    assert!(
        said.contains("60 of 60") && !said.contains("missing"),
        "{said}"
    );
}

#[test]
fn a_folder_has_one_process_at_a_time() {
    let folder = fresh("busy");
    // Long enough not to finish.
    let long = [&SLOW[..3], &["1000000"], &SLOW[4..]].concat();
    let mut child = spawned(&folder, &long);
    until("a shard", || !shards(&folder).is_empty());
    for more in [&[][..], &["--shard", "2/3"]] {
        let said = refused(&folder, &[&long[..], more].concat());
        assert!(said.contains("another process is computing"), "{said}");
    }
    child.kill();

    let folder = fresh("busy-parts");
    let part = |part: &'static str| [&long[..], &["--shard", part]].concat();
    let mut child = spawned(&folder, &part("2/4"));
    until("a shard", || !shards(&folder).is_empty());
    // 1/3 shares shards with 2/4, and the whole sweep contains all of them.
    for other in [long.clone(), part("2/4"), part("1/3"), part("2/2")] {
        let said = refused(&folder, &other);
        assert!(
            said.contains("another process is computing"),
            "{other:?}: {said}"
        );
    }
    let mut other = spawned(&folder, &part("1/2"));
    let first = folder.join("shard-000000.parquet");
    until("a shard of the other part", || first.exists());
    assert!(other.0.try_wait().expect("a child").is_none());
    for child in [&mut child, &mut other] {
        child.kill();
    }
    // 2/4 has every fourth shard from the second on, 1/2 every second one from the first on.
    let numbers = shards(&folder).into_iter().map(|path| {
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        name["shard-".len()..].parse::<u64>().expect("a number")
    });
    for number in numbers {
        assert!(number % 4 == 1 || number % 2 == 0, "{number}");
    }
}

/// A sweep that takes little time.
const FAST: [&str; 12] = [
    "--vary",
    "start w = uniform(-1, 1); m = normal(1, 0.1)",
    "--members",
    "24",
    "--until",
    "0.02",
    "--step",
    "0.01",
    "--shard-size",
    "8",
    "--seed",
    "1",
];

#[test]
fn another_sweep_is_refused_with_the_difference() {
    let folder = fresh("other");
    done(&folder, &FAST);
    let before = bytes(&folder);
    let replaced = |old: &str, new: &'static str| -> Vec<&str> {
        FAST.iter()
            .map(|word| if *word == old { new } else { *word })
            .collect()
    };
    for (options, said) in [
        (replaced("1", "2"), "seed: 1 there, 2 here"),
        (replaced("24", "25"), "members: 24 there, 25 here"),
        (replaced("8", "9"), "members of a shard: 8 there, 9 here"),
        (replaced("0.01", "0.02"), "step: 0.01 there, 0.02 here"),
        (
            replaced(FAST[1], "m = normal(1, 0.1)"),
            "there, \"m = normal(1, 0.1)\" here",
        ),
        (
            [&FAST[..], &["--keep", "max(w)"]].concat(),
            "keep: \"end\" there, \"max(w)\" here",
        ),
        ([&FAST[..], &["--method", "rkmk4"]].concat(), "method: "),
    ] {
        let found = refused(&folder, &options);
        assert!(
            found.contains("the folder of another sweep") && found.contains(said),
            "{found}"
        );
    }
    // A description with another number in line 3.
    let known = fs::read_to_string(model("heavy_top")).expect("a model");
    let other = fresh("other.eom");
    fs::write(&other, known.replace("9.81", "9.82")).expect("a model");
    let words = arguments(&other.display().to_string(), &folder, &FAST);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let found = text(&hamel(&words, "").stderr);
    let line = "description, line 3: `    param m = 1.3, g = 9.81;` there, `    param m = 1.3, g = 9.82;` here";
    assert!(found.contains(line), "{found}");
    assert_eq!(bytes(&folder), before);
}

#[test]
fn what_is_no_shard_of_the_sweep_is_refused() {
    let (folder, other) = (fresh("wrong"), fresh("wrong-other"));
    done(&folder, &FAST);
    done(&other, &[&FAST[..11], &["2"]].concat());
    let first = folder.join("shard-000000.parquet");
    let whole = fs::read(&first).expect("a shard");
    let of_other = fs::read(other.join("shard-000000.parquet")).expect("a shard");
    for (name, content, why) in [
        (
            "shard-000000.parquet",
            &of_other[..],
            "it belongs to another sweep",
        ),
        (
            "shard-000001.parquet",
            &whole[..whole.len() - 9],
            "it cannot be read",
        ),
        ("shard-000003.parquet", &whole[..], "the sweep has 3 shards"),
    ] {
        let known = fs::read(folder.join(name)).ok();
        fs::write(folder.join(name), content).expect("written");
        for said in [refused(&folder, &FAST), {
            let output = hamel(&["sweep", "--status", &folder.display().to_string()], "");
            assert_eq!(output.status.code(), Some(2));
            text(&output.stderr)
        }] {
            assert!(said.contains(name) && said.contains(why), "{said}");
        }
        match known {
            Some(known) => fs::write(folder.join(name), known).expect("written"),
            None => fs::remove_file(folder.join(name)).expect("removed"),
        }
    }
    let before = bytes(&folder);
    fs::remove_file(&first).expect("removed");
    let said = done(&folder, &FAST);
    assert!(said.contains(" 8 members computed"), "{said}");
    assert_eq!(bytes(&folder), before);

    fs::write(folder.join("_sweep.json"), "{\"format\": 1, \"format\": 1}").expect("written");
    let said = refused(&folder, &FAST);
    assert!(
        said.contains("_sweep.json") && said.contains("twice"),
        "{said}"
    );
    fs::remove_file(folder.join("_sweep.json")).expect("removed");
    let said = refused(&folder, &FAST);
    assert!(said.contains("has shards but no _sweep.json"), "{said}");
    let output = hamel(&["sweep", "--status", &folder.display().to_string()], "");
    assert!(text(&output.stderr).contains("is not a sweep folder"));
}

/// Runs the command after shell commands that set a limit.
fn under(limit: &str, folder: &Path) -> Output {
    let script = format!("{limit}; exec \"$@\"");
    let mut shell = Command::new("sh");
    shell.args(["-c", &script, "sh", env!("CARGO_BIN_EXE_hamel")]);
    shell.args(arguments(&model("heavy_top"), folder, &FAST));
    shell
        .stdin(Stdio::null())
        .output()
        .expect("the command runs")
}

fn hidden(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let names = entries.map(|entry| entry.expect("an entry").file_name().into_string());
    let names = names.map(|name| name.expect("UTF-8"));
    names.filter(|name| name.ends_with(".tmp")).collect()
}

/// Limits files to a number of blocks: none, or enough for the manifest but not for a shard. Writes fail, or the system
/// kills the process during one.
#[test]
fn a_full_disk_leaves_no_half_file() {
    let whole = fresh("disk");
    done(&whole, &FAST);
    let size = |name: &str| fs::metadata(whole.join(name)).expect("a file").len();
    let (manifest, shard) = (size("_sweep.json"), size("shard-000000.parquet"));
    // Blocks of `ulimit` have 512 bytes, in some shells 1024.
    let between = (manifest + shard) / 2 / 1024;
    assert!(
        between * 512 > manifest && between * 1024 < shard,
        "{manifest} {shard}"
    );
    for (name, limit, killed) in [
        ("disk-none", "trap '' XFSZ; ulimit -f 0".to_string(), false),
        (
            "disk-some",
            format!("trap '' XFSZ; ulimit -f {between}"),
            false,
        ),
        ("disk-kill", format!("ulimit -f {between}"), true),
    ] {
        let folder = fresh(name);
        let output = under(&limit, &folder);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), (!killed).then_some(2), "{said}");
        if !killed {
            assert!(
                said.contains("cannot write") && said.contains("File too large"),
                "{said}"
            );
            assert_eq!(hidden(&folder), Vec::<String>::new());
        }
        assert_eq!(shards(&folder), Vec::<PathBuf>::new());
        assert_eq!(folder.join("_sweep.json").exists(), name != "disk-none");
        done(&folder, &FAST);
        assert_eq!(bytes(&folder), bytes(&whole));
        assert_eq!(hidden(&folder), Vec::<String>::new());
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_refused() {
    let file = fresh("file");
    fs::write(&file, "a file").expect("written");
    for folder in [
        file.clone(),
        file.join("below"),
        PathBuf::from("/proc/hamel-sweep"),
    ] {
        let said = refused(&folder, &FAST);
        assert!(
            said.contains("cannot write") && said.contains(folder.to_str().expect("UTF-8")),
            "{said}"
        );
    }
    // A folder without write permission, as user nobody, since root may write anyway.
    let folder = fresh("read-only");
    let half = [&FAST[..], &["--shard", "1/2"]].concat();
    done(&folder, &half);
    let before = bytes(&folder);
    let rights = |mode: &str, path: &Path| {
        let changed = Command::new("chmod").arg("-R").arg(mode).arg(path).status();
        assert!(changed.expect("chmod runs").success());
    };
    rights("a-w,a+rX", &folder);
    let program = fresh("hamel-for-nobody");
    fs::copy(env!("CARGO_BIN_EXE_hamel"), &program).expect("copied");
    let mut command = match am_root() {
        true => Command::new("setpriv"),
        false => Command::new(&program),
    };
    if am_root() {
        command.args(["--reuid=65534", "--regid=65534", "--clear-groups"]);
        command.arg(&program);
    }
    command.args(arguments(&model("heavy_top"), &folder, &FAST));
    let output = command.output().expect("the command runs");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("cannot write") && said.contains("Permission denied"),
        "{said}"
    );
    assert!(status(&folder).contains("2 of 3"));
    assert_eq!(bytes(&folder), before);
    rights("u+w", &folder);
    done(&folder, &FAST);
    assert_eq!(bytes(&folder).len(), 3);
}

fn am_root() -> bool {
    let output = Command::new("id").arg("-u").output().expect("id runs");
    text(&output.stdout).trim() == "0"
}
