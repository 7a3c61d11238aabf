//! Rows of sweeps: what they depend on, how they are distributed, what is kept, and what of members that fail.

mod common;
#[path = "common/table.rs"]
mod table;

use common::{hamel, text};
use hamel::so3;
use std::fs;
use std::path::PathBuf;
use table::{Table, bytes, fresh};

/// A ball that flies in a plane, z̈ = −g + F/m.
const BALL: &str = "system Ball {
    param m = 2, g = 10;
    param drift: vec2 = [0, 0];
    coord y, z;
    velocity v, w;
    rate y = v;
    rate z = w;
    particle mass m at [y, 0, z];
    gravity [0, 0, -g];
    input F;
    generalized force w = F;
    output height = z;
    start v = 1;
    start w = 4;
}";

fn model(name: &str) -> String {
    format!("{}/../tests/models/{name}.eom", env!("CARGO_MANIFEST_DIR"))
}

/// A sweep of a text, or of a file, into a new folder.
fn swept_into(name: &str, model: &str, options: &[&str]) -> PathBuf {
    let folder = fresh(name);
    run(&folder, model, options);
    folder
}

fn run(folder: &std::path::Path, model: &str, options: &[&str]) {
    let out = folder.display().to_string();
    let (file, input) = match model.contains('{') {
        true => ("-", model),
        false => (model, ""),
    };
    let output = hamel(&[&["sweep", file, "--out", &out], options].concat(), input);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

fn swept(name: &str, model: &str, options: &[&str]) -> Table {
    Table::read(&swept_into(name, model, options))
}

fn refused(options: &[&str]) -> String {
    let folder = fresh("refused");
    let out = folder.display().to_string();
    let output = hamel(&[&["sweep", "-", "--out", &out], options].concat(), BALL);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stdout));
    assert!(!folder.exists(), "nothing is made for what is refused");
    text(&output.stderr)
}

const VARY: &str = "m = normal(2, 0.1); start w = uniform(3, 5); start y = latin(0, 1)";

