//! `hamel trim` as users run it: equilibria with closed forms, failures, wrong requests, and random mechanisms.

use crate::common::{hamel, text};
use serde_json::Value;
use std::f64::consts::PI;
use std::path::PathBuf;

pub type Vector = [f64; 3];

pub fn model(name: &str) -> String {
    format!("{}/../{name}.eom", env!("CARGO_MANIFEST_DIR"))
}

/// Runs `hamel trim FILE` with these options, and returns its JSON.
pub fn trimmed(file: &str, input: &str, options: &[&str]) -> Value {
    let arguments = [&["trim", file, "--format", "json"], options].concat();
    let output = hamel(&arguments, input);
    assert!(output.status.success(), "{input}: {}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Runs `hamel trim` on a text that it refuses, and returns the message.
fn refused(input: &str, options: &[&str], status: i32) -> String {
    let output = hamel(&[&["trim", "-"], options].concat(), input);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{input}: {message}");
    assert!(output.stdout.is_empty());
    message
}

pub fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

pub fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(list) => list.iter().flat_map(numbers).collect(),
        other => vec![number(other)],
    }
}

pub fn vector(value: &Value) -> Vector {
    numbers(value).try_into().expect("three numbers")
}

/// Names of the undetermined directions with a single entry.
pub fn undetermined(found: &Value) -> Vec<String> {
    let all = found["undetermined"].as_array().expect("a list").iter();
    let named = all.map(|one| {
        one.as_object()
            .expect("entries")
            .keys()
            .cloned()
            .collect::<Vec<_>>()
            .join(" ")
    });
    let mut named: Vec<String> = named.collect();
    named.sort();
    named
}

pub fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} instead of {expected}"
    );
}

/// Writes a state, and returns its path.
fn written(name: &str, state: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("hamel-trim-{}-{name}.json", std::process::id()));
    std::fs::write(&path, state).expect("a file");
    path
}

/// Asserts that a motion from the state of a result keeps these velocities for some seconds.
pub fn assert_stays(file: &str, input: &str, found: &Value, (until, names): (&str, &[&str])) {
    let at = written(
        &format!("stays-{}", names.join("")),
        &found["state"].to_string(),
    );
    let out = at.with_extension("run.json");
    let words = [
        "simulate", file, "--until", until, "--step", "0.001", "--at",
    ];
    let words = [
        &words[..],
        &[
            at.to_str().expect("UTF-8"),
            "--out",
            out.to_str().expect("UTF-8"),
        ],
    ];
    let output = hamel(&words.concat(), input);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let samples: Value =
        serde_json::from_slice(&std::fs::read(&out).expect("a run")).expect("JSON");
    let samples = samples.as_array().expect("samples");
    for name in names {
        let before = number(&samples[0][name]);
        for sample in samples {
            assert_near(number(&sample[name]), before, 1e-8);
        }
    }
    assert!(samples.len() > 10);
    std::fs::remove_file(at)
        .and_then(|()| std::fs::remove_file(out))
        .expect("removed");
}

/// A chain of point masses 1 + i/4 on rods of length 1, in absolute angles from the vertical, with torsion springs.
fn chain(n: usize, stiffness: f64, start: f64) -> String {
    let mut text = String::from("system Chain { gravity [0, 0, -9.81];");
    let (mut x, mut z) = (String::from("0"), String::from("0"));
    for i in 1..=n {
        let mass = mass(i);
        x += &format!(" + sin(q{i})");
        z += &format!(" - cos(q{i})");
        text += &format!(
            "coord q{i}; velocity w{i}; rate q{i} = w{i}; start q{i} = {};",
            start + 0.1 / i as f64
        );
        text += &format!("particle mass {mass} at [{x}, 0, {z}];");
        if stiffness > 0.0 {
            let before = if i > 1 {
                format!("q{}", i - 1)
            } else {
                "0".into()
            };
            text += &format!(
                "spring stiffness {stiffness} on q{i} - {before} - {};",
                rest(i)
            );
        }
    }
    text + "}"
}

