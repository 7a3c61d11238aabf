//! `hamel lqr`, `step`, `bode` and what `hamel linearize` says of steps, modes and zeros, against closed forms.

use crate::common::{hamel, text};
use serde_json::Value;
use std::path::PathBuf;

/// A mass m on a spring k with a damper c, pushed by F.
const MASS: &str = "system Mass {
    param m = 2, k = 8, c = 0.8;
    coord q;
    velocity v;
    rate q = v;
    input F;
    kinetic m * v^2 / 2;
    potential k * q^2 / 2;
    generalized force v = F - c * v;
    output place = q;
    output felt = 3 * v + F;
}";
const FREE: &str = r#"{"param": {"m": 1, "k": 0, "c": 0}}"#;

/// A pole that stands on a cart, and a turntable that no input reaches.
const CART: &str = "system Cart {
    param M = 1.2, m = 0.3, l = 0.5, g = 9.81;
    input F;
    joint rail: prismatic [1, 0, 0] moves car;
    joint hinge: revolute [0, 1, 0] on car moves rod;
    joint table: revolute [0, 0, 1] at [0, 3, 0] moves plate;
    body on car { mass M; inertia diag(1, 1, 1) about com; }
    body on rod { mass m; com [0, 0, l]; inertia diag(0, 0, 0) about com; }
    body on plate { mass 1; inertia diag(1, 1, 1) about com; }
    gravity [0, 0, -g];
    generalized force rail_dot = F;
    output place = rail;
    output turned = table;
}";

fn file(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("linear");
    std::fs::create_dir_all(&folder).expect("a folder");
    folder.join(name)
}

fn run(words: &[&str], description: &str) -> String {
    let output = hamel(words, description);
    assert!(
        output.status.success(),
        "{words:?}: {}",
        text(&output.stderr)
    );
    text(&output.stdout)
}

fn json(words: &[&str], description: &str) -> Value {
    let words = [words, &["--format", "json"]].concat();
    serde_json::from_str(&run(&words, description)).expect("JSON")
}

fn matrix(value: &Value) -> Vec<Vec<f64>> {
    serde_json::from_value(value.clone()).expect("a matrix")
}

fn refused(words: &[&str], description: &str, status: i32, parts: &[&str]) {
    let output = hamel(words, description);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{words:?}: {said}");
    for part in parts {
        assert!(said.contains(part), "{words:?}: {part}: {said}");
    }
}

fn assert_near(found: f64, expected: f64, what: &str) {
    let scale = expected.abs().max(1e-3);
    assert!(
        (found - expected).abs() < 1e-10 * scale,
        "{what}: {found} is not {expected}"
    );
}

/// A file with the state of a mass without spring and damper.
fn free() -> String {
    let path = file("free.json");
    std::fs::write(&path, FREE).expect("a file");
    path.display().to_string()
}

/// x1' = x2, x2' = u, ∫ (q1 x1² + q2 x2² + r u²) dt: K = (√(q1/r), √(q2/r + 2 √(q1/r))).
#[test]
fn a_double_integrator_has_its_regulator_in_closed_form() {
    let free = free();
    for (q1, q2, r) in [(1.0, 1.0, 1.0), (1e6, 3.0, 1e-6), (2.5e-4, 0.0, 40.0)] {
        let (q, r_given) = (format!("h(v) = {q1}, d(v) = {q2}"), format!("F={r}"));
        let found = json(
            &["lqr", "-", "--at", &free, "--q", &q, "--r", &r_given],
            MASS,
        );
        let gain = matrix(&found["K"]);
        let first = f64::sqrt(q1 / r);
        assert_near(gain[0][0], first, "K1");
        assert_near(gain[0][1], (q2 / r + 2.0 * first).sqrt(), "K2");
        // X = [[k1 k2 r, k1 r], [k1 r, k2 r]].
        let cost = matrix(&found["X"]);
        assert_near(cost[0][0], gain[0][0] * gain[0][1] * r, "X11");
        assert_near(cost[0][1], first * r, "X12");
        assert_near(cost[1][0], cost[0][1], "symmetry");
    }
}

