//! Closed loops with rows that vanish or are redundant, compared with the motion by hand.

use crate::common::{generated, value};
use hamel_codegen::generate::Generated;

/// Returns ξ̇ at the start.
fn accel(of: &Generated) -> Vec<f64> {
    let model = &of.active;
    let inputs = vec![0.0; model.u.len()];
    value(of, "accel", [&model.start_x, &model.start_xi, &inputs, &[]])
}

fn close(found: f64, expected: f64) {
    let error = (found - expected).abs() / expected.abs().max(1.0);
    assert!(error < 1e-9, "{found} for {expected}");
}

/// Two hinges with parallel axes keep the second link level: b = -a. The rows of the loop are -sin(a + b) and cos(a +
/// b) times the same velocities, and the first one vanishes where the loop is closed.
#[test]
fn a_link_is_kept_level() {
    for a in [0.7, -1.9, 3.0] {
        let of = generated(&format!(
            "system Parallel {{
                joint a: revolute [0, 0, 1] moves f1;
                joint b: revolute [0, 0, 1] on f1 at [1, 0, 0] moves f2;
                body on f1 {{ mass 1; com [0.5, 0, 0]; inertia diag(0.1, 0.1, 0.1) about com; }}
                body on f2 {{ mass 2; com [0.2, 0.1, 0]; inertia diag(0.2, 0.2, 0.2) about com; }}
                loop f2.R * [1, 0, 0] = [1, 0, 0];
                gravity [0, -9.81, 0];
                start a = {a}, a_dot = 0.4;
            }}"
        ));
        let found = accel(&of);
        let expected = -9.81 * (0.5 + 2.0) * f64::cos(a) / (0.1 + 0.25 + 2.0);
        close(found[0], expected);
        close(found[1], -expected);
    }
}

/// A ball joint with one axis held rotates about this axis: Θ ẇ is the torque of the weight.
#[test]
fn an_axis_of_a_ball_joint_is_held() {
    for (axis, turn, theta, arms) in [
        ("[1, 0, 0]", "rotx", 0.3 + 2.0 * (0.01 + 0.09), [-0.1, 0.3]),
        ("[0, 1, 0]", "roty", 0.2 + 2.0 * (0.04 + 0.09), [0.2, 0.3]),
    ] {
        let of = generated(&format!(
            "system Held {{
                joint base: spherical moves f;
                body on f {{ mass 2; com [0.2, 0.1, 0.3]; inertia diag(0.3, 0.2, 0.25) about com; }}
                loop f.R * {axis} = {axis};
                gravity [0, 0, -9.81];
                start base = {turn}(0.4);
            }}"
        ));
        let along = usize::from(turn == "roty");
        let arm = arms[0] * f64::cos(0.4) + arms[1] * f64::sin(0.4);
        close(accel(&of)[along], 2.0 * 9.81 * arm / theta);
    }
}

/// A table on an arm, kept from rotating by all nine entries of its rotation: every point of it moves as the arm's end.
#[test]
fn a_table_is_kept_from_turning() {
    for held in [
        "f2.R = identity(3)",
        "f2.R * [1, 0, 0] = [1, 0, 0], (f2.R * [0, 1, 0])[3] = 0",
    ] {
        let of = generated(&format!(
            "system Table {{
                joint a: revolute [0, 1, 0] at pose(rotz(0.6), [0, 0, 0]) moves f1;
                joint b: spherical on f1 at [0.3, 0, 0] moves f2;
                body on f1 {{ mass 1; com [0.15, 0, 0]; inertia diag(0.01, 0.01, 0.01) about com; }}
                body on f2 {{ mass 1; com [0.1, 0.02, -0.03]; inertia diag(0.01, 0.012, 0.013) about com; }}
                loop {held};
                gravity [0, 0, -9.81];
                start a = -0.9, a_dot = 2;
            }}"
        ));
        let theta = 0.01 + 0.15 * 0.15 + 0.3 * 0.3;
        close(accel(&of)[0], 9.81 * (0.15 + 0.3) * f64::cos(0.9) / theta);
    }
    let falling = generated(
        "system Falling {
            joint base: free moves f;
            body on f { mass 2; com [0.1, 0.2, 0.3]; inertia diag(0.1, 0.2, 0.3) about com; }
            loop f.R = identity(3);
            gravity [0, 0, -9.81];
        }",
    );
    for (found, expected) in accel(&falling)
        .into_iter()
        .zip([0.0, 0.0, -9.81, 0.0, 0.0, 0.0])
    {
        close(found, expected);
    }
}