fn mass(i: usize) -> f64 {
    1.0 + i as f64 / 4.0
}

fn rest(i: usize) -> f64 {
    0.3 * i as f64
}

/// Slopes of the potential energy of [`chain`] at angles q: m g sin q + moments of the springs.
fn chain_slopes(q: &[f64], stiffness: f64) -> Vec<f64> {
    let n = q.len();
    let moment = |i: usize| stiffness * (q[i] - if i > 0 { q[i - 1] } else { 0.0 } - rest(i + 1));
    let carried = |i: usize| (i + 1..=n).map(mass).sum::<f64>();
    let one = |i: usize| {
        9.81 * carried(i) * q[i].sin() + moment(i) - if i + 1 < n { moment(i + 1) } else { 0.0 }
    };
    (0..n).map(one).collect()
}

#[test]
fn chains_hang_and_stand() {
    for n in 2..=5 {
        for (start, angle, growing, verdict) in [(0.0, 0.0, 0, "neutral"), (PI, PI, n, "unstable")]
        {
            let found = trimmed("-", &chain(n, 0.0, start), &[]);
            for i in 1..=n {
                assert_near(
                    number(&found["state"]["coord"][format!("q{i}")]),
                    angle,
                    1e-10,
                );
            }
            assert_eq!(
                (found["rank"].as_u64(), &found["stability"]),
                (Some(n as u64), &verdict.into())
            );
            let values = found["eigenvalues"].as_array().expect("pairs");
            assert_eq!(
                values.iter().filter(|pair| number(&pair[0]) > 1e-6).count(),
                growing
            );
            assert!(undetermined(&found).is_empty());
        }
        for stiffness in [2.0, 60.0] {
            let found = trimmed("-", &chain(n, stiffness, 0.2), &[]);
            let angle = |i: usize| number(&found["state"]["coord"][format!("q{i}")]);
            let q: Vec<f64> = (1..=n).map(angle).collect();
            for slope in chain_slopes(&q, stiffness) {
                assert_near(slope, 0.0, 1e-10 * (1.0 + stiffness));
            }
            assert_eq!(found["stability"], "neutral");
        }
    }
}

/// A crank of length 0.4, a coupler of length 1 and a rocker of length 0.8 on pivots 1 apart, with a spring at the crank:
/// dV/dq₁ = 0 with the other angles and their slopes by the loop.
#[test]
fn a_four_bar_rests_where_its_energy_is_least() {
    let (l1, l2, l3, d, k, q0) = (0.4, 1.0, 0.8, 1.0, 7.0, 1.1);
    let text = std::fs::read_to_string(model("tests/models/four_bar_loop")).expect("a model");
    let text = text
        .replace(
            "start q1",
            &format!("spring stiffness {k} on q1 - {q0}; start q1"),
        )
        .replace("start w1 = 2;", "");
    let found = trimmed("-", &text, &[]);
    let of = |name: &str| number(&found["state"]["coord"][name]);
    let slope = |q1: f64| {
        // The joint of coupler and rocker, on the upper side.
        let (x, y) = (l1 * f64::cos(q1), l1 * f64::sin(q1));
        let (dx, dy) = (d - x, -y);
        let distance = dx.hypot(dy);
        let along = (l2 * l2 - l3 * l3 + distance * distance) / (2.0 * distance);
        let across = (l2 * l2 - along * along).sqrt();
        let joint = [
            x + along * dx / distance - across * dy / distance,
            y + along * dy / distance + across * dx / distance,
        ];
        let q2 = (joint[1] - y).atan2(joint[0] - x);
        let q3 = joint[1].atan2(joint[0] - d);
        // l₁ ∂(cos, sin)(q₁) + l₂ ∂(cos, sin)(q₂) q₂' = l₃ ∂(cos, sin)(q₃) q₃'.
        let determinant = l2 * l3 * f64::sin(q2 - q3);
        let d2 = l1 * l3 * f64::sin(q3 - q1) / determinant;
        let d3 = l1 * l2 * f64::sin(q2 - q1) / determinant;
        let g = 9.81;
        let height = 0.5 * l1 / 2.0 * q1.cos()
            + 1.2 * (l1 * q1.cos() + l2 / 2.0 * q2.cos() * d2)
            + l3 / 2.0 * q3.cos() * d3;
        (g * height + k * (q1 - q0), q2, q3)
    };
    let (mut low, mut high) = (-0.5, 1.5);
    assert!(slope(low).0 < 0.0 && slope(high).0 > 0.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if slope(middle).0 < 0.0 {
            low = middle
        } else {
            high = middle
        }
    }
    let (_, q2, q3) = slope(low);
    for (name, expected) in [("q1", low), ("q2", q2), ("q3", q3)] {
        assert_near(of(name), expected, 1e-10);
    }
    assert_eq!(
        (found["unknowns"].as_u64(), &found["stability"]),
        (Some(1), &"neutral".into())
    );
}

