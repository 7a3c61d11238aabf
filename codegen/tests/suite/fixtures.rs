//! Multibody systems of the literature, described with joints, each compared with an independent source: published
//! equations, a mass matrix derived by hand, another description, or the Newton-Euler equations.

use crate::common::{Random, difference, generated, value};
use crate::tree::{Kind, Link, Tree};
use hamel_codegen::generate::Generated;
use std::fmt::Write;

/// Rounding of a few hundred operations.
const TOLERANCE: f64 = 1e-11;
/// Number of states per system.
const STATES_PER_SYSTEM: usize = 5;

fn text(path: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/models/");
    std::fs::read_to_string(format!("{folder}{path}.eom")).expect("it is in the repository")
}

/// Returns a fixture with the requested functions.
fn model(path: &str, functions: &str) -> Generated {
    let text = text(path);
    let end = text.rfind('}').expect("a system ends with a brace");
    generated(&format!("{}generate {functions};\n}}\n", &text[..end]))
}

/// Cazzolato and Prime (2011), equations (29) and (30), rewritten for their full inertias.
#[test]
fn furuta_pendulum_has_the_published_equations() {
    let system = model("multibody/furuta", "accel");
    let [m2, l2, length] = [0.075, 0.148, 0.278];
    let (m1, l1) = (0.3, 0.15);
    let [j1, jx, jy, jz] = [0.0248, 0.0001, 0.00386, 0.0038];
    let (b1, b2, g) = (0.0001, 0.00028, 9.81);
    let mut random = Random::new(0xf0);
    for _ in 0..STATES_PER_SYSTEM {
        let (x, xi, u) = (random.numbers(2), random.numbers(2), random.numbers(1));
        let dot = value(&system, "accel", [&x, &xi, &u, &[]]);
        let (s, c) = x[1].sin_cos();
        let (w1, w2) = (xi[0], xi[1]);
        let turning = m2 * l2 * l2 + jy;
        let arm = j1 + m1 * l1 * l1 + m2 * length * length;
        let first = dot[0] * (arm + turning * s * s + jx * c * c) + dot[1] * m2 * length * l2 * c
            - m2 * length * l2 * s * w2 * w2
            + w1 * w2 * 2.0 * s * c * (turning - jx)
            + b1 * w1;
        let second = dot[0] * m2 * length * l2 * c + dot[1] * (m2 * l2 * l2 + jz)
            - w1 * w1 * s * c * (turning - jx)
            + b2 * w2
            + g * m2 * l2 * s;
        assert!(difference(&[first, second], &[u[0], 0.0]) < TOLERANCE);
    }
}

/// Returns a cart with a chain of n pendulums, point masses at the ends of rods; all different.
fn cart_chain(n: usize) -> String {
    let mut text = String::from(
        "system CartChain {\n joint cart: prismatic [1, 0, 0] moves f0;\n body on f0 { mass 2; }\n",
    );
    for i in 1..=n {
        let (mass, rod) = link(i);
        let place = if i == 1 { 0.0 } else { -link(i - 1).1 };
        let before = i - 1;
        let _ = writeln!(
            text,
            " joint q{i}: revolute [0, -1, 0] on f{before} at pose(identity(3), [0, 0, {place}]) moves f{i};\n \
             particle mass {mass} at [0, 0, -{rod}] on f{i};"
        );
    }
    text + " gravity [0, 0, -9.81];\n generate mass_matrix, potential_force, bias;\n}\n"
}

/// Returns mass and length of a rod.
fn link(i: usize) -> (f64, f64) {
    (0.5 + 0.25 * i as f64, 0.75 + 0.125 * i as f64)
}