/// Two equal angles on circles: at each multiple of a right angle, one of the two rows vanishes, but never both.
#[test]
fn one_row_may_vanish_on_the_way() {
    let of = generated(
        "system Same {
            coord a: S1, b: S1;
            velocity u, v;
            rate a = u, b = v;
            kinetic u^2 / 2 + v^2;
            loop a = b;
            generalized force u = 1;
        }",
    );
    let right = std::f64::consts::FRAC_PI_2;
    for angle in [0.0, 1e-9, 1e-8, 1e-6, 1e-3, 0.7, right - 1e-8, right] {
        let (s, c) = angle.sin_cos();
        let x = [c, s, c, s];
        for rate in value(&of, "accel", [&x, &[0.2, 0.2], &[], &[]]) {
            close(rate, 1.0 / 3.0);
        }
    }
}

/// Returns Bennett's mechanism, with further statements.
fn bennett(more: &str) -> Generated {
    let second =
        "body on g2 { mass 1; com [b / 2, 0, 0]; inertia diag(0.01, 0.1, 0.1) about com; }";
    bennett_with(second, more)
}

/// Returns Bennett's mechanism with this load on its second link.
fn bennett_with(second: &str, more: &str) -> Generated {
    generated(&format!(
        "system Bennett {{
            const al = 40 * pi / 180, a = 1, b = 1.3;
            let be = asin(b / a * sin(al));
            coord q1, q2, q3;
            velocity w1, w2, w3;
            rate q1 = w1, q2 = w2, q3 = w3;
            frame g1 = pose(rotz(q1), [0, 0, 0]);
            frame f1 on g1 = pose(rotx(al), [a, 0, 0]);
            frame g2 on f1 = pose(rotz(q2), [0, 0, 0]);
            frame f2 on g2 = pose(rotx(be), [b, 0, 0]);
            frame g3 on f2 = pose(rotz(q3), [0, 0, 0]);
            frame f3 on g3 = pose(rotx(al), [a, 0, 0]);
            let base = pose(rotx(-be), [-b, 0, 0]);
            loop f3.p = base.p, f3.R * [0, 0, 1] = base.R * [0, 0, 1];
            body on g1 {{ mass 1; com [a / 2, 0, 0]; inertia diag(0.01, 0.1, 0.1) about com; }}
            {second}
            body on g3 {{ mass 1; com [a / 2, 0, 0]; inertia diag(0.01, 0.1, 0.1) about com; }}
            gravity [0, -9.81, 0];
            {more}
        }}"
    ))
}

/// Opposite links of Bennett's mechanism rotate equally, and the total power of loads and inertia is zero, even where a
/// row of the loop vanishes, at q1 = 0.
#[test]
fn bennetts_mechanism_passes_its_folded_position() {
    for q1 in [0.0, 1e-7, 0.3, 1.0] {
        let of = bennett(&format!("start q1 = {q1}, q2 ~ 3, q3 ~ -{q1}, w1 = -0.7;"));
        let (x, xi) = (&of.model.start_x, &of.model.start_xi);
        close(xi[2], -xi[0]);
        let rates = accel(&of);
        close(rates[2], -rates[0]);
        let needed = value(&of, "inverse_dynamics", [x, xi, &[], &rates]);
        let power: f64 = needed.iter().zip(xi).map(|(f, v)| f * v).sum();
        assert!(power.abs() < 1e-9, "{power} at {q1}");
    }
}

