//! What the README says of speed and error is what the report says.

use hamel_bench::cases::ALL;
use hamel_report::{json, readme};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &str) -> String {
    let path = root().join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn the_block_of_the_readme_is_that_of_the_report() {
    let report = json::read(&read("docs/report/report.json")).expect("a report");
    let readme = read("README.md");
    let present = readme::present(&readme).expect("a block");
    assert_eq!(
        present,
        readme::block(&report),
        "run the command of the report"
    );
    assert!(present.lines().count() > 10, "{present}");
}

#[test]
fn the_report_holds_every_case_and_reads_back() {
    let text = read("docs/report/report.json");
    let report = json::read(&text).expect("a report");
    let names: Vec<&str> = report.cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names, ALL.iter().map(|job| job.name).collect::<Vec<_>>());
    assert_eq!(json::write(&report).expect("JSON"), text);
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
    let report = json::read(&read("docs/report/report.json")).expect("a report");
    for case in &report.cases {
        let path = format!("tests/reference/{}.json", case.name);
        let solution = hamel_report::solution::Solution::parse(&read(&path)).expect("a solution");
        assert!(
            solution.times().contains(&case.until),
            "{path}: {}",
            case.until
        );
    }
}
