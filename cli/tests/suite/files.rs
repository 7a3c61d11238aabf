//! Files that commands write: completely, or not at all; failures to write are errors, and no command hangs.

use crate::common::{hamel, text};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Time limit for one command, generous because the machine may be busy.
const PATIENCE: Duration = Duration::from_secs(120);

const CART: &str = r#"<robot name="cart">
  <link name="rail"/>
  <joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/></joint>
  <link name="cart"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
</robot>"#;

fn model(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/models");
    folder.join(name).display().to_string()
}

/// An empty folder for one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("files")
        .join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Waits for a command, and kills it after the time limit.
fn in_time(mut child: Child) -> Output {
    let start = Instant::now();
    while child.try_wait().expect("a child").is_none() {
        if start.elapsed() > PATIENCE {
            child.kill().expect("a child");
            panic!("the command hangs");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    child.wait_with_output().expect("it has ended")
}

fn spawn(command: &mut Command) -> Output {
    let piped = command.stdin(Stdio::null()).stderr(Stdio::piped());
    in_time(piped.spawn().expect("the command runs"))
}

/// Commands that write to a file, which is the last argument; robots come from a file next to it.
fn writers(folder: &Path, file: &str) -> Vec<Vec<String>> {
    let robot = folder.parent().expect("a folder").join("cart.urdf");
    fs::write(&robot, CART).expect("a robot");
    let path = folder.join(file).display().to_string();
    let robot = robot.display().to_string();
    let top = model("pendulum.eom");
    let lines: [&[&str]; 4] = [
        &["emit", &top, "-o", &path],
        &["import", &robot, "-o", &path],
        &["simulate", &top, "--until", "1", "--out", &path],
        &["simulate", &top, "--until", "1", "--plot", &path],
    ];
    let owned = |line: &&[&str]| line.iter().map(|word| word.to_string()).collect();
    lines.iter().map(owned).collect()
}

/// Runs the command after shell commands that set a limit.
fn under(limit: &str, arguments: &[String]) -> Output {
    let script = format!("{limit}; exec \"$@\"");
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &script, "sh", env!("CARGO_BIN_EXE_hamel")])
        .args(arguments);
    spawn(shell.stdout(Stdio::piped()))
}

