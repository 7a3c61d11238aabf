//! Identifies the inertias of a UR5 from noisy torques. The forces are f = Y(x, ξ, ξ̇) β, where Y is generated in the
//! base parameters, the only combinations of masses, centres of mass and inertias that torques determine. β is the
//! least-squares solution over many samples of a motion that excites all joints.
//!
//! `cargo run --release -p control --bin identify`

use control::Noise;
use nalgebra::{DMatrix, DVector};

hamel::rigid_eom! {
    /// Universal Robots' UR5, as its URDF file has it.
    system Ur5 {
        gravity [0, 0, -9.81];
        joint pan: revolute [0, 0, 1] at pose(identity(3), [0, 0, 0.089159]) moves shoulder;
        joint lift: revolute [0, 1, 0] on shoulder at pose(roty(pi / 2), [0, 0.13585, 0]) moves upper_arm;
        joint elbow: revolute [0, 1, 0] on upper_arm at pose(identity(3), [0, -0.1197, 0.425]) moves forearm;
        joint wrist1: revolute [0, 1, 0] on forearm at pose(roty(pi / 2), [0, 0, 0.39225]) moves first;
        joint wrist2: revolute [0, 0, 1] on first at pose(identity(3), [0, 0.093, 0]) moves second;
        joint wrist3: revolute [0, 1, 0] on second at pose(identity(3), [0, 0, 0.09465]) moves third;
        body on shoulder { mass 3.7; inertia diag(0.010267495893, 0.010267495893, 0.00666) about com; }
        body on upper_arm {
            mass 8.393; com [0, 0, 0.28]; inertia diag(0.22689067591, 0.22689067591, 0.0151074) about com;
        }
        body on forearm {
            mass 2.275; com [0, 0, 0.25]; inertia diag(0.049443313556, 0.049443313556, 0.004095) about com;
        }
        body on first { mass 1.219; inertia diag(0.111172755531, 0.111172755531, 0.21942) about com; }
        body on second { mass 1.219; inertia diag(0.111172755531, 0.111172755531, 0.21942) about com; }
        body on third { mass 0.1879; inertia diag(0.0171364731454, 0.0171364731454, 0.033822) about com; }
        generate inverse_dynamics, regressor;
    }
}

/// Number of joints.
const N: usize = 6;
/// Number of base parameters.
const BASE: usize = 36;
/// Number of samples of a motion of 20 s.
const SAMPLES: usize = 2000;
/// Noise of the torques, relative to their root mean square.
const NOISE: f64 = 0.05;

/// Angles, rates and accelerations of the joints.
type Sample = [[f64; N]; 3];

/// A motion that is a sum of five harmonics in each joint, with random phases.
fn motion(noise: &mut Noise) -> Vec<Sample> {
    let waves: Vec<[(f64, f64, f64); 5]> = (0..N)
        .map(|_| {
            std::array::from_fn(|k| {
                let rate = std::f64::consts::TAU * 0.1 * (k + 1) as f64;
                let speed = 0.3 + 0.4 * noise.uniform();
                (rate, speed / rate, std::f64::consts::TAU * noise.uniform())
            })
        })
        .collect();
    let at = |t: f64| -> Sample {
        let mut sample = [[0.0; N]; 3];
        for (joint, waves) in waves.iter().enumerate() {
            for (rate, size, phase) in waves {
                let (sin, cos) = (rate * t + phase).sin_cos();
                sample[0][joint] += size * sin;
                sample[1][joint] += size * rate * cos;
                sample[2][joint] -= size * rate * rate * sin;
            }
        }
        sample
    };
    (0..SAMPLES).map(|i| at(0.01 * i as f64)).collect()
}

fn torques(robot: &Ur5<f64>, motion: &[Sample]) -> Vec<[f64; N]> {
    let torque = |[x, xi, xi_dot]: &Sample| robot.inverse_dynamics(x, xi, xi_dot);
    motion.iter().map(torque).collect()
}

/// The root mean square of each joint's torque.
fn size(torques: &[[f64; N]]) -> [f64; N] {
    std::array::from_fn(|joint| {
        let squares: f64 = torques.iter().map(|torque| torque[joint].powi(2)).sum();
        (squares / torques.len() as f64).sqrt()
    })
}

