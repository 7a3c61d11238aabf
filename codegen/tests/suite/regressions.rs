//! Descriptions that were once refused wrongly, or caused a panic.

use crate::common::{generated, value};
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::proof::check::{Verdict, check};

/// All terms of dampers and springs are available when identities are proved.
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

/// An M that is not positive definite only affects functions that need its inverse.
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

/// A number that a prime of the proofs divides is 0 modulo it: it is refused, and its neighbours are not.
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

/// Twists of a joint may vary in body axes although their drift is 0, as for spin in world axes. Results of the
/// recursion for constant twists must not be used for these.
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

/// Values of inverse functions are also compared as real numbers: sin² + cos² of such an angle is 1.
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

/// The inertia that a slider does not see is passed to the previous link in its axes, which were rotated for another
/// hinge on it: M at rest has the diagonal computed by hand.
#[test]
fn a_slider_stands_beside_a_hinge() {
    let of = generated(
        "system A {
            joint a: revolute [0, 0, 1] moves f; joint b: revolute [0, 3, 4] on f moves g;
            joint p: prismatic [0, 1, 0] on g moves h; joint c: revolute [0, 1, 0] on g moves k;
            body on k { mass 1; inertia diag(1, 1, 1) about com; }
            body on h { mass 1; com [1, 0, 0]; inertia diag(1, 2, 3) about com; }
        }",
    );
    let mass = value(&of, "mass_matrix", [&[0.0; 4], &[0.0; 4], &[], &[]]);
    let diagonal: Vec<f64> = (0..4).map(|i| mass[5 * i]).collect();
    // About z: 1 + 3 + 1; about (0, 3, 4)/5: 1 + (9 · 2 + 16 · 3) / 25 + 1.
    let expected = [5.0, 2.0 + 66.0 / 25.0, 1.0, 1.0];
    for (found, expected) in diagonal.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-14, "{diagonal:?}");
    }
}

/// Forces as functions of a dependent velocity, and many roots of velocities: for particles with M = I and one
/// constraint b ξ = 0, ξ̇ = f − b (b f) / (b b).
#[test]
fn forces_depend_on_dependent_velocities() {
    for law in [
        "tanh(V)",
        "sin(V)",
        "V / sqrt(1 + V^2)",
        "exp(V) - 1",
        "V * sqrt(4 + V^2)",
    ] {
        let force = |v: &str| law.replace('V', v);
        let of = generated(&format!(
            "system A {{ coord x, y, z, q; velocity u, v, w, s; rate x = u; rate y = v; rate z = w; rate q = s;
                kinetic (u^2 + v^2 + w^2 + s^2) / 2; nonholonomic u - v - 2 * w = 0;
                generalized force u = -({}); generalized force v = -({}); generalized force w = -({});
                generalized force s = -({}); }}",
            force("u"), force("v"), force("w"), force("s")
        ));
        let value_of = |v: f64| match law {
            "tanh(V)" => v.tanh(),
            "sin(V)" => v.sin(),
            "V / sqrt(1 + V^2)" => v / (1.0 + v * v).sqrt(),
            "exp(V) - 1" => v.exp() - 1.0,
            _ => v * (4.0 + v * v).sqrt(),
        };
        let (v, w, s) = (0.3, -0.7, 0.4);
        let f = [v + 2.0 * w, v, w, s].map(|v| -value_of(v));
        let along = (f[0] - f[1] - 2.0 * f[2]) / 6.0;
        let expected = [f[1] + along, f[2] + 2.0 * along, f[3]];
        let found = value(&of, "accel", [&[0.0; 4], &[v, w, s], &[], &[]]);
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-14,
                "{law}: {found} {expected}"
            );
        }
    }
}

/// Functions of sums of velocities that constraints make proportional or zero: proofs evaluate both by one linear form.
#[test]
fn forces_depend_on_multiples_of_velocities() {
    let text = "system A { coord x, y, z; velocity u, v, w; rate x = u; rate y = v; rate z = w;
        kinetic 1.5 * u^2 / 2 + v^2 / 4 + w^2 / 2; nonholonomic 3 * u + 2 * w = 0;
        generalized force u = cosh((w - u) / 3) - sin((w + u) / 5); }";
    let (v, w) = (0.3, -0.7);
    let u = -2.0 / 3.0 * w;
    let force = ((w - u) / 3.0_f64).cosh() - ((w + u) / 5.0_f64).sin();
    let expected = [0.0, -2.0 / 3.0 * force / (1.0 + 1.5 * 4.0 / 9.0)];
    let found = value(&generated(text), "accel", [&[0.0; 3], &[v, w], &[], &[]]);
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
    for still in ["sin(u)", "tanh(u)", "exp(u) - 1", "sinh(u / 3 + v)"] {
        let text = format!(
            "system A {{ coord x, y, z; velocity u, v, w; rate x = u; rate y = v; rate z = w;
                kinetic u^2 + w^2; nonholonomic (1 + y^2) * u = 0; nonholonomic 3 * v = 0;
                generalized force w = {still} + log(2 + sin(v)); }}"
        );
        let found = value(
            &generated(&text),
            "accel",
            [&[0.0; 3], &[0.0, 0.4], &[], &[]],
        );
        assert_eq!(found.len(), 2, "{still}");
        assert!(
            (found[1] - 2.0_f64.ln() / 2.0).abs() < 1e-14,
            "{still}: {found:?}"
        );
    }
}