const SLIDER: &str = "system Slider { param F = 3; input u; coord q; velocity v; rate q = v; particle mass 2 at [q, 0, 0];
    generalized force v = F + u - 0.5 * v; output speed = v; }";

/// A slider under a constant force has no equilibrium, but an input can hold it, and it moves at F/d.
#[test]
fn a_slider_needs_a_force_or_a_speed() {
    let message = refused(SLIDER, &[], 1);
    assert!(
        message.contains("no solution near this start") && message.contains("the rate of v 1.5"),
        "{message}"
    );
    let found = trimmed("-", SLIDER, &["--free", "u"]);
    assert_near(number(&found["state"]["input"]["u"]), -3.0, 1e-12);
    assert_eq!(undetermined(&found), ["q"]);
    let found = trimmed("-", SLIDER, &["--steady"]);
    assert_near(number(&found["state"]["velocity"]["v"]), 6.0, 1e-12);
    assert_eq!(
        (undetermined(&found), &found["stability"]),
        (vec!["q".into()], &"asymptotic".into())
    );
    let found = trimmed(
        "-",
        SLIDER,
        &[
            "--steady",
            "--free",
            "u",
            "--fix",
            "speed = 2",
            "--fix",
            "2 * q = 1 + 1",
        ],
    );
    assert_near(number(&found["state"]["input"]["u"]), -2.0, 1e-12);
    assert_near(number(&found["state"]["coord"]["q"]), 1.0, 1e-12);
    // A given acceleration; an input with an equation is free.
    let found = trimmed("-", SLIDER, &["--free", "u", "--rate", "v = 0.5"]);
    assert_near(number(&found["state"]["input"]["u"]), -2.0, 1e-12);
    assert_near(number(&found["xi_dot"][0]), 0.5, 1e-12);
    let found = trimmed("-", SLIDER, &["--free", "v", "--fix", "u = 2 - F / 3"]);
    assert_near(number(&found["state"]["velocity"]["v"]), 8.0, 1e-12);
}

#[test]
fn many_solutions_and_none_are_told_apart() {
    let body = "system Body { coord r: R3, R: SO3; velocity v: vec3, w: vec3; rate r = R * v; rate R = R * hat(w);
        frame b = pose(R, r); body on b { mass 2; inertia diag(1, 2, 3) about com; } }";
    let found = trimmed("-", body, &[]);
    assert_eq!(found["rank"].as_u64(), Some(0));
    assert_eq!(
        undetermined(&found),
        ["h(w[1])", "h(w[2])", "h(w[3])", "r[1]", "r[2]", "r[3]"]
    );
    assert_eq!(found["stability"], "neutral");
    let one = |force: &str| {
        format!(
            "system One {{ coord q; velocity v; rate q = v; kinetic v^2 / 2; generalized force v = {force}; start q = 0.5; }}"
        )
    };
    for (force, said) in [
        ("-q^3", "singular there: along q"),
        ("-q^2 * (1 - q)", "singular there: along q"),
        ("-q^2 - 1e-3", "no solution near this start"),
        ("-exp(-q)", "far away or at infinity"),
        ("sqrt(q) + 0.1", "leaves the states at which"),
        ("sqrt(q - 1)", "no search can begin"),
    ] {
        let message = refused(&one(force), &[], 1);
        assert!(message.contains(said), "{force}: {message}");
    }
    // Hoop and bead at the speed where the lowest point branches: a r Ω² = g.
    let hoop =
        "system Hoop { param r = 1, W = 3; coord q; velocity w; rate q = w; kinetic r^2 * w^2 / 2;
        potential 9 * -r * cos(q) - r^2 * W^2 * sin(q)^2 / 2; start q = 0.4; }";
    assert!(refused(hoop, &[], 1).contains("singular there: along q"));
    let faster = hoop.replace("W = 3", "W = 5").replace("q = 0.4", "q = 1");
    let found = trimmed("-", &faster, &[]);
    assert_near(
        number(&found["state"]["coord"]["q"]),
        (9.0_f64 / 25.0).acos(),
        1e-12,
    );
}

