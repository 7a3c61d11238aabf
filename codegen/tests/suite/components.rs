//! Constraints whose X has several components: the equations are those of the component that contains the start, for
//! any form of the constraint.

use crate::common::{generated, value};

/// A constraint, the rates of x, y, z, their start, and ξ̇ there.
type Case = (&'static str, [&'static str; 3], [&'static str; 3], [f64; 2]);

/// Lines, planes and a cylinder as one equation, with M = I and the potential y: ξ̇ is minus its slope along
/// each velocity.
#[test]
fn the_component_of_the_start_is_meant() {
    let cases: [Case; 12] = [
        (
            "x^2 - y^2 = 0",
            ["v", "v", "w"],
            ["1", "1", "0"],
            [-1.0, 0.0],
        ),
        (
            "x^2 - y^2 = 0",
            ["v", "-v", "w"],
            ["1", "-1", "0"],
            [1.0, 0.0],
        ),
        (
            "x^4 - y^4 = 0",
            ["v", "v", "w"],
            ["1", "1", "0"],
            [-1.0, 0.0],
        ),
        (
            "x^6 - y^6 = 0",
            ["v", "-v", "w"],
            ["1", "-1", "0.5"],
            [1.0, 0.0],
        ),
        (
            "x^2 = l^2 * y^2",
            ["l * v", "v", "w"],
            ["2", "1", "0"],
            [-1.0, 0.0],
        ),
        (
            "x^2 = 2 * y^2",
            ["sqrt(2) * v", "v", "w"],
            ["sqrt(2)", "1", "0"],
            [-1.0, 0.0],
        ),
        (
            "x^2 * z + y^2 * z = z",
            ["v", "w", "0"],
            ["0.3", "0.2", "0"],
            [0.0, -1.0],
        ),
        (
            "x^2 * z + y^2 * z = z",
            ["-y * v", "x * v", "w"],
            ["1", "0", "0.7"],
            [-1.0, 0.0],
        ),
        (
            "x^2 * z = y^2 * z",
            ["v", "v", "w"],
            ["1", "1", "0.7"],
            [-1.0, 0.0],
        ),
        (
            "x * y + x * z = y^2 + y * z",
            ["v", "v", "w"],
            ["1", "1", "0.7"],
            [-1.0, 0.0],
        ),
        (
            "(x - y)^2 = z^2",
            ["v + w", "v", "w"],
            ["1.7", "1", "0.7"],
            [-1.0, 0.0],
        ),
        ("z = 0", ["v", "w", "0"], ["1", "0.2", "0"], [0.0, -1.0]),
    ];
    for (constraint, rates, start, expected) in cases {
        let text = format!(
            "system A {{ param l = 2; coord x, y, z; constraint {constraint}; velocity v, w;
                rate x = {}; rate y = {}; rate z = {}; kinetic v^2 / 2 + w^2 / 2; potential y;
                output _l = l; start x = {}, y = {}, z = {}; }}",
            rates[0], rates[1], rates[2], start[0], start[1], start[2]
        );
        let of = generated(&text);
        let found = value(&of, "accel", [&of.model.start_x, &[0.2, 0.3], &[], &[]]);
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-14,
                "{constraint}: {found} {expected}"
            );
        }
    }
}

/// Four bars of two lengths, by absolute angles: crank and rocker turn equally and the coupler stays level, which is
/// one of two assemblies. The velocity is given by its rate, or by its definition.
#[test]
fn a_parallelogram_stays_one() {
    for rates in [
        "velocity w; rate a = w; rate b = 0; rate c = w;",
        "velocity w = rate(a);",
    ] {
        let of = generated(&format!(
            "system Parallelogram {{
                param l = 0.5, d = 2; coord a: S1, b: S1, c: S1;
                constraint l * a.c + d * b.c = d + l * c.c;
                constraint l * a.s + d * b.s = l * c.s;
                {rates}
                frame crank = pose(rotz(a), [0, 0, 0]);
                frame rocker = pose(rotz(c), [d, 0, 0]);
                body on crank {{ mass 1; com [0.2, 0, 0]; inertia diag(0, 0, 0.1) about com; }}
                body on rocker {{ mass 1; com [0.2, 0, 0]; inertia diag(0, 0, 0.1) about com; }}
                gravity [0, -9.81, 0];
                start a = 1, b = 0, c = 1;
            }}"
        ));
        let (s, c) = 0.8_f64.sin_cos();
        let x = [c, s, 1.0, 0.0, c, s];
        let found = value(&of, "accel", [&x, &[0.4], &[], &[]])[0];
        let expected = -2.0 * 9.81 * 0.2 * c / (2.0 * (0.1 + 0.04));
        assert!(
            (found - expected).abs() < 1e-12,
            "{rates}: {found} {expected}"
        );
    }
}

/// A set that is almost a line, a circle or a pair of lines near the start, but not elsewhere: ẋ = A ξ is compared with
/// the derivative of x as a function of y and z.
#[test]
fn what_holds_near_the_start_alone_is_no_equation() {
    let state = [0.7, 0.95];
    for power in [8, 12, 18, 24, 30] {
        for small in [1.0, 1e-2, 1e-5] {
            for (constraint, square) in [
                ("x = 2 * y", false),
                ("x^2 = y^2", true),
                ("x^2 = 1 - y^2", true),
            ] {
                let curved = format!("{constraint} + {small:e} * z^{power}");
                // x or x² as a function of y and z, and its slopes
                let at = |[y, z]: [f64; 2]| {
                    let bent = small * z.powi(power);
                    let slope = small * f64::from(power) * z.powi(power - 1);
                    match constraint {
                        "x = 2 * y" => (2.0 * y + bent, [2.0, slope]),
                        "x^2 = y^2" => (y * y + bent, [2.0 * y, slope]),
                        _ => (1.0 - y * y + bent, [-2.0 * y, slope]),
                    }
                };
                let x_of = |state: [f64; 2]| {
                    let (x, [along_y, along_z]) = at(state);
                    match square {
                        false => (x, [along_y, along_z]),
                        true => (x.sqrt(), [along_y, along_z].map(|s| s / 2.0 / x.sqrt())),
                    }
                };
                let start = x_of([0.6, 0.1]).0;
                let of = generated(&format!(
                    "system A {{ coord x, y, z; velocity v = rate(y), w = rate(z);
                        constraint {curved}; particle mass 1 at [x, y, z];
                        start x = {start}, y = 0.6, z = 0.1; }}"
                ));
                let (x, slopes) = x_of(state);
                let x = [x, state[0], state[1]];
                for (i, slope) in slopes.into_iter().enumerate() {
                    let xi: [f64; 2] = std::array::from_fn(|j| f64::from(u8::from(i == j)));
                    let found = value(&of, "rate", [&x, &xi, &[], &[]])[0];
                    assert!(
                        (found - slope).abs() < 1e-12 * slope.abs().max(1.0),
                        "{curved}: {found}, expected {slope}"
                    );
                }
            }
        }
    }
}
