//! Inputs of runs from files and by expressions, and samples at given times, against closed forms; functions in Rust
//! evaluated by their stand-ins.

use crate::common::{hamel, text};
use std::path::{Path, PathBuf};

/// A mass of 2 on a rail, q̈ = F/2.
const RAIL: &str = "system Rail {
    param m = 2;
    input F, side: vec2;
    joint q: prismatic [1, 0, 0] moves slide { force F + side[2]; }
    body on slide { mass m; com [0, 0, 0]; }
    state z = 0;
    rate z = F;
}";

/// Error bound of a run.
const CLOSE: f64 = 1e-9;

fn file(name: &str, content: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("inputs");
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(name);
    std::fs::write(&path, content).expect("written");
    path
}

/// The samples of a run of the rail: t, q, q_dot, z.
fn samples(name: &str, arguments: &[&str]) -> Vec<Vec<f64>> {
    let out = file(name, "").display().to_string();
    let fixed = ["simulate", "-", "--until", "3", "--out", &out];
    let output = hamel(&[&fixed[..], arguments].concat(), RAIL);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let written = std::fs::read_to_string(&out).expect("samples");
    let numbers = |line: &str| {
        line.split(',')
            .map(|n| n.parse().expect("a number"))
            .collect()
    };
    written.lines().skip(1).map(numbers).collect()
}

fn near(found: &[f64], wanted: [f64; 4]) {
    for (found, wanted) in found.iter().zip(wanted) {
        assert!((found - wanted).abs() < CLOSE, "{found} {wanted}");
    }
}

/// Between rows F is linear: 2 t up to 1, then 2 − 2 (t − 1).
#[test]
fn inputs_from_a_file() {
    let forces = file("forces.csv", "# newtons\nt, F\n0, 0\n1, 2\n3, -2\n");
    let forces = forces.to_str().expect("UTF-8");
    let times = file("at.csv", "t\n0\n0.5\n1\n3\n");
    let times = times.to_str().expect("UTF-8");
    let exact = |t: f64| {
        let s = t - 1.0;
        match t <= 1.0 {
            true => [t, t.powi(3) / 6.0, t * t / 2.0, t * t],
            false => [
                t,
                1.0 / 6.0 + s / 2.0 + s * s / 2.0 - s.powi(3) / 6.0,
                0.5 + s - s * s / 2.0,
                1.0 + 2.0 * s - s * s,
            ],
        }
    };
    let equal: &[&str] = &["--method", "rkmk8", "--step", "0.01"];
    let chosen: &[&str] = &["--method", "rkmk8", "--tol", "1e-12"];
    for method in [equal, chosen] {
        let asked = [method, &["--inputs", forces, "--times", times]].concat();
        let rows = samples("lines.csv", &asked);
        let found: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        assert_eq!(found, [0.0, 0.5, 1.0, 3.0]);
        rows.iter().for_each(|row| near(row, exact(row[0])));
    }
    // With `--hold`, F is 0, then 2, and q = (t − 1)²/2.
    let held = samples(
        "held.csv",
        &[equal, &["--inputs", forces, "--hold"]].concat(),
    );
    near(held.last().expect("samples"), [3.0, 2.0, 2.0, 4.0]);
}

/// F = −8 q makes an oscillator with ω = 2, q(0) = 0, q̇(0) = 1; entries of vectors are separate inputs.
#[test]
fn inputs_by_expressions() {
    let start = file("start.json", r#"{"velocity": {"q_dot": 1}}"#);
    let start = start.to_str().expect("UTF-8");
    let common = ["--at", start, "--method", "rkmk8", "--step", "0.01"];
    let rows = samples(
        "swing.csv",
        &[&common[..], &["--input", "F = -4 * m * q"]].concat(),
    );
    for row in rows {
        let t = row[0];
        near(
            &row,
            [
                t,
                (2.0 * t).sin() / 2.0,
                (2.0 * t).cos(),
                2.0 * ((2.0 * t).cos() - 1.0),
            ],
        );
    }
    // q̈ = 6 t/2.
    let both = ["--input", "F = 2 * t", "--input", "side = [t, 4 * t]"];
    let rows = samples("times.csv", &[&common[..], &both].concat());
    for row in rows {
        let t = row[0];
        near(&row, [t, t + t.powi(3) / 2.0, 1.0 + 1.5 * t * t, t * t]);
    }
    // z = t², so that q̈ = (2 t + t²)/2.
    let entry = ["--input", "side[2] = z", "--input", "F = 2 * t"];
    let rows = samples("entry.csv", &[&common[..], &entry].concat());
    for row in rows {
        let t = row[0];
        let place = t + t.powi(3) / 6.0 + t.powi(4) / 24.0;
        near(&row, [t, place, 1.0 + t * t / 2.0 + t.powi(3) / 6.0, t * t]);
    }
}

/// v̇₂ = v₂ from 1, where v₁ is inactive: an entry of a vector keeps its name without the others.
#[test]
fn inputs_know_entries_of_vectors() {
    let ball = "system Ball { coord r: R3; velocity v: vec3; rate r = v; particle mass 1 at r; inactive v[1]; input F;
        generalized force v[2] = F; output y = v[2]; start v[2] = 1; }";
    let description = file("ball.eom", ball).display().to_string();
    for input in ["F = v[2]", "F = v_2 + 0 * r[2]"] {
        let output = hamel(
            &["simulate", &description, "--until", "1", "--input", input],
            "",
        );
        let report = text(&output.stdout);
        assert!(report.contains("2.71828"), "{report}");
    }
}