#[test]
fn wrong_requests_say_what_to_do() {
    for (options, said) in [
        (&["--free", "U"][..], "`U` is unknown; there are v, u"),
        (&["--free", "a,b"], "`a` is unknown; there are v, u"),
        (&["--rate", "z = 1"], "`z` is unknown"),
        (&["--rate", "v"], "write NAME = VALUE"),
        (&["--rate", "v = nan"], "write NAME = VALUE"),
        (&["--fix", "q"], "expected one equation"),
        (&["--fix", "q = 1 = 2"], "expected one equation"),
        (&["--fix", "q <= 1"], "expected one equation"),
        (&["--fix", "q = "], "expected one equation"),
        (&["--fix", "q = (1"], "`)` is missing"),
        (&["--fix", "q = zz"], "nothing is called `zz`"),
        (&["--fix", "q = [1, 2]"], "--fix"),
    ] {
        let message = refused(SLIDER, options, 2);
        assert!(message.contains(said), "{options:?}: {message}");
    }
    let hoop = std::fs::read_to_string(model("tests/models/driven_hoop")).expect("a model");
    let message = refused(&hoop, &["--steady"], 2);
    assert!(message.contains("depends on the time `t`"), "{message}");
    assert!(hamel(&["trim", "-"], &hoop).status.success());
}

/// The state of `-o` has all digits: accelerations at it are those of the result.
#[test]
fn the_state_that_is_written_reads_back() {
    let file = model("tests/models/vane");
    let out = written("back", "");
    let path = out.to_str().expect("UTF-8");
    let output = hamel(&["trim", &file, "-o", path], "");
    let report = text(&output.stdout);
    for part in [
        "equilibrium from the start of the description",
        "3 conditions of rank 3",
        "stable: all deviations decay",
    ] {
        assert!(report.contains(part), "{part}: {report}");
    }
    let output = hamel(&["eval", &file, "--at", path], "");
    let values: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    numbers(&values["accel"])
        .iter()
        .for_each(|rate| assert_near(*rate, 0.0, 1e-12));
    let again = trimmed(&file, "", &["--at", path]);
    assert!(number(&again["steps"]) <= 1.0, "{again}");
    let output = hamel(&["trim", &file, "--at", path, "-o", path], "");
    assert_eq!(output.status.code(), Some(2));
    std::fs::remove_file(out).expect("removed");
}

/// Random numbers between −1 and 1.
fn random(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1_u64 << 30) as f64 - 1.0
    }
}

