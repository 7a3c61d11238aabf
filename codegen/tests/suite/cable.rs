//! Cables, which pull when they are longer than their length and do nothing otherwise, compared with equations by hand.

use crate::common::{Random, difference, generated, value};
use hamel_codegen::proof::check::{Verdict, check};

/// A load on a cable from the ceiling to a point below it, off the centre of mass.
const LOAD: &str = "
system Load {
    param m = 3, k = 2000, l = 0.8;
    coord r: R3;
    coord R: SO3;
    velocity v: vec3;
    velocity w: vec3;
    rate r = v;
    rate R = R * hat(w);
    frame load = pose(R, r);
    body on load { mass m; inertia diag(0.2, 0.3, 0.4); }
    gravity [0, 0, -9.81];
    cable stiffness k length l from [0, 0, 1] on world to [0, 0.1, 0.2] on load;
    start r = [0, 0, -0.1];
}";

#[test]
fn a_load_is_pulled_only_by_a_taut_cable() {
    let of = generated(LOAD);
    for identity in check(&of.model, &of.program) {
        let failed = matches!(identity.verdict, Verdict::Failed(_));
        assert!(!failed, "{identity:?}");
    }
    let (m, k, l) = (3.0, 2000.0, 0.8);
    let mut random = Random::new(11);
    let mut taut = 0;
    for _ in 0..40 {
        // Without rotation, so that the body's axes are those of the world.
        let r = random.numbers(3);
        let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let x = [r.clone(), identity.to_vec()].concat();
        let arm = [0.0, 0.1, 0.2];
        let d = [r[0] + arm[0], r[1] + arm[1], r[2] + arm[2] - 1.0];
        let distance = d.iter().map(|e| e * e).sum::<f64>().sqrt();
        let pull = k * (distance - l).max(0.0) / distance;
        taut += i32::from(distance > l);
        let force = d.map(|entry| -pull * entry);
        let torque = [
            arm[1] * force[2] - arm[2] * force[1],
            arm[2] * force[0] - arm[0] * force[2],
            arm[0] * force[1] - arm[1] * force[0],
        ];
        let expected = [
            force[0] / m,
            force[1] / m,
            force[2] / m - 9.81,
            torque[0] / 0.2,
            torque[1] / 0.3,
            torque[2] / 0.4,
        ];
        let found = value(&of, "accel", [&x, &[0.0; 6], &[], &[]]);
        let largest = expected.iter().fold(1.0, |a: f64, e| a.max(e.abs()));
        assert!(difference(&found, &expected) <= 1e-12 * largest);
    }
    assert!((5..=35).contains(&taut), "{taut} of 40 are taut");
}

/// A slider that passes the anchor of its cable.
const SLIDER: &str = "
system Slider {
    param k = 40;
    joint q: prismatic [1, 1, 0] moves block;
    body on block { mass 2; }
    cable stiffness k length 0.5 from world to block;
    start q = 1;
    generate all, linearize;
}";

#[test]
fn a_cable_pulls_towards_its_anchor_from_both_sides() {
    let of = generated(SLIDER);
    for q in [-3.0, -0.6, -0.5, -0.1, 0.0, 0.2, 0.5, 0.7, 2.0_f64] {
        let expected = -q.signum() * 20.0 * (q.abs() - 0.5).max(0.0);
        let found = value(&of, "accel", [&[q], &[0.3], &[], &[]]);
        assert!(difference(&found, &[expected]) <= 1e-13, "{q}: {found:?}");
        let slope = if q.abs() > 0.5 { -20.0 } else { 0.0 };
        if q.abs() != 0.5 {
            let found = value(&of, "linearize", [&[q], &[0.3], &[], &[]]);
            assert!(
                difference(&found, &[0.0, 1.0, slope, 0.0]) <= 1e-13,
                "{q}: {found:?}"
            );
        }
    }
}
