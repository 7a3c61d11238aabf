//! Mechanisms with a redundant row of constraints, in `f32` and `f64`: their systems are singular up to rounding, and
//! the regularisation that makes them solvable has to suit both precisions.

use hamel::Scalar;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::program::FunctionId;
use hamel_native::{Compiled, Tapes, evaluate_in};

/// A platform on three parallel cranks of the same length.
const PLATFORM: &str = "
    pub system Platform {
        gravity [0, -9.81, 0];
        joint a: revolute [0, 0, 1] on world moves first { damping 0.3; }
        joint b: revolute [0, 0, 1] on world at pose(identity(3), [0.7, 0.1, 0]) moves second { }
        joint c: revolute [0, 0, 1] on world at pose(identity(3), [0.3, 0.6, 0]) moves third { armature 0.2; }
        joint top: revolute [0, 0, 1] on first at pose(identity(3), [0.5, 0, 0]) moves platform { }
        body on first { mass 1.2; com [0.2, 0.1, 0]; inertia diag(0.1, 0.2, 0.3) about com; }
        body on second { mass 0.7; com [0.3, 0, 0]; inertia diag(0.1, 0.1, 0.1) about com; }
        body on third { mass 0.4; com [0.1, 0.2, 0]; inertia diag(0.1, 0.1, 0.2) about com; }
        body on platform { mass 2; com [0.3, 0.2, 0]; inertia diag(0.2, 0.2, 0.4) about com; }
        loop position(platform, [0.7, 0.1, 0])[1] - position(second, [0.5, 0, 0])[1] = 0;
        loop position(platform, [0.7, 0.1, 0])[2] - position(second, [0.5, 0, 0])[2] = 0;
        loop position(platform, [0.3, 0.6, 0])[1] - position(third, [0.5, 0, 0])[1] = 0;
        loop position(platform, [0.3, 0.6, 0])[2] - position(third, [0.5, 0, 0])[2] = 0;
        generate all, linearize;
    }";

/// Lengths of the cranks, and their inertia about the axes together with that of the platform, which does not rotate.
const LENGTH: f64 = 0.5;
const INERTIA: f64 = (0.3 + 1.2 * (0.2 * 0.2 + 0.1 * 0.1))
    + (0.1 + 0.7 * 0.3 * 0.3)
    + (0.2 + 0.4 * (0.1 * 0.1 + 0.2 * 0.2) + 0.2)
    + 2.0 * LENGTH * LENGTH;
/// First moments of mass along the cranks and across them.
const MOMENTS: [f64; 2] = [
    1.2 * 0.2 + 0.7 * 0.3 + 0.4 * 0.1 + 2.0 * LENGTH,
    1.2 * 0.1 + 0.4 * 0.2,
];
const STATES: usize = 300;

/// The angular acceleration of the cranks, which have one degree of freedom, and its slopes by the angle and by the
/// rate.
fn reference(angle: f64, rate: f64) -> [f64; 3] {
    let ([along, across], (sin, cos)) = (MOMENTS, angle.sin_cos());
    [
        (-9.81 * (along * cos - across * sin) - 0.3 * rate) / INERTIA,
        9.81 * (along * sin + across * cos) / INERTIA,
        -0.3 / INERTIA,
    ]
}

/// The largest errors of ξ̇ and of its slopes along the motion, relative to the largest undamped acceleration.
fn errors<S: Scalar>(found: &Generated) -> Result<[f64; 2], String> {
    let program = &found.program;
    let named = |id: FunctionId| program.function(id.name()).ok_or("no such function");
    let functions = [named(FunctionId::Accel)?, named(FunctionId::Linearize)?];
    let tapes = Tapes::new(program, &functions).map_err(|why| format!("{why:?}"))?;
    let constants = Compiled::interpreted(tapes.clone()).constants(&program.defaults);
    let short = |of: f64| [1.0, 1.0, 1.0, -1.0].map(|sign| S::from_f64(sign * of));
    let mut worst = [0.0f64; 2];
    for k in 0..STATES {
        let (angle, rate) = (0.021 * k as f64 + 0.01, (k as f64).sin());
        let [acceleration, by_angle, by_rate] = reference(angle, rate);
        let (x, xi) = (short(angle), short(rate));
        let arguments: [&[S]; 5] = [&x, &xi, &[], &[], &[]];
        let (mut xi_dot, mut slopes) = ([S::default(); 4], [S::default(); 64]);
        for (tape, out) in tapes
            .functions
            .iter()
            .zip([&mut xi_dot[..], &mut slopes[..]])
        {
            evaluate_in(tape, constants.known(), arguments, out)
                .map_err(|cause| format!("{angle}: {cause:?}"))?;
        }
        for (row, sign) in [1.0, 1.0, 1.0, -1.0].into_iter().enumerate() {
            let error = |found: f64, wanted: f64| (found - sign * wanted).abs();
            let along = |first: usize| {
                let row = &slopes[8 * (4 + row) + first..][..4];
                let [a, b, c, top] = [0, 1, 2, 3].map(|k| row[k].largest_lane());
                a + b + c - top
            };
            worst[0] = worst[0].max(error(xi_dot[row].largest_lane(), acceleration));
            worst[1] = worst[1].max(error(along(0), by_angle));
            worst[1] = worst[1].max(error(along(4), by_rate));
        }
    }
    let [along, across] = MOMENTS;
    Ok(worst.map(|error| error * INERTIA / (9.81 * along.hypot(across))))
}

/// For states that violate the loops, their rows contradict one another. The contradiction is removed before the
/// division by the term that is added to the diagonal, in either precision, so that neither accelerations nor slopes
/// lose digits to it. Slopes lose some where the first rows are nearly dependent without the last one, as for level
/// cranks: elimination begins with these.
#[test]
fn what_the_diagonal_is_raised_by_costs_no_digits() -> Result<(), String> {
    fn holds<S: Scalar>(found: &Generated) -> Result<(), String> {
        let [accelerations, slopes] = errors::<S>(found)?;
        println!("{accelerations:.1e} {slopes:.1e}");
        assert!(accelerations < 1e3 * S::EPSILON, "{accelerations}");
        assert!(slopes < 4e3 * S::EPSILON, "{slopes}");
        Ok(())
    }
    let found = from_text(PLATFORM).map_err(|why| format!("{why:?}"))?;
    holds::<f64>(&found)?;
    holds::<f32>(&found)
}