/// In steps of h the double integrator has A = [[1, h], [0, 1]], B = (h²/2, h), and X = Q + Aᵀ X (A − B K) with
/// (R + Bᵀ X B) K = Bᵀ X A.
#[test]
fn a_regulator_in_steps_solves_its_equation() {
    let (h, free) = (0.05, free());
    let found = json(
        &[
            "lqr", "-", "--at", &free, "--step", "0.05", "--q", "h=10,d=1", "--r", "F=0.1",
        ],
        MASS,
    );
    let (k, x) = (matrix(&found["K"]), matrix(&found["X"]));
    let (a, b, q) = ([[1.0, h], [0.0, 1.0]], [h * h / 2.0, h], [10.0, 1.0]);
    let sum = |terms: &dyn Fn(usize, usize) -> f64| -> f64 {
        (0..2)
            .flat_map(|i| (0..2).map(move |j| (i, j)))
            .map(|(i, j)| terms(i, j))
            .sum()
    };
    let weight = 0.1 + sum(&|i, j| b[i] * x[i][j] * b[j]);
    for (j, gain) in k[0].iter().enumerate() {
        assert_near(weight * gain, sum(&|i, l| b[i] * x[i][l] * a[l][j]), "K");
    }
    for i in 0..2 {
        for j in 0..2 {
            let closed = |l: usize| a[l][j] - b[l] * k[0][j];
            let right = sum(&|m, l| a[m][i] * x[m][l] * closed(l));
            assert_near(x[i][j], right + if i == j { q[i] } else { 0.0 }, "X");
        }
    }
    for pole in matrix(&found["poles"]) {
        assert!(pole[0].hypot(pole[1]) < 1.0);
    }
}

/// exp(A h) and ∫ exp(A s) B ds of a damped oscillator.
#[test]
fn steps_are_exponentials() {
    let h: f64 = 0.3;
    let found = json(&["linearize", "-", "--step", "0.3"], MASS);
    let (decay, omega) = (0.2_f64, (4.0_f64 - 0.04).sqrt());
    let (e, c, s) = (
        (-decay * h).exp(),
        (omega * h).cos(),
        (omega * h).sin() / omega,
    );
    let expected = [
        [e * (c + decay * s), e * s],
        [-4.0 * e * s, e * (c - decay * s)],
    ];
    let (a, b) = (matrix(&found["A"]), matrix(&found["B"]));
    for i in 0..2 {
        for j in 0..2 {
            assert_near(a[i][j], expected[i][j], "A");
        }
    }
    assert_near(b[0][0], (1.0 - expected[0][0]) / 8.0, "B1");
    assert_near(b[1][0], expected[0][1] / 2.0, "B2");
    assert_eq!(found["step"], 0.3);
    for pair in matrix(&found["eigenvalues"]) {
        assert_near(pair[0].hypot(pair[1]), e, "|z|");
    }
}

/// y(t) = (1 − e^(−δ t) (cos ω t + δ/ω sin ω t)) / k, with an overshoot of exp(−π δ/ω).
#[test]
fn a_step_response_has_its_closed_form() {
    let out = file("step.csv");
    let words = [
        "step",
        "-",
        "--to",
        "place",
        "--out",
        &out.display().to_string(),
    ];
    let said = run(&words, MASS);
    let (decay, omega) = (0.2_f64, (4.0_f64 - 0.04).sqrt());
    let written = std::fs::read_to_string(&out).expect("a file");
    let mut rows = written.lines();
    assert_eq!(rows.next(), Some("t,y"));
    let mut count = 0;
    for row in rows {
        let (t, y) = row.split_once(',').expect("two columns");
        let (t, y): (f64, f64) = (t.parse().expect("t"), y.parse().expect("y"));
        let swing = (omega * t).cos() + decay / omega * (omega * t).sin();
        assert!(
            (y - (1.0 - (-decay * t).exp() * swing) / 8.0).abs() < 1e-13,
            "{row}"
        );
        count += 1;
    }
    assert!(count > 500);
    let shown = |name: &str| -> f64 {
        let line = said
            .lines()
            .find(|line| line.trim_start().starts_with(name));
        let last = line.and_then(|line| line.split_whitespace().last());
        last.unwrap_or_else(|| panic!("{name}: {said}"))
            .parse()
            .expect("a number")
    };
    assert_near(shown("limit"), 0.125, "limit");
    let overshoot = 100.0 * (-std::f64::consts::PI * decay / omega).exp();
    assert!((shown("overshoot") - overshoot).abs() < 0.02, "{said}");
    // From the last time outside of 2 %: the envelope gives an upper bound, half a period less a lower one.
    let latest = (50.0 / (1.0 - 0.01_f64).sqrt()).ln() / decay;
    let settling = shown("settling");
    assert!(
        settling < latest && settling > latest - std::f64::consts::PI / omega,
        "{said}"
    );
    // In steps the same motion, at multiples of their length.
    let stepped = run(
        &[
            "step", "-", "--to", "place", "--step", "0.35", "--until", "7",
        ],
        MASS,
    );
    assert!(stepped.contains("21 samples"), "{stepped}");
    refused(
        &["step", "-"],
        MASS,
        2,
        &["--to is needed: one of place, felt"],
    );
    refused(
        &["step", "-", "--to", "q"],
        MASS,
        2,
        &["no output or state `q`; there are place, felt, h(v), d(v)"],
    );
}

