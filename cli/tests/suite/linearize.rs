//! `hamel linearize` and `hamel ops --advise` as users run them: eigenvalues with closed forms.

use crate::common::{hamel, text};
use serde_json::Value;

/// Rounding error of the QR algorithm on matrices of about ten rows, with entries up to 1e3.
const ROUNDING: f64 = 1e-9;

fn model(name: &str) -> String {
    format!("{}/../tests/models/{name}.eom", env!("CARGO_MANIFEST_DIR"))
}

fn linearized(name: &str, state: &str) -> Value {
    let arguments = ["linearize", &model(name), "--at", "-", "--format", "json"];
    let output = hamel(&arguments, state);
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Asserts that each expected eigenvalue is found once.
fn assert_eigenvalues(linear: &Value, expected: &[(f64, f64)]) {
    let list = linear["eigenvalues"].as_array().expect("a list");
    let mut found: Vec<(f64, f64)> = list
        .iter()
        .map(|pair| (pair[0].as_f64().expect("re"), pair[1].as_f64().expect("im")))
        .collect();
    assert_eq!(found.len(), expected.len());
    for &(re, im) in expected {
        let near = found
            .iter()
            .position(|(a, b)| (a - re).hypot(b - im) < ROUNDING * (1.0 + re.hypot(im)));
        let near = near.unwrap_or_else(|| panic!("{re} + {im} i is not among {found:?}"));
        found.remove(near);
    }
}

/// The sleeping top is stable if (C ω)² > 4 m g l A: in axes at rest its tilt z satisfies
/// A z̈ − i C ω ż − m g l z = 0; body axes turn with ω.
#[test]
fn the_sleeping_top_is_stable_where_it_spins_fast() {
    let (m, g, l, a, c) = (1.2, 9.81, 0.25, 0.15, 0.04);
    for spin in [0.0, 20.0, 33.0, 34.0, 60.0] {
        let state = format!("{{\"velocity\": {{\"w\": [0, 0, {spin}]}}}}");
        let linear = linearized("lagrange_top", &state);
        let mut expected = vec![(0.0, 0.0), (0.0, 0.0)];
        let turning = c * spin / (2.0 * a) - spin;
        let square: f64 = 4.0 * m * g * l * a - f64::powi(c * spin, 2);
        let root = square.abs().sqrt() / (2.0 * a);
        for sign in [1.0, -1.0] {
            let (re, im) = if square > 0.0 {
                (sign * root, turning)
            } else {
                (0.0, turning + sign * root)
            };
            expected.extend([(re, im), (re, -im)]);
        }
        assert_eigenvalues(&linear, &expected);
    }
}

/// Equal masses and rods: ω² = (2 ± √2) g/l.
#[test]
fn the_double_pendulum_at_rest_has_its_textbook_frequencies() {
    let still = r#"{"coord": {"th1": 0, "th2": 0}}"#;
    let linear = linearized("double_pendulum_angles", still);
    let mut expected = Vec::new();
    for square in [2.0 + 2.0_f64.sqrt(), 2.0 - 2.0_f64.sqrt()] {
        let omega: f64 = (9.81 * square).sqrt();
        expected.extend([(0.0, omega), (0.0, -omega)]);
    }
    assert_eigenvalues(&linear, &expected);
}

/// A force on a free body at rest: B is M⁻¹, and displacements drift.
#[test]
fn inputs_have_columns_of_their_own() {
    let linear = linearized("free_body", r#"{"velocity": {"w": [0, 0, 0]}}"#);
    let b = linear["B"].as_array().expect("rows");
    assert_eq!((b.len(), b[0].as_array().map(Vec::len)), (12, Some(6)));
    assert_eq!(linear["inputs"][3], "tau[1]");
    assert_eq!(linear["states"][0], "h(v[1])");
    assert!((0..6).all(|row| (0..6).all(|column| b[row][column] == 0.0)));
    // M⁻¹ is symmetric.
    for (i, j) in [(0, 4), (1, 3), (2, 5), (3, 5)] {
        let (a, t) = (b[6 + i][j].as_f64(), b[6 + j][i].as_f64());
        assert!((a.expect("a number") - t.expect("a number")).abs() < 1e-14);
    }
}

#[test]
fn the_text_names_rows_and_says_where_it_holds() {
    let output = hamel(&["linearize", &model("cart_pole")], "");
    let report = text(&output.stdout);
    for part in ["h(w)", "d(v)", "eigenvalues of A", "hold for this instant"] {
        assert!(report.contains(part), "{part}: {report}");
    }
    // Zeros share one line, between the other eigenvalues.
    let values = report.split("eigenvalues of A").nth(1).expect("values");
    let values: Vec<&str> = values.lines().skip(1).take(3).map(str::trim).collect();
    assert_eq!(values[1], "0, 2 times", "{report}");
    assert!(
        values[2].starts_with('-') && !values[0].starts_with('-'),
        "{report}"
    );
    let free = "system Free { input F, _G; coord q; velocity v; rate q = v; kinetic v^2 / 2; generalized force v = F + q; output y = v; }";
    let output = hamel(&["linearize", "-"], free);
    let report = text(&output.stdout);
    assert!(
        report.contains("\nD = 0\n") && report.contains("\nB\n"),
        "{report}"
    );
    let state = r#"{"param": {"m": 0}}"#;
    let output = hamel(&["linearize", &model("pendulum"), "--at", "-"], state);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("no linearisation"));
}

#[test]
fn advice_is_ordered_and_says_what_to_write() {
    let output = hamel(&["ops", &model("heavy_top_world"), "--advise"], "");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let report = text(&output.stdout);
    let body = report.find("R turned in body axes").expect("body axes");
    let world = report
        .find("R turned in world axes, as written")
        .expect("as written");
    assert!(body < world, "{report}");
    assert!(report.contains("rate R = R * hat(w);"), "{report}");
    let arguments = [
        "ops",
        &model("heavy_top_world"),
        "--advise",
        "--format",
        "json",
    ];
    let advice: Value = serde_json::from_slice(&hamel(&arguments, "").stdout).expect("JSON");
    assert_eq!(advice["choices"][1]["as_written"], "yes");
    let output = hamel(&["ops", &model("rod_particles"), "--advise"], "");
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("nothing to compare"));
    for (name, why) in [("kapitza", "has `time`"), ("sleigh", "are constrained")] {
        let output = hamel(&["ops", &model(name), "--advise"], "");
        assert_eq!(output.status.code(), Some(1));
        assert!(text(&output.stderr).contains(why));
    }
}

