//! Slopes of steps against differences of the steps themselves along the manifold, extrapolated; composition, the
//! limit of short steps, and the symplectic form.

use hamel::methods::{
    BackwardEuler, Cf4, General, Lgvi, Rk4, Rkmk4, Rkmk8, Rkmk54, Scheme, SemiImplicitEuler,
    Splitting,
};
use hamel::{Block, Method, Split, State, System, Table, Tangent, manifold, step, step_slopes};
use hamel_tests::linear;

/// Differences over steps of 2⁻⁴ … 2⁻⁹, extrapolated: truncation like 2⁻³⁶ of derivatives of order 13, rounding 1e-13.
const DIFFERENCE: f64 = 2e-10;
/// Sums of products of slopes.
const ROUNDING: f64 = 1e-12;

/// The chart vector of a tangent vector δx at x.
fn chart(blocks: &[Block], mut x: &[f64], mut dx: &[f64]) -> Vec<f64> {
    let mut all = Vec::new();
    for block in blocks {
        let (here, rest) = x.split_at(block.coordinates());
        let (moved, others) = dx.split_at(block.coordinates());
        match block {
            Block::Flat(_) => all.extend(moved),
            Block::Circle => all.push(here[0] * moved[1] - here[1] * moved[0]),
            Block::Quaternion => {
                let [w, a, b, c] = [here[0], here[1], here[2], here[3]];
                let [dw, da, db, dc] = [moved[0], moved[1], moved[2], moved[3]];
                all.extend([
                    2.0 * (w * da - a * dw - b * dc + c * db),
                    2.0 * (w * db - b * dw - c * da + a * dc),
                    2.0 * (w * dc - c * dw - a * db + b * da),
                ]);
            }
            Block::Rotation => {
                let entry = |i: usize, j: usize| {
                    (0..3).map(|k| here[3 * k + i] * moved[3 * k + j]).sum::<f64>()
                };
                all.extend([entry(2, 1), entry(0, 2), entry(1, 0)]);
            }
        }
        (x, dx) = (rest, others);
    }
    all
}

/// (x⁺, ξ⁺) of a step from a state moved along A η and by δξ, at inputs moved by δu.
fn moved<Sys, M>(method: &M, system: &Sys, start: &State<Sys>, u: &[f64], h: f64, by: &[f64]) -> Vec<f64>
where
    Sys: Tangent<Scalar = f64>,
    M: Method<Sys>,
{
    let frame = system.frame(&start.x);
    let velocities = start.xi.as_ref().len();
    let displacements = by.len() - velocities - u.len();
    let dx: Vec<f64> = (0..frame.rows())
        .map(|i| frame.row(i).iter().zip(by).map(|(a, by)| a * by).sum())
        .collect();
    let along = chart(system.blocks(), start.x.as_ref(), &dx);
    let mut state = start.clone();
    manifold::retract(system.blocks(), state.x.as_mut(), &along);
    for (xi, by) in state.xi.as_mut().iter_mut().zip(&by[displacements..]) {
        *xi += by;
    }
    let mut inputs = system.zero_inputs();
    let pushed = inputs.as_mut().iter_mut().zip(u.iter().zip(&by[displacements + velocities..]));
    pushed.for_each(|(input, (u, by))| *input = u + by);
    step(system, method, &mut state, h, &|_, _, _| inputs.clone()).expect("a step");
    state.x.as_ref().iter().chain(state.xi.as_ref()).copied().collect()
}

/// d/ds of a function of s at 0, by Richardson's extrapolation of central differences.
fn slope(of: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let mut table: Vec<Vec<f64>> = Vec::new();
    for level in 0..6 {
        let s = 2.0_f64.powi(-4 - level);
        let (ahead, behind) = (of(s), of(-s));
        let mut row: Vec<f64> = ahead.iter().zip(behind).map(|(a, b)| (a - b) / (2.0 * s)).collect();
        for (order, known) in table.iter_mut().enumerate() {
            let factor = 4.0_f64.powi(order as i32 + 1);
            let better: Vec<f64> = row
                .iter()
                .zip(known.iter())
                .map(|(new, old)| new + (new - old) / (factor - 1.0))
                .collect();
            *known = std::mem::replace(&mut row, better);
        }
        table.push(row);
    }
    table.pop().expect("six levels")
}

