//! Rounding of emitted functions: arms with almost parallel, perpendicular or intersecting axes, compared with their
//! dynamics from the definitions in doubled precision.

use crate::arm::{Angle, Arm, Decimal, Joint};
use crate::common::{Random, generated, size, value};
use hamel_codegen::algebra::double::Double;
use hamel_codegen::algebra::numeric::evaluate;
use hamel_codegen::derive::numerical_loss::losses;
use hamel_codegen::derive::tables::EquationTables;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::render::render;

/// Bound of the error, relative to the scale of a result.
const TOLERANCE: f64 = 1e-13;
/// Number of arms by default and at full size.
const ARM_COUNTS: (u64, u64) = (10, 1000);
/// Number of states of each arm.
const STATES_PER_ARM: usize = 3;

fn largest<'a>(entries: impl IntoIterator<Item = &'a Double>) -> f64 {
    let sizes = entries.into_iter().map(|entry| entry.abs().to_f64());
    sizes.fold(0.0, f64::max)
}

/// Returns the largest difference; infinity for NaN.
fn apart(found: &[f64], wanted: &[Double]) -> f64 {
    assert_eq!(found.len(), wanted.len());
    let both = found.iter().zip(wanted);
    let far = both.map(|(&a, &b)| (Double::new(a) - b).abs().to_f64());
    far.fold(0.0, |most, d| {
        if d.is_nan() {
            f64::INFINITY
        } else {
            f64::max(most, d)
        }
    })
}

/// Returns the errors of M, bias, slope of the potential and ξ̇ at random states, each relative to its scale.
fn errors(arm: &Arm, system: &Generated, seed: u64) -> [f64; 4] {
    let n = arm.0.len();
    let mut random = Random::new(seed);
    let mut worst = [0.0; 4];
    for _ in 0..STATES_PER_ARM {
        let (x, xi, u) = (random.numbers(n), random.numbers(n), random.numbers(n));
        let of = |name: &str| value(system, name, [&x, &xi, &u, &[]]);
        let exact = arm.dynamics(&x, &xi);
        let mass = exact.mass.concat();
        let size = largest(&mass);
        let right: Vec<Double> = (0..n)
            .map(|i| Double::new(u[i]) - exact.bias[i] - exact.slope[i])
            .collect();
        let motion = exact.solve(&right);
        let moved = [
            (apart(&of("mass_matrix"), &mass), size),
            (
                apart(&of("bias"), &exact.bias),
                largest(&exact.bias).max(size),
            ),
            (
                apart(&of("potential_force"), &exact.slope),
                largest(&exact.slope).max(size),
            ),
            (
                apart(&of("accel"), &motion),
                largest(&motion) * exact.condition(),
            ),
        ];
        for (worst, (error, scale)) in worst.iter_mut().zip(moved) {
            *worst = f64::max(*worst, error / scale);
        }
    }
    worst
}

/// Returns the error of M in the printed tables, KR18 (20).
fn error_of_tables(arm: &Arm, system: &Generated, seed: u64) -> f64 {
    let n = arm.0.len();
    let geometry = EquationTables::new(&system.model).expect("velocities that determine the rates");
    let model = &geometry.model;
    let mut random = Random::new(seed);
    let (x, still) = (random.numbers(n), vec![0.0; n]);
    let numbers = model.numbers(&[], &x, &still, &still, &still);
    let mass = arm.dynamics(&x, &still).mass.concat();
    apart(
        &evaluate(&model.graph, &geometry.mass.concat(), &numbers),
        &mass,
    ) / largest(&mass)
}

#[test]
fn awkward_axes_keep_their_digits() {
    let mut random = Random::new(0xa2);
    let mut failures = Vec::new();
    for case in 0..size(ARM_COUNTS.0, ARM_COUNTS.1) {
        let arm = Arm::awkward(&mut random);
        let text = arm.text();
        let system = match from_text(&text) {
            Ok(system) => system,
            Err(errors) => {
                let message = render(&errors, "arm", &text, false);
                failures.push(format!("case {case}: {message}\n{text}"));
                continue;
            }
        };
        let worst = errors(&arm, &system, case);
        let mut tables = 0.0;
        if arm.0.len() <= 3 {
            tables = error_of_tables(&arm, &system, case);
        }
        if worst
            .iter()
            .chain([&tables])
            .any(|error| error.is_nan() || *error > TOLERANCE)
        {
            failures.push(format!(
                "case {case}: {worst:?}, tables {tables:.1e}\n{text}"
            ));
        }
    }
    assert!(
        failures.is_empty(),
        "{} arms:\n{}",
        failures.len(),
        failures.join("\n")
    );
}