/// With angles θᵢ from the vertical, M₀₀ = Σ m, M₀ᵢ = μᵢ lᵢ cos θᵢ, M_ij = μ_max lᵢ l_j cos(θᵢ − θ_j), where μᵢ is the
/// mass from rod i on; θᵢ is the sum of the joint angles.
#[test]
fn chains_on_a_cart_have_the_mass_matrix_derived_by_hand() {
    let mut random = Random::new(0xca);
    for n in 1..=10 {
        let system = generated(&cart_chain(n));
        for _ in 0..STATES_PER_SYSTEM {
            let (x, xi) = (random.numbers(n + 1), random.numbers(n + 1));
            let theta: Vec<f64> = (1..=n).map(|i| x[1..=i].iter().sum()).collect();
            let spin: Vec<f64> = (1..=n).map(|i| xi[1..=i].iter().sum()).collect();
            let beyond = |i: usize| (i..=n).map(|k| link(k).0).sum::<f64>();
            let moment = |i: usize| beyond(i) * link(i).1;
            // In absolute angles; row 0 is the cart.
            let mass = |i: usize, j: usize| match (i, j) {
                (0, 0) => 2.0 + beyond(1),
                (0, k) | (k, 0) => moment(k) * theta[k - 1].cos(),
                _ => {
                    let (low, high) = (i.min(j), i.max(j));
                    link(low).1 * moment(high) * (theta[i - 1] - theta[j - 1]).cos()
                }
            };
            // ∂/∂qᵢ = Σ_{k ≥ i} ∂/∂θ_k
            let from = |i: usize| if i == 0 { 0..=0 } else { i..=n };
            let mut wanted = Vec::new();
            for i in 0..=n {
                for j in 0..=n {
                    let sum: f64 = from(i)
                        .map(|a| from(j).map(|b| mass(a, b)).sum::<f64>())
                        .sum();
                    wanted.push(sum);
                }
            }
            let at = [x.as_slice(), &xi, &[], &[]];
            let found = value(&system, "mass_matrix", at);
            assert!(
                difference(&wanted, &found) < TOLERANCE,
                "mass matrix of {n} rods"
            );
            let weight = |k: usize| 9.81 * moment(k) * theta[k - 1].sin();
            let wanted: Vec<f64> = (0..=n)
                .map(|i| from(i).filter(|&k| k > 0).map(weight).sum())
                .collect();
            let found = value(&system, "potential_force", at);
            assert!(
                difference(&wanted, &found) < TOLERANCE,
                "gravity of {n} rods"
            );
            // Only the centripetal forces of the rods act on the cart.
            let pull: f64 = (1..=n)
                .map(|k| -moment(k) * theta[k - 1].sin() * spin[k - 1] * spin[k - 1])
                .sum();
            let found = value(&system, "bias", at);
            assert!(
                (found[0] - pull).abs() < TOLERANCE * pull.abs().max(1.0),
                "bias of {n} rods"
            );
        }
    }
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    (0..9)
        .map(|e| (0..3).map(|k| a[3 * (e / 3) + k] * b[3 * k + e % 3]).sum())
        .collect()
}

/// Rᵀ a
fn back(r: &[f64], a: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|k| r[3 * k + i] * a[k]).sum())
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// `two_bodies` has the rotation and the spin of its second body in the world, converted by hand.
#[test]
fn double_spherical_pendulum_is_two_bodies() {
    let joints = model("multibody/double_spherical_pendulum", "accel, energy");
    let hand = model("two_bodies", "accel, energy");
    let mut random = Random::new(0xd5);
    for _ in 0..STATES_PER_SYSTEM {
        let x = random.configuration(&joints.program.blocks);
        let xi = random.numbers(6);
        let relative = &x[9..];
        let mut absolute = x[..9].to_vec();
        absolute.extend(product(&x[..9], relative));
        let seen = back(relative, &xi[..3]);
        let mut spins = xi[..3].to_vec();
        spins.extend((0..3).map(|i| seen[i] + xi[3 + i]));
        let (at, there) = ([&x[..], &xi, &[], &[]], [&absolute[..], &spins, &[], &[]]);
        let (a, b) = (value(&joints, "energy", at), value(&hand, "energy", there));
        assert!(difference(&a, &b) < TOLERANCE, "energy");
        let (a, b) = (value(&joints, "accel", at), value(&hand, "accel", there));
        // d/dt (Rᵀ ω₁ + ω) = Rᵀ ω̇₁ − ω × Rᵀ ω₁ + ω̇
        let carried = back(relative, &a[..3]);
        let turned = cross([xi[3], xi[4], xi[5]], seen);
        let mut wanted = a[..3].to_vec();
        wanted.extend((0..3).map(|i| carried[i] - turned[i] + a[3 + i]));
        assert!(difference(&wanted, &b) < TOLERANCE, "accelerations");
    }
}