/// Rows are solved for large factors: with a pivot of 1e-5, half of the digits were lost. For M = I and rows b₁, b₂ the
/// motion is ξ = s n, n = b₁ × b₂, and ξ̇ follows by cross products.
#[test]
fn small_factors_are_no_pivots() {
    let of = generated(
        "system A { coord x, y, z; velocity u, v, w; rate x = u; rate y = v; rate z = w;
            kinetic (u^2 + v^2 + w^2) / 2; potential 3 * x - y + 2 * z;
            nonholonomic 1e-5 * u + (1 + x^2) * v + cos(x) * w = 0;
            nonholonomic -3 * u + x * v + (2 + sin(x)) * w = 0; }",
    );
    let cross = |a: [f64; 3], b: [f64; 3]| {
        std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
    };
    let dot = |a: [f64; 3], b: [f64; 3]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let x = 0.7_f64;
    let rows = [[1e-5, 1.0 + x * x, x.cos()], [-3.0, x, 2.0 + x.sin()]];
    let n: [f64; 3] = cross(rows[0], rows[1]);
    let xi = n.map(|n| 0.3 * n);
    let changes = [
        [0.0, 2.0 * x * xi[0], -x.sin() * xi[0]],
        [0.0, xi[0], x.cos() * xi[0]],
    ];
    let sides = changes.map(|change| -dot(change, xi));
    let along = dot(n, [-3.0, 1.0, -2.0]);
    let across: [[f64; 3]; 2] = [cross(rows[1], n), cross(n, rows[0])];
    let motion =
        |i: usize| (along * n[i] + sides[0] * across[0][i] + sides[1] * across[1][i]) / dot(n, n);
    let place = |name: &str| ["u", "v", "w"].iter().position(|known| *known == name);
    let names = of.active.velocities.iter();
    let active: Vec<usize> = names
        .map(|group| place(&group.name).expect("known"))
        .collect();
    let given: Vec<f64> = active.iter().map(|&i| xi[i]).collect();
    let found = value(&of, "accel", [&[x, 0.0, 0.0], &given, &[], &[]]);
    for (&i, found) in active.iter().zip(found) {
        assert!(
            (found - motion(i)).abs() < 1e-13,
            "{i}: {found} {}",
            motion(i)
        );
    }
}

/// √(e²) of an e that is positive everywhere but occurs only later, in slopes: at some points modulo the primes the
/// root is e, at others −e.
#[test]
fn roots_of_squares_may_turn_out_to_be_known() {
    for (potential, slope) in [
        ("sqrt(1 + sinh(a * x)^2)", |x: f64| 0.5 * (0.5 * x).sinh()),
        ("sqrt(1 + sinh(x / 2)^2)", |x: f64| 0.5 * (0.5 * x).sinh()),
        ("sqrt(x^4 + 2 * x^2 + 1)", |x: f64| 2.0 * x),
        ("sqrt(3) * sqrt(1 + sinh(a * x)^2)", |x: f64| {
            3.0_f64.sqrt() * 0.5 * (0.5 * x).sinh()
        }),
        ("sqrt(4 * x^4 + 4 * a * x^2 + a^2)", |x: f64| 4.0 * x),
        ("sqrt(2 + exp(x) + exp(-x))", |x: f64| (0.5 * x).sinh()),
    ] as [(&str, fn(f64) -> f64); 6]
    {
        // Unused parameters change the points.
        for count in 0..6 {
            let idle: String = (0..count).map(|k| format!(", _p{k} = 2")).collect();
            let of = generated(&format!(
                "system A {{ param a = 0.5{idle}; coord x; velocity v; rate x = v;
                    kinetic v^2 / 2; potential {potential}; output _a = a; start x = 0.3; }}"
            ));
            let found = value(&of, "accel", [&[0.7], &[0.0], &[], &[]])[0];
            assert!((found + slope(0.7)).abs() < 1e-14, "{potential}: {found}");
        }
    }
}

