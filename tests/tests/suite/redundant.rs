//! Steps of a mechanism with a redundant row of constraints: compares their slopes along the loops with differences of
//! the steps.

use hamel::methods::{InChart, Rkmk4, Rkmk8, SemiImplicitEuler};
use hamel::{Method, State, Table, TangentSystem, step, step_slopes};

hamel::rigid_eom! {
    /// A platform on three cranks of one length, which stay parallel.
    system Platform {
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
    }
}

/// Error of extrapolated differences with steps of 2⁻⁴ … 2⁻⁹.
const DIFFERENCE_TOLERANCE: f64 = 1e-11;

/// The motion of all joints, relative to the first crank.
const CRANK_DIRECTIONS: [f64; 4] = [1.0, 1.0, 1.0, -1.0];

/// Returns the state at an angle and a rate of the cranks.
fn at(angle: f64, rate: f64) -> State<Platform<f64>> {
    State {
        t: 0.0,
        x: CRANK_DIRECTIONS.map(|sign| sign * angle),
        xi: CRANK_DIRECTIONS.map(|sign| sign * rate),
    }
}

/// d/ds of a function of s at 0, by Richardson extrapolation of central differences
fn slope(of: impl Fn(f64) -> [f64; 8]) -> [f64; 8] {
    let mut table: Vec<[f64; 8]> = Vec::new();
    for level in 0..6 {
        let s = 2.0_f64.powi(-4 - level);
        let (ahead, behind) = (of(s), of(-s));
        let mut row: [f64; 8] = std::array::from_fn(|i| (ahead[i] - behind[i]) / (2.0 * s));
        for (order, known) in table.iter_mut().enumerate() {
            let factor = 4.0_f64.powi(order as i32 + 1) - 1.0;
            let better = std::array::from_fn(|i| row[i] + (row[i] - known[i]) / factor);
            *known = std::mem::replace(&mut row, better);
        }
        table.push(row);
    }
    table[5]
}

fn agree<M>(name: &str, method: &M)
where
    M: Method<Platform<f64>> + Method<TangentSystem<Platform<f64>>> + InChart,
{
    let system = Platform::<f64>::default();
    let end = |angle: f64, rate: f64, h: f64| -> [f64; 8] {
        let mut state = at(angle, rate);
        step(&system, method, &mut state, h, &|_, _, _| []).expect("a step");
        let [x, xi] = [state.x, state.xi];
        std::array::from_fn(|i| if i < 4 { x[i] } else { xi[i - 4] })
    };
    for (angle, rate) in [(0.4, 0.0), (1.3, -1.1), (-0.7, 2.3), (2.6, 0.8)] {
        let h = 0.01;
        let (_, slopes) = step_slopes(method, &system, &at(angle, rate), &[], h).expect("a step");
        for first in [0, 4] {
            let expected = slope(|s| match first {
                0 => end(angle + s, rate, h),
                _ => end(angle, rate + s, h),
            });
            for (row, expected) in expected.iter().enumerate() {
                let entries = &slopes.row(row)[first..];
                let found: f64 = entries
                    .iter()
                    .zip(CRANK_DIRECTIONS)
                    .map(|(a, sign)| a * sign)
                    .sum();
                let apart = (found - expected).abs();
                assert!(
                    apart < DIFFERENCE_TOLERANCE,
                    "{name} at {angle}, row {row}: {found}, {expected}"
                );
            }
        }
    }
}

#[test]
fn slopes_of_steps_keep_all_digits_where_loops_are_redundant() {
    agree("semi-implicit", &SemiImplicitEuler);
    agree("rkmk4", &Rkmk4);
    agree("rkmk8", &Rkmk8);
}