/// An entry of a coordinate is not a velocity of the same name: q̈ = r₂ = 2, not `r_2` = 0.
#[test]
fn entries_of_coordinates_are_no_velocities() {
    let two = "system Two { coord r: R3, q; velocity r_1, r_2, r_3, u; rate r = [r_1, r_2, r_3], q = u; particle mass 1 at r;
        kinetic u^2 / 2; input F; generalized force u = F; output y = q; start r = [0, 2, 0]; }";
    let description = file("two.eom", two).display().to_string();
    let output = hamel(
        &[
            "simulate",
            &description,
            "--until",
            "1",
            "--input",
            "F = r[2]",
        ],
        "",
    );
    let said = text(&output.stdout);
    let line = said
        .lines()
        .find(|line| line.trim_start().starts_with("u "));
    assert!(
        line.is_some_and(|line| line.trim_end().ends_with(" 2")),
        "{said}"
    );
}

#[test]
fn what_cannot_be_used_is_said() {
    let path = |name: &str, content: &str| file(name, content).display().to_string();
    let cases: [(&[&str], &str); 16] = [
        (
            &["--input", "G = 2"],
            "no input is called `G`: the inputs are F, side[1], side[2]",
        ),
        (&["--input", "sides[1] = 2"], "did you mean `side[1]`?"),
        (&["--input", "F = qq"], "nothing is called `qq`"),
        (
            &["--input", "F = -2 * qdot"],
            "nothing is called `qdot`; the rate of `q` is `q_dot`",
        ),
        (&["--input", "F = dq"], "the rate of `q` is `q_dot`"),
        (
            &["--input", "F = [1, 2]"],
            "`F` is a number, this is 2 numbers",
        ),
        (
            &["--input", "side = 1"],
            "`side` was declared as a vector of 2, but its value is a scalar",
        ),
        (&["--input", "F"], "an input is written `NAME = EXPRESSION`"),
        (&["--input", "F = 1; q"], "expected one expression"),
        (
            &["--input", "F = 1", "--input", "F = 2"],
            "`F` is given twice",
        ),
        (
            &["--inputs", &path("falling.csv", "t,F\n0,1\n2,1\n1,1\n")],
            "line 4: t = 1 is not after t = 2",
        ),
        (
            &["--inputs", &path("unknown.csv", "t,G\n0,1\n4,1\n")],
            "no input is called `G`",
        ),
        (
            &["--inputs", &path("missing.csv", "time,F\n0,1\n4,1\n")],
            "no column `t`",
        ),
        (
            &["--inputs", &path("short.csv", "t,F\n0,1\n2,1\n")],
            "its times reach from 0 to 2, the run from 0 to 3",
        ),
        (
            &["--inputs", &path("ragged.csv", "t,F\n0,1\n4\n")],
            "line 3: 1 column, the header has 2",
        ),
        (
            &["--times", &path("late.csv", "t\n1\n5\n")],
            "line 3: t = 5 is outside the run",
        ),
    ];
    for (arguments, wanted) in cases {
        let output = hamel(
            &[&["simulate", "-", "--until", "3"], arguments].concat(),
            RAIL,
        );
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(wanted), "{said}");
    }
    let both = path("both.csv", "t,F\n0,1\n4,1\n");
    let output = hamel(
        &[
            "simulate", "-", "--until", "3", "--inputs", &both, "--input", "F = 1",
        ],
        RAIL,
    );
    assert!(text(&output.stderr).contains("`F` is given by a column of --inputs and by --input"));
}

