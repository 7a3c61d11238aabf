//! Velocities given by definitions, rates of expressions, motions in axes of any frame, and the choice of independent
//! velocities: compared with formulas of textbooks, and with equivalent descriptions.

use crate::common::{Random, difference, generated, value};
use hamel_codegen::generate::Generated;

/// Rounding of a few hundred operations of f64.
const TOLERANCE: f64 = 1e-11;

type V3 = [f64; 3];
type M3 = [V3; 3];

const AIRCRAFT: &str = include_str!("../../../tests/models/aircraft_euler.eom");

fn cross(a: V3, b: V3) -> V3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn times(m: &M3, a: V3) -> V3 {
    m.map(|row| row[0] * a[0] + row[1] * a[1] + row[2] * a[2])
}

fn transposed(m: &M3) -> M3 {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

fn sum(terms: &[V3]) -> V3 {
    terms
        .iter()
        .fold([0.0; 3], |sum, a| std::array::from_fn(|k| sum[k] + a[k]))
}

fn scaled(factor: f64, a: V3) -> V3 {
    a.map(|entry| factor * entry)
}

/// The rotation from body to world by yaw, pitch, roll, as in textbooks on flight.
fn attitude(phi: f64, theta: f64, psi: f64) -> M3 {
    let ((sf, cf), (st, ct), (sp, cp)) = (phi.sin_cos(), theta.sin_cos(), psi.sin_cos());
    [
        [ct * cp, sf * st * cp - cf * sp, cf * st * cp + sf * sp],
        [ct * sp, sf * st * sp + cf * cp, cf * st * sp - sf * cp],
        [-st, sf * ct, cf * ct],
    ]
}

fn three(list: &[f64]) -> V3 {
    [list[0], list[1], list[2]]
}

/// Returns a state of the aircraft with a pitch below 90 degrees: r, φ, θ, ψ; v, ω; F, τ.
fn state(random: &mut Random) -> ([f64; 6], [f64; 6], [f64; 6]) {
    let mut list = |scale: f64| -> [f64; 6] { std::array::from_fn(|_| scale * random.number()) };
    (list(1.2), list(3.0), list(5.0))
}

/// Body rates with Euler angles as coordinates: ψ̇, θ̇, φ̇ of the textbooks, and the Newton-Euler equations in body
/// axes.
#[test]
fn an_aircraft_in_euler_angles_obeys_the_textbook() {
    let aircraft = generated(AIRCRAFT);
    let mut random = Random::new(1);
    let (m, g, inertia) = (2.0, 9.81, [0.02, 0.05, 0.06]);
    for _ in 0..20 {
        let (x, xi, u) = state(&mut random);
        let ([phi, theta, psi], [p, q, r]) = ([x[3], x[4], x[5]], [xi[3], xi[4], xi[5]]);
        let rotation = attitude(phi, theta, psi);
        let (v, w) = (three(&xi), [p, q, r]);
        let moved = times(&rotation, v);
        let rates = [
            p + (q * phi.sin() + r * phi.cos()) * theta.tan(),
            q * phi.cos() - r * phi.sin(),
            (q * phi.sin() + r * phi.cos()) / theta.cos(),
        ];
        let expected = [moved, rates].concat();
        let found = value(&aircraft, "rate", [&x, &xi, &[], &[]]);
        assert!(
            difference(&expected, &found) < TOLERANCE,
            "{expected:?} {found:?}"
        );
        let weight = times(&transposed(&rotation), [0.0, 0.0, -g]);
        let v_dot = sum(&[
            weight,
            scaled(1.0 / m, three(&u)),
            scaled(-1.0, cross(w, v)),
        ]);
        let spin: V3 = std::array::from_fn(|k| inertia[k] * w[k]);
        let turned = cross(w, spin);
        let w_dot: V3 = std::array::from_fn(|k| (u[3 + k] - turned[k]) / inertia[k]);
        let expected = [v_dot, w_dot].concat();
        let found = value(&aircraft, "accel", [&x, &xi, &u, &[]]);
        assert!(
            difference(&expected, &found) < TOLERANCE,
            "{expected:?} {found:?}"
        );
    }
}

/// An accelerometer off the centre measures Rᵀ (a − g) with α × p + ω × (ω × p), in the axes of its mounting; a gyro
/// measures ω, and a velocity log on the tail Rₘᵀ (v + ω × p).
#[test]
fn sensors_of_an_aircraft_feel_the_closed_form() {
    let aircraft = generated(AIRCRAFT);
    let mut random = Random::new(2);
    // The box is rotated by 0.3 about its second axis.
    let (s, c) = 0.3_f64.sin_cos();
    let mount: M3 = [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]];
    for _ in 0..20 {
        let (x, xi, _) = state(&mut random);
        let dot: [f64; 6] = std::array::from_fn(|_| 4.0 * random.number());
        let rotation = attitude(x[3], x[4], x[5]);
        let (v, w, p) = (three(&xi), three(&xi[3..]), [0.1, -0.05, 0.02]);
        let (v_dot, alpha) = (three(&dot), three(&dot[3..]));
        let weight = times(&transposed(&rotation), [0.0, 0.0, -9.81]);
        let felt = sum(&[
            v_dot,
            cross(w, v),
            cross(alpha, p),
            cross(w, cross(w, p)),
            scaled(-1.0, weight),
        ]);
        let back = transposed(&mount);
        let through = sum(&[v, cross(w, p)]);
        let still = [0.0; 6];
        for (name, expected) in [
            ("accelerometer", times(&back, felt)),
            ("gyro", times(&back, w)),
            ("log", times(&back, through)),
            ("world_spin", times(&rotation, w)),
        ] {
            let found = value(&aircraft, name, [&x, &xi, &still, &dot]);
            assert!(
                difference(&expected, &found) < TOLERANCE,
                "{name}: {expected:?} {found:?}"
            );
        }
    }
}

