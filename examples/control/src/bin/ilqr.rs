//! Swings a double pendulum up by the iterative linear-quadratic regulator: a forward run, then backwards the optimal
//! feedback for deviations from it, from the exact slopes of the run's steps.
//!
//! W. Li, E. Todorov, *Iterative linear quadratic regulator design for nonlinear biological movement systems*, ICINCO
//! (2004). `cargo run --release -p control --bin ilqr`

use hamel::methods::Rkmk4;
use hamel::{State, StepError, TangentSystem, step, step_slopes_into};
use nalgebra::{Matrix2, Matrix2x4, Matrix4, Matrix4x2, Vector2, Vector4};
use std::f64::consts::PI;

hamel::rigid_eom! {
    /// Two rods that hang at rest, with a motor at each joint.
    system Pendulums {
        param m = 0.8, l = 0.5;
        let J = m * l^2 / 12;
        input shoulder, elbow;
        joint first: revolute [0, 1, 0] moves upper { damping 0.02; }
        joint second: revolute [0, 1, 0] on upper at [0, 0, -l] moves lower { damping 0.02; }
        body on upper { mass m; com [0, 0, -l / 2]; inertia diag(J, J, 0) about com; }
        body on lower { mass m; com [0, 0, -l / 2]; inertia diag(J, J, 0) about com; }
        gravity [0, 0, -9.81];
        generalized force first_dot = shoulder;
        generalized force second_dot = elbow;
        generate all, linearize;
    }
}

/// Length of a step, in s.
const STEP: f64 = 0.03;
/// Number of steps of the swing.
const STEPS: usize = 80;
/// Costs of the two torques over a step.
const EFFORT: [f64; 2] = [0.02, 0.01];
/// Cost of the deviation of the final state.
const END: f64 = 200.0;

type Position = State<Pendulums<f64>>;
type Torques = [Vector2<f64>; STEPS];

/// The deviation of a state from both rods upright and at rest.
fn off(state: &Position) -> Vector4<f64> {
    let ([first, second], [rate, other]) = (state.x, state.xi);
    Vector4::new(first - PI, second, rate, other)
}

/// The states of a run, and its cost.
fn run(system: &Pendulums<f64>, torques: &Torques) -> Result<(Vec<Position>, f64), StepError> {
    let mut state = State {
        t: 0.0,
        x: [0.0, 0.0],
        xi: [0.0, 0.0],
    };
    let mut states = vec![state.clone()];
    let mut cost = 0.0;
    for u in torques {
        cost += 0.5 * (EFFORT[0] * u.x * u.x + EFFORT[1] * u.y * u.y);
        step(system, Rkmk4, &mut state, STEP, &|_, _, _| [u.x, u.y])?;
        states.push(state.clone());
    }
    Ok((states, cost + 0.5 * END * off(&state).norm_squared()))
}

/// k and K of a feedback.
type Answer = (Vector2<f64>, Matrix2x4<f64>);

/// The feedback u = k + K (h, δξ) for every step, from the value ½ (h, δξ)ᵀ V (h, δξ) + vᵀ (h, δξ) of the steps that
/// follow; `None` if the quadratic model has no minimum.
fn answers(
    tangent: &TangentSystem<Pendulums<f64>>,
    states: &[Position],
    torques: &Torques,
    reluctance: f64,
) -> Result<Option<Vec<Answer>>, StepError> {
    let effort = Matrix2::from_diagonal(&Vector2::from(EFFORT));
    let mut v = END * off(&states[STEPS]);
    let mut value = END * Matrix4::identity();
    let mut all = Vec::new();
    let mut slopes = [[0.0; 6]; 4];
    for (state, u) in states.iter().zip(torques).take(STEPS).rev() {
        step_slopes_into(&Rkmk4, tangent, state, &[u.x, u.y], STEP, &mut slopes)?;
        let a = Matrix4::from_fn(|i, j| slopes[i][j]);
        let b = Matrix4x2::from_fn(|i, j| slopes[i][4 + j]);
        let held = value + reluctance * Matrix4::identity();
        let inner = effort + b.transpose() * held * b;
        let Some(inverse) = inner.cholesky().map(|factors| factors.inverse()) else {
            return Ok(None);
        };
        let slope: Vector2<f64> = effort * u + b.transpose() * v;
        let constant = -inverse * slope;
        let gain = -inverse * (b.transpose() * held * a);
        let closed = a + b * gain;
        v = closed.transpose() * v
            + gain.transpose() * (effort * (u + constant))
            + closed.transpose() * value * b * constant;
        value = gain.transpose() * effort * gain + closed.transpose() * value * closed;
        all.push((constant, gain));
    }
    all.reverse();
    Ok(Some(all))
}