/// Inverse dynamics agrees with the Newton-Euler equations, including the wrench on the hull.
#[test]
fn quadrotor_with_load_obeys_newton_and_euler() {
    let system = model("multibody/quadrotor_load", "accel, inverse_dynamics");
    assert_eq!((system.program.nu, system.program.n), (21, 9));
    let links = [
        Link::body(
            Kind::Free,
            None,
            [0.0; 3],
            1.4,
            [0.0; 3],
            [0.03, 0.032, 0.055],
        ),
        Link::body(
            Kind::Spherical,
            Some(0),
            [0.0, 0.01, -0.08],
            0.5,
            [0.0, 0.0, -1.2],
            [0.002; 3],
        ),
    ];
    let mut random = Random::new(0x0dad);
    for _ in 0..STATES_PER_SYSTEM {
        let x = random.configuration(&system.program.blocks);
        let (xi, dot, u) = (random.numbers(9), random.numbers(9), random.numbers(4));
        let mut tree = Tree::new(&links, &x, &xi);
        tree.gravity = [0.0, 0.0, -9.81];
        let at = [x.as_slice(), &xi, &u, &dot];
        let needed = value(&system, "inverse_dynamics", at);
        assert!(difference(&tree.needed(&dot, 1.0), &needed) < TOLERANCE);
        let motion = value(&system, "accel", at);
        let wrench = [0.0, 0.0, u[0], u[1], u[2], u[3], 0.0, 0.0, 0.0];
        assert!(difference(&tree.needed(&motion, 1.0), &wrench) < TOLERANCE);
    }
}

/// Checks ν and n of every fixture.
#[test]
fn fixtures_have_their_sizes() {
    for (name, size) in [
        ("cart_rods", (4, 4)),
        ("furuta", (2, 2)),
        ("double_spherical_pendulum", (18, 6)),
        ("quadrotor_load", (21, 9)),
        ("tricopter", (30, 15)),
        ("satellite_arm", (19, 13)),
    ] {
        let system = model(&format!("multibody/{name}"), "rate");
        assert_eq!((system.program.nu, system.program.n), size, "{name}");
    }
}