/// A sum of as many operands as are allowed needs more stack than the 1 MB that Windows gives the main thread.
#[test]
fn deep_descriptions_need_no_stack_of_the_system() {
    let sum: Vec<String> = (1..500).map(|k| format!("sin({k} * x)")).collect();
    let folder = folder("deep");
    let [file, out] = ["deep.eom", "deep.rs"].map(|name| folder.join(name));
    let description = format!(
        "system Deep {{ coord x; velocity v; rate x = v; kinetic v^2; potential {}; }}",
        sum.join(" + ")
    );
    fs::write(&file, description).expect("a file");
    let [file, out] = [file, out].map(|path| path.display().to_string());
    let line = ["emit", &file, "-o", &out].map(str::to_string);
    let output = under("ulimit -s 1024", &line);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

/// The disk is full after the first byte: writes fail, or the system kills the process during one.
#[test]
fn a_full_disk_and_a_kill_leave_the_old_file() {
    for (name, limit, killed) in [
        ("full", "trap '' XFSZ; ulimit -f 0", false),
        ("killed", "ulimit -f 0", true),
    ] {
        let folder = folder(name);
        for arguments in writers(&folder, "out.svg") {
            let out = folder.join("out.svg");
            fs::write(&out, "the old text").expect("a file");
            let output = under(limit, &arguments);
            assert!(!output.status.success(), "{arguments:?}");
            assert_eq!(output.status.code().is_none(), killed, "{arguments:?}");
            if !killed {
                let said = text(&output.stderr);
                assert!(
                    said.contains("cannot write") && said.contains("File too large"),
                    "{said}"
                );
            }
            assert_eq!(
                fs::read_to_string(&out).expect("a file"),
                "the old text",
                "{arguments:?}"
            );
            // Without the limit the file is written.
            let output = under("true", &arguments);
            assert!(output.status.success(), "{}", text(&output.stderr));
            assert_ne!(fs::read_to_string(&out).expect("a file"), "the old text");
        }
    }
}

#[test]
fn what_is_no_file_is_refused_with_its_reason() {
    let folder = folder("refused");
    assert!(
        Command::new("mkfifo")
            .arg(folder.join("pipe.svg"))
            .status()
            .expect("mkfifo")
            .success()
    );
    fs::create_dir(folder.join("folder.svg")).expect("a folder");
    std::os::unix::fs::symlink("/dev/full", folder.join("full.svg")).expect("a link");
    for (name, reason) in [
        ("pipe.svg", "it is a pipe that nobody reads from"),
        ("folder.svg", "it is a folder"),
        ("full.svg", "No space left on device"),
        ("none/out.svg", "No such file or directory"),
    ] {
        for arguments in writers(&folder, name) {
            let output = under("true", &arguments);
            let said = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{arguments:?} {said}");
            assert!(
                said.contains("cannot write") && said.contains(reason),
                "{arguments:?} {said}"
            );
        }
    }
    // Comparing with a pipe would wait for a writer.
    let pipe = folder.join("pipe.svg").display().to_string();
    let check = ["emit", &model("pendulum.eom"), "--check", "-o", &pipe].map(String::from);
    let output = under("true", &check);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(said.contains("it is no regular file"), "{said}");
}

#[test]
fn a_full_standard_output_is_an_error() {
    let (top, robot) = (model("pendulum.eom"), folder("output").join("cart.urdf"));
    fs::write(&robot, CART).expect("a robot");
    let robot = robot.display().to_string();
    let lines: [&[&str]; 11] = [
        &["emit", &top],
        &["emit", &top, "-o", "/dev/stdout"],
        &["import", &robot],
        &["check", &top],
        &["tables", &top],
        &["ops", &top],
        &["eval", &top],
        &["linearize", &top],
        &["simulate", &top, "--until", "1"],
        &[
            "compare",
            &top,
            "--until",
            "1",
            "--methods",
            "rkmk4",
            "--steps",
            "10",
        ],
        &["--help"],
    ];
    for arguments in lines {
        let full = File::options()
            .write(true)
            .open("/dev/full")
            .expect("a device");
        let output = spawn(
            Command::new(env!("CARGO_BIN_EXE_hamel"))
                .args(arguments)
                .stdout(full),
        );
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?} {said}");
        assert!(
            said.contains("No space left on device"),
            "{arguments:?} {said}"
        );
    }
}

#[test]
fn standard_output_may_be_named() {
    let emit = |out: &[&str]| {
        let top = model("pendulum.eom");
        let output = hamel(&[&["emit", &top], out].concat(), "");
        assert!(output.status.success(), "{}", text(&output.stderr));
        output.stdout
    };
    assert_eq!(emit(&["-o", "/dev/stdout"]), emit(&[]));
    assert!(emit(&["-o", "/dev/null"]).is_empty());
    // A file to which the shell appends keeps its content.
    let log = folder("named").join("log");
    fs::write(&log, "old\n").expect("a file");
    let file = File::options().append(true).open(&log).expect("a file");
    let mut command = Command::new(env!("CARGO_BIN_EXE_hamel"));
    let top = model("pendulum.eom");
    let output = spawn(
        command
            .args(["emit", &top, "-o", "/dev/stdout"])
            .stdout(file),
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    let log = fs::read_to_string(&log).expect("a file");
    assert_eq!(log, format!("old\n{}", text(&emit(&[]))));
}

#[test]
fn a_folder_of_a_comparison_is_written_whole() {
    let folder = folder("compare");
    let (top, out) = (
        model("pendulum.eom"),
        folder.join("report").display().to_string(),
    );
    let arguments = [
        "compare",
        &top,
        "--until",
        "1",
        "--methods",
        "rkmk4",
        "--steps",
        "10",
        "-o",
        &out,
    ];
    let arguments = arguments.map(String::from);
    assert!(under("true", &arguments).status.success());
    let files = || -> Vec<(PathBuf, String)> {
        let entries = fs::read_dir(&out).expect("a folder");
        let paths = entries.map(|entry| entry.expect("an entry").path());
        let mut files: Vec<_> = paths
            .map(|path| (path.clone(), fs::read_to_string(path).expect("a text")))
            .collect();
        files.sort();
        files
    };
    let before = files();
    assert_eq!(before.len(), 4, "{before:?}");
    let output = under("trap '' XFSZ; ulimit -f 0", &arguments);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(files() == before);
}
