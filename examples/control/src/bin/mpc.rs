//! Flies a quadrotor along a figure of eight by model-predictive control: each tick solves a quadratic program over the
//! next second, linearised about the last plan by the exact slopes of its steps, with bounds on every rotor.
//!
//! M. Diehl, H. G. Bock, J. P. Schlöder, *A real-time iteration scheme for nonlinear optimization in optimal feedback
//! control*, SIAM J. Control Optim. 43 (2005); the solver is that of P. J. Goulart, Y. Chen, *Clarabel* (2024).
//! `cargo run --release -p control --bin mpc`

use std::error::Error;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT,
};
use hamel::methods::Rkmk4;
use hamel::{State, TangentSystem, so3, step, step_slopes_into};

hamel::rigid_eom! {
    /// A quadrotor: a thrust along the third axis at the end of each arm, and what its rotor twists the hull with.
    system Quadrotor {
        param m = 1.1, arm = 0.17, twist = 0.016;
        coord r: R3, R: SO3;
        velocity v: vec3, w: vec3;
        rate r = v;
        rate R = R * hat(w);
        input front, left, back, right;
        frame hull = pose(R, r);
        body on hull { mass m; inertia diag(0.011, 0.012, 0.02) about com; }
        force [0, 0, front] at [arm, 0, 0] on hull in hull;
        force [0, 0, left] at [0, arm, 0] on hull in hull;
        force [0, 0, back] at [-arm, 0, 0] on hull in hull;
        force [0, 0, right] at [0, -arm, 0] on hull in hull;
        torque [0, 0, twist * (front - left + back - right)] on hull in hull;
        gravity [0, 0, -9.81];
        generate all, linearize;
    }
}

/// Time between decisions, and the length of a predicted step, in s.
const TICK: f64 = 0.05;
/// Number of steps of the horizon.
const AHEAD: usize = 20;
/// Number of errors: δr and a rotation in body axes, then those of ξ = (v, w).
const N: usize = 12;
/// Number of rotors.
const M: usize = 4;
/// Smallest and largest thrust of a rotor, in N.
const THRUST: [f64; 2] = [0.5, 4.5];
/// The thrust of each rotor in hover, in N.
const HOVER: f64 = 1.1 * 9.81 / 4.0;
/// Costs of errors of position, attitude, velocity and angular velocity, and of thrusts that differ from hover.
const COST: [f64; 4] = [40.0, 1.0, 4.0, 0.2];
const EFFORT: f64 = 0.05;
/// Factor of the costs of the last state.
const END: f64 = 10.0;

type Place = State<Quadrotor<f64>>;
type Plan = [[f64; M]; AHEAD];

/// The position on the path at a time, and its velocity.
fn path(time: f64) -> ([f64; 3], [f64; 3]) {
    let (s, c) = (0.9 * time).sin_cos();
    let (s2, c2) = (1.8 * time).sin_cos();
    ([2.0 * s, s2, 0.5 * c], [1.8 * c, 1.8 * c2, -0.45 * s])
}

/// The deviation of a state from the path, level and at the path's velocity.
fn off(place: &Place) -> [f64; N] {
    let (r, v) = path(place.t);
    let here = QuadrotorState::from(place);
    let [a, b, c] = here.r_upper;
    let turn = so3::log([a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]]);
    let w = here.w;
    let ([x, y, z], [vx, vy, vz]) = (here.r, here.v);
    [
        x - r[0],
        y - r[1],
        z - r[2],
        turn[0],
        turn[1],
        turn[2],
        vx - v[0],
        vy - v[1],
        vz - v[2],
        w[0],
        w[1],
        w[2],
    ]
}

/// The entries of a sparse matrix, in any order.
#[derive(Default)]
struct Entries {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl Entries {
    fn add(&mut self, row: usize, column: usize, value: f64) {
        if value != 0.0 {
            self.rows.push(row);
            self.columns.push(column);
            self.values.push(value);
        }
    }