#[test]
fn runs_end_with_the_drift_of_the_invariants() {
    let output = hamel(
        &["simulate", &model("kovalevskaya_top"), "--until", "1"],
        "",
    );
    let report = text(&output.stdout);
    let line = report
        .lines()
        .find(|line| line.contains("invariant kovalevskaya"));
    let line = line.unwrap_or_else(|| panic!("{report}"));
    let change = line.split_whitespace().last().expect("a change");
    assert!(change.parse::<f64>().expect("a number") < 1e-9, "{line}");
}

/// A five-bar linkage with springs on its cranks, at rest where they are relaxed.
const SPRUNG: &str = "system Sprung {
    const a = 0.3, b = 0.5, d = 0.25;
    joint q1: revolute [0, 0, 1] moves left { stiffness 3; rest 2; }
    joint q2: revolute [0, 0, 1] at pose(identity(3), [d, 0, 0]) moves right { stiffness 5; rest 1; }
    joint p1: revolute [0, 0, 1] on left at pose(identity(3), [a, 0, 0]) moves fore1;
    joint p2: revolute [0, 0, 1] on right at pose(identity(3), [a, 0, 0]) moves fore2;
    body on left { mass 0.4; com [a / 2, 0, 0]; inertia diag(0, 0, 0.003) about com; }
    body on right { mass 0.4; com [a / 2, 0, 0]; inertia diag(0, 0, 0.003) about com; }
    body on fore1 { mass 0.6; com [b / 2, 0, 0]; inertia diag(0, 0, 0.0125) about com; }
    body on fore2 { mass 0.6; com [b / 2, 0, 0]; inertia diag(0, 0, 0.0125) about com; }
    let tip1 = position(fore1, [b, 0, 0]), tip2 = position(fore2, [b, 0, 0]);
    loop tip1[1] = tip2[1], tip1[2] = tip2[2];
    independent q1_dot, q2_dot;
    input push;
    generalized force q1_dot = push;
    start q1 = 2, q2 = 1;
    start p1 ~ -1, p2 ~ 1;
    output tip = tip1;
    output speed = velocity(fore1, [b, 0, 0]);
}";

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter()
        .map(|one| one.as_f64().expect("a number"))
        .collect()
}

