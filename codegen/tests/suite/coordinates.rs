//! One heavy top in many sets of coordinates: with the velocities ω, M, Γ ξ ξ, ∂V and ξ̇ are the same in all of them.

use crate::common::{difference, generated, value};

/// Returns the top, whose rotation `turn` the description defines.
fn top(coordinates: &str, velocity: &str) -> String {
    format!(
        "system Top {{
            param m = 1.3, g = 9.81, s: vec3 = [0.1, -0.2, 0.4];
            param J: sym3 = [[0.5, 0.02, -0.03], [0.02, 0.6, 0.04], [-0.03, 0.04, 0.3]];
            input u: vec3;
            velocity w: vec3{velocity};
            {coordinates}
            frame f = pose(turn, [0, 0, 0]);
            body on f {{ mass m; com s; inertia J about origin; }}
            gravity [0, 0, -g];
            torque u on f in body;
            generate accel, mass_matrix, bias, potential_force, energy;
            start w = [0.7, -1.1, 0.4];
        }}"
    )
}

/// ω defined by rates of the rotation.
const DEFINED: [&str; 3] = [
    "",
    " = angular_velocity(f) in f",
    " = vee(turn.T * rate(turn))",
];

/// Coordinates for the rotation of the quaternion [1, 2, 4, 2] / 5, each with the index of the definition of ω.
const COORDINATES: [(&str, usize); 14] = [
    (
        "coord R: SO3; let turn = R; rate R = R * hat(w); start R = rot([1, 2, 4, 2] / 5);",
        0,
    ),
    (
        "coord q: S3; let turn = rot(q); rate q = qmul(q, [0, w[1], w[2], w[3]]) / 2; start q = [1, 2, 4, 2] / 5;",
        0,
    ),
    (
        "coord a, b, c, d; constraint a^2 + b^2 + c^2 + d^2 = 1; let turn = rot([a, b, c, d]);
         rate a = -(b * w[1] + c * w[2] + d * w[3]) / 2, b = (a * w[1] + c * w[3] - d * w[2]) / 2;
         rate c = (a * w[2] + d * w[1] - b * w[3]) / 2, d = (a * w[3] + b * w[2] - c * w[1]) / 2;
         start a = 1 / 5, b = 2 / 5, c = 4 / 5, d = 2 / 5;",
        0,
    ),
    // The same with twice the length.
    (
        "coord a, b, c, d; constraint a^2 + b^2 + c^2 + d^2 = 4; let turn = rot([a, b, c, d] / 2);
         start a = 2 / 5, b = 4 / 5, c = 8 / 5, d = 4 / 5;",
        1,
    ),
    // Rodrigues parameters, standard and modified.
    (
        "coord r: R3; let n = 1 + dot(r, r); let turn = identity(3) + (2 / n) * (hat(r) + hat(r) * hat(r));
         rate r = (w + cross(r, w) + r * dot(r, w)) / 2; start r = [2, 4, 2];",
        0,
    ),
    (
        "coord r: R3; let n = dot(r, r);
         let turn = identity(3) + (4 * (1 - n) / (1 + n)^2) * hat(r) + (8 / (1 + n)^2) * hat(r) * hat(r);
         rate r = ((1 - n) * w + 2 * cross(r, w) + 2 * r * dot(r, w)) / 4; start r = [1, 2, 1] / 3;",
        0,
    ),
    // Two columns, and three rows of which one is redundant.
    (
        "coord a: R3, b: R3; constraint dot(a, a) = 1, dot(b, b) = 1, dot(a, b) = 0;
         let c = cross(a, b); let turn = [[a[1], b[1], c[1]], [a[2], b[2], c[2]], [a[3], b[3], c[3]]];
         rate a = b * w[3] - c * w[2], b = c * w[1] - a * w[3];
         start a = [-3 / 5, 4 / 5, 0], b = [12, 9, 20] / 25;",
        0,
    ),
    (
        "coord a: R3, b: R3, c: R3; constraint dot(a, a) = 1, dot(b, b) = 1, dot(a, b) = 0, c = cross(a, b);
         let turn = [a, b, c]; rate a = cross(a, w), b = cross(b, w), c = cross(c, w);
         start a = [-15, 12, 16] / 25, b = [4 / 5, 9 / 25, 12 / 25], c = [0, 20, -15] / 25;",
        0,
    ),
    (
        "coord a: R3, b: R3, c: R3;
         constraint dot(a, a) = 1, dot(b, b) = 1, dot(c, c) = 1, dot(a, b) = 0, dot(b, c) = 0, dot(c, a) = 0;
         let turn = [a, b, c]; start a = [-15, 12, 16] / 25, b = [4 / 5, 9 / 25, 12 / 25], c = [0, 20, -15] / 25;",
        2,
    ),
    // Angles, as numbers and on circles.
    (
        "coord y, p, r; let turn = rotz(y) * roty(p) * rotx(r);
         start y = atan2(4, -3), p = 0, r = atan2(4, -3);",
        1,
    ),
    (
        "coord y: S1, p: S1, r: S1; let turn = rotz(y) * roty(p) * rotx(r);
         start y = atan2(4, -3), p = 0, r = atan2(4, -3);",
        1,
    ),
    (
        "coord y, p, r; let turn = rotz(y) * rotx(p) * rotz(r); start y = atan2(4, -3), p = acos(-3 / 5), r = 0;",
        1,
    ),
    // Axis and angle, and the rotation vector.
    (
        "coord e: R3, t; constraint dot(e, e) = 1;
         let turn = identity(3) + sin(t) * hat(e) + (1 - cos(t)) * hat(e) * hat(e);
         start e = [1, 2, 1] / sqrt(6), t = 2 * acos(1 / 5);",
        1,
    ),
    (
        "coord v: R3; let t = norm(v); let e = v / t;
         let turn = identity(3) + sin(t) * hat(e) + (1 - cos(t)) * hat(e) * hat(e);
         start v = 2 * acos(1 / 5) / sqrt(6) * [1, 2, 1];",
        2,
    ),
];