/// G(iω) = 1/(k − m ω² + i c ω), whose phase goes from 0 to −180°, and the margin where |G| = 1.
#[test]
fn a_frequency_response_has_its_closed_form() {
    let (out, plot) = (file("bode.csv"), file("bode.svg"));
    let (out_given, plot_given) = (out.display().to_string(), plot.display().to_string());
    let words = [
        "bode",
        "-",
        "--to",
        "place",
        "--range",
        "0.01,1000",
        "--out",
        &out_given,
        "--plot",
        &plot_given,
    ];
    run(&words, MASS);
    let written = std::fs::read_to_string(&out).expect("a file");
    for row in written.lines().skip(1) {
        let row: Vec<f64> = row
            .split(',')
            .map(|cell| cell.parse().expect("a number"))
            .collect();
        let (real, imaginary) = (8.0 - 2.0 * row[0] * row[0], 0.8 * row[0]);
        let size = real.hypot(imaginary);
        assert!((row[1] * size - 1.0).abs() < 1e-11, "{row:?}");
        assert!((row[2] + 20.0 * size.log10()).abs() < 1e-9, "{row:?}");
        assert!(
            (row[3] + imaginary.atan2(real).to_degrees()).abs() < 1e-8,
            "{row:?}"
        );
    }
    let drawn = std::fs::read_to_string(&plot).expect("a picture");
    assert!(drawn.contains("phase (degrees)") && drawn.contains("rad/s") && !drawn.contains("NaN"));
    // felt = 3 v + F: (m s² + (c + 3) s + k)/(m s² + c s + k) is nowhere −180°.
    let said = run(&["bode", "-", "--to", "felt"], MASS);
    assert!(
        said.contains("gain margins: none") && said.contains("the loop is stable"),
        "{said}"
    );
    refused(
        &["bode", "-", "--to", "turned"],
        CART,
        1,
        &["nothing passes"],
    );
    refused(
        &["bode", "-", "--to", "place", "--range", "3,2"],
        MASS,
        2,
        &["0 < LOW < HIGH"],
    );
}

/// The pole's angle and the cart's place: zeros of F → place are ±√(g/l), poles ±√(g (M + m)/(M l)) and two zeros; the
/// turntable's two zeros are reached by nothing.
#[test]
fn modes_and_zeros_of_a_cart_have_closed_forms() {
    let found = json(&["linearize", "-", "--modes"], CART);
    let modes = found["modes"].as_array().expect("a list");
    let pole = (9.81_f64 * 1.5 / (1.2 * 0.5)).sqrt();
    assert_near(
        modes[0]["value"][0].as_f64().expect("a number"),
        pole,
        "pole",
    );
    assert_eq!(modes.len(), 6);
    let off: Vec<&Value> = modes
        .iter()
        .filter(|mode| mode["reachable"] == false)
        .collect();
    assert_eq!(off.len(), 2);
    for mode in &off {
        assert_eq!(mode["value"], serde_json::json!([0.0, 0.0]));
    }
    assert!(
        modes.iter().all(|mode| mode["observable"] == true),
        "{modes:?}"
    );
    let path = file("cart.eom");
    std::fs::write(&path, CART.replace("output turned = table;", "")).expect("a file");
    let found = json(&["linearize", &path.display().to_string(), "--modes"], "");
    let zeros = matrix(&found["zeros"]);
    let root = f64::sqrt(9.81 / 0.5);
    assert_near(zeros[0][0], root, "zero");
    assert_near(zeros[zeros.len() - 1][0], -root, "zero");
    // The turntable is an input and output decoupling zero, twice.
    assert_eq!(zeros.len(), 4);
    let said = run(&["linearize", "-", "--modes"], CART);
    assert!(
        said.contains("h(table_dot), d(table_dot); not reached by inputs")
            && said.contains("h(rail_dot), d(rail_dot)\n"),
        "{said}"
    );
}