/// A pull of −3 x on a mass of 2, a function in Rust; `stand_in` follows its declaration.
fn pulled(stand_in: &str) -> String {
    format!(
        "system Pulled {{
    extern fn pull(x) -> 1{stand_in};
    joint q: prismatic [1, 0, 0] moves slide;
    body on slide {{ mass 2; com [0, 0, 0]; }}
    generalized force q_dot = -pull(q);
    start q = 0.5;
}}"
    )
}

#[test]
fn functions_in_rust_have_values_by_their_stand_ins_alone() {
    let alone = pulled("");
    for command in [
        &["eval", "-"][..],
        &["linearize", "-"],
        &["simulate", "-", "--until", "1"],
    ] {
        let output = hamel(command, &alone);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{said}");
        let wanted = "`pull` is a function in Rust, which cannot be called here";
        assert!(
            said.contains(wanted) && said.contains("2:15") && said.contains("-> 1 = 0;"),
            "{said}"
        );
    }
    for command in ["emit", "check", "ops", "tables"] {
        let output = hamel(&[command, "-"], &alone);
        assert!(
            output.status.success(),
            "{command}: {}",
            text(&output.stderr)
        );
    }
    let standing = pulled(" = 3 * x");
    let output = hamel(&["eval", "-"], &standing);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(
        value
            .pointer("/accel/0")
            .and_then(serde_json::Value::as_f64),
        Some(-0.75)
    );
    let output = hamel(&["linearize", "-"], &standing);
    assert!(text(&output.stdout).contains("1.22474"), "ω = √(3/2)");
    // The emitted code differs only in its hash and in the description at its top.
    let emitted = |text: &str| {
        let output = hamel(&["emit", "-"], text);
        let text = String::from_utf8(output.stdout).expect("UTF-8");
        text.lines()
            .filter(|line| !line.starts_with("//"))
            .collect::<Vec<_>>()
            .join("\n")
    };
    assert_eq!(emitted(&alone), emitted(&standing));
}

const PENDULUM: &str = "system Pendulum {
    param m = 1, l = 0.5, g = 9.81;
    coord q;
    velocity w;
    rate q = w;
    particle mass m at [l * sin(q), 0, -l * cos(q)];
    gravity [0, 0, -g];
    input tau;
    generalized force w = tau;
    start q = 2.9;
}";

/// The last row of a run, and its messages.
fn end(name: &str, arguments: &[&str]) -> (Vec<f64>, String) {
    let out = file(name, "").display().to_string();
    let fixed = ["simulate", "-", "--until", "0.5", "--out", &out];
    let output = hamel(&[&fixed[..], arguments].concat(), PENDULUM);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let written = std::fs::read_to_string(&out).expect("samples");
    let last = written.lines().last().expect("a row").split(',');
    let last = last.map(|n| n.parse().expect("a number")).collect();
    (last, text(&output.stdout))
}

/// Splitting has its full order only if forces do not depend on velocities; an input may introduce this dependence.
#[test]
fn inputs_that_depend_on_velocities_are_not_split() {
    let feedback = "tau = -12 * (q - pi) - 3 * w";
    let by = |method: &str| {
        end(
            "by.csv",
            &["--input", feedback, "--method", method, "--step", "1e-3"],
        )
        .0
    };
    let (wanted, collocated) = (by("rkmk8"), by("gauss6"));
    let (found, said) = end("auto.csv", &["--input", feedback, "--step", "1e-3"]);
    for ((wanted, collocated), found) in wanted.iter().zip(&collocated).zip(&found) {
        assert!(
            (wanted - collocated).abs() < CLOSE && (wanted - found).abs() < CLOSE,
            "{said}"
        );
    }
    assert!(
        said.contains("rkmk54 was chosen: forces depend on velocities"),
        "{said}"
    );
    for method in [
        "splitting",
        "splitting2",
        "splitting6",
        "suzuki",
        "kahan-li",
        "lgvi",
    ] {
        let asked = [
            "simulate", "-", "--until", "0.5", "--method", method, "--input", feedback,
        ];
        let output = hamel(&asked, PENDULUM);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{method}: {said}");
        assert!(
            said.contains("the input `tau` makes forces depend on velocities"),
            "{method}: {said}"
        );
    }
    // A function of the configuration alone can be split and keeps the order.
    let spring = "tau = -12 * (q - pi) * cos(t)";
    let (found, said) = end("split.csv", &["--input", spring]);
    assert!(said.contains("splitting6 was chosen"), "{said}");
    let (wanted, _) = end("spring.csv", &["--input", spring, "--method", "rkmk8"]);
    near(&found, [wanted[0], wanted[1], wanted[2], 0.0]);
}