/// The slopes of a step against differences.
fn agree<Sys, M>(name: &str, method: &M, system: &Sys, start: &State<Sys>, u: &[f64], h: f64)
where
    Sys: Tangent<Scalar = f64>,
    M: Method<Sys> + Method<Sys::Dual>,
{
    let mut inputs = system.zero_inputs();
    inputs.as_mut().copy_from_slice(u);
    let (end, slopes) = step_slopes(method, system, start, &inputs, h).expect("a step");
    let mut alone = start.clone();
    step(system, method, &mut alone, h, &|_, _, _| inputs.clone()).expect("a step");
    assert_eq!(end.x.as_ref(), alone.x.as_ref(), "{name}: x");
    assert_eq!(end.xi.as_ref(), alone.xi.as_ref(), "{name}: ξ");
    let columns = slopes.row(0).len();
    let displacements = slopes.rows() - start.xi.as_ref().len();
    let coframe = system.coframe(&end.x);
    let nu = start.x.as_ref().len();
    for column in 0..columns {
        let differences = slope(|s| {
            let mut by = vec![0.0; columns];
            by[column] = s;
            moved(method, system, start, u, h, &by)
        });
        let expected = (0..slopes.rows()).map(|row| match row.checked_sub(displacements) {
            None => coframe.row(row).iter().zip(&differences).map(|(y, d)| y * d).sum(),
            Some(velocity) => differences[nu + velocity],
        });
        let scale = differences.iter().fold(1.0_f64, |scale, d| scale.max(d.abs()));
        for (row, expected) in expected.enumerate() {
            let found = slopes.row(row)[column];
            assert!(
                (found - expected).abs() < DIFFERENCE * scale,
                "{name}, row {row}, column {column}: {found} {expected}"
            );
        }
    }
}

/// A state some steps into the motion of the description, kept by its constraints.
fn under_way<Sys: System<Scalar = f64>>(system: &Sys, u: &[f64]) -> State<Sys> {
    let (x, xi) = system.start();
    let mut state = State { t: 0.0, x, xi };
    let mut inputs = system.zero_inputs();
    inputs.as_mut().copy_from_slice(u);
    for _ in 0..20 {
        step(system, Rkmk8, &mut state, 0.01, &|_, _, _| inputs.clone()).expect("a step");
    }
    state
}

/// All methods for any system.
fn all_methods<Sys>(name: &str, system: &Sys, u: &[f64])
where
    Sys: Tangent<Scalar = f64>,
{
    let start = under_way(system, u);
    for method in General::ALL {
        if *method == General::BackwardEuler {
            continue;
        }
        agree(&format!("{name}, {}", method.name()), method, system, &start, u, 0.02);
    }
}

macro_rules! fixtures {
    ($($test:ident $module:ident $type:ident $u:expr;)*) => {$(
        #[test]
        fn $test() {
            let system = linear::$module::$type::<f64>::default();
            all_methods(stringify!($module), &system, &$u);
        }
    )*};
}

fixtures! {
    a_bicycle bicycle Bicycle [0.2];
    a_cart_pole cart_pole CartPole [0.7];
    a_drone drone Drone [3.1, 2.9, 3.0, 3.2];
    a_five_bar five_bar FiveBar [];
    a_closed_loop four_bar_loop FourBarLoop [];
    a_rotation_matrix heavy_top HeavyTop [];
    a_quaternion heavy_top_quaternion QuaternionTop [];
    a_driven_pivot kapitza Kapitza [];
    states_of_first_order lagging_drone LaggingDrone [3.0, 3.1, 2.9, 3.0, 0.1, -0.2, 0.05];
    a_circle pendulum_circle CirclePendulum [];
    a_rolling_disk rolling_disk RollingDisk [];
    two_bodies satellite Satellite [0.1, -0.2, 0.3];
    a_sleigh sleigh Sleigh [];
    angles_with_rates_that_are_none spherical_angles SphericalAngles [];
    a_chain_of_springs spring_chain SpringChain [];
    wheels two_wheeled_robot TwoWheeledRobot [0.4, -0.3];
}