/// The estimate.
struct Found {
    beta: DVector<f64>,
    /// Standard deviations of β.
    deviation: DVector<f64>,
}

/// Weighted least squares: the rows of a joint are divided by the noise of its torque. `None` if the motion does not
/// excite all of β.
fn identified(robot: &Ur5<f64>, motion: &[Sample], measured: &[[f64; N]]) -> Option<Found> {
    let sizes = size(measured);
    let mut y = DMatrix::zeros(N * motion.len(), BASE);
    let mut f = DVector::zeros(N * motion.len());
    for (sample, ([x, xi, xi_dot], torque)) in motion.iter().zip(measured).enumerate() {
        let rows = robot.regressor(x, xi, xi_dot);
        for joint in 0..N {
            let deviation = NOISE * sizes[joint];
            let row = N * sample + joint;
            f[row] = torque[joint] / deviation;
            for column in 0..BASE {
                y[(row, column)] = rows[joint][column] / deviation;
            }
        }
    }
    let covariance = (y.transpose() * &y).cholesky()?.inverse();
    let beta = &covariance * (y.transpose() * f);
    Some(Found {
        beta,
        deviation: covariance.diagonal().map(f64::sqrt),
    })
}

/// The error of predicted torques on another motion, relative to the root mean square of each joint's torque.
fn predicted(robot: &Ur5<f64>, beta: &DVector<f64>, motion: &[Sample]) -> [f64; N] {
    let truth = torques(robot, motion);
    let errors: Vec<[f64; N]> = motion
        .iter()
        .zip(&truth)
        .map(|([x, xi, xi_dot], truth)| {
            let rows = robot.regressor(x, xi, xi_dot);
            std::array::from_fn(|joint| {
                let terms = rows[joint]
                    .iter()
                    .zip(beta.iter())
                    .map(|(y, beta)| y * beta);
                terms.sum::<f64>() - truth[joint]
            })
        })
        .collect();
    let (errors, sizes) = (size(&errors), size(&truth));
    std::array::from_fn(|joint| errors[joint] / sizes[joint])
}

/// Identifies the parameters from a noisy run; returns the estimate, its errors in standard deviations, and the errors
/// of prediction.
fn run() -> Option<(Found, Vec<f64>, [f64; N])> {
    let robot = Ur5::default();
    let mut noise = Noise(1);
    let exciting = motion(&mut noise);
    let mut measured = torques(&robot, &exciting);
    let sizes = size(&measured);
    for torque in &mut measured {
        for joint in 0..N {
            torque[joint] += NOISE * sizes[joint] * noise.normal();
        }
    }
    let found = identified(&robot, &exciting, &measured)?;
    let truth = robot.base_parameters();
    let off = (0..BASE).map(|k| (found.beta[k] - truth[k]) / found.deviation[k]);
    let off = off.collect();
    let errors = predicted(&robot, &found.beta, &motion(&mut noise));
    Some((found, off, errors))
}

fn main() {
    let Some((found, off, errors)) = run() else {
        println!("this motion does not tell all base parameters apart");
        return;
    };
    println!("base parameter     true    found   deviation");
    for (k, truth) in Ur5::<f64>::default().base_parameters().iter().enumerate() {
        println!(
            "{:14} {truth:8.4} {:8.4} {:11.4}",
            k + 1,
            found.beta[k],
            found.deviation[k]
        );
    }
    let most = off.iter().fold(0.0_f64, |most, off| most.max(off.abs()));
    println!("none is more than {most:.1} standard deviations off");
    println!("torques of another motion, error of each joint:");
    for error in errors {
        println!("  {:.2} %", 100.0 * error);
    }
}

#[cfg(test)]
mod tests {
    use super::{BASE, run};

    #[test]
    fn torques_of_another_motion_are_better_known_than_they_were_measured() {
        let (_, off, errors) = run().expect("an exciting motion");
        // Of 36 normal numbers, one exceeds 4.5 with a probability of 2 in 10,000; their mean square is near 1.
        assert!(off.iter().all(|off| off.abs() < 4.5), "{off:?}");
        let square = off.iter().map(|off| off * off).sum::<f64>() / BASE as f64;
        assert!((0.3..2.5).contains(&square), "{square}");
        // The noise of 5 % averages out.
        assert!(errors.iter().all(|error| *error < 0.01), "{errors:?}");
    }
}
