//! Rows of sweeps: dependence, distributions, and errors in options.

use crate::common::{hamel, text};
use crate::shards::bytes;
use crate::swept::{BALL, run, swept, swept_into};
use crate::table::{Table, fresh};

fn refused(options: &[&str]) -> String {
    let folder = fresh("refused");
    let out = folder.display().to_string();
    let output = hamel(&[&["sweep", "-", "--out", &out], options].concat(), BALL);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stdout));
    assert!(!folder.exists(), "nothing is made for what is refused");
    text(&output.stderr)
}

const VARY: &str = "m = normal(2, 0.1); start w = uniform(3, 5); start y = latin(0, 1)";
/// The varied entries, the length of runs, and the kept results.
const SWEPT: [&str; 8] = [
    "--vary",
    VARY,
    "--until",
    "0.1",
    "--step",
    "0.01",
    "--keep",
    "end; max(w)",
];

#[test]
fn a_member_depends_on_the_seed_and_its_number_alone() {
    let options = |more: &[&'static str]| [&SWEPT[..], more].concat();
    let one = options(&[
        "--members",
        "50",
        "--seed",
        "7",
        "--threads",
        "1",
        "--shard-size",
        "8",
    ]);
    let one = swept_into("one", BALL, &one);
    let many = options(&[
        "--members",
        "50",
        "--seed",
        "7",
        "--threads",
        "3",
        "--shard-size",
        "8",
    ]);
    let many = swept_into("many", BALL, &many);
    assert_eq!(bytes(&one).len(), 7);
    assert_eq!(bytes(&one), bytes(&many));

    let parts = fresh("parts");
    for part in ["3/3", "1/3", "2/3"] {
        let mut part = options(&[
            "--members",
            "50",
            "--seed",
            "7",
            "--shard-size",
            "8",
            "--shard",
            part,
        ]);
        part.extend(["--threads", "2"]);
        run(&parts, BALL, &part);
    }
    assert_eq!(bytes(&one), bytes(&parts));

    let table = Table::read(&one);
    assert_eq!(
        table.column("index"),
        (0..50).map(f64::from).collect::<Vec<f64>>()
    );
    let whole = swept("whole", BALL, &options(&["--members", "50", "--seed", "7"]));
    assert_eq!(table, whole);
    // Strata depend on the number of members, all else only on the member.
    let more = swept("more", BALL, &options(&["--members", "80", "--seed", "7"]));
    for name in ["m", "start w"] {
        assert_eq!(table.column(name), more.column(name)[..50]);
    }
    let other = swept("other", BALL, &options(&["--members", "50", "--seed", "8"]));
    for name in ["m", "start w", "start y"] {
        let (a, b) = (table.column(name), other.column(name));
        assert!(a.iter().zip(b).all(|(a, b)| *a != b), "{name}");
    }
}

#[test]
fn columns_have_the_moments_and_strata_that_are_asked_for() {
    let count = 1500;
    let table = swept(
        "moments",
        BALL,
        &[
            "--vary",
            "m = normal(g / 5, 0.1); start w = uniform(3, 5); start v = latin(-1, 2); drift = normal([1, 2], [0.1, 0.2])",
            "--members",
            "1500",
            "--until",
            "0.01",
            "--step",
            "0.01",
        ],
    );
    let uniform = 1.0 / 12_f64.sqrt();
    let mut deviations = Vec::new();
    for (name, mean, deviation) in [
        ("m", 2.0, 0.1),
        ("start w", 4.0, 2.0 * uniform),
        ("drift[1]", 1.0, 0.1),
        ("drift[2]", 2.0, 0.2),
    ] {
        let values = table.column(name);
        let found = values.iter().sum::<f64>() / f64::from(count);
        let squares = values.iter().map(|value| (value - found).powi(2));
        let spread = (squares.sum::<f64>() / f64::from(count)).sqrt();
        let off = 5.0 * deviation / f64::from(count).sqrt();
        assert!((found - mean).abs() < off, "{name}: {found}");
        assert!((spread - deviation).abs() < off, "{name}: {spread}");
        deviations.push(
            values
                .into_iter()
                .map(move |value| (value - mean) / deviation),
        );
    }
    // No two columns are correlated.
    let deviations: Vec<Vec<f64>> = deviations.into_iter().map(Iterator::collect).collect();
    for (place, a) in deviations.iter().enumerate() {
        for b in &deviations[..place] {
            let products = a.iter().zip(b).map(|(a, b)| a * b);
            let correlation = products.sum::<f64>() / f64::from(count);
            assert!(
                correlation.abs() < 5.0 / f64::from(count).sqrt(),
                "{correlation}"
            );
        }
    }
    let strata = table.column("start v").into_iter();
    let mut strata: Vec<i32> = strata
        .map(|value| ((value + 1.0) / 3.0 * f64::from(count)).floor() as i32)
        .collect();
    let in_order = strata.windows(2).filter(|two| two[0] < two[1]).count();
    assert!((600..900).contains(&in_order), "{in_order}");
    strata.sort_unstable();
    assert_eq!(strata, (0..count).collect::<Vec<i32>>());
}

#[test]
fn grids_make_all_combinations() {
    let short = ["--until", "0.01", "--step", "0.01"];
    let grid = "start w = grid(1, 3, 3); m = grid(1, 2, 2)";
    let table = swept("grid", BALL, &[&["--vary", grid], &short[..]].concat());
    let pairs: Vec<(f64, f64)> = table
        .column("start w")
        .into_iter()
        .zip(table.column("m"))
        .collect();
    let wanted = [
        (1.0, 1.0),
        (1.0, 2.0),
        (2.0, 1.0),
        (2.0, 2.0),
        (3.0, 1.0),
        (3.0, 2.0),
    ];
    assert_eq!(pairs, wanted);
    let more = "start w = grid(1, 3, 3); m = uniform(1, 2)";
    let table = swept(
        "grids",
        BALL,
        &[&["--vary", more, "--members", "6"], &short[..]].concat(),
    );
    assert_eq!(table.column("start w"), [1.0, 2.0, 3.0, 1.0, 2.0, 3.0]);
    assert_ne!(table.column("m")[0], table.column("m")[3]);
    let said = refused(&[&["--vary", more, "--members", "7"], &short[..]].concat());
    assert!(
        said.contains("the grids have 3 points: --members has to be a multiple"),
        "{said}"
    );
}

/// An argument of a distribution may refer to the parameter itself and to unvaried ones, but not to other varied ones.
#[test]
fn arguments_are_not_varied_by_others() {
    let said = refused(&[
        "--vary",
        "m = normal(m, m / 10); start w = normal(m, 1)",
        "--members",
        "3",
        "--until",
        "1",
    ]);
    assert!(
        said.contains("`m` is itself varied and has no value here"),
        "{said}"
    );
    assert!(said.contains(":1:34") && said.contains("1 error"), "{said}");
}

#[test]
fn all_that_is_wrong_is_said_at_once() {
    let said = refused(&[
        "--vary",
        "n = normal(1, 2); start w = unifrm(1, 2); input F = grid(0, 1); start w = normal(0, k); m; m = normal(1, 1); m = normal(1, 1)",
        "--members",
        "3",
        "--until",
        "1",
    ]);
    for (message, place) in [
        ("no parameter is called `n`", ":1:1"),
        ("did you mean `uniform`?", ":1:29"),
        ("`grid` takes 3 arguments", ":1:53"),
        ("nothing is called `k`", ":1:85"),
        ("an item is written", ":1:89"),
        ("`m` is varied twice", ":1:110"),
        ("6 errors", ""),
    ] {
        assert!(
            said.contains(message) && said.contains(place),
            "{message} {place}: {said}"
        );
    }
    let keep = |keep: &str| {
        refused(&[
            "--vary",
            "m = normal(1, 1)",
            "--members",
            "3",
            "--until",
            "1",
            "--keep",
            keep,
        ])
    };
    let said = keep("max(k); min(nrm(z)); event([y, z] < 0); event([y, z] < [0, 0])");
    for (message, place) in [
        ("nothing is called `k`", "--keep:1:5"),
        ("no function is called `nrm`", "--keep:1:13"),
        ("cannot subtract", "--keep:1:22"),
    ] {
        assert!(
            said.contains(message) && said.contains(place),
            "{message} {place}: {said}"
        );
    }
    // Names are resolved even if another item cannot be parsed.
    let said = keep("max(w +); min(k); mean(nrm(z))");
    for (message, place) in [
        ("expected an expression", "--keep:1:"),
        ("nothing is called `k`", "--keep:1:15"),
        ("no function is called `nrm`", "--keep:1:24"),
        ("3 errors", ""),
    ] {
        assert!(
            said.contains(message) && said.contains(place),
            "{message} {place}: {said}"
        );
    }
    let said = keep("end; event([y, z] < [0, 0])");
    assert!(
        said.contains("an event compares numbers") && said.contains("--keep:1:6"),
        "{said}"
    );
    // Errors of syntax, of names and of the other option together.
    let said = refused(&[
        "--vary",
        "n = normal(1, 1); m = normal(1, -1)",
        "--members",
        "3",
        "--until",
        "1",
        "--keep",
        "ends; max(k); at(2, w)",
    ]);
    for (message, place) in [
        ("`ends` cannot be kept", "--keep:1:1"),
        ("nothing is called `k`", "--keep:1:11"),
        ("expected a time from 0 to 1", "--keep:1:18"),
        ("3 errors", ""),
        ("no parameter is called `n`", "--vary:1:1"),
        ("a standard deviation cannot be negative", "--vary:1:33"),
        ("2 errors", ""),
    ] {
        assert!(
            said.contains(message) && said.contains(place),
            "{message} {place}: {said}"
        );
    }
    for (option, value, message) in [
        ("--seed", "-1", "a whole number from 0 to 2^64 - 1"),
        ("--members", "-3", "a whole number from 1 to 2^63 - 1"),
        ("--members", "0", "a whole number from 1 to 2^63 - 1"),
        ("--threads", "-1", "not in 1..=65535"),
        ("--shard-size", "-1", "invalid value '-1'"),
    ] {
        let said = refused(&["--vary", "m = normal(1, 1)", "--until", "1", option, value]);
        let whole = format!("invalid value '{value}' for '{option}");
        assert!(said.contains(&whole) && said.contains(message), "{said}");
    }
    for (options, message) in [
        (
            &["--vary", "m = normal(1, 1)", "--until", "1"][..],
            "--members is required",
        ),
        (&["--vary", "", "--until", "1"], "nothing is varied"),
        (
            &[
                "--vary",
                "input F = grid(0, 1, 2)",
                "--input",
                "F = 1",
                "--until",
                "1",
            ],
            "`input F` is varied and also given",
        ),
        (
            &[
                "--vary",
                "m = grid(1, 2, 2)",
                "--until",
                "1",
                "--shard",
                "3/2",
            ],
            "expected i/N",
        ),
        (
            &[
                "--vary",
                "m = grid(1, 2, 2)",
                "--until",
                "1",
                "--method",
                "gauss7",
            ],
            "invalid value",
        ),
        (&["--vary", "m = grid(1, 2, 2)"], "--until"),
    ] {
        let said = refused(options);
        assert!(said.contains(message), "{message}: {said}");
    }
}

#[test]
fn every_member_is_a_point_of_the_picture() {
    let folder = fresh("plotted");
    let (out, picture) = (folder.display().to_string(), folder.with_extension("svg"));
    let place = picture.display().to_string();
    let own = [
        "sweep",
        "-",
        "--out",
        &out,
        "--members",
        "40",
        "--plot",
        &place,
    ];
    let options = [&own[..], &SWEPT].concat();
    let drawn = || {
        let output = hamel(&options, BALL);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        assert!(text(&output.stdout).contains("wrote "));
        std::fs::read_to_string(&picture).expect("a picture")
    };
    let first = drawn();
    // Three causes; the end time has no diagram among the results, since it is the same for all.
    let diagrams = first.matches("h0").count() / 40;
    assert_eq!(first.matches("h0").count(), 40 * diagrams);
    assert!(diagrams >= 9 && diagrams % 3 == 0, "{diagrams}");
    assert!(first.contains("start w") && first.contains("max(w)") && first.contains("40 members"));
    // If nothing is left to compute, the picture is the same.
    assert_eq!(drawn(), first);
}
