//! Synthetic spatial chains: n links on revolute joints about alternating axes, by `rate` and `frame` statements with
//! run-time parameters only.

use std::fmt::Write;

/// Returns the description of a chain of n links.
pub fn chain(n: usize) -> String {
    let mut text = String::from("/// A spatial chain.\npub system Chain {\n    param g = 9.81;\n");
    for i in 1..=n {
        let _ = writeln!(
            text,
            "    param m{i} = 1, s{i}: vec3 = [0.1, 0.02, -0.3], d{i}: vec3 = [0.1, -0.05, -0.6];\n    \
             param I{i}: sym3 = [[0.02, 0.001, 0.002], [0.001, 0.03, 0.003], [0.002, 0.003, 0.04]];\n    \
             coord q{i}: S1;\n    velocity u{i};\n    rate q{i} = u{i};"
        );
    }
    for i in 1..=n {
        let axis = ["z", "x", "y"][i % 3];
        let on = if i > 1 {
            format!(" on f{}", i - 1)
        } else {
            String::new()
        };
        let _ = writeln!(
            text,
            "    frame f{i}{on} = pose(rot{axis}(q{i}), d{i});\n    \
             body on f{i} {{ mass m{i}; com s{i}; inertia I{i} about com; }}"
        );
    }
    text.push_str("    gravity [0, 0, -g];\n    generate accel, rate;\n}\n");
    text
}
