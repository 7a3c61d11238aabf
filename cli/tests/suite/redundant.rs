//! Linearisations of mechanisms with redundant loops. Each is described twice: as a tree with closed loops, and with
//! one coordinate that places all bodies by closed forms. Both have the same matrices, and for conservative systems at
//! rest the eigenvalues are imaginary, to rounding.

use crate::common::{hamel, text};
use serde_json::Value;

/// Rounding error relative to the largest entry.
const ROUNDING: f64 = 1e-12;

/// A mechanism, and the same in one coordinate q, the angle of its first joint.
struct Twice {
    name: &'static str,
    /// Joints, loops, and guesses as functions of the angle.
    tree: &'static str,
    guesses: fn(f64) -> Vec<(&'static str, f64)>,
    /// The frames as functions of q.
    frames: &'static str,
    /// Bodies on the frames.
    bodies: &'static str,
    /// An angle in the middle of its range.
    amid: f64,
}

/// Three cranks of equal length carry a platform that stays parallel: one of the loop equations is redundant.
const CRANKS: Twice = Twice {
    name: "three cranks",
    tree: "
        joint q: revolute [0, 0, 1] on turn moves first { }
        joint b: revolute [0, 0, 1] on turn at pose(identity(3), [0.7, 0.1, 0]) moves second { }
        joint c: revolute [0, 0, 1] on turn at pose(identity(3), [0.3, 0.6, 0]) moves third { }
        joint top: revolute [0, 0, 1] on first at pose(identity(3), [0.5, 0, 0]) moves plate { }
        loop position(plate, [0.7, 0.1, 0]) = position(second, [0.5, 0, 0]);
        loop position(plate, [0.3, 0.6, 0]) = position(third, [0.5, 0, 0]);",
    guesses: |q| vec![("b", q), ("c", q), ("top", -q)],
    frames: "
        frame first on turn = pose(rotz(q), [0, 0, 0]);
        frame second on turn = pose(rotz(q), [0.7, 0.1, 0]);
        frame third on turn = pose(rotz(q), [0.3, 0.6, 0]);
        frame plate on first = pose(rotz(-q), [0.5, 0, 0]);",
    bodies: "
        body on first { mass 1.2; com [0.2, 0.1, 0]; inertia diag(0.1, 0.2, 0.3) about com; }
        body on second { mass 0.7; com [0.3, 0, 0]; inertia diag(0.1, 0.1, 0.1) about com; }
        body on third { mass 0.4; com [0.1, 0.2, 0]; inertia diag(0.1, 0.1, 0.2) about com; }
        body on plate { mass 2; com [0.3, 0.2, 0]; inertia diag(0.2, 0.2, 0.4) about com; }",
    amid: 0.8,
};

/// Two cranks with a coupler that is held level by a redundant constraint.
const LEVEL: Twice = Twice {
    name: "a level coupler",
    tree: "
        joint q: revolute [0, 0, 1] on turn moves first { }
        joint b: revolute [0, 0, 1] on turn at pose(identity(3), [0.9, 0, 0]) moves second { }
        joint top: revolute [0, 0, 1] on first at pose(identity(3), [0.4, 0, 0]) moves plate { }
        loop position(plate, [0.9, 0, 0]) = position(second, [0.4, 0, 0]);
        let along = plate.R * [1, 0, 0];
        loop along[2] = 0;",
    guesses: |q| vec![("b", q), ("top", -q)],
    frames: "
        frame first on turn = pose(rotz(q), [0, 0, 0]);
        frame second on turn = pose(rotz(q), [0.9, 0, 0]);
        frame plate on first = pose(rotz(-q), [0.4, 0, 0]);",
    bodies: "
        body on first { mass 1.1; com [0.2, 0.1, 0]; inertia diag(0.1, 0.2, 0.3) about com; }
        body on second { mass 0.8; com [0.3, 0, 0]; inertia diag(0.1, 0.1, 0.1) about com; }
        body on plate { mass 3; com [0.5, 0.2, 0]; inertia diag(0.2, 0.2, 0.4) about com; }",
    amid: 1.1,
};

/// Bennett's linkage: four skew hinges, links of lengths 1/2 and 1 twisted by π/6 and π/2, so that tan (q/2) tan
/// (r/2) = √3.
const BENNETT: Twice = Twice {
    name: "Bennett",
    tree: "
        joint q: revolute [0, 0, 1] on turn moves first { }
        joint r: revolute [0, 0, 1] on first at pose(rotx(pi / 6), [0.5, 0, 0]) moves second { }
        joint s: revolute [0, 0, 1] on second at pose(rotx(pi / 2), [1, 0, 0]) moves third { }
        loop back * (position(third, [0.5, 0, 0]) - turn.p) = [-1, 0, 0];
        let axis = back * third.R * rotx(pi / 6) * [0, 0, 1];
        loop axis[1] = 0, axis[3] = 0;",
    guesses: |q| {
        let half = 0.5 * q;
        let other = (3.0_f64.sqrt() * half.cos()).atan2(half.sin());
        vec![("r", 2.0 * other), ("s", -q)]
    },
    frames: "
        let r = 2 * atan2(sqrt(3) * cos(q / 2), sin(q / 2));
        frame first on turn = pose(rotz(q), [0, 0, 0]);
        frame second on first = pose(rotx(pi / 6) * rotz(r), [0.5, 0, 0]);
        frame third on second = pose(rotx(pi / 2) * rotz(-q), [1, 0, 0]);",
    bodies: "
        body on first { mass 1.2; com [0.2, 0.1, 0]; inertia diag(0.1, 0.2, 0.25) about com; }
        body on second { mass 0.7; com [0.5, 0, 0.1]; inertia diag(0.1, 0.12, 0.15) about com; }
        body on third { mass 0.9; com [0.3, 0.2, 0]; inertia diag(0.2, 0.15, 0.1) about com; }",
    amid: 1.3,
};

/// Sarrus's linkage: a plate on two legs of three hinges each, in planes at right angles, moves along a straight line.
const SARRUS: Twice = Twice {
    name: "Sarrus",
    tree: "
        joint q: revolute [0, -1, 0] on turn at [0.3, 0, 0] moves low { }
        joint knee: revolute [0, -1, 0] on low at [0.5, 0, 0] moves high { }
        joint hip: revolute [0, -1, 0] on high at [0.5, 0, 0] moves plate { }
        joint other: revolute [0, -1, 0] on turn at pose(rotz(pi / 2), [0, 0.3, 0]) moves left { }
        joint bend: revolute [0, -1, 0] on left at [0.5, 0, 0] moves right { }
        joint last: revolute [0, -1, 0] on right at [0.5, 0, 0] moves top { }
        let apart = back * (position(top, [0, 0, 0]) - position(plate, [-0.3, 0.3, 0]));
        loop apart[1] = 0, apart[2] = 0, apart[3] = 0;
        let up = transpose(plate.R) * top.R * [0, 0, 1];
        let ahead = transpose(plate.R) * top.R * [1, 0, 0];
        loop up[1] = 0, up[2] = 0, ahead[1] = 0;",
    guesses: |q| {
        let pi = std::f64::consts::PI;
        vec![
            ("knee", pi - 2.0 * q),
            ("hip", q - pi),
            ("other", q),
            ("bend", pi - 2.0 * q),
            ("last", q - pi),
        ]
    },
    frames: "
        frame low on turn = pose(roty(-q), [0.3, 0, 0]);
        frame high on low = pose(roty(2 * q - pi), [0.5, 0, 0]);
        frame plate on high = pose(roty(pi - q), [0.5, 0, 0]);
        frame left on turn = pose(rotz(pi / 2) * roty(-q), [0, 0.3, 0]);
        frame right on left = pose(roty(2 * q - pi), [0.5, 0, 0]);",
    bodies: "
        body on low { mass 1.2; com [0.2, 0.1, 0]; inertia diag(0.1, 0.2, 0.25) about com; }
        body on high { mass 0.7; com [0.3, 0, 0.1]; inertia diag(0.1, 0.12, 0.15) about com; }
        body on plate { mass 2; com [-0.1, 0.2, 0]; inertia diag(0.2, 0.15, 0.3) about com; }
        body on left { mass 0.9; com [0.25, 0, 0]; inertia diag(0.1, 0.1, 0.1) about com; }
        body on right { mass 0.6; com [0.2, 0.05, 0]; inertia diag(0.1, 0.15, 0.1) about com; }",
    amid: 0.7,
};

/// Bricard's mechanism of six hinges at right angles: cos q + cos r + cos q cos r = 0.
const BRICARD: Twice = Twice {
    name: "Bricard",
    tree: "
        joint q: revolute [0, 0, 1] on turn moves f1 { }
        joint r: revolute [0, 0, 1] on f1 at pose(rotx(pi / 2), [1, 0, 0]) moves f2 { }
        joint s: revolute [0, 0, 1] on f2 at pose(rotx(-pi / 2), [1, 0, 0]) moves f3 { }
        joint t: revolute [0, 0, 1] on f3 at pose(rotx(pi / 2), [1, 0, 0]) moves f4 { }
        joint v: revolute [0, 0, 1] on f4 at pose(rotx(-pi / 2), [1, 0, 0]) moves f5 { }
        loop back * (position(f5, [1, 0, 0]) - turn.p) = [-1, 0, 0];
        let axis = back * f5.R * rotx(pi / 2) * [0, 0, 1];
        loop axis[1] = 0, axis[3] = 0;",
    guesses: |q| {
        let other = (1.0 + 2.0 * q.cos()).sqrt().atan2(-q.cos());
        vec![("r", other), ("s", q), ("t", other), ("v", q)]
    },
    frames: "
        let r = atan2(sqrt(1 + 2 * cos(q)), -cos(q));
        frame f1 on turn = pose(rotz(q), [0, 0, 0]);
        frame f2 on f1 = pose(rotx(pi / 2) * rotz(r), [1, 0, 0]);
        frame f3 on f2 = pose(rotx(-pi / 2) * rotz(q), [1, 0, 0]);
        frame f4 on f3 = pose(rotx(pi / 2) * rotz(r), [1, 0, 0]);
        frame f5 on f4 = pose(rotx(-pi / 2) * rotz(q), [1, 0, 0]);",
    bodies: "
        body on f1 { mass 1; com [0.5, 0, 0]; inertia diag(0.01, 0.1, 0.1) about com; }
        body on f2 { mass 2; com [0.4, 0.1, 0]; inertia diag(0.02, 0.1, 0.1) about com; }
        body on f3 { mass 1; com [0.5, 0, 0.1]; inertia diag(0.02, 0.1, 0.11) about com; }
        body on f4 { mass 1.5; com [0.5, 0, 0]; inertia diag(0.01, 0.1, 0.1) about com; }
        body on f5 { mass 1; com [0.6, 0, 0]; inertia diag(0.01, 0.1, 0.1) about com; }",
    amid: 1.4,
};

const ALL: [Twice; 5] = [CRANKS, LEVEL, BENNETT, SARRUS, BRICARD];

/// The first entries of a list, and all with `HAMEL_ATTACK`: linearisations of six-bar loops take seconds.
fn first<T>(some: usize, all: &[T]) -> &[T] {
    match std::env::var_os("HAMEL_ATTACK") {
        Some(_) => all,
        None => &all[..some],
    }
}

impl Twice {
    /// Both descriptions at an angle, with rates of the angle and of the base, under loads that both have.
    fn described(&self, q: f64, [rate, spin]: [f64; 2], loads: &str) -> [String; 2] {
        let guesses = (self.guesses)(q).into_iter();
        let guesses = guesses.map(|(name, value)| format!("start {name} ~ {value:?};\n"));
        let guesses: String = guesses.collect();
        let base = "
            joint spin: continuous [0, 1, 0] on world at [-0.2, 0, 0.3] moves turn { }
            body on turn { mass 1; com [0.1, 0, 0.2]; inertia diag(0.4, 0.5, 0.6) about com; }
            let back = transpose(turn.R);
            input push;
            gravity [0, -9.81, 0];";
        let start = format!("start q = {q:?}, q_dot = {rate:?}, spin_dot = {spin:?};");
        let common = format!("{} {loads} {start} generate all, linearize;", self.bodies);
        let (tree, frames) = (self.tree, self.frames);
        [
            format!("{base} {tree} {common} {guesses} independent spin_dot, q_dot;"),
            format!("{base} coord q; velocity q_dot; rate q = q_dot; {frames} {common}"),
        ]
        .map(|all| format!("pub system Twice {{ {all} }}"))
    }
}

fn linearized(description: &str) -> Value {
    let output = hamel(&["linearize", "-", "--format", "json"], description);
    assert!(
        output.status.success(),
        "{}\n{description}",
        text(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn rows(value: &Value) -> Vec<Vec<f64>> {
    let list = |value: &Value| value.as_array().expect("a list").clone();
    let number = |value: &Value| value.as_f64().expect("a number");
    let rows = list(value).into_iter();
    rows.map(|row| list(&row).iter().map(number).collect())
        .collect()
}

#[test]
fn slopes_of_redundant_loops_are_those_in_one_coordinate() {
    let loads = "
        spring stiffness 5 on q - 0.2;
        generalized force q_dot = push * cos(q) - 0.3 * q_dot;
        generalized force spin_dot = push - 0.1 * spin_dot;";
    let states = [
        (0.0, [0.0, 0.0]),
        (0.05, [1.3, 0.4]),
        (-0.21, [-2.1, 0.9]),
        (0.17, [0.7, -1.5]),
    ];
    for mechanism in first(2, &ALL) {
        for &(angle, rates) in first(2, &states) {
            let both = mechanism.described(mechanism.amid + angle, rates, loads);
            let [tree, single] = both.map(|description| linearized(&description));
            assert_eq!(tree["states"].as_array().map(Vec::len), Some(4));
            for part in ["A", "B"] {
                let (found, expected) = (rows(&tree[part]).concat(), rows(&single[part]).concat());
                assert_eq!(found.len(), expected.len(), "{}", mechanism.name);
                let size = expected.iter().fold(1.0_f64, |most, e| most.max(e.abs()));
                for (found, expected) in found.iter().zip(&expected) {
                    let apart = (found - expected).abs() / size;
                    assert!(
                        apart < ROUNDING,
                        "{} at {angle}, {part}: {found}, {expected}, {apart:e} apart",
                        mechanism.name
                    );
                }
            }
        }
    }
}

/// The base turns steadily, and a constant force holds the first joint: apart from the free turn no mode grows or
/// decays, and the loops oscillate with the frequencies found in one coordinate.
#[test]
fn conservative_redundant_loops_have_imaginary_eigenvalues() {
    for mechanism in first(2, &ALL) {
        let amid = mechanism.amid;
        let at = |force: f64| {
            let loads = format!(
                "spring stiffness 60 on q - {amid:?}; generalized force q_dot = {force:?} + push;"
            );
            let both = mechanism.described(amid, [0.0, 1.3], &loads);
            both.map(|description| linearized(&description))
        };
        let [_, single] = at(0.0);
        let place = single["states"].as_array().and_then(|names| {
            let mut names = names.iter();
            names.position(|name| name == "d(q_dot)")
        });
        let place = place.expect("it moves");
        let rate = single["xi_dot"][place - 2].as_f64().expect("a number");
        let [tree, single] = at(-rate / rows(&single["B"])[place][0]);
        let [found, expected] = [tree, single].map(|linear| {
            let swinging = rows(&linear["eigenvalues"]).into_iter();
            let mut swinging = swinging.filter(|pair| pair[1] > 0.1);
            let found = swinging.next().expect("it swings");
            assert!(swinging.next().is_none(), "{}", mechanism.name);
            found
        });
        let (real, apart) = (found[0].abs(), (found[1] - expected[1]).abs());
        assert!(
            real.max(apart) < ROUNDING * expected[1],
            "{}: {found:?}, {expected:?}",
            mechanism.name
        );
    }
}