/// Compares inverse dynamics, and forward dynamics with forces on joints, with the Newton-Euler equations.
fn obeys_newton_and_euler(
    path: &str,
    links: &[Link],
    gravity: f64,
    forces: impl Fn(&Tree<'_>, &[f64]) -> Vec<f64>,
) {
    let system = model(path, "accel, inverse_dynamics");
    let program = &system.program;
    let mut random = Random::new(0x5a7);
    for _ in 0..STATES_PER_SYSTEM {
        let x = random.configuration(&program.blocks);
        let (xi, dot) = (random.numbers(program.n), random.numbers(program.n));
        let u = random.numbers(program.m);
        let mut tree = Tree::new(links, &x, &xi);
        tree.gravity = [0.0, 0.0, -gravity];
        let at = [x.as_slice(), &xi, &u, &dot];
        let needed = value(&system, "inverse_dynamics", at);
        assert!(
            difference(&tree.needed(&dot, 1.0), &needed) < TOLERANCE,
            "{path}"
        );
        // Light parts have large accelerations, so forces are compared, relative to the largest inertia force.
        let motion = value(&system, "accel", at);
        let rest = tree.needed(&vec![0.0; program.n], 1.0);
        let (whole, wanted) = (tree.needed(&motion, 1.0), forces(&tree, &u));
        let inertial = whole
            .iter()
            .zip(&rest)
            .fold(1.0, |most: f64, (a, b)| most.max((a - b).abs()));
        let apart = whole
            .iter()
            .zip(&wanted)
            .fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert!(apart < TOLERANCE * inertial, "{path}: {apart:e}");
    }
}

#[test]
fn satellite_with_an_arm_obeys_newton_and_euler() {
    let arm = |parent, place, mass, com, inertia| {
        Link::body(Kind::Revolute, Some(parent), place, mass, com, inertia)
    };
    let (y, o) = ([0.0, 1.0, 0.0], [0.0; 3]);
    let links = [
        Link::body(
            Kind::Free,
            None,
            o,
            120.0,
            [0.02, 0.0, -0.05],
            [12.0, 14.0, 11.0],
        ),
        arm(0, [0.5, 0.0, 0.2], 3.0, [0.0, 0.0, 0.1], [0.03, 0.03, 0.01]),
        arm(
            1,
            [0.0, 0.0, 0.2],
            4.0,
            [0.0, 0.02, 0.15],
            [0.05, 0.05, 0.01],
        )
        .about(y),
        arm(
            2,
            [0.0, 0.0, 0.35],
            3.0,
            [0.02, 0.0, 0.15],
            [0.04, 0.04, 0.01],
        ),
        arm(
            3,
            [0.05, 0.0, 0.3],
            3.0,
            [-0.02, 0.0, 0.15],
            [0.04, 0.04, 0.01],
        )
        .about(y),
        arm(
            4,
            [-0.05, 0.0, 0.35],
            2.0,
            [0.0, 0.02, 0.2],
            [0.03, 0.03, 0.005],
        ),
        arm(
            5,
            [0.0, 0.0, 0.3],
            1.5,
            [0.04, 0.0, 0.0],
            [0.004, 0.004, 0.003],
        )
        .about(y),
        arm(
            6,
            [0.08, 0.0, 0.0],
            1.0,
            [0.0, 0.0, 0.08],
            [0.002, 0.002, 0.001],
        ),
    ];
    obeys_newton_and_euler("multibody/satellite_arm", &links, 0.0, |_, u| {
        let mut forces = vec![0.0; 6];
        forces.extend(u);
        forces
    });
}

/// Thrusts act along the third axes of the propellers, at their centres.
#[test]
fn tricopter_obeys_newton_and_euler() {
    let circle = |parent, place, mass, com, inertia| {
        Link::body(Kind::Continuous, Some(parent), place, mass, com, inertia)
    };
    let (o, first) = ([0.0; 3], [1.0, 0.0, 0.0]);
    let third = 2.0 * std::f64::consts::PI / 3.0;
    let mut links = vec![Link::body(
        Kind::Free,
        None,
        o,
        1.2,
        o,
        [0.012, 0.012, 0.02],
    )];
    for arm in 0..3 {
        let tilt = circle(0, o, 0.08, [0.25, 0.0, 0.0], [0.0004; 3]).about(first);
        links.push(tilt.turned(f64::from(arm) * third));
    }
    for arm in 1..=3 {
        links.push(circle(
            arm,
            [0.25, 0.0, 0.04],
            0.02,
            o,
            [0.00003, 0.00003, 0.00006],
        ));
    }
    links.push(circle(0, [0.0, 0.0, -0.05], 0.0, o, o).about(first));
    links.push(circle(7, o, 0.0, o, o).about([0.0, 1.0, 0.0]));
    links.push(circle(8, o, 0.4, [0.0, 0.0, -0.8], [0.001; 3]));
    obeys_newton_and_euler("multibody/tricopter", &links, 9.81, |tree, u| {
        let mut thrusts = [[0.0; 3]; 10];
        for prop in 0..3 {
            thrusts[4 + prop][2] = u[6 + prop];
        }
        let mut forces = tree.pushed(&thrusts);
        for (force, u) in forces[6..12].iter_mut().zip(u) {
            *force += u;
        }
        forces
    });
}