/// The torques of a swing, and the cost after each iteration.
fn swing(iterations: usize) -> Result<(Torques, Vec<f64>), StepError> {
    let system = Pendulums::default();
    let tangent = TangentSystem::new(&system);
    let mut torques: Torques = std::array::from_fn(|k| {
        let time = STEP * k as f64;
        Vector2::new((3.0 * time).sin(), -0.5 * (3.0 * time).sin())
    });
    let (mut states, mut cost) = run(&system, &torques)?;
    let (mut costs, mut reluctance) = (vec![cost], 1.0);
    for _ in 0..iterations {
        let found = answers(&tangent, &states, &torques, reluctance)?;
        let mut better = None;
        for length in [1.0, 0.5, 0.25, 0.1, 0.03] {
            let Some(answers) = &found else { break };
            let mut tried = torques;
            let mut state = states[0].clone();
            for (k, (constant, gain)) in answers.iter().enumerate() {
                tried[k] += length * constant + gain * (off(&state) - off(&states[k]));
                let u = tried[k];
                step(&system, Rkmk4, &mut state, STEP, &|_, _, _| [u.x, u.y])?;
            }
            let (other, less) = run(&system, &tried)?;
            if less < cost {
                better = Some((tried, other, less));
                break;
            }
        }
        match better {
            Some((tried, other, less)) => {
                (torques, states, cost) = (tried, other, less);
                reluctance = (reluctance * 0.5).max(1e-6);
            }
            None => reluctance = (reluctance * 4.0).max(1e-3),
        }
        costs.push(cost);
    }
    Ok((torques, costs))
}

fn main() -> Result<(), StepError> {
    let (torques, costs) = swing(120)?;
    for (iteration, cost) in costs.iter().enumerate().step_by(20) {
        println!("iteration {iteration:3}: cost {cost:10.4}");
    }
    let (states, _) = run(&Pendulums::default(), &torques)?;
    let last = &states[STEPS];
    let most = torques.iter().fold(0.0_f64, |most, u| most.max(u.amax()));
    println!(
        "after {:.1} s: {:.4?}, {:.4?}; greatest torque {most:.2} N m",
        last.t, last.x, last.xi
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Pendulums, STEPS, off, run, swing};

    /// The rods stand upright, and no change of a torque reduces the cost by more than a thousandth.
    #[test]
    fn the_pendulum_swings_up() {
        let (torques, costs) = swing(120).expect("a swing");
        assert!(costs[120] < 1e-3 * costs[0] && costs[120] > 0.999 * costs[100]);
        let (states, _) = run(&Pendulums::default(), &torques).expect("a run");
        assert!(off(&states[STEPS]).amax() < 0.05, "{:?}", states[STEPS]);
        // The gain from changing the torque of one step: its slope squared over twice the curvature.
        let cost = |k: usize, by: f64| {
            let mut other = torques;
            other[k].x += by;
            run(&Pendulums::default(), &other).expect("a run").1
        };
        for k in [0, 20, 40, 60] {
            let [ahead, here, behind] = [1e-4, 0.0, -1e-4].map(|by| cost(k, by));
            let slope = (ahead - behind) / 2e-4;
            let curvature = (ahead + behind - 2.0 * here) / 1e-8;
            assert!(
                slope * slope / (2.0 * curvature) < 1e-3,
                "{k}: {slope}, {curvature}"
            );
        }
    }
}
