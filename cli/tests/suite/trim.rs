//! `hamel trim` as users run it: equilibria and steady motions with closed forms, balances by hand, and failures.

use crate::common::{hamel, text};
use serde_json::Value;
use std::f64::consts::PI;
use std::path::PathBuf;

type Vector = [f64; 3];

fn model(name: &str) -> String {
    format!("{}/../{name}.eom", env!("CARGO_MANIFEST_DIR"))
}

/// Runs `hamel trim FILE` with these options, and returns its JSON.
fn trimmed(file: &str, input: &str, options: &[&str]) -> Value {
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

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(list) => list.iter().flat_map(numbers).collect(),
        other => vec![number(other)],
    }
}

fn vector(value: &Value) -> Vector {
    numbers(value).try_into().expect("three numbers")
}

/// Names of the undetermined directions with a single entry.
fn undetermined(found: &Value) -> Vec<String> {
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

fn assert_near(found: f64, expected: f64, tolerance: f64) {
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
fn assert_stays(file: &str, input: &str, found: &Value, (until, names): (&str, &[&str])) {
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

fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn cross(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

fn sum(a: Vector, b: Vector, factor: f64) -> Vector {
    std::array::from_fn(|i| a[i] + factor * b[i])
}

type Matrix = [Vector; 3];

fn times(a: Matrix, b: Matrix) -> Matrix {
    a.map(|row| std::array::from_fn(|j| (0..3).map(|k| row[k] * b[k][j]).sum()))
}

fn apply(a: Matrix, v: Vector) -> Vector {
    a.map(|row| dot(row, v))
}

fn transpose(a: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

/// Rotation by an angle about a coordinate axis.
fn turn(axis: usize, angle: f64) -> Matrix {
    let (s, c) = angle.sin_cos();
    let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut r = [[0.0; 3]; 3];
    r[axis][axis] = 1.0;
    (r[a][a], r[b][b], r[a][b], r[b][a]) = (c, c, -s, s);
    r
}

/// The Navion in a level turn at 176 ft/s without sideslip: forces and moments balance in stability axes with the
/// coefficients of the book, and the horizontal force is m V Ω.
#[test]
fn an_aircraft_turns_coordinated() {
    let file = model("tests/models/navion");
    for bank in [0.2, 0.6, 1.0] {
        let bank_given = format!("phi = {bank}");
        let options = ["--steady", "--free", "elevator,throttle,aileron,rudder"];
        let fixed = [
            "speed = 176",
            &bank_given,
            "v[2] = 0",
            "velocity(hull)[3] = 0",
        ];
        let fixed = fixed.iter().flat_map(|equation| ["--fix", equation]);
        let options: Vec<&str> = options.into_iter().chain(fixed).collect();
        let found = trimmed(&file, "", &options);
        let (coord, velocity, input) = (
            &found["state"]["coord"],
            &found["state"]["velocity"],
            &found["state"]["input"],
        );
        let (v, w) = (vector(&velocity["v"]), vector(&velocity["w"]));
        let [phi, theta, psi] = ["phi", "theta", "psi"].map(|name| number(&coord[name]));
        assert_eq!(phi, bank);
        let hull = times(times(turn(2, psi), turn(1, theta)), turn(0, phi));
        let r = times(hull, turn(1, -0.05));
        // A turn about the vertical, at one height.
        let down = transpose(r).map(|row| row[2]);
        let rate = dot(w, down);
        (0..3).for_each(|i| assert_near(w[i], rate * down[i], 1e-12));
        assert_near(dot(v, down), 0.0, 1e-10);
        let (m, g, s, c, b, speed) = (85.4, 32.2, 184.0, 5.7, 33.4, 176.0);
        let [elevator, throttle, aileron, rudder] =
            ["elevator", "throttle", "aileron", "rudder"].map(|name| number(&input[name]));
        let alpha = v[2].atan2(v[0]);
        let pressure = 0.002378 * speed * speed / 2.0 * s;
        let lift = 0.41 + 4.44 * alpha + 0.355 * elevator;
        let drag = 0.05 + 0.33 * alpha;
        let force = [
            throttle + pressure * (lift * alpha.sin() - drag * alpha.cos()),
            pressure * 0.157 * rudder,
            -pressure * (lift * alpha.cos() + drag * alpha.sin()),
        ];
        let required = sum(cross(w, v), down, -g);
        (0..3).for_each(|i| assert_near(force[i], m * required[i], 1e-8));
        let [p, q, yaw] = [b * w[0], c * w[1], b * w[2]].map(|rate| rate / (2.0 * speed));
        let moment = [
            pressure * b * (-0.410 * p + 0.107 * yaw - 0.134 * aileron + 0.0107 * rudder),
            pressure * c * (-0.683 * alpha - 9.96 * q - 0.923 * elevator),
            pressure * b * (-0.0575 * p - 0.125 * yaw - 0.0035 * aileron - 0.072 * rudder),
        ];
        let momentum = [1048.0 * w[0], 3000.0 * w[1], 3530.0 * w[2]];
        let required = cross(w, momentum);
        (0..3).for_each(|i| assert_near(moment[i], required[i], 1e-8));
        // In world axes: what carries the aircraft, and what turns it.
        let world = apply(r, force);
        assert_near(world[2], -m * g, 1e-8);
        assert_near(world[0].hypot(world[1]), m * speed * rate.abs(), 1e-8);
        assert_eq!(undetermined(&found), ["psi", "r[1]", "r[2]", "r[3]"]);
        assert_stays(
            &file,
            "",
            &found,
            ("5", &["v[1]", "v[3]", "w[1]", "w[2]", "w[3]"]),
        );
    }
}

/// A thin disk on a plane, in axes that do not spin with it: on its circle
/// (I₃ + m a²) ω₃ Ω sin α − I₁ Ω² sin α cos α + m g a cos α = 0.
#[test]
fn a_disk_rolls_in_circles() {
    let disk = "system Disk { param m = 2, a = 0.5, g = 9.81, I1 = 0.125, I3 = 0.25;
        coord r: R3, psi, al, s; velocity v: vec3, wp, wa, ws;
        rate psi = wp; rate al = wa; rate s = ws;
        let H = rotz(psi) * rotx(al);
        rate r = H * v;
        frame head = pose(H, r); frame disk on head = pose(rotz(s), [0, 0, 0]);
        body on disk { mass m; inertia diag(I1, I1, I3) about com; } gravity [0, 0, -g];
        nonholonomic v + cross([wa, wp * sin(al), wp * cos(al) + ws], [0, -a, 0]) = 0;
        start al = 1.3, ws = -5, wp = 0.5; }";
    for (tilt, spin) in [(1.3, -5.0), (0.9, -8.0), (1.5, -4.0)] {
        let (tilt_given, spin_given) = (format!("al = {tilt}"), format!("ws = {spin}"));
        let found = trimmed(
            "-",
            disk,
            &["--steady", "--fix", &tilt_given, "--fix", &spin_given],
        );
        let velocity = &found["state"]["velocity"];
        let turning = number(&velocity["wp"]);
        let (m, a, i1, i3): (f64, f64, f64, f64) = (2.0, 0.5, 0.125, 0.25);
        let axial = turning * f64::cos(tilt) + spin;
        let (sin, cos) = f64::sin_cos(tilt);
        let left = (i3 + m * a * a) * axial * turning * sin - i1 * turning * turning * sin * cos
            + m * 9.81 * a * cos;
        assert_near(left, 0.0, 1e-10);
        assert_near(vector(&velocity["v"])[0], -a * axial, 1e-10);
        assert_near(number(&velocity["wa"]), 0.0, 1e-12);
        assert_eq!(undetermined(&found), ["psi", "r[1]", "r[2]", "r[3]", "s"]);
        assert_stays("-", disk, &found, ("1", &["wp", "ws", "wa"]));
    }
    // Without equations, tilt and spin may be chosen, too.
    let found = trimmed("-", disk, &["--steady"]);
    assert_eq!(
        (found["rank"].as_u64(), undetermined(&found).len()),
        (Some(2), 7)
    );
}

/// The bicycle on a circle: both wheels on the ground, moments about the line of contact balance, with
/// d/dt H = Ω × H of all bodies.
#[test]
fn a_bicycle_rides_in_a_circle() {
    let file = model("examples/control/bicycle");
    let heights = [
        "(r + R * cr)[3] = 0",
        "(r + R * (head + G * (hub + cf)))[3] = 0",
        "delta = 0.05",
        "wr = -16",
    ];
    let fixed = heights.iter().flat_map(|equation| ["--fix", equation]);
    let options: Vec<&str> = ["--steady", "--free", "steer"]
        .into_iter()
        .chain(fixed)
        .collect();
    let found = trimmed(&file, "", &options);
    let (coord, velocity) = (&found["state"]["coord"], &found["state"]["velocity"]);
    let rows = numbers(&coord["R"]);
    let rear: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| rows[3 * i + j]));
    let place = vector(&coord["r"]);
    let [v, o] = ["v", "o"].map(|name| apply(rear, vector(&velocity[name])));
    let [wd, wr, wf] = ["wd", "wr", "wf"].map(|name| number(&velocity[name]));
    assert_near(wd, 0.0, 1e-12);
    let lambda = PI / 10.0;
    let tilted = times(
        times(turn(1, lambda), turn(2, number(&coord["delta"]))),
        turn(1, -lambda),
    );
    let fork = times(rear, tilted);
    // Ω is vertical.
    let rate = o[2];
    assert!(rate.abs() > 0.1 && o[0].hypot(o[1]) < 1e-10, "{o:?}");
    let steer = sum(place, apply(rear, [1.1, 0.0, 0.3]), 1.0);
    let hub = sum(steer, apply(fork, [-0.08, 0.0, -0.35]), 1.0);
    let about = |axes: Matrix, spin: f64| sum(o, axes.map(|row| row[1]), spin);
    let bodies = [
        (
            2.0,
            place,
            about(rear, wr),
            rear,
            [[0.0603, 0.0, 0.0], [0.0, 0.12, 0.0], [0.0, 0.0, 0.0603]],
        ),
        (
            85.0,
            sum(place, apply(rear, [0.3, 0.0, -0.6]), 1.0),
            o,
            rear,
            [[9.2, 0.0, 2.4], [0.0, 11.0, 0.0], [2.4, 0.0, 2.8]],
        ),
        (
            4.0,
            sum(steer, apply(fork, [0.9 - 1.1, 0.0, -0.7]), 1.0),
            o,
            fork,
            [
                [0.05892, 0.0, -0.00756],
                [0.0, 0.06, 0.0],
                [-0.00756, 0.0, 0.00708],
            ],
        ),
        (
            3.0,
            hub,
            about(fork, wf),
            fork,
            [[0.1405, 0.0, 0.0], [0.0, 0.28, 0.0], [0.0, 0.0, 0.1405]],
        ),
    ];
    // The lowest points of the wheels, z down.
    let lowest = |centre: Vector, axes: Matrix, radius: f64| {
        let axle = axes.map(|row| row[1]);
        let down = sum([0.0, 0.0, 1.0], axle, -axle[2]);
        sum(centre, down, radius / dot(down, down).sqrt())
    };
    let contacts = [lowest(place, rear, 0.3), lowest(hub, fork, 0.35)];
    contacts
        .iter()
        .for_each(|contact| assert_near(contact[2], 0.0, 1e-12));
    let line = sum(contacts[1], contacts[0], -1.0);
    let mut balance = 0.0;
    for (m, centre, w, axes, inertia) in bodies {
        let arm = sum(centre, contacts[0], -1.0);
        let speed = sum(v, cross(o, sum(centre, place, -1.0)), 1.0);
        let turning = [0.0, 0.0, rate];
        let inertia = times(times(axes, inertia), transpose(axes));
        let accelerated = sum(cross(turning, speed), [0.0, 0.0, 9.81], -1.0);
        balance +=
            m * dot(line, cross(arm, accelerated)) + dot(line, cross(turning, apply(inertia, w)));
    }
    assert_near(balance, 0.0, 1e-9);
    assert_stays(
        &file,
        "",
        &found,
        ("10", &["wr", "o[1]", "o[2]", "o[3]", "wd"]),
    );
}

/// A quadrotor that hovers in wind W leans so that thrust balances weight and drag: T² = (m g)² + (d W)².
#[test]
fn a_quadrotor_leans_against_the_wind() {
    let drone = "system Drone { param m = 1.1, g = 9.81, a = 0.2, k = 0.02, d = 0.15, W = 6;
        coord r: R3, R: SO3; velocity v: vec3, w: vec3; rate r = R * v; rate R = R * hat(w);
        frame hull = pose(R, r);
        body on hull { mass m; inertia diag(0.012, 0.014, 0.021) about com; } gravity [0, 0, -g];
        input f: vec4;
        force [0, 0, f[1]] at [a, 0, 0] on hull in body; force [0, 0, f[2]] at [0, a, 0] on hull in body;
        force [0, 0, f[3]] at [-a, 0, 0] on hull in body; force [0, 0, f[4]] at [0, -a, 0] on hull in body;
        torque [0, 0, k * (f[1] - f[2] + f[3] - f[4])] on hull in hull;
        force d * ([W, 0, 0] - R * v) at [0, 0, 0] on hull in world; }";
    let found = trimmed("-", drone, &["--free", "f"]);
    let (weight, drag): (f64, f64) = (1.1 * 9.81, 0.15 * 6.0);
    for force in numbers(&found["state"]["input"]["f"]) {
        assert_near(force, weight.hypot(drag) / 4.0, 1e-10);
    }
    let rows = numbers(&found["state"]["coord"]["R"]);
    let axis = [rows[2], rows[5], rows[8]].map(|entry| entry * weight.hypot(drag));
    [-drag, 0.0, weight]
        .iter()
        .zip(axis)
        .for_each(|(expected, found)| assert_near(found, *expected, 1e-10));
    // Place and heading: the turn about the thrust.
    assert_eq!(
        (found["rank"].as_u64(), undetermined(&found).len()),
        (Some(6), 4)
    );
    // In still air at a given speed over ground, with another centre of mass.
    let file = model("tests/models/drone");
    let found = trimmed(
        &file,
        "",
        &[
            "--steady",
            "--free",
            "f",
            "--fix",
            "speed = [6, 0, 0]",
            "--fix",
            "w = [0, 0, 0]",
        ],
    );
    let forces = numbers(&found["state"]["input"]["f"]);
    assert_near(forces.iter().sum(), weight.hypot(drag), 1e-9);
    // Moments about the centre of mass at (0.01, 0, -0.03).
    assert_near(
        (0.2 - 0.01) * forces[0] - 0.01 * (forces[1] + forces[3]) - 0.21 * forces[2],
        0.0,
        1e-10,
    );
    assert_near(forces[1] - forces[3], 0.0, 1e-10);
    assert_near(forces[0] - forces[1] + forces[2] - forces[3], 0.0, 1e-10);
    assert_stays(
        &file,
        "",
        &found,
        ("3", &["v[1]", "v[2]", "v[3]", "w[1]", "w[2]", "w[3]"]),
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
    // A given acceleration; an input that is not free keeps the value that is asked for.
    let found = trimmed("-", SLIDER, &["--free", "u", "--rate", "v = 0.5"]);
    assert_near(number(&found["state"]["input"]["u"]), -2.0, 1e-12);
    assert_near(number(&found["xi_dot"][0]), 0.5, 1e-12);
    let found = trimmed("-", SLIDER, &["--free", "v", "--fix", "u = 1"]);
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