#[test]
fn what_a_regulator_cannot_do_is_named() {
    let words = ["lqr", "-"];
    refused(
        &words,
        CART,
        1,
        &[
            "the inputs do not reach them",
            "0 of h(table_dot), d(table_dot)",
        ],
    );
    let free = free();
    let at = ["lqr", "-", "--at", &free];
    refused(
        &[&at[..], &["--q", "d = 1"]].concat(),
        MASS,
        1,
        &["0 of h(v)", "give a weight"],
    );
    let wrong: [(&str, &str, &str); 5] = [
        ("--q", "w = 1", "`w` is none of h(v), d(v), place, felt"),
        ("--q", "h = -1", "zero or greater"),
        ("--q", "h", "expected NAME = W"),
        ("--r", "F = 0", "greater than zero"),
        ("--q", "felt = 1", "depends directly on inputs"),
    ];
    for (option, value, why) in wrong {
        refused(&[&at[..], &[option, value]].concat(), MASS, 2, &[why]);
    }
    refused(&["lqr", "-", "--out", "K.txt"], MASS, 2, &[".json or .rs"]);
    let without = MASS.replace("input F;", "param F = 0;");
    refused(&["lqr", "-"], &without, 2, &["a regulator needs inputs"]);
    refused(&["step", "-", "--to", "place"], &without, 2, &["no input"]);
    refused(
        &["linearize", "-", "--step", "1e30"],
        &MASS.replace("F - c * v", "F + c * v"),
        1,
        &["shorter"],
    );
}