/// Straight and level flight at 20 m/s with a pitch, under constant forces: it is a trim, and the linearisation about
/// it is δv̇ = v × δω + (Rᵀg) × h, δω̇ = 0, ḣ = δv + …, by hand.
#[test]
fn a_trimmed_aircraft_is_linearised_as_by_hand() {
    let aircraft = generated(AIRCRAFT);
    let (m, g, theta) = (2.0, 9.81, 0.1_f64);
    let rotation = attitude(0.0, theta, 0.0);
    let weight = times(&transposed(&rotation), [0.0, 0.0, -g]);
    let v = times(&transposed(&rotation), [20.0, 0.0, 0.0]);
    let x = [0.0, 0.0, 50.0, 0.0, theta, 0.0];
    let xi = [v[0], v[1], v[2], 0.0, 0.0, 0.0];
    let lift = scaled(-m, weight);
    let u = [lift[0], lift[1], lift[2], 0.0, 0.0, 0.0];
    let accel = value(&aircraft, "accel", [&x, &xi, &u, &[]]);
    assert!(accel.iter().all(|a| a.abs() < 1e-12), "{accel:?}");
    let flat = value(&aircraft, "linearize", [&x, &xi, &u, &[]]);
    let row = |i: usize| &flat[18 * i..18 * i + 18];
    let hat = |a: V3| -> M3 { [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]] };
    // States are h = (h_v, h_w), δv, δω; inputs F, τ. δω rotates the axes in which v is constant: −δω × v = v × δω; h_w
    // rotates them as well, and with them the velocity of the displacement.
    let (turned, felt) = (hat(v), hat(weight));
    for i in 0..3 {
        let mut expected = [0.0; 18];
        expected[6 + i] = 1.0;
        expected[3..6].copy_from_slice(&turned[i].map(|e| -e));
        assert!(
            difference(&expected, row(i)) < TOLERANCE,
            "ḣ_v {i}: {:?}",
            row(i)
        );
        let mut expected = [0.0; 18];
        expected[9 + i] = 1.0;
        assert!(
            difference(&expected, row(3 + i)) < TOLERANCE,
            "ḣ_w {i}: {:?}",
            row(3 + i)
        );
        let mut expected = [0.0; 18];
        expected[3..6].copy_from_slice(&felt[i]);
        expected[9..12].copy_from_slice(&turned[i]);
        expected[12 + i] = 1.0 / m;
        assert!(
            difference(&expected, row(6 + i)) < TOLERANCE,
            "δv̇ {i}: {:?}",
            row(6 + i)
        );
        let mut expected = [0.0; 18];
        expected[15 + i] = 1.0 / [0.02, 0.05, 0.06][i];
        assert!(
            difference(&expected, row(9 + i)) < TOLERANCE,
            "δω̇ {i}: {:?}",
            row(9 + i)
        );
    }
}

/// The same body with an SO3 coordinate: velocities by definitions equal those by rates.
#[test]
fn a_rotation_matrix_gives_the_same_velocities() {
    let body = |kinematics: &str| {
        generated(&format!(
            "system B {{
                coord r: R3, R: SO3; velocity {kinematics}
                frame hull = pose(R, r);
                body on hull {{ mass 1.3; com [0.1, -0.2, 0.3]; inertia diag(2, 1.7, 1.2) about com; }}
                gravity [0, 0, -9.81];
                input F: vec3; force F at [0, 0, 0.1] on hull in body;
                generate accel, rate, energy;
            }}"
        ))
    };
    let defined =
        body("v: vec3 = velocity(hull) in hull, w: vec3 = angular_velocity(hull) in body;");
    let rated = body("v: vec3, w: vec3; rate r = R * v, R = R * hat(w);");
    let world = body("v: vec3 = velocity(hull), w: vec3 = angular_velocity(hull);");
    let given = body("v: vec3, w: vec3; rate r = v, R = hat(w) * R;");
    agree(&defined, &rated);
    agree(&world, &given);
}