/// Returns an axis perpendicular to two parallel ones, the last of which is tilted.
fn arm_of_three(tilt: Decimal) -> Arm {
    let (zero, one) = (Decimal(0, 0), Decimal(1, 0));
    let joint = |axis: usize, tilt: Decimal, place: Decimal, mass: Decimal| Joint {
        slides: false,
        axis,
        rpy: [Angle(0, zero), Angle(0, tilt), Angle(0, zero)],
        place: [place, zero, zero],
        mass,
        com: [one, Decimal(3, -1), Decimal(2, -1)],
        moments: [mass; 3],
    };
    Arm(vec![
        joint(1, zero, zero, zero),
        joint(2, zero, one, zero),
        joint(2, tilt, one, one),
    ])
}

/// A regression: M₁₁ was 7.20 instead of 10.04.
#[test]
fn a_tilt_of_a_hundredth_of_a_millionth() {
    let arm = arm_of_three(Decimal(1, -8));
    let system = generated(&arm.text());
    let still = [0.0; 3];
    let mass = value(&system, "mass_matrix", [&still, &still, &still, &[]]);
    assert!((mass[0] - 10.040000008).abs() < 1e-12, "{}", mass[0]);
    let worst = errors(&arm, &system, 1);
    assert!(worst.iter().all(|&error| error <= TOLERANCE), "{worst:?}");
}

/// Digits that are lost by every candidate are measured and documented.
#[test]
fn lost_digits_are_measured() {
    let text = "system Lost {
        coord x; velocity v; rate x = v; kinetic v^2 / 2; start x = 0.5;
        output small = (1 - cos(1e-4 * x)) * 2e8;
        output fine = x^2 + 3 * v;
    }";
    let system = generated(text);
    let losses = losses(&system.active, &system.program);
    let of = |name: &str| {
        let mut functions = system.program.functions.iter();
        functions
            .position(|function| function.name == name)
            .expect("it is there")
    };
    // 1 − cos(1e-4 x) is about 1e-9, with an error of 1e-16.
    let (small, fine) = (of("small"), of("fine"));
    let lost = losses[small].expect("it has values");
    assert!((7.0..10.0).contains(&lost), "{lost}");
    assert!(losses[fine].expect("it has values") < 1.0);
    let says = |index: usize| {
        system.program.functions[index]
            .docs
            .concat()
            .contains("Rounding loses")
    };
    assert!(says(small) && !says(fine));
    // The measure agrees with f64: compared with x² − 1e-8 x⁴ / 12.
    let (x, v) = (0.7, 0.2);
    let found = value(&system, "small", [&[x], &[v], &[], &[]])[0];
    let error = (found - (x * x - 1e-8 * x.powi(4) / 12.0)).abs();
    assert!(error > 1e-12 && error < 1e-6, "{error:e}");
}

/// The position of the scene in the world does not affect the accuracy of its frames.
#[test]
fn far_from_the_origin_of_the_world() {
    let text = "system Far {
        generate mass_matrix, accel; gravity [0, 0, -9.81];
        joint a: revolute [0, 1, 0] at pose(identity(3), [1e6, -2e6, 3e6]) moves f;
        joint b: revolute [0, 0, 1] on f at pose(identity(3), [1, 0, 0]) moves g;
        joint c: revolute [0, 0, 1] on g at pose(roty(1e-3), [1, 0, 0]) moves h;
        body on h { mass 1; com [1, 0.3, 0.2]; inertia diag(1, 1, 1) about com; }
    }";
    let near = text.replace("[1e6, -2e6, 3e6]", "[0, 0, 0]");
    let state = [0.3, -0.4, 0.8];
    let of = |text: &str| {
        value(
            &generated(text),
            "mass_matrix",
            [&state, &[0.0; 3], &[], &[]],
        )
    };
    let (far, near) = (of(text), of(&near));
    let exact = arm_of_three(Decimal(1, -3))
        .dynamics(&state, &[0.0; 3])
        .mass
        .concat();
    let scale = largest(&exact);
    assert!(apart(&far, &exact) <= TOLERANCE * scale && apart(&near, &exact) <= TOLERANCE * scale);
}