#[test]
fn a_member_depends_on_the_seed_and_its_number_alone() {
    let fixed = [
        "--vary",
        VARY,
        "--until",
        "0.1",
        "--step",
        "0.01",
        "--keep",
        "end; max(w)",
    ];
    let options = |more: &[&'static str]| [&fixed[..], more].concat();
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
    // Strata are those of so many members, all else is the member's own.
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
    // No two columns go together.
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

/// The last row of a run of `hamel simulate`: t, x, ξ.
fn simulated(name: &str, model: &str, state: &str, options: &[&str]) -> Vec<f64> {
    let folder = fresh(&format!("simulated-{name}"));
    fs::create_dir_all(&folder).expect("a folder");
    let (at, out) = (folder.join(format!("{name}.json")), folder.join("run.csv"));
    fs::write(&at, state).expect("a state");
    let (at, out) = (at.display().to_string(), out.display().to_string());
    let fixed = ["simulate", model, "--at", &at, "--out", &out];
    let output = hamel(&[&fixed[..], options].concat(), "");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let written = fs::read_to_string(&out).expect("samples");
    let last = written.lines().last().expect("a row");
    last.split(',')
        .map(|number| number.parse().expect("a number"))
        .collect()
}

/// The values of `end` are those of the same run, to the bit, whatever the method.
#[test]
fn ends_are_those_of_simulate() {
    let top = model("heavy_top");
    for (name, options) in [
        (
            "steps",
            &["--until", "0.2", "--method", "rkmk4", "--step", "0.01"][..],
        ),
        ("auto", &["--until", "0.2", "--step", "0.01"]),
        (
            "tol",
            &["--until", "0.2", "--method", "rkmk8", "--tol", "1e-9"],
        ),
    ] {
        let vary = "m = uniform(1, 2); start w[2] = uniform(-1, 1); start R = uniform(-1, 1); s[3] = uniform(0.2, 0.4)";
        let members = ["--vary", vary, "--members", "3"];
        let table = swept(
            &format!("ends-{name}"),
            &top,
            &[&members[..], options].concat(),
        );
        let end = table
            .names
            .iter()
            .position(|name| name == "end t")
            .expect("end");
        for row in &table.rows {
            let value: Vec<f64> = row.iter().map(|value| value.expect("a number")).collect();
            let [m, w2, s3] = [value[1], value[2], value[6]];
            let turn = so3::retract(so3::identity(), [value[3], value[4], value[5]]);
            let rows: Vec<&[f64]> = turn.chunks(3).collect();
            let state = format!(
                "{{\"param\": {{\"m\": {m:?}, \"s\": [0.1, -0.2, {s3:?}]}}, \"coord\": {{\"R\": {rows:?}}}, \"velocity\": {{\"w\": [0.3, {w2:?}, 5]}}}}"
            );
            assert_eq!(
                value[end..],
                simulated(name, &top, &state, options),
                "{name}"
            );
        }
    }
}

/// What is not given closes loops, and inputs by expressions have the parameters of their member.
#[test]
fn members_are_completed_as_states_are() {
    let bar = model("four_bar_loop");
    let options = ["--until", "0.05", "--step", "0.01"];
    let vary = ["--vary", "start q1 = grid(1, 1.5, 2)"];
    let table = swept("loops", &bar, &[&vary[..], &options].concat());
    for row in &table.rows {
        let value: Vec<f64> = row.iter().map(|value| value.expect("a number")).collect();
        let state = format!("{{\"coord\": {{\"q1\": {:?}}}}}", value[1]);
        assert_eq!(value[2..], simulated("loop", &bar, &state, &options));
    }
    let pushed = [
        "--vary",
        "m = grid(1, 2, 2)",
        "--input",
        "F = m * g + m",
        "--until",
        "1",
    ];
    let table = swept("pushed", BALL, &pushed);
    for w in table.column("end w") {
        assert!((w - 5.0).abs() < 1e-9, "{w}");
    }
    let inputs = ["--vary", "input F = grid(0, 40, 2)", "--until", "1"];
    let found = swept("inputs", BALL, &inputs).column("end w");
    assert!(
        (found[0] + 6.0).abs() < 1e-9 && (found[1] - 14.0).abs() < 1e-9,
        "{found:?}"
    );
}

/// z = w t − g t²/2: lands at 2 w/g, is highest w²/2 g at w/g, and means w t/2 − g t²/6.
#[test]
fn what_is_kept_is_that_of_the_parabola() {
    let keep = "max(height); min(z); mean(z); at(0.3, [y, w]); event(z < 0); event(w <= 0); event(z > 100); event(v > 0); event(2 < z + y)";
    let fixed = [
        "--vary",
        "start w = grid(4, 5, 2)",
        "--until",
        "1",
        "--keep",
        keep,
    ];
    for (name, options, off) in [
        ("steps", &["--method", "rkmk4", "--step", "0.01"][..], 2e-4),
        ("tol", &["--method", "rkmk8", "--tol", "1e-10"], 2e-6),
    ] {
        let table = swept(
            &format!("kept-{name}"),
            BALL,
            &[&fixed[..], options].concat(),
        );
        for (row, w) in [4.0, 5.0].into_iter().enumerate() {
            let at = |name: &str| table.optional(name)[row];
            let near = |name: &str, wanted: f64, off: f64| {
                let found = at(name).expect(name);
                assert!(
                    (found - wanted).abs() <= off,
                    "{name}: {found}, not {wanted}"
                );
            };
            let height = |t: f64| w * t - 5.0 * t * t;
            near("max(height)", height(w / 10.0), off);
            near("min(z)", height(1.0).min(0.0), 1e-12);
            near("mean(z)", w / 2.0 - 10.0 / 6.0, off);
            near("at(0.3, [y, w])[1]", 0.3, 1e-12);
            near("at(0.3, [y, w])[2]", w - 3.0, 1e-12);
            near("event(w <= 0)", w / 10.0, 1e-12);
            assert_eq!(at("event(z > 100)"), None);
            // It holds from the start on.
            assert_eq!(at("event(v > 0)"), None);
            // y + z = t + w t − 5 t².
            let first = ((w + 1.0) - ((w + 1.0_f64).powi(2) - 40.0).max(0.0).sqrt()) / 10.0;
            match (w + 1.0).powi(2) > 40.0 {
                true => near("event(2 < z + y)", first, 1e-12),
                false => assert_eq!(at("event(2 < z + y)"), None),
            }
            match w < 5.0 {
                true => near("event(z < 0)", w / 5.0, 1e-12),
                // Where the run ends it is there, but for rounding.
                false => assert!(at("event(z < 0)").is_none_or(|t| (t - 1.0).abs() < 1e-12)),
            }
        }
    }
}

#[test]
fn members_that_fail_are_rows_with_their_reasons() {
    let grid = [
        "--vary",
        "m = grid(-1, 1, 3)",
        "--until",
        "0.1",
        "--keep",
        "end; max(z)",
    ];
    let table = swept("failed", BALL, &grid);
    assert_eq!(table.column("m"), [-1.0, 0.0, 1.0]);
    for (member, error) in table.errors.iter().enumerate() {
        let kept = [
            table.optional("end t")[member],
            table.optional("max(z)")[member],
        ];
        match error {
            Some(error) => {
                assert!(error.starts_with("singular: the mass matrix"), "{error}");
                assert_eq!((member < 2, kept), (true, [None, None]));
            }
            None => assert!(member == 2 && kept.iter().all(Option::is_some), "{member}"),
        }
    }
    let growing = BALL.replace("force w = F", "force w = exp(20 * z) + F");
    let options = [
        "--vary",
        "start w = grid(-4, 40, 2)",
        "--until",
        "1",
        "--method",
        "rkmk4",
        "--step",
        "0.05",
    ];
    let table = swept("diverging", &growing, &options);
    assert_eq!(table.errors[0], None);
    let error = table.errors[1].clone().expect("it diverges");
    assert!(
        error.starts_with("not finite: the run ends at t = "),
        "{error}"
    );
    let options = ["--vary", "start c = grid(0.6, 2, 2)", "--until", "0.1"];
    let table = swept("start", &model("pendulum"), &options);
    assert_eq!(table.errors[0], None);
    let error = table.errors[1].clone().expect("no such start");
    assert!(
        error.starts_with("start: coord: violates constraint 1"),
        "{error}"
    );
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
    let said = keep("end; event([y, z] < [0, 0])");
    assert!(
        said.contains("an event compares numbers") && said.contains("--keep:1:6"),
        "{said}"
    );
    for (options, message) in [
        (
            &["--vary", "m = normal(1, 1)", "--until", "1"][..],
            "--members says how many there are",
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
            "`input F` is varied, and given",
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
            "i/N is needed",
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
