//! Descriptions that once were refused, or ended in a panic, without reason.

mod common;

use common::{generated, value};
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::proof::check::{Verdict, check};

/// All of what dampers and springs are made of is there when the identities are proved.
#[test]
fn proofs_know_of_dampers() {
    let text = "system A {
        param m = 1, c = 0.5; coord x, y; velocity v, w; rate x = v; rate y = w;
        kinetic m * v^2 / 2 + m * w^2 / 2;
        output a1 = x^3 * y + v^4 + w * x^2 * c^5;
        output a2 = (x + 7)^3 * y;
        damper coefficient c^2 + 3 on v - 2 * w;
    }";
    let of = Generated::all(generated(text).model, 0).expect("right");
    for identity in check(&of.model, &of.program) {
        assert!(
            !matches!(identity.verdict, Verdict::Failed(_)),
            "{identity:?}"
        );
    }
}

/// An M that is not positive concerns what needs its inverse alone.
#[test]
fn inverse_dynamics_need_no_positive_mass() {
    let text = |list: &str| {
        format!(
            "system A {{ coord x, y; velocity u, v; rate x = u; rate y = v;
                kinetic u^2 / 2 - v^2; {list} }}"
        )
    };
    let of = generated(&text("generate inverse_dynamics, mass_matrix;"));
    let force = value(
        &of,
        "inverse_dynamics",
        [&[0.0; 2], &[0.0; 2], &[], &[3.0, 5.0]],
    );
    assert_eq!(force, [3.0, -10.0]);
    for list in ["", "generate accel;"] {
        let errors = from_text(&text(list)).expect_err("no inverse");
        assert!(errors[0].message.contains("not positive definite"));
    }
}

/// A number that a prime of the proofs divides is 0 there: it is refused, and its neighbours are not.
#[test]
fn multiples_of_the_primes_are_refused() {
    let text = |number: &str| {
        format!(
            "system A {{ coord q; velocity v; rate q = v; kinetic v^2 / 2; output a = {number} * q; start q = 1; }}"
        )
    };
    for prime in [
        "3622009729038446591",
        "3133965575612089391",
        "6267931151224178782",
    ] {
        let errors = from_text(&text(prime)).expect_err("0 modulo the prime");
        assert!(
            errors[0].message.contains("multiple of a prime"),
            "{}",
            errors[0].message
        );
    }
    for number in [
        "3622009729038446590",
        "2305843009213693951",
        "3133965575612089392",
    ] {
        let of = generated(&text(number));
        let found = value(&of, "a", [&[1.0], &[0.0], &[], &[]])[0];
        assert_eq!(found, number.parse::<f64>().expect("a number"));
    }
}

/// Twists of a link's freedoms may vary in its axes although their drift is 0: those of a spin in axes of the
/// world do. What is found by recursion for constant twists must not be taken for these.
#[test]
fn spins_in_axes_of_the_world() {
    let body = |i: usize| {
        format!(
            "coord R{i}: SO3; velocity w{i}: vec3; rate R{i} = hat(w{i}) * R{i};
             frame top{i} = pose(R{i}, [0, 0, {i}]);
             body on top{i} {{ mass {i}.5; com [0.1, -0.2, 0.3]; inertia diag(2, 3, 4) about com; }}"
        )
    };
    let bodies: String = (1..=3).map(body).collect();
    let of = generated(&format!(
        "system Tops {{ {bodies} gravity [0, 0, -9.81]; }}"
    ));
    assert!(of.program.function("momentum_rate").is_some());
}

/// Numbers of inverse functions are compared as real numbers, too: sin² + cos² of such an angle is 1.
#[test]
fn mounts_turn_by_angles_of_inverse_functions() {
    for angle in [
        "acos(0.8)",
        "asin(-3/5)",
        "atan2(3, -4)",
        "log(2)",
        "2 * acos(1/3) - asin(sqrt(2) / 3)",
    ] {
        let of = generated(&format!(
            "system A {{ joint j: revolute [0, 0, 1] at pose(rpy({angle}, 0, {angle}), [0, 0, 0]) moves f;
                body on f {{ mass 1; com [1, 0, 0]; inertia diag(1, 1, 1) about com; }}
                output c = cos(acos(0.8)); output s = sin(asin(0.3) + asin(0.3)); }}"
        ));
        let output = |name: &str| value(&of, name, [&[0.3], &[0.0], &[], &[]])[0];
        assert!((output("c") - 0.8).abs() < 1e-15, "{angle}");
        let twice = 2.0 * 0.3 * (1.0_f64 - 0.09).sqrt();
        assert!((output("s") - twice).abs() < 1e-15, "{angle}");
    }
}
