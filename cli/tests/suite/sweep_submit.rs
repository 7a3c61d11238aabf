//! `hamel sweep --submit` with substitutes for the commands of the engines, which run the tasks in another order, and
//! lose some of them.

use crate::common::{hamel, text};
use crate::shards::bytes;
use crate::table::{Table, fresh};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the script of a task, the last argument, for the tasks of `--array=1-N` from the last to the first, except the
/// tasks in the variable `LOST`. Its arguments are written to a file.
const ENGINE: &str = r#"#!/bin/sh
printf '%s\n' "$@" > "$CALLED"
for word; do
    case "$word" in --array=1-*) last="${word#--array=1-}" ;; esac
    script="$word"
done
failed=0
while [ "$last" -gt 0 ]; do
    case " $LOST " in
        *" $last "*) failed=1 ;;
        *) env "$VARIABLE=$last" sh "$script" > /dev/null || failed=1 ;;
    esac
    last=$((last - 1))
done
exit $failed
"#;

const SWEEP: [&str; 14] = [
    "--vary",
    "start w = uniform(-1, 1)",
    "--members",
    "40",
    "--until",
    "0.02",
    "--step",
    "0.01",
    "--shard-size",
    "2",
    "--seed",
    "1",
    "--keep",
    "max(norm(w)); end",
];

fn model() -> String {
    format!(
        "{}/../tests/models/heavy_top.eom",
        env!("CARGO_MANIFEST_DIR")
    )
}

/// Runs the command with an engine of this name, which loses some tasks.
fn submitted(
    engines: &Path,
    command: &str,
    variable: &str,
    lost: &str,
    folder: &Path,
    options: &[&str],
) -> Output {
    use std::os::unix::fs::PermissionsExt;
    fs::create_dir_all(engines).expect("a folder");
    let program = engines.join(command);
    fs::write(&program, ENGINE).expect("a script");
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).expect("it can be run");
    let path = format!(
        "{}:{}",
        engines.display(),
        std::env::var("PATH").unwrap_or_default()
    );
    Command::new(env!("CARGO_BIN_EXE_hamel"))
        .args(["sweep", &model(), "--out"])
        .arg(folder)
        .args(SWEEP)
        .args(options)
        .envs([
            ("PATH", path.as_str()),
            ("VARIABLE", variable),
            ("LOST", lost),
        ])
        .env("CALLED", engines.join("called"))
        .output()
        .expect("the command runs")
}

#[test]
fn engines_compute_all_parts() {
    let whole = fresh("submit-whole");
    let out = whole.display().to_string();
    let output = hamel(
        &[&["sweep", &model(), "--out", &out], &SWEEP[..]].concat(),
        "",
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(Table::read(&whole).column("index").len(), 40);
    for (engine, command, variable, wanted) in [
        (
            "slurm",
            "sbatch",
            "SLURM_ARRAY_TASK_ID",
            "--array=1-16\n--job-name=hamel-sweep\n--cpus-per-task=2\n",
        ),
        (
            "hyperqueue",
            "hq",
            "HQ_TASK_ID",
            "submit\n--array=1-16\n--name=hamel-sweep\n--cpus=2\n",
        ),
    ] {
        let (engines, folder) = (
            fresh(&format!("engine-{engine}")),
            fresh(&format!("it's {engine}")),
        );
        let options = ["--submit", engine, "--threads=2", "--wait"];
        let output = submitted(&engines, command, variable, "3 7", &folder, &options);
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stdout));
        let said = text(&output.stderr);
        assert!(
            said.contains("has failed") && said.contains("to compute what is missing"),
            "{said}"
        );
        // Parts 3 and 7 of 16 have shards 2 and 18, and 6.
        assert_eq!(bytes(&folder).len(), 17);
        let called = fs::read_to_string(engines.join("called")).expect("the engine was called");
        assert!(
            called.starts_with(wanted) && called.contains("--wait\n"),
            "{called}"
        );

        let output = submitted(&engines, command, variable, "", &folder, &options);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let said = text(&output.stdout);
        assert!(
            said.contains("20 of 20") && !said.contains("missing"),
            "{said}"
        );
        assert_eq!(bytes(&folder), bytes(&whole));
    }
}

#[test]
fn what_cannot_be_submitted_is_refused() {
    let (engines, folder) = (fresh("no-engine"), fresh("no-engine-runs"));
    let output = Command::new(env!("CARGO_BIN_EXE_hamel"))
        .args(["sweep", &model(), "--submit", "slurm", "--out"])
        .arg(&folder)
        .args(SWEEP)
        .env("PATH", &engines)
        .output()
        .expect("the command runs");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("cannot run `sbatch`") && said.contains("_task.sh"),
        "{said}"
    );
    let (out, model) = (folder.display().to_string(), model());
    for (options, why) in [
        (
            &["--submit", "slurm", "--shard", "1/2"][..],
            "cannot be used with",
        ),
        (&["--tasks", "4"], "--submit"),
        (&["--submit", "pbs"], "invalid value"),
    ] {
        let all = [&["sweep", &model, "--out", &out], &SWEEP[..], options].concat();
        let output = hamel(&all, "");
        assert_eq!(output.status.code(), Some(2));
        assert!(
            text(&output.stderr).contains(why),
            "{}",
            text(&output.stderr)
        );
    }
    let output = hamel(
        &[
            &["sweep", "-", "--out", &out, "--submit", "slurm"],
            &SWEEP[..],
        ]
        .concat(),
        "",
    );
    assert!(
        text(&output.stderr).contains("a description in a file"),
        "{}",
        text(&output.stderr)
    );
}