#[test]
fn a_top_is_the_same_in_all_coordinates() {
    let functions = ["accel", "mass_matrix", "bias", "potential_force", "energy"];
    let numbers = COORDINATES.map(|(coordinates, defined)| {
        let of = generated(&top(coordinates, DEFINED[defined]));
        let model = &of.active;
        let state: [&[f64]; 4] = [&model.start_x, &model.start_xi, &[0.3, -0.2, 0.5], &[]];
        functions.map(|name| value(&of, name, state))
    });
    // M is J for all coordinates of the rotation.
    let inertia = [0.5, 0.02, -0.03, 0.02, 0.6, 0.04, -0.03, 0.04, 0.3];
    for (of, (coordinates, _)) in numbers.iter().zip(COORDINATES) {
        assert!(difference(&inertia, &of[1]) < 1e-15, "{coordinates}");
        for (name, (found, first)) in functions.iter().zip(of.iter().zip(&numbers[0])) {
            let error = difference(first, found);
            assert!(
                error < 1e-13,
                "{name} differs by {error} with {coordinates}"
            );
        }
    }
    // Euler's equations by hand: J ẇ = u − w × J w + s × m Rᵀ [0, 0, −g].
    let [w, u, s] = [[0.7, -1.1, 0.4], [0.3, -0.2, 0.5], [0.1, -0.2, 0.4]];
    let by =
        |v: [f64; 3]| [0, 1, 2].map(|i| (0..3).map(|j| inertia[3 * i + j] * v[j]).sum::<f64>());
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
    };
    let weight = [0.0, 0.8, -0.6].map(|row| -1.3 * 9.81 * row);
    let (gyroscopic, lever) = (cross(w, by(w)), cross(s, weight));
    let torque = [0, 1, 2].map(|i| u[i] - gyroscopic[i] + lever[i]);
    let accel = &numbers[0][0];
    assert!(difference(&torque, &by([accel[0], accel[1], accel[2]])) < 1e-13);
}
