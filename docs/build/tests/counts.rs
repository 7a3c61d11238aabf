//! Checks that the operation counts in the book and the README are the locked ones of the tests.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).expect(path)
}

/// Returns the operations of every function of every system in a snapshot.
fn counts(path: &str) -> BTreeMap<(String, String), u64> {
    let (mut system, mut all) = (String::new(), BTreeMap::new());
    for line in read(path).lines() {
        let mut words = line.split_whitespace();
        match (words.next(), words.next(), words.next()) {
            (Some(function), Some(count), Some("flops")) => {
                let count = count.parse().expect("a number");
                all.insert((system.clone(), function.to_string()), count);
            }
            _ => system = line.trim().to_string(),
        }
    }
    all
}

/// Returns the cells of the row of a page that begins with a text.
fn row(page: &str, first: &str) -> Vec<String> {
    let rows = page.lines().filter(|line| line.starts_with("| "));
    let mut cells = rows.map(|line| {
        let cells = line.trim_matches('|').split('|');
        cells.map(|cell| cell.trim().to_string()).collect()
    });
    let found = cells.find(|cells: &Vec<String>| cells[0] == first);
    found.unwrap_or_else(|| panic!("no row {first}"))
}

/// Parses the number at the beginning of a cell.
fn number(cell: &str) -> u64 {
    let digits = cell.split(' ').next().unwrap_or_default().replace(',', "");
    digits
        .parse()
        .unwrap_or_else(|_| panic!("no number: {cell}"))
}

const MODELS: &str = "tests/tests/suite/snapshots/suite__snapshots__operation_counts.snap";
const ROBOTS: &str =
    "cli/tests/suite/snapshots/suite__counts__robots_cost_no_more_than_their_bars.snap";
const CHAINS: &str = "cli/tests/suite/snapshots/suite__counts__chains_grow_by_the_link.snap";

/// The rows of the chapter on costs, each with its model.
const SYSTEMS: [(&str, &str); 10] = [
    ("torque-free body, principal axes", "principal_axes"),
    (
        "heavy top, principal axes, mass on an axis",
        "heavy_top_axis",
    ),
    ("cart-pole", "cart_pole"),
    ("planar double pendulum, angles", "double_pendulum_angles"),
    ("heavy top, full inertia, any centre of mass", "heavy_top"),
    (
        "free body in gravity, full inertia, any centre of mass",
        "free_body_no_wrench",
    ),
    ("the same with a wrench as input", "free_body"),
    ("Chaplygin sleigh", "sleigh"),
    ("disk rolling on a plane", "rolling_disk"),
    ("Whipple bicycle, M, forces and solution for ξ̇", "bicycle"),
];

#[test]
fn the_chapter_on_costs_has_the_counts_of_the_snapshots() {
    let page = read("docs/book/src/cost.md");
    let models = counts(MODELS);
    for (first, model) in SYSTEMS {
        let locked = models[&(model.to_string(), "accel".to_string())];
        assert_eq!(number(&row(&page, first)[1]), locked, "{first}");
    }
    let robots = counts(ROBOTS);
    for (first, robot) in [
        ("UR5, 6 joints", "UR5"),
        ("Panda, 7 joints, fingers locked", "Panda"),
        ("Solo12, floating, 12 joints", "Solo12"),
        ("ANYmal B, floating, 12 joints", "ANYmal B"),
    ] {
        let cells = row(&page, first);
        let functions = ["inverse_dynamics", "mass_matrix", "accel", "linearize"];
        for (cell, function) in cells[1..].iter().zip(functions) {
            let locked = robots[&(robot.to_string(), function.to_string())];
            assert_eq!(number(cell), locked, "{first}, {function}");
        }
    }
    // The increment per link.
    let chains = counts(CHAINS);
    let added = |function: &str, (from, to): (u64, u64)| {
        let count = |links: u64| chains[&(format!("{links} links"), function.to_string())];
        (count(to) - count(from)) as f64 / (to - from) as f64
    };
    let ranges = [(4, 8), (8, 16), (16, 32)];
    assert!(
        ranges
            .iter()
            .all(|range| added("inverse_dynamics", *range) == 156.0)
    );
    let mut accel = ranges.map(|range| added("accel", range).round());
    accel.sort_by(f64::total_cmp);
    let said = format!("{} to {} in forward dynamics", accel[0], accel[2]);
    let flat = page.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat.contains("156 operations more for every link"),
        "{flat}"
    );
    assert!(flat.contains(&said), "{said}");
}

#[test]
fn the_readme_has_them_too() {
    let page = read("README.md");
    let (models, robots) = (counts(MODELS), counts(ROBOTS));
    let lines: Vec<&str> = page.lines().collect();
    let head = lines
        .iter()
        .position(|line| line.starts_with("| cart-pole | heavy top, any inertia"));
    let cells = lines[head.expect("the table") + 2]
        .trim_matches('|')
        .split('|');
    let shown: Vec<u64> = cells.map(|cell| number(cell.trim())).collect();
    let model = |name: &str| models[&(name.to_string(), "accel".to_string())];
    let robot = |name: &str| robots[&(name.to_string(), "accel".to_string())];
    let locked = [
        model("cart_pole"),
        model("heavy_top"),
        model("free_body_no_wrench"),
        robot("UR5"),
        robot("Panda"),
        robot("Solo12"),
    ];
    assert_eq!(shown, locked);
}