/// Roots of velocities whose constraints contain a root of a non-square modulo the primes, or that proofs move onto
/// constraints: they are outside the prime fields, and so are their radicands. For M = I and one constraint
/// b ξ = 0, ξ̇ = f − b (b f) / (b b).
#[test]
fn roots_of_velocities_outside_the_prime_fields() {
    for square in [0.99999999_f64, 0.43, 0.47, 0.59, 0.1009] {
        let scale = square.sqrt();
        let of = generated(&format!(
            "system A {{ coord x, y, z; velocity u, v, w; rate x = u; rate y = v; rate z = w;
                kinetic (u^2 + v^2 + w^2) / 2; nonholonomic u - sqrt({square}) * v - cos(z) * w = 0;
                generalized force u = -u * sqrt(u^2 + v^2 + 1e-7); generalized force w = -sqrt(w^2 + v^2 + 1); }}"
        ));
        let (z, v, w) = (0.4_f64, 0.3, -0.7);
        let u = scale * v + z.cos() * w;
        let f = [
            -u * (u * u + v * v + 1e-7).sqrt(),
            0.0,
            -(w * w + v * v + 1.0_f64).sqrt(),
        ];
        let b = [1.0, -scale, -z.cos()];
        // d/dt (b ξ) = b ξ̇ + sin z w² = 0
        let push = b.iter().zip(&f).map(|(b, f)| b * f).sum::<f64>() + z.sin() * w * w;
        let along = push / b.iter().map(|b| b * b).sum::<f64>();
        let expected = [f[1] - b[1] * along, f[2] - b[2] * along];
        let found = value(&of, "accel", [&[0.1, 0.2, z], &[v, w], &[], &[]]);
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-13 * expected.abs().max(1.0),
                "{square}: {found} {expected}"
            );
        }
    }
}

/// ξ̇ as a by-product of [A B] of a tree is followed by the rates of states, as in `accel`.
#[test]
fn trees_with_states_have_slopes() {
    let of = generated(
        "system A { joint j: spherical moves f; state z = 0.5; rate z = j_dot[3]^3 - 2 * z;
            body on f { mass 1; inertia [[1, 0.05, 0.02], [0.05, 1, 0.03], [0.02, 0.03, 1]]; }
            torque [z, 0, 0] on f in body; generate linearize; }",
    );
    let x = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let rows = value(&of, "linearize", [&x, &[0.0, 0.0, 2.0, 0.5], &[], &[]]);
    // The last row, of ż, by (h, δξ, δz).
    assert_eq!(rows[42..], [0.0, 0.0, 0.0, 0.0, 0.0, 12.0, -2.0]);
}

/// Runs are projected onto every nonlinear loop, even if the factor of a velocity in it is constant: while the velocity
/// of the slider was dependent, its position drifted away from the rod. Every method preserves linear loops such as
/// gears.
#[test]
fn runs_are_led_back_to_sliders() {
    let text = |kept: &str| {
        format!(
            "system A {{ coord q, p, x; velocity w, u, v; rate q = w, p = u, x = v;
                kinetic w^2 / 2 + u^2 / 2 + v^2;
                loop {kept}; start q = 0.5; }}"
        )
    };
    let slider = generated(&text("cos(q) + 3 * cos(p) = x, sin(q) + 3 * sin(p) = 0"));
    assert_eq!(slider.active.n(), 3);
    // φ = (cos q + 3 cos p − x, sin q + 3 sin p), off the loop.
    let [x, p] = [0.0_f64, 0.25];
    let off = value(&slider, "constraint", [&[0.0, p, x], &[], &[], &[]]);
    assert_eq!(off, [1.0 + 3.0 * p.cos() - x, 3.0 * p.sin()]);
    let step = value(&slider, "project_position", [&[0.0, p, x], &[], &[], &[]]);
    assert!(
        step[2] > 0.0,
        "the slider goes where the rod ends: {step:?}"
    );
    let gears = generated(&text("q = 2 * p + x"));
    assert_eq!(gears.active.n(), 2);
}

