//! `hamel trim --steady` as users run it: steady motions with closed forms and with balances by hand.

use crate::trim::{
    Vector, assert_near, assert_stays, model, number, numbers, trimmed, undetermined, vector,
};
use std::f64::consts::PI;

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
