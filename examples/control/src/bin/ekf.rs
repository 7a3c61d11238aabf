//! Estimates attitude, position and velocities of a drone from measured positions and two directions. The errors of the
//! extended Kalman filter are displacements, three numbers for a rotation, so that nothing is renormalised.
//!
//! `cargo run --release -p control --bin ekf`

use control::Noise;
use hamel::methods::Rkmk4;
use hamel::{State, StepError, System, manifold, step, step_slopes};
use nalgebra::{SMatrix, SVector, Vector3};

hamel::rigid_eom! {
    /// A drone: the thrust along its third axis and torques in body axes.
    system Drone {
        param m = 1.1;
        coord r: R3, R: SO3;
        velocity v: vec3, w: vec3;
        rate r = v;
        rate R = R * hat(w);
        input thrust, torque: vec3;
        frame hull = pose(R, r);
        body on hull { mass m; inertia diag(0.011, 0.012, 0.02) about com; }
        force [0, 0, thrust] at [0, 0, 0] on hull in hull;
        torque torque on hull in hull;
        gravity [0, 0, -9.81];
        generate all, linearize;
    }
}

/// Time between measurements, in s.
const PERIOD: f64 = 0.02;
/// Standard deviation of a measured position, in m.
const PLACE: f64 = 0.5;
/// Standard deviation of a measured direction.
const DIRECTION: f64 = 0.05;
/// Standard deviation of torques and thrusts, in N m and N.
const PUSH: f64 = 2e-3;
/// Number of errors: displacements h = (r, R), then the errors of ξ = (v, w).
const N: usize = 12;
/// Number of measurements: positions, and the directions up and north in body axes.
const M: usize = 9;

type Square = SMatrix<f64, N, N>;

/// The measurement y = (r, Rᵀ e₃, Rᵀ e₁).
fn measured(state: &State<Drone<f64>>) -> SVector<f64, M> {
    let x = &state.x;
    SVector::from([x[0], x[1], x[2], x[9], x[10], x[11], x[3], x[4], x[5]])
}

/// ∂y/∂(h, δξ): δ(Rᵀ e) = (Rᵀ e) × h for a rotation by h in body axes.
fn measurement(y: &SVector<f64, M>) -> SMatrix<f64, M, N> {
    let mut slopes = SMatrix::<f64, M, N>::zeros();
    slopes.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
    for first in [3, 6] {
        let direction = Vector3::new(y[first], y[first + 1], y[first + 2]);
        slopes
            .fixed_view_mut::<3, 3>(first, 3)
            .copy_from(&direction.cross_matrix());
    }
    slopes
}

/// Displaces a state by an error: x along the chart vector h, ξ by the rest.
fn moved(system: &Drone<f64>, state: &mut State<Drone<f64>>, by: &SVector<f64, N>) {
    let (h, change) = by.as_slice().split_at(6);
    manifold::retract(system.blocks(), &mut state.x, h);
    state
        .xi
        .iter_mut()
        .zip(change)
        .for_each(|(xi, by)| *xi += by);
}

/// Errors of the angle (rad) and of the position (m): initially, and in the last second of a flight of ten seconds.
fn flight(seed: u64) -> Result<[[f64; 2]; 2], StepError> {
    let drone = Drone::default();
    let mut noise = Noise(seed);
    let (x, xi) = drone.start();
    let mut truth = State { t: 0.0, x, xi };
    let mut guess = truth.clone();
    // The initial estimate is off by 60 degrees and 2 m.
    let off = [
        1.0, -1.0, 1.4, 0.7, -0.6, 0.5, 0.3, 0.2, -0.1, 0.1, -0.2, 0.1,
    ];
    moved(&drone, &mut guess, &SVector::from(off));
    let mut p = Square::identity();
    let off = |guess: &State<Drone<f64>>, truth: &State<Drone<f64>>| {
        let turn: f64 = (3..12).map(|i| guess.x[i] * truth.x[i]).sum();
        let place: f64 = (0..3).map(|i| (guess.x[i] - truth.x[i]).powi(2)).sum();
        [((turn - 1.0) / 2.0).clamp(-1.0, 1.0).acos(), place.sqrt()]
    };
    let before = off(&guess, &truth);
    let (mut last, mut count) = ([0.0; 2], 0.0);
    for k in 0..500 {
        let time = f64::from(k) * PERIOD;
        let u = [
            1.1 * 9.81 + 0.5 * (0.9 * time).sin(),
            2e-3 * (2.0 * time).cos(),
            2e-3 * (1.5 * time).sin(),
            1e-3,
        ];
        let pushed = u.map(|u| u + PUSH * noise.normal());
        step(&drone, Rkmk4, &mut truth, PERIOD, &|_, _, _| pushed)?;
        // Predicts the estimate and its covariance.
        let (next, slopes) = step_slopes(&Rkmk4, &drone, &guess, &u, PERIOD)?;
        guess = next;
        let a = Square::from_fn(|i, j| slopes[i][j]);
        let b = SMatrix::<f64, N, 4>::from_fn(|i, j| slopes[i][N + j]);
        p = a * p * a.transpose() + PUSH * PUSH * b * b.transpose() + 1e-8 * Square::identity();
        // Corrects them by the measurement.
        let y = measured(&truth);
        let y = SVector::<f64, M>::from_fn(|i, _| {
            y[i] + noise.normal() * if i < 3 { PLACE } else { DIRECTION }
        });
        let expected = measured(&guess);
        let c = measurement(&expected);
        let spread = SMatrix::<f64, M, M>::from_fn(|i, j| match (i == j, i < 3) {
            (false, _) => 0.0,
            (true, true) => PLACE * PLACE,
            (true, false) => DIRECTION * DIRECTION,
        });
        let Some(inverse) = (c * p * c.transpose() + spread).try_inverse() else {
            continue;
        };
        let gain = p * c.transpose() * inverse;
        moved(&drone, &mut guess, &(gain * (y - expected)));
        p = (Square::identity() - gain * c) * p;
        if k >= 450 {
            let now = off(&guess, &truth);
            last = [last[0] + now[0], last[1] + now[1]];
            count += 1.0;
        }
    }
    Ok([before, last.map(|sum| sum / count)])
}

fn main() -> Result<(), StepError> {
    for seed in 1..=5 {
        let [before, after] = flight(seed)?;
        println!(
            "attitude off by {:5.2}° and then {:4.2}°, place by {:4.2} m and then {:4.2} m",
            before[0].to_degrees(),
            after[0].to_degrees(),
            before[1],
            after[1]
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{DIRECTION, PLACE, flight};

    /// Sixty degrees shrink below the noise of one direction, two metres below half the noise of a position.
    #[test]
    fn errors_go_below_those_of_the_measurements() {
        for seed in 1..=5 {
            let [before, after] = flight(seed).expect("a flight");
            assert!(
                before[0] > 1.0 && after[0] < DIRECTION,
                "{before:?} {after:?}"
            );
            assert!(
                before[1] > 1.9 && after[1] < PLACE / 2.0,
                "{before:?} {after:?}"
            );
        }
    }
}