/// Terms without a velocity may be inside products: a partly prescribed spin, with Euler's equations of the total spin,
/// and a constraint with a common factor that varies.
#[test]
fn terms_without_a_velocity_stand_in_products() {
    let spin = "[w[1] + 0.3 * cos(t), w[2], w[3]]";
    let (t, w) = (0.7_f64, [0.4, -0.8, 1.1]);
    let full = [w[0] + 0.3 * t.cos(), w[1], w[2]];
    // Θ = diag(2, 3, 4): Θ dΩ/dt = (Θ Ω) × Ω, and Ω₁ = w₁ + 0.3 cos t
    let expected = [
        (3.0 - 4.0) * full[1] * full[2] / 2.0 + 0.3 * t.sin(),
        (4.0 - 2.0) * full[2] * full[0] / 3.0,
        (2.0 - 3.0) * full[0] * full[1] / 4.0,
    ];
    for (kind, rate, x) in [
        (
            "S3",
            format!("qmul(q, [0, {spin}[1], {spin}[2], {spin}[3]]) / 2"),
            &[t, 0.5, -0.5, 0.5, 0.5][..],
        ),
        (
            "SO3",
            format!("q * hat({spin})"),
            &[t, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        ),
    ] {
        let frame = if kind == "S3" { "rot(q)" } else { "q" };
        let of = generated(&format!(
            "system A {{ time t; coord q: {kind}; velocity w: vec3; rate q = {rate};
                frame f = pose({frame}, [0, 0, 0]); body on f {{ mass 1; inertia diag(2, 3, 4) about com; }} }}"
        ));
        let found = value(&of, "accel", [x, &w, &[], &[]]);
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-14,
                "{kind}: {found} {expected}"
            );
        }
    }
    let text = |time: &str, constraint: &str| {
        format!(
            "system A {{ {time} coord x, y; velocity u, v; rate x = u, y = v; kinetic u^2 / 2 + v^2 / 2;
                nonholonomic {constraint}; start x = 1; start v = 2; }}"
        )
    };
    // v = x (u + sin t): one degree of freedom u of mass 1 + x², with the force from d/dt of x (u + sin t).
    let of = generated(&text("time t;", "x * (u + sin(t)) = v"));
    let [x, u] = [1.3, 0.4];
    let other = u * (u + t.sin()) + x * t.cos();
    let expected = -x * other / (1.0 + x * x);
    let found = value(&of, "accel", [&[t, x, 0.2], &[u], &[], &[]]);
    assert!((found[0] - expected).abs() < 1e-14, "{found:?} {expected}");
    // Without time, an error explains that the same text is wrong.
    let errors = from_text(&text("", "x * (u + 3) = y * v")).expect_err("no time");
    assert!(errors[0].message.contains("a term without a velocity"));
}

/// With stabilisation, d/dt (B ξ) = −λ B ξ for a velocity constraint and φ̈ = −2 λ φ̇ − λ² φ for a loop: violations
/// decay like exp(−λ t).
#[test]
fn violations_decay_at_the_rate_that_is_given() {
    let (x, xi) = ([0.4, 0.1], [0.7, -0.3]);
    let accel = |kept: &str| {
        let of = generated(&format!(
            "system A {{ coord x, y; velocity u, v; rate x = u, y = v; kinetic u^2 / 2 + v^2;
                start x = 1; {kept} }}"
        ));
        value(&of, "accel", [&x, &xi, &[], &[]])
    };
    // s = x u + y v
    let found = accel("nonholonomic x * u + y * v = 0 stabilized 5;");
    let s = x[0] * xi[0] + x[1] * xi[1];
    let s_dot = x[0] * found[0] + x[1] * found[1] + xi[0] * xi[0] + xi[1] * xi[1];
    assert!((s_dot + 5.0 * s).abs() < 1e-14, "{s_dot} {s}");
    // φ = x² + y² − 1, with the same directions
    let found = accel("loop x^2 + y^2 = 1 stabilized 5;");
    let phi = x[0] * x[0] + x[1] * x[1] - 1.0;
    let twice = 2.0 * (x[0] * found[0] + x[1] * found[1] + xi[0] * xi[0] + xi[1] * xi[1]);
    assert!((twice + 10.0 * 2.0 * s + 25.0 * phi).abs() < 1e-13);
}

/// Roots of a dependent velocity, whose factor contains primes that are not squares in the fields of the proof.
#[test]
fn roots_of_velocities_that_follow_from_others_are_proved() {
    let text = |law: &str| {
        format!(
            "system A {{ coord x, y; velocity u, v; rate x = u, y = v; kinetic u^2 / 2 + v^2;
                nonholonomic 53 * v + 2 * u = 0; independent u; generalized force u = {law}; }}"
        )
    };
    let (u, ratio) = (0.7_f64, -2.0 / 53.0);
    let v = ratio * u;
    for (law, force) in [
        ("sqrt(v^2 + 1)", (v * v + 1.0).sqrt()),
        ("norm([v, u]) * v", v.hypot(u) * v),
        ("norm([v, v]) * v", 2.0_f64.sqrt() * v.abs() * v),
    ] {
        let of = generated(&text(law));
        let found = value(&of, "accel", [&[0.0; 2], &[u], &[], &[]])[0];
        // (1 + 2 r²) u̇ = f with v = r u.
        let expected = force / (1.0 + 2.0 * ratio * ratio);
        assert!(
            (found - expected).abs() < 1e-14,
            "{law}: {found}, {expected}"
        );
    }
}

