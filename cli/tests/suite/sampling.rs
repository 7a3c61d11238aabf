//! Samples at multiples of a time in equal steps, runs that are too short, and energy that starts from zero.

use crate::common::{hamel, text};
use std::path::{Path, PathBuf};

/// q = t²/2, w = t: Runge–Kutta steps are exact.
const PUSHED: &str = "system Pushed {
    coord q; velocity w; rate q = w; kinetic w^2/2; input F; generalized force w = F;
}";
/// q = sin t.
const SWING: &str = "system Swing {
    coord q; velocity w; rate q = w; kinetic w^2/2; potential q^2/2; start w = 1;
}";

fn file(name: &str, content: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("sampling");
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(name);
    std::fs::write(&path, content).expect("written");
    path
}

/// The samples t, q, w of a run, and its messages.
fn run(name: &str, model: &str, options: &[&str]) -> (Vec<Vec<f64>>, String) {
    let out = file(name, "").display().to_string();
    let fixed = ["simulate", "-", "--out", &out];
    let output = hamel(&[&fixed[..], options].concat(), model);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let written = std::fs::read_to_string(&out).expect("samples");
    let number = |n: &str| n.parse().expect("a number");
    let rows = written.lines().skip(1);
    let rows = rows.map(|line| line.split(',').map(number).collect());
    (rows.collect(), text(&output.stdout))
}

/// Asserts that samples are exactly at the multiples of a time, and at the end.
fn at_multiples(samples: &[Vec<f64>], every: f64, until: f64) {
    let count = (until / every + 1e-9).floor() as usize;
    for (index, sample) in samples.iter().enumerate().take(count + 1) {
        let wanted = (index as f64 * every).min(until);
        assert!(
            (sample[0] - wanted).abs() <= 4.0 * f64::EPSILON * wanted,
            "{sample:?} {wanted}"
        );
    }
    assert_eq!(samples.last().map(|sample| sample[0]), Some(until));
    let is_multiple = (until - count as f64 * every).abs() < 1e-9;
    assert_eq!(samples.len(), count + if is_multiple { 1 } else { 2 });
}

#[test]
fn samples_are_at_multiples_of_a_time() {
    for (until, step, every) in [
        ("3.14159", "1e-3", "0.1"),
        ("1", "0.07", "0.3"),
        ("2", "0.01", "0.1"),
        // Enough steps to be taken by machine code, many at once.
        ("20.05", "1e-3", "2.5"),
        ("5", "1e-3", "5e-4"),
        // Only one sample, and none except start and end.
        ("1", "0.01", "1"),
        ("1", "0.01", "7"),
    ] {
        let seconds = format!("{every}s");
        let asked = ["--until", until, "--step", step, "--every", &seconds];
        let number = |text: &str| text.parse::<f64>().expect("a number");
        for method in ["rkmk4", "splitting", "gauss4"] {
            let (samples, _) = run(
                "swing.csv",
                SWING,
                &[&asked[..], &["--method", method]].concat(),
            );
            at_multiples(&samples, number(every), number(until));
            for sample in &samples {
                let error =
                    (sample[1] - sample[0].sin()).abs() + (sample[2] - sample[0].cos()).abs();
                assert!(error < 10.0 * number(step).powi(4), "{method} {sample:?}");
            }
        }
    }
}

/// Likewise if steps end at jumps of inputs in between: w = t + (t − τ) after the jump at τ.
#[test]
fn samples_are_at_multiples_beside_jumps() {
    let forces = file("forces.csv", "t,F\n0,1\n0.1234567,2\n0.6,1\n");
    let forces = forces.to_str().expect("UTF-8");
    let asked = ["--until", "1", "--every", "0.1s", "--method", "rkmk4"];
    let (samples, _) = run(
        "jumps.csv",
        PUSHED,
        &[&asked[..], &["--inputs", forces, "--hold"]].concat(),
    );
    at_multiples(&samples, 0.1, 1.0);
    for sample in samples {
        let t = sample[0];
        let w = t + (t - 0.1234567).max(0.0) - (t - 0.6).max(0.0);
        assert!((sample[2] - w).abs() < 1e-12, "{sample:?} {w}");
    }
}

/// All steps between the first and the last multiple are equal, with a fixed number per sample: a splitting keeps
/// (q, w) on one ellipse, which for leapfrog is w² + (1 − h²/4) q², to rounding.
#[test]
fn steps_between_samples_are_equal() {
    let asked = [
        "--until",
        "100",
        "--step",
        "0.07",
        "--every",
        "0.3s",
        "--method",
        "splitting2",
    ];
    let (samples, said) = run("ellipse.csv", SWING, &asked);
    at_multiples(&samples, 0.3, 100.0);
    // 0.3 takes five steps of 0.06, and the last tenth of a second two of 0.05.
    assert!(said.contains("1 667 steps"), "{said}");
    let h: f64 = 0.06;
    for sample in &samples[..samples.len() - 1] {
        let kept = sample[2].powi(2) + (1.0 - h * h / 4.0) * sample[1].powi(2);
        assert!((kept - 1.0).abs() < 1e-12, "{sample:?} {kept}");
    }
}

#[test]
fn runs_that_are_too_short_are_refused() {
    for until in ["5e-324", "1e-322", "1e-310"] {
        for options in [
            &["--method", "rkmk8", "--tol", "1e-9"][..],
            &["--method", "rkmk4"],
        ] {
            let output = hamel(
                &[&["simulate", "-", "--until", until], options].concat(),
                SWING,
            );
            assert_eq!(output.status.code(), Some(2), "{until} {options:?}");
            let said = text(&output.stderr);
            assert!(said.starts_with("error: the length of a run"), "{said}");
        }
    }
    let (samples, _) = run(
        "short.csv",
        SWING,
        &["--until", "1e-300", "--method", "rkmk8", "--tol", "1e-9"],
    );
    assert_eq!(samples.last().map(|sample| sample[0]), Some(1e-300));
}

/// A mass at rest has no energy with which to compare work: no relative change is given, and none for 0.
#[test]
fn energy_from_nothing_has_no_relative_change() {
    let asked = ["--until", "2", "--input", "F = 3"];
    let (_, said) = run("work.csv", PUSHED, &asked);
    let row = |said: &str| -> String {
        let row = said
            .lines()
            .find(|line| line.trim_start().starts_with("energy"));
        row.expect("a row").to_string()
    };
    // ½ 6².
    assert!(row(&said).ends_with(" 1.8e1"), "{said}");
    let (_, said) = run("rest.csv", PUSHED, &["--until", "2"]);
    assert!(row(&said).ends_with("0, 0 relative"), "{said}");
    let (_, said) = run("swinging.csv", SWING, &["--until", "2"]);
    assert!(row(&said).ends_with(" relative"), "{said}");
}