fn matrix(value: &Value) -> Vec<Vec<f64>> {
    value
        .as_array()
        .expect("rows")
        .iter()
        .map(numbers)
        .collect()
}

fn run(command: &[&str], description: &str) -> Value {
    let output = hamel(command, description);
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Two springs and two freedoms: four eigenvalues, with ω² those of M⁻¹ K. M is that of the crank angles, from the
/// rods' ends as intersections of two circles, and from their differences.
#[test]
fn a_five_bar_with_two_springs_has_four_eigenvalues() {
    let linear = run(&["linearize", "-", "--format", "json"], SPRUNG);
    let (a, b, d) = (0.3_f64, 0.5_f64, 0.25_f64);
    // The directions of the forearms.
    let arms = |q: [f64; 2]| -> [f64; 2] {
        let left = [a * q[0].cos(), a * q[0].sin()];
        let right = [d + a * q[1].cos(), a * q[1].sin()];
        let across = [right[0] - left[0], right[1] - left[1]];
        let half = 0.5 * across[0].hypot(across[1]);
        let height = (b * b - half * half).sqrt();
        let along = [across[0] / (2.0 * half), across[1] / (2.0 * half)];
        let tip = [
            0.5 * (left[0] + right[0]) - height * along[1],
            0.5 * (left[1] + right[1]) + height * along[0],
        ];
        [left, right].map(|end| (tip[1] - end[1]).atan2(tip[0] - end[0]))
    };
    let here = [2.0, 1.0];
    let slope = |k: usize| -> [f64; 2] {
        let at = |h: f64| {
            let mut q = here;
            q[k] += h;
            arms(q)
        };
        let h = 1e-3;
        let [p, m, pp, mm] = [at(h), at(-h), at(2.0 * h), at(-2.0 * h)];
        [0, 1].map(|i| (8.0 * (p[i] - m[i]) - (pp[i] - mm[i])) / (12.0 * h))
    };
    let angles = arms(here);
    let turned = [slope(0), slope(1)];
    // T = ½ Σ: cranks about their pivots, forearms by the velocity of their midpoints and their rotation.
    let mut mass = [[0.0; 2]; 2];
    for side in 0..2 {
        let (crank, arm) = (here[side], angles[side]);
        let column = |k: usize| -> [f64; 4] {
            let own = if k == side { 1.0 } else { 0.0 };
            let turn = turned[k][side];
            [
                own,
                -a * crank.sin() * own - 0.5 * b * arm.sin() * turn,
                a * crank.cos() * own + 0.5 * b * arm.cos() * turn,
                turn,
            ]
        };
        let weights = [0.003 + 0.4 * 0.25 * a * a, 0.6, 0.6, 0.0125];
        for i in 0..2 {
            for j in 0..2 {
                let terms = (0..4).map(|k| weights[k] * column(i)[k] * column(j)[k]);
                mass[i][j] += terms.sum::<f64>();
            }
        }
    }
    let (stiff, det) = (
        [3.0, 5.0],
        mass[0][0] * mass[1][1] - mass[0][1] * mass[1][0],
    );
    let trace = (mass[1][1] * stiff[0] + mass[0][0] * stiff[1]) / det;
    let product = stiff[0] * stiff[1] / det;
    let root = (0.25 * trace * trace - product).sqrt();
    let squares = [0.5 * trace + root, 0.5 * trace - root];
    let expected = squares.map(|square: f64| [(0.0, square.sqrt()), (0.0, -square.sqrt())]);
    assert_eq!(linear["states"].as_array().map(Vec::len), Some(4));
    assert_eigenvalues(&linear, &expected.concat());
    // With `--full`, all of them.
    let full = run(&["linearize", "-", "--full", "--format", "json"], SPRUNG);
    assert_eq!(full["states"].as_array().map(Vec::len), Some(8));
}

/// In motion the dependent velocities change with the rest: rows of accelerations and of outputs against differences
/// between states that `eval` closes.
#[test]
fn the_minimal_form_of_a_loop_in_motion_agrees_with_differences() {
    let here = [2.05, 0.9, 1.3, -0.7];
    let state = |at: [f64; 4], push: f64| {
        format!(
            r#"{{"coord": {{"q1": {}, "q2": {}}}, "velocity": {{"q1_dot": {}, "q2_dot": {}}}, "input": {{"push": {push}}}}}"#,
            at[0], at[1], at[2], at[3]
        )
    };
    let file = format!("{}/five-bar-in-motion.json", env!("CARGO_TARGET_TMPDIR"));
    let at = |command: &str, at: [f64; 4], push: f64| {
        std::fs::write(&file, state(at, push)).expect("written");
        let format: &[&str] = if command == "linearize" {
            &["--format", "json"]
        } else {
            &[]
        };
        run(&[&[command, "-", "--at", &file], format].concat(), SPRUNG)
    };
    let linear = at("linearize", here, 0.4);
    let names = ["h(q1_dot)", "h(q2_dot)", "d(q1_dot)", "d(q2_dot)"];
    assert_eq!(linear["states"], serde_json::json!(names));
    let rates = |at_state: [f64; 4], push: f64| -> Vec<f64> {
        let value = at("eval", at_state, push);
        let mut rates = numbers(&value["accel"])[..2].to_vec();
        for output in ["tip", "speed"] {
            rates.extend(numbers(&value["outputs"][output]));
        }
        rates
    };
    let [a, b, c, d] = ["A", "B", "C", "D"].map(|part| matrix(&linear[part]));
    let h = 1e-3;
    for column in 0..5 {
        let moved = |k: f64| {
            let (mut state, mut push) = (here, 0.4);
            match column {
                4 => push += k * h,
                _ => state[column] += k * h,
            }
            rates(state, push)
        };
        let [p, m, pp, mm] = [1.0, -1.0, 2.0, -2.0].map(moved);
        for row in 0..p.len() {
            let slope = (8.0 * (p[row] - m[row]) - (pp[row] - mm[row])) / (12.0 * h);
            let (square, right) = if row < 2 {
                (&a[2 + row], &b[2 + row])
            } else {
                (&c[row - 2], &d[row - 2])
            };
            let found = if column == 4 {
                right[0]
            } else {
                square[column]
            };
            let size = 1.0 + slope.abs();
            assert!(
                (found - slope).abs() < 1e-7 * size,
                "{row} {column}: {found}, {slope}"
            );
        }
    }
}

/// A Stewart platform: six legs, each a cardan joint and a slider with a spring, whose ends loops attach to the plate.
#[test]
fn a_stewart_platform_has_six_freedoms() {
    let stewart = "system Stewart {
        joint plate: free moves top;
        body on top { mass 10; inertia diag(0.5, 0.5, 0.9) about com; }
        gravity [0, 0, -9.81];
        for i in 1..6 {
            frame foot[i] = pose(rotz(pi * i / 3), [0.6 * cos(pi * i / 3), 0.6 * sin(pi * i / 3), 0]);
            joint hip[i]: universal [1, 0, 0], [0, 1, 0] on foot[i] moves shin[i];
            joint slide[i]: prismatic [0, 0, 1] on shin[i] moves rod[i] { stiffness 4000; rest 0.85; damping 20; }
            body on rod[i] { mass 0.5; com [0, 0, 0]; inertia diag(0.02, 0.02, 0.001) about com; }
            loop position(rod[i]) = position(top, [0.4 * cos(pi * i / 3 + 0.5), 0.4 * sin(pi * i / 3 + 0.5), 0]);
            start slide[i] ~ 0.8;
        }
        independent plate_v, plate_w;
        start plate_r ~ [0, 0, 0.8];
    }";
    let output = hamel(&["linearize", "-"], stewart);
    let said = text(&output.stdout);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(
        said.contains("36 further ones follow from these by constraints"),
        "{said}"
    );
    let linear = run(&["linearize", "-", "--format", "json"], stewart);
    let names = numbers(&linear["eigenvalues"][0]).len();
    assert_eq!(
        (names, linear["eigenvalues"].as_array().map(Vec::len)),
        (2, Some(12))
    );
    // A rotation by a sixth maps it to itself: the horizontal directions are equivalent, and decoupled from the
    // vertical.
    let a = matrix(&linear["A"]);
    let near = |i: usize, j: usize, k: usize, l: usize| {
        let (x, y) = (a[i][j], a[k][l]);
        assert!(
            (x - y).abs() < 1e-6 * (1.0 + x.abs()),
            "{i} {j}: {x}, {k} {l}: {y}"
        );
    };
    for block in [0, 3] {
        for by in [0, 3, 6, 9] {
            near(6 + block, by, 7 + block, by + 1);
            assert!((a[6 + block][by + 1] + a[7 + block][by]).abs() < 1e-4);
            assert!(a[6 + block][by + 2].abs() < 1e-4 && a[8 + block][by].abs() < 1e-4);
        }
    }
}