/// A prescribed angle on a circle: its displacement has no effect, since it is not read.
#[test]
fn given_circles_have_a_linearisation() {
    let of = generated(
        "system A { time t; coord q, c: S1; velocity u, w; rate q = u, c = w; kinetic u^2 / 2 + w^2 / 2;
            prescribe c = 0.3 * t; generalized force u = c.s - 3 * q - 2 * u; generate linearize; }",
    );
    let x = [0.5, 0.7, 0.15_f64.cos(), 0.15_f64.sin()];
    let found = value(&of, "linearize", [&x, &[0.2], &[], &[]]);
    // ḣ of q is δu, that of c is 0; δu̇ = −3 h − 2 δu
    assert_eq!(found, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -3.0, 0.0, -2.0]);
}

/// The leading stars of a block comment are not list items, as in rustdoc; those of other texts are kept.
#[test]
fn stars_of_block_comments_are_no_docs() {
    let docs = |docs: &str| {
        let text = format!("{docs}\nsystem A {{ coord x; velocity v; rate x = v; kinetic v^2; }}");
        generated(&text).program.docs
    };
    let starred = "/** A block\n *\n *  - set in\r\n * of wood.\n */";
    assert_eq!(docs(starred), ["A block", "", " - set in", "of wood."]);
    assert_eq!(docs("/**\n  * A block\n  */"), ["A block"]);
    assert_eq!(
        docs("/** A\n * list\nin prose */"),
        ["A", "* list", "in prose "]
    );
    assert_eq!(docs("/// * a\n/// * b\n///"), ["* a", "* b", ""]);
}

/// Functions of accelerations that are constants or sums of velocities are proved with these inserted.
#[test]
fn functions_of_known_accelerations_are_proved() {
    let stone = |more: &str| {
        format!(
            "system Stone {{ coord z; velocity v; rate z = v; frame f at [0, 0, z]; body on f {{ mass 1; }}
                gravity [0, 0, -9.81]; {more} }}"
        )
    };
    let of = generated(&stone("state a = 0; rate a = norm(acceleration(f)) - a;"));
    let found = value(&of, "accel", [&[0.0], &[0.0], &[0.0], &[]]);
    assert!((found[0] + 9.81).abs() < 1e-14 && (found[1] - 9.81).abs() < 1e-14);
    for of in ["exp", "tanh", "cos"] {
        let output =
            format!("output y = {of}(acceleration(f)[3] / 9) * v; generate y_slopes, linearize;");
        generated(&stone(&output));
    }
    generated(
        "system S { time t; coord q, p; velocity u, v; rate q = u + p, p = v + t * u; kinetic u^2 / 2 + v^2 / 2;
            frame f = pose(roty(q), [0, 0, 0]); output y = cos(angular_acceleration(f)[2]); generate all, linearize; }",
    );
    generated(
        "system Drive { coord q; velocity v; rate q = v; kinetic v^2; prescribe rate(v) = 0.5;
            frame f at [q, 0, 0]; output y = sin(acceleration(f)[1]) * q; generate all, linearize, y_slopes; }",
    );
}

/// Components in the axes of frames with an index, and of frames of parts.
#[test]
fn frames_of_arrays_have_axes() {
    let of = |axes: &str| {
        let of = generated(&format!(
            "system S {{
                component Leg() {{
                    joint q: revolute [0, 0, 1] moves f;
                    body on f {{ mass 1; inertia diag(1, 1, 1) about com; }}
                }}
                joint j[1]: revolute [0, 0, 1] moves g[1];
                body on g[1] {{ mass 1; inertia diag(1, 1, 1) about com; }}
                part a[2] = Leg();
                output y = (velocity(g[1], [1, 0, 0]) in {axes})[1];
            }}"
        ));
        value(&of, "y", [&[0.3, 0.8], &[2.0, 0.5], &[], &[]])[0]
    };
    // The velocity has the direction [−sin 0.3, cos 0.3].
    assert!((of("world") + 2.0 * 0.3_f64.sin()).abs() < 1e-15);
    assert!(of("g[1]").abs() < 1e-15);
    assert!((of("a[2].f") - 2.0 * 0.5_f64.sin()).abs() < 1e-15);
}
