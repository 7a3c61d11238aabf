//! The figures of the book on speed and error are measured ones: its table is made from `docs/summary.json`, which the
//! command of the report writes together with it.

use hamel_bench::cases::ALL;
use hamel_bench::output::{CHAPTER, SUMMARY};
use hamel_report::data::Report;
use hamel_report::summary::summary;
use hamel_report::{book_excerpt, json};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &str) -> String {
    let path = root().join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn measured() -> Report {
    json::read(&read(SUMMARY)).expect("a report")
}

#[test]
fn the_table_of_the_book_is_what_was_measured() {
    let report = measured();
    let chapter = read(CHAPTER);
    let present = book_excerpt::present(&chapter).expect("a block");
    assert_eq!(
        present,
        book_excerpt::block(&report),
        "run the command of the report"
    );
    assert!(present.lines().count() > 10, "{present}");
    // The chapter contains the command, with the features of a full report.
    let (command, folder) = report.command.split_once(" -- ").expect("arguments");
    for part in [command, folder] {
        assert!(chapter.contains(part), "{part}");
    }
}

#[test]
fn the_summary_holds_every_case_and_nothing_else() {
    let report = measured();
    let names: Vec<&str> = report.cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names, ALL.iter().map(|job| job.name).collect::<Vec<_>>());
    assert_eq!(summary(&report), report);
    assert_eq!(json::write(&report).expect("JSON"), read(SUMMARY));
    // Every other program is named, measured or not.
    for name in ["Rapier", "ode_solvers", "MuJoCo"] {
        assert!(
            report.peers.iter().any(|peer| peer.name.starts_with(name)),
            "{name}"
        );
    }
}

#[test]
fn every_case_ends_at_a_time_of_its_reference() {
    for case in &measured().cases {
        let path = format!("tests/reference/{}.json", case.name);
        let solution = hamel_report::solution::Solution::parse(&read(&path)).expect("a solution");
        assert!(
            solution.times().contains(&case.until),
            "{path}: {}",
            case.until
        );
    }
}