/// Weights of an output are those of its states; an unstable mode without weight is mirrored: its pole λ becomes −λ.
#[test]
fn weights_may_be_those_of_outputs_or_none() {
    let path = file("inverted.json");
    std::fs::write(&path, r#"{"param": {"m": 1, "k": -4, "c": 0}}"#).expect("a file");
    let path = path.display().to_string();
    let at = ["lqr", "-", "--at", &path];
    let by_output = json(&[&at[..], &["--q", "place = 9"]].concat(), MASS);
    let by_state = json(&[&at[..], &["--q", "h(v) = 9"]].concat(), MASS);
    assert_eq!(by_output["K"], by_state["K"]);
    let none = json(&[&at[..], &["--q", "h = 0"]].concat(), MASS);
    for pole in matrix(&none["poles"]) {
        // A double eigenvalue −2, which rounding splits by its root.
        assert!((pole[0] + 2.0).hypot(pole[1]) < 1e-6, "{none}");
    }
    assert_near(matrix(&none["K"])[0][0], 8.0, "K1");
    assert_near(matrix(&none["K"])[0][1], 4.0, "K2");
}

/// The gain as Rust is a program; as JSON, what is printed.
#[test]
fn gains_are_written() {
    let (rust, data) = (file("gain.rs"), file("gain.json"));
    let paths = [&rust, &data].map(|path| path.display().to_string());
    run(&["lqr", "-", "-o", &paths[0]], MASS);
    let printed = json(&["lqr", "-", "-o", &paths[1]], MASS);
    let written = std::fs::read_to_string(&data).expect("a file");
    assert_eq!(
        serde_json::from_str::<Value>(&written).expect("JSON"),
        printed
    );
    let program = std::fs::read_to_string(&rust).expect("a file");
    let parsed = syn::parse_file(&program).expect("Rust");
    assert_eq!(parsed.items.len(), 1);
    let gain = matrix(&printed["K"]);
    assert!(
        program.contains(&format!("[{:?}, {:?}],", gain[0][0], gain[0][1])),
        "{program}"
    );
    assert!(program.contains("pub const K: [[f64; 2]; 1]"), "{program}");
}

/// Matrices are the same in all formats.
#[test]
fn formats_agree() {
    let found = json(&["linearize", "-"], MASS);
    let [a, b, c, d] = ["A", "B", "C", "D"].map(|name| matrix(&found[name]));
    let csv = run(&["linearize", "-", "--format", "csv"], MASS);
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some(",h(v),d(v),F"));
    let upper = a
        .iter()
        .zip(&b)
        .map(|(left, right)| [left.clone(), right.clone()].concat());
    let lower = c
        .iter()
        .zip(&d)
        .map(|(left, right)| [left.clone(), right.clone()].concat());
    for ((line, name), row) in lines
        .zip(["h(v)", "d(v)", "place", "felt"])
        .zip(upper.chain(lower))
    {
        let (found, cells) = line.split_once(',').expect("cells");
        let cells: Vec<f64> = cells
            .split(',')
            .map(|cell| cell.parse().expect("a number"))
            .collect();
        assert_eq!((found, cells), (name, row));
    }
    for format in ["matlab", "python"] {
        let text = run(&["linearize", "-", "--format", format], MASS);
        let numbers = |name: &str| -> Vec<f64> {
            let start = text
                .split(&format!("\n{name} = "))
                .nth(1)
                .expect("a matrix");
            let body = &start[start.find("[").expect("[")
                ..start
                    .find(if format == "matlab" { "];" } else { "])" })
                    .expect("]")];
            let cells = body.split(|letter: char| !"+-.e0123456789".contains(letter));
            cells
                .filter(|cell| !cell.is_empty())
                .map(|cell| cell.parse().expect("a number"))
                .collect()
        };
        for (name, matrix) in [("A", &a), ("B", &b), ("C", &c), ("D", &d)] {
            assert_eq!(numbers(name), matrix.concat(), "{format} {name}");
        }
        assert!(text.contains("'h(v)', 'd(v)'"), "{text}");
    }
}

/// A stable system without weights is left alone.
#[test]
fn nothing_is_done_where_nothing_costs() {
    let found = json(&["lqr", "-", "--q", "h = 0"], MASS);
    assert_eq!(matrix(&found["K"]), [[0.0, 0.0]]);
}

/// Poles of a free body are zero to rounding: they set no length of a response.
#[test]
fn a_response_has_a_length_of_its_own() {
    let said = run(&["step", "-", "--to", "place", "--at", &free()], MASS);
    assert!(said.contains("unit step, 10 s"), "{said}");
}

/// The printed law holds a pole upright that falls without it, on a cart that returns.
#[test]
fn a_printed_law_can_be_simulated() {
    let cart = CART.replace(
        "joint table: revolute [0, 0, 1] at [0, 3, 0] moves plate;",
        "",
    );
    let cart = cart.replace(
        "body on plate { mass 1; inertia diag(1, 1, 1) about com; }",
        "",
    );
    let cart = cart.replace("output turned = table;", "start rail = 0.5;");
    let said = run(&["lqr", "-"], &cart);
    assert!(said.contains("* (rail - 0.5)"), "{said}");
    let law = said
        .lines()
        .find_map(|line| line.trim().strip_prefix("--input "));
    let law = law.expect("a law").trim_matches('"');
    let leaning = cart.replace("start rail = 0.5;", "start hinge = 0.2;");
    let out = file("held.csv").display().to_string();
    let words = [
        "simulate", "-", "--until", "20", "--input", law, "--out", &out,
    ];
    run(&words, &leaning);
    let written = std::fs::read_to_string(&out).expect("a file");
    let last = written.lines().last().expect("a row").split(',');
    let last: Vec<f64> = last.map(|cell| cell.parse().expect("a number")).collect();
    assert!(
        (last[1] - 0.5).abs() < 1e-3 && last[2].abs() < 1e-3,
        "{last:?}"
    );
    // In steps, and where displacements are not those of coordinates, nothing is printed.
    let stepped = run(&["lqr", "-", "--step", "0.01"], &cart);
    assert!(!stepped.contains("--input"), "{stepped}");
}