/// A random tree of bodies on springy joints, with springs to the world, and with a loop if `looped`.
fn springy(seed: u64, looped: bool) -> String {
    let mut number = random(seed);
    let mut vector = |size: f64| -> String {
        let entries: Vec<String> = (0..3).map(|_| format!("{:.3}", size * number())).collect();
        format!("[{}]", entries.join(", "))
    };
    let mut other = random(seed ^ 0x5555);
    let count = 2 + (seed % 4) as usize;
    let mut text = String::from("system Springy { gravity [0, 0, -9.81];");
    for i in 1..=count {
        let below = ((other() + 1.0) / 2.0 * i as f64) as usize;
        let on = if below == 0 {
            String::new()
        } else {
            format!("on b{below} ")
        };
        let kind = other();
        let (stiffness, rest) = (3.0 + 2.0 * other(), 0.5 * other());
        let joint = match kind {
            _ if kind < 0.4 => format!(
                "revolute {} {on}at {} moves b{i} {{ stiffness {stiffness:.3}; rest {rest:.3}; }}",
                vector(1.0),
                vector(0.4)
            ),
            _ if kind < 0.8 => format!(
                "prismatic {} {on}at {} moves b{i} {{ stiffness {:.3}; rest {rest:.3}; }}",
                vector(1.0),
                vector(0.4),
                20.0 * stiffness
            ),
            _ => format!("spherical {on}at {} moves b{i}", vector(0.4)),
        };
        let end = if joint.ends_with('}') { "" } else { ";" };
        text += &format!("joint j{i}: {joint}{end}\n");
        text += &format!(
            "body on b{i} {{ mass {:.3}; com {}; inertia diag(0.03, 0.04, 0.05) about com; }}
            spring stiffness {:.3} length 0.3 from {} on b{i} to {} on world;\n",
            0.6 + 0.4 * other(),
            vector(0.3),
            30.0 + 20.0 * other(),
            vector(0.5),
            vector(1.0),
        );
    }
    if looped {
        text += &format!(
            "loop dot(position(b{count}, {}) - position(b1, {}), {}) = 0.02;",
            vector(0.3),
            vector(0.3),
            vector(1.0)
        );
    }
    text + "}"
}

/// At every equilibrium of a random mechanism accelerations vanish by another evaluation, and the search from there
/// stays. `HAMEL_ATTACK` adds mechanisms.
#[test]
fn random_mechanisms_come_to_rest() {
    let count = match std::env::var("HAMEL_ATTACK").as_deref() {
        Ok("full") => 300,
        Ok(_) => 60,
        Err(_) => 5,
    };
    let (mut tried, mut found, mut stable) = (0, 0, 0);
    for seed in 0..count {
        let text = springy(seed, seed % 3 == 2);
        let reporter = std::sync::Arc::new(hamel_engine::Quiet);
        let session =
            hamel_engine::Session::read(text.clone(), "random", &Default::default(), reporter);
        // Some random loops cannot be closed.
        let Ok(session) = session else {
            continue;
        };
        tried += 1;
        let options = hamel_engine::TrimOptions::default();
        let trim = match session.trim(&session.start(), &options) {
            Ok(trim) => trim,
            Err(error) => {
                println!("{seed}: {error}");
                continue;
            }
        };
        found += 1;
        if trim.neighbour > 0 {
            println!("{seed}: from neighbour {}", trim.neighbour);
        }
        stable += usize::from(
            trim.spectrum
                .as_ref()
                .is_some_and(|found| found.stability == hamel_engine::trim::Stability::Neutral),
        );
        let values = session.evaluate(&trim.state).expect("values");
        let rates = values.accel.expect("accelerations");
        let size = trim
            .spectrum
            .as_ref()
            .map_or(1.0, |found| found.size.max(1.0));
        rates
            .iter()
            .for_each(|rate| assert_near(*rate, 0.0, 1e-12 * size));
        let written = trim
            .state
            .to_json(session.generated(), &trim.full)
            .to_string();
        let read = session
            .state(&trim.state.params, &written, "written")
            .expect("a state");
        let again = session.trim(&read, &options).expect("the same");
        let moved = again.state.x.iter().zip(&trim.state.x);
        moved.for_each(|(a, b)| assert_near(*a, *b, 1e-9));
        assert!(
            again.steps <= 6 && trim.undetermined.is_empty(),
            "{seed}: {trim:?}\n{text}"
        );
    }
    println!("{found} of {tried} found, {stable} of them stable");
    assert!(found * 10 >= tried * 9, "{found} of {tried}");
}