/// Overconstrained mechanisms can be driven like others.
#[test]
fn overconstrained_mechanisms_are_driven() {
    let pushed =
        bennett("input F; prescribe rate(w1) = F; start q1 = 1, q2 ~ 3, q3 ~ -1, w1 = 0.7;");
    let (x, xi) = (&pushed.model.start_x, &pushed.model.start_xi);
    let rates = value(&pushed, "accel", [x, xi, &[0.8], &[]]);
    close(rates[0], 0.8);
    close(rates[2], -0.8);
    let turned = bennett("time t; prescribe w1 = 0.7 + 0.8 * t; start q1 = 1, q2 ~ 3, q3 ~ -1;");
    let other = accel(&turned);
    close(*other.last().expect("rates"), -0.8);
    close(other[other.len() - 2], rates[1]);
}

/// Returns a crank that drives a slider by a massless rod: M of the three joints is singular.
fn slider(rod: &str, more: &str) -> Generated {
    generated(&format!(
        "system Slider {{
            param mr = 0, J = 0.02, m = 0.7, r = 0.1, l = 0.3;
            joint a: revolute [0, 0, 1] moves crank {{ armature J; }}
            joint b: revolute [0, 0, 1] on crank at [r, 0, 0] moves rod;
            joint s: prismatic [1, 0, 0] moves piston;
            {rod}
            body on piston {{ mass m; }}
            loop rod.p + rod.R * [l, 0, 0] = piston.p;
            gravity [-9.81, 0, 0];
            {more}
        }}"
    ))
}

/// s = r cos a + √(l² − r² sin² a), (J + m s'²) ä + m s' s'' ȧ² = −m g s', with or without a rod of mass 0.
#[test]
fn links_of_a_loop_need_no_mass() {
    let (inertia, mass, r, l) = (0.02, 0.7, 0.1, 0.3_f64);
    for rod in ["", "body on rod { mass mr; com [l / 2, 0, 0]; }"] {
        for (a, rate) in [(0.7_f64, 2.0), (-2.1, -3.0), (3.0, 0.5)] {
            let (sin, cos) = a.sin_cos();
            let root = (l * l - r * r * sin * sin).sqrt();
            let slope = -r * sin - r * r * sin * cos / root;
            let bend = -r * cos
                - r * r * (cos * cos - sin * sin) / root
                - (r * r * sin * cos).powi(2) / root.powi(3);
            let force = -mass * (9.81 * slope + slope * bend * rate * rate);
            let expected = force / (inertia + mass * slope * slope);
            let of = slider(rod, &format!("start a = {a}, a_dot = {rate}, s ~ 0.3;"));
            let found = accel(&of);
            close(found[0], expected);
            close(found[2], slope * expected + bend * rate * rate);
        }
    }
    // With redundant rows as well: the coupler has no mass, or almost none.
    let folded = "start q1 = 0, q2 ~ 3, q3 ~ 0, w1 = -0.7;";
    let (none, little) = (
        bennett_with("", folded),
        bennett_with(
            "body on g2 { mass 1e-6; inertia diag(1e-7, 1e-7, 1e-7) about com; }",
            folded,
        ),
    );
    for (none, little) in accel(&none).iter().zip(accel(&little)) {
        assert!(
            (none - little).abs() < 1e-4 * little.abs(),
            "{none} and {little}"
        );
    }
    // With a driven crank.
    let driven = slider(
        "",
        "input F; prescribe rate(a_dot) = F; start a = 0.7, a_dot = 2;",
    );
    let model = &driven.model;
    let found = value(
        &driven,
        "accel",
        [&model.start_x, &model.start_xi, &[0.8], &[]],
    );
    close(found[0], 0.8);
}
