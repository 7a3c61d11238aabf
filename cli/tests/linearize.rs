//! `hamel linearize` and `hamel ops --advise` as they are used: eigenvalues with closed forms.

mod common;

use common::{hamel, text};
use serde_json::Value;

/// The QR algorithm on matrices of some ten rows, entries up to 1e3.
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

/// Eigenvalues, each expected one found once.
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

/// The sleeping top is stable where (C ω)² > 4 m g l A: in axes at rest its tilt z obeys
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
