//! Rides the Whipple bicycle along a line by its handlebar: a linear-quadratic regulator from the exact slopes of the
//! controller's steps, restricted to the subspace that the handlebar reaches.
//!
//! The wheels roll, so the velocities are constrained. Of the (h, δξ) in the slopes of a step, only the combinations
//! that the input reaches count: the span of B, A B, A² B …. It has dimension six here: position, heading, lean,
//! steering angle, and the rates of the last two.
//!
//! `cargo run --release -p control --bin bicycle`

use control::Noise;
use hamel::methods::Rkmk4;
use hamel::{State, StepError, System, step, step_slopes};
use nalgebra::{Matrix1, SMatrix, SVector};

/// The bicycle of Meijaard, Papadopoulos, Ruina and Schwab (2007), as `bicycle.eom` describes it.
mod whipple {
    include!(concat!(env!("OUT_DIR"), "/bicycle.rs"));
}

use whipple::Bicycle;

/// The period of the controller, in s.
const PERIOD: f64 = 0.01;
/// h of v, o, wd, wr, wf, then δξ of o, wd, wr, wf: the hubs' velocities follow from the wheels'.
const STATES: usize = 15;
/// Dimension of the subspace that the handlebar reaches.
const REACHED: usize = 6;
/// Standard deviations of the hands' torque (N m) and of measured rates (rad/s).
const NOISE: (f64, f64) = (0.5, 0.01);

type Vector = SVector<f64, STATES>;

/// The state upright on the x axis at a speed in m/s. The initial velocities are those of 1 m/s.
fn riding(speed: f64) -> State<Bicycle<f64>> {
    let (x, xi) = Bicycle::<f64>::default().start();
    State {
        t: 0.0,
        x,
        xi: xi.map(|rate| speed * rate),
    }
}

/// The deviation of a state from riding along the x axis, as (h, δξ), without distance covered and angles of wheels.
fn error(state: &State<Bicycle<f64>>, ridden: &State<Bicycle<f64>>) -> Vector {
    let x = &state.x;
    // x contains r, then R by rows, then δ.
    let turned = |i: usize, j: usize| x[3 + 3 * i + j];
    let mut error = Vector::zeros();
    error[1] = x[1];
    error[3] = 0.5 * (turned(2, 1) - turned(1, 2));
    error[5] = 0.5 * (turned(1, 0) - turned(0, 1));
    error[6] = x[12];
    for i in 0..6 {
        error[9 + i] = state.xi[i] - ridden.xi[i];
    }
    error
}

/// The gain K of steer = −K (h, δξ) on the reachable subspace; `None` if its dimension is less than six.
fn regulator(speed: f64) -> Result<Option<SMatrix<f64, 1, STATES>>, StepError> {
    let system = Bicycle::default();
    let (_, slopes) = step_slopes(&Rkmk4, &system, &riding(speed), &[0.0], PERIOD)?;
    let a = SMatrix::<f64, STATES, STATES>::from_fn(|i, j| slopes[i][j]);
    let b = Vector::from_fn(|i, _| slopes[i][STATES]);
    // An orthonormal basis of the reachable subspace.
    let mut basis: Vec<Vector> = Vec::new();
    let mut next = b;
    while basis.len() < REACHED {
        // Orthogonalises twice, for accuracy.
        for _ in 0..2 {
            for one in &basis {
                next -= *one * one.dot(&next);
            }
        }
        let Some(one) = next.try_normalize(1e-9) else {
            return Ok(None);
        };
        basis.push(one);
        next = a * one;
    }
    let t = SMatrix::<f64, STATES, REACHED>::from_columns(&basis);
    let (a, b) = (t.transpose() * a * t, t.transpose() * b);
    let mut weights = Vector::zeros();
    for (place, weight) in [(1, 0.1), (3, 10.0), (5, 1.0), (6, 1.0), (9, 0.1), (12, 0.1)] {
        weights[place] = weight;
    }
    let weight = t.transpose() * SMatrix::<f64, STATES, STATES>::from_diagonal(&weights) * t;
    let (mut p, mut gain) = (weight, SMatrix::<f64, 1, REACHED>::zeros());
    for _ in 0..20_000 {
        let inverse = 1.0 / (Matrix1::new(0.01) + b.transpose() * p * b).x;
        gain = inverse * b.transpose() * p * a;
        p = weight + a.transpose() * p * (a - b * gain);
    }
    Ok(Some(gain * t.transpose()))
}

/// The outcome of a ride after a push: the greatest lean (rad) and the greatest distance from the line in the last
/// second (m), or the time at which the lean exceeded 60° and the bicycle fell.
enum Ride {
    Upright { lean: f64, astray: f64 },
    Fallen(f64),
}

fn ride(speed: f64, seconds: f64, gain: &SMatrix<f64, 1, STATES>) -> Result<Ride, StepError> {
    let system = Bicycle::default();
    let ridden = riding(speed);
    let mut state = riding(speed);
    // The push: a lean rate of half a radian per second.
    state.xi[0] = 0.5;
    let mut noise = Noise(7);
    let (mut lean, mut astray) = (0.0_f64, 0.0_f64);
    let periods = (seconds / PERIOD).round() as usize;
    for period in 0..periods {
        let mut measured = error(&state, &ridden);
        for rate in 9..STATES {
            measured[rate] += NOISE.1 * noise.normal();
        }
        let torque = -(gain * measured).x + NOISE.0 * noise.normal();
        step(&system, Rkmk4, &mut state, PERIOD, &|_, _, _| [torque])?;
        let now = error(&state, &ridden);
        lean = lean.max(now[3].abs());
        if now[3].abs() > 0.87 {
            return Ok(Ride::Fallen(state.t));
        }
        if period + 100 >= periods {
            astray = astray.max(now[1].abs());
        }
    }
    Ok(Ride::Upright { lean, astray })
}

fn main() -> Result<(), StepError> {
    let hands_off = SMatrix::zeros();
    for speed in [3.0, 4.5, 6.0] {
        let Some(gain) = regulator(speed)? else {
            println!("{speed} m/s: the handlebar does not reach all that it has to");
            continue;
        };
        for (hands, gain) in [("hands off", &hands_off), ("LQR", &gain)] {
            match ride(speed, 20.0, gain)? {
                Ride::Upright { lean, astray } => println!(
                    "{speed} m/s, {hands:9}: upright, lean up to {:4.1}°, at the end {astray:.2} m off the line",
                    lean.to_degrees()
                ),
                Ride::Fallen(t) => println!("{speed} m/s, {hands:9}: fallen after {t:.1} s"),
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Ride, SMatrix, regulator, ride};

    #[test]
    fn the_regulator_keeps_the_bicycle_upright_on_its_line() {
        for speed in [3.0, 4.5, 6.0] {
            let gain = regulator(speed).expect("slopes").expect("reached");
            let Ok(Ride::Upright { lean, astray }) = ride(speed, 20.0, &gain) else {
                panic!("fallen at {speed} m/s");
            };
            assert!(lean < 0.4 && astray < 0.5, "{speed}: {lean} {astray}");
        }
        // The uncontrolled bicycle is unstable below 4.29 m/s (Meijaard and others, table 2).
        assert!(matches!(
            ride(3.0, 20.0, &SMatrix::zeros()),
            Ok(Ride::Fallen(_))
        ));
    }
}