    fn matrix(self, rows: usize, columns: usize) -> CscMatrix<f64> {
        CscMatrix::new_from_triplets(rows, columns, self.rows, self.columns, self.values)
    }
}

/// Improves the plan: the errors e₁ … and changes of thrusts d₀ … of least cost, subject to eₖ₊₁ = Aₖ eₖ + Bₖ dₖ, e₀ =
/// 0, and bounds on all thrusts.
fn decide(
    tangent: &TangentSystem<Quadrotor<f64>>,
    now: &Place,
    plan: &mut Plan,
) -> Result<(), Box<dyn Error>> {
    let error = |k: usize, i: usize| N * (k - 1) + i;
    let change = |k: usize, j: usize| N * AHEAD + M * k + j;
    let unknowns = (N + M) * AHEAD;
    let (mut curvature, mut slope) = (Entries::default(), vec![0.0; unknowns]);
    let mut rows = Entries::default();
    let bounds = N * AHEAD;
    let mut right = vec![0.0; bounds + 2 * M * AHEAD];
    let mut place = now.clone();
    let mut slopes = [[0.0; N + M]; N];
    for (k, u) in plan.iter().enumerate() {
        place = step_slopes_into(&Rkmk4, tangent, &place, u, TICK, &mut slopes)?;
        let weight = if k + 1 == AHEAD { END } else { 1.0 };
        for (i, off) in off(&place).into_iter().enumerate() {
            let column = error(k + 1, i);
            curvature.add(column, column, weight * COST[i / 3]);
            slope[column] = weight * COST[i / 3] * off;
            rows.add(column, column, 1.0);
            for j in 0..N {
                if k > 0 {
                    rows.add(column, error(k, j), -slopes[i][j]);
                }
            }
            for j in 0..M {
                rows.add(column, change(k, j), -slopes[i][N + j]);
            }
        }
        for (j, u) in u.iter().enumerate() {
            let column = change(k, j);
            curvature.add(column, column, EFFORT);
            slope[column] = EFFORT * (u - HOVER);
            let row = bounds + 2 * (M * k + j);
            rows.add(row, column, 1.0);
            rows.add(row + 1, column, -1.0);
            right[row] = THRUST[1] - u;
            right[row + 1] = u - THRUST[0];
        }
    }
    let settings = DefaultSettings {
        verbose: false,
        ..Default::default()
    };
    let mut solver = DefaultSolver::new(
        &curvature.matrix(unknowns, unknowns),
        &slope,
        &rows.matrix(right.len(), unknowns),
        &right,
        &[ZeroConeT(bounds), NonnegativeConeT(2 * M * AHEAD)],
        settings,
    )?;
    solver.solve();
    let solution = &solver.solution;
    if !matches!(
        solution.status,
        SolverStatus::Solved | SolverStatus::AlmostSolved
    ) {
        return Err(format!("the program ends with {:?}", solution.status).into());
    }
    for (k, u) in plan.iter_mut().enumerate() {
        for (j, u) in u.iter_mut().enumerate() {
            // The solver's tolerance may exceed a bound by rounding.
            *u = (*u + solution.x[change(k, j)]).clamp(THRUST[0], THRUST[1]);
        }
    }
    Ok(())
}

/// The record of a flight: the distance from the path and the thrusts, tick by tick.
struct Flight {
    distances: Vec<f64>,
    thrusts: Vec<[f64; M]>,
}

/// Flies for a time, starting a metre and a half from the path.
fn fly(until: f64) -> Result<Flight, Box<dyn Error>> {
    let quadrotor = Quadrotor::default();
    let tangent = TangentSystem::new(&quadrotor);
    let mut place = Place::from(QuadrotorState {
        r: [-1.0, 1.0, 0.0],
        ..Default::default()
    });
    let mut plan: Plan = [[HOVER; M]; AHEAD];
    let (mut distances, mut thrusts) = (Vec::new(), Vec::new());
    while place.t < until {
        decide(&tangent, &place, &mut plan)?;
        let [u, ..] = plan;
        step(&quadrotor, Rkmk4, &mut place, TICK, &|_, _, _| u)?;
        let [x, y, z, ..] = off(&place);
        distances.push((x * x + y * y + z * z).sqrt());
        thrusts.push(u);
        // The plan starts a tick later.
        plan.rotate_left(1);
        plan[AHEAD - 1] = plan[AHEAD - 2];
    }
    Ok(Flight { distances, thrusts })
}

/// The smallest and the largest of all thrusts.
fn extremes(thrusts: &[[f64; M]]) -> [f64; 2] {
    let all = thrusts.iter().flatten();
    all.fold([f64::INFINITY, 0.0], |[least, most], u| {
        [u.min(least), u.max(most)]
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let flight = fly(10.0)?;
    for (tick, distance) in flight.distances.iter().enumerate().step_by(20) {
        println!(
            "{:5.2} s: {distance:.3} m from the path",
            TICK * (tick + 1) as f64
        );
    }
    let [least, most] = extremes(&flight.thrusts);
    println!("thrusts between {least:.2} N and {most:.2} N");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{THRUST, extremes, fly};

    /// Thrusts reach their bounds on the way to the path but never exceed them; then the quadrotor stays close to the
    /// path.
    #[test]
    fn the_path_is_reached_within_the_bounds() {
        let flight = fly(8.0).expect("a flight");
        let [least, most] = extremes(&flight.thrusts);
        assert!(least >= THRUST[0] && most <= THRUST[1]);
        assert!(least < THRUST[0] + 1e-3 && most > THRUST[1] - 1e-3);
        assert!(flight.distances[0] > 1.0);
        let later = &flight.distances[60..];
        let farthest = later.iter().copied().fold(0.0, f64::max);
        assert!(farthest < 0.02, "{farthest}");
    }
}