fn agree(a: &Generated, b: &Generated) {
    let mut random = Random::new(4);
    for _ in 0..5 {
        let x = random.configuration(&a.active.blocks);
        let (xi, u) = (
            random.numbers(a.active.n()),
            random.numbers(a.active.u.len()),
        );
        for name in ["rate", "accel", "energy"] {
            let at = [&x[..], &xi, &u, &[]];
            let (one, other) = (value(a, name, at), value(b, name, at));
            assert!(
                difference(&one, &other) < TOLERANCE,
                "{name}: {one:?} {other:?}"
            );
        }
    }
}

/// d/dt of expressions: the chain rule by hand, first and second derivatives, also of an angle.
#[test]
fn rates_of_expressions_are_the_chain_rule() {
    let system = generated(
        "system S {
            time t;
            coord q, a: S1; velocity w, s; rate q = w, a = s;
            particle mass 1 at [q, sin(q), 0];
            kinetic s^2;
            let e = q^2 * a.s + t;
            output first = rate(e), second = rate(rate(e)), turn = rate(a), both = rate([q * w, sin(q)]);
        }",
    );
    let mut random = Random::new(5);
    for _ in 0..10 {
        let (q, angle, w, s) = (
            random.number(),
            3.0 * random.number(),
            random.number(),
            random.number(),
        );
        let (q2, s2) = (random.number(), random.number());
        // The time is declared first.
        let names: Vec<&str> = system
            .active
            .coordinates
            .iter()
            .map(|c| c.name.as_str())
            .collect();
        assert_eq!(names, ["t", "q", "a"]);
        let x = [0.7, q, angle.cos(), angle.sin()];
        let (sin, cos) = angle.sin_cos();
        let first = 2.0 * q * w * sin + q * q * cos * s + 1.0;
        let second =
            2.0 * (w * w + q * q2) * sin + 4.0 * q * w * cos * s + q * q * (cos * s2 - sin * s * s);
        let both = [w * w + q * q2, q.cos() * w];
        for (name, expected) in [
            ("first", vec![first]),
            ("second", vec![second]),
            ("turn", vec![s]),
            ("both", both.to_vec()),
        ] {
            let found = value(&system, name, [&x, &[w, s], &[], &[q2, s2]]);
            assert!(
                difference(&expected, &found) < TOLERANCE,
                "{name}: {expected:?} {found:?}"
            );
        }
    }
}

/// Chaplygin's sleigh with its blade ahead: the motion is the same for any choice of the independent velocity.
#[test]
fn the_velocity_that_stays_is_the_users_choice() {
    let sleigh = |choice: &str| {
        generated(&format!(
            "system S {{
                coord x, y, q; velocity u, v, w;
                rate x = cos(q) * u - sin(q) * v, y = sin(q) * u + cos(q) * v, q = w;
                frame f = pose(rotz(q), [x, y, 0]);
                body on f {{ mass 2; inertia diag(0, 0, 0.7) about com; }}
                nonholonomic v = 0.4 * w;
                {choice}
                generate accel, rate;
            }}"
        ))
    };
    let (by_w, by_v) = (sleigh("independent u, w;"), sleigh("independent v;"));
    let names = |of: &Generated| -> Vec<String> {
        of.active
            .velocities
            .iter()
            .map(|group| group.name.clone())
            .collect()
    };
    assert_eq!(names(&by_w), ["u", "w"]);
    assert_eq!(names(&by_v), ["u", "v"]);
    assert_eq!(by_v.solved, [(2, 0)]);
    let mut random = Random::new(6);
    for _ in 0..10 {
        let (q, u, w) = (random.number(), random.number(), random.number());
        let x = [0.3, -0.2, q];
        let one = value(&by_w, "accel", [&x, &[u, w], &[], &[]]);
        let other = value(&by_v, "accel", [&x, &[u, 0.4 * w], &[], &[]]);
        // u̇ = v w = 0.4 w², and (J + 0.16 m) ẇ = −0.4 m u w
        let expected = [0.4 * w * w, -0.8 * u * w / (0.7 + 0.32)];
        assert!(
            difference(&expected, &one) < TOLERANCE,
            "{expected:?} {one:?}"
        );
        assert!(
            difference(&expected, &[other[0], other[1] / 0.4]) < TOLERANCE,
            "{other:?}"
        );
    }
}
