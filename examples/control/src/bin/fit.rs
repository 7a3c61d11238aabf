//! Estimates parameters of a pendulum from a filmed swing, by sensitivities through a whole run.
//!
//! A run in dual numbers has the slopes of every state with respect to the parameters, exactly those of the discrete
//! run. With them, the Gauss-Newton method finds length, damping and the angle of release in a few steps.
//! `parameter_slopes` gives the slopes ∂ξ̇/∂p at a single state.
//!
//! `cargo run --release -p control --bin fit`

use control::Noise;
use hamel::methods::Rkmk4;
use hamel::{Dual, Scalar, State, StepError, integrate};
use nalgebra::{Cholesky, Matrix3, Vector3};
use std::error::Error;

hamel::rigid_eom! {
    /// A rod of length l that swings in air and in its bearing.
    system Swing {
        param l = 1, c = 0.1, g = 9.81;
        coord q: S1;
        velocity w;
        rate q = w;
        kinetic l^2 * w^2 / 6;
        potential -g * l / 2 * q.c;
        generalized force w = -c * w - 0.02 * l^4 * abs(w) * w;
        generate accel, parameter_slopes;
    }
}

/// Number of unknowns: length, damping, and the angle of release.
const SOUGHT: usize = 3;
/// A number with its slopes with respect to the unknowns.
type Number = Dual<f64, SOUGHT>;
/// The time between pictures, in s, and the number of steps between them.
const PICTURE: f64 = 0.1;
const STEPS: f64 = 10.0;
const PICTURES: usize = 60;

/// The angles of a run at the times of the pictures, for any type of number.
fn swing<S: Scalar>([l, c, angle]: [S; SOUGHT]) -> Result<Vec<S>, Box<dyn Error>>
where
    Swing<S>: hamel::System<
            Scalar = S,
            Coordinates = [S; 2],
            Velocities = [S; 1],
            Inputs = [S; 0],
            Chart = [S; 1],
        >,
{
    let system = Swing::new(SwingParameters {
        l,
        c,
        g: S::from_f64(9.81),
    })?;
    let (sin, cos) = angle.sin_cos();
    let mut state = State::<Swing<S>> {
        t: 0.0,
        x: [cos, sin],
        xi: [S::default()],
    };
    let mut angles = Vec::new();
    for picture in 1..=PICTURES {
        let until = PICTURE * picture as f64;
        let run: Result<(), StepError> = integrate(
            &system,
            Rkmk4,
            &mut state,
            PICTURE / STEPS,
            until,
            |_, _, _| [],
            |_| {},
        );
        run?;
        angles.push(state.x[1].atan2(state.x[0]));
    }
    Ok(angles)
}

/// A fit: the unknowns with their standard deviations, and the standard deviation of a picture.
struct Fit {
    found: [f64; SOUGHT],
    doubt: [f64; SOUGHT],
    picture: f64,
}

/// Fits the unknowns to measured angles by Gauss-Newton steps from a guess.
fn fit(measured: &[f64], guess: [f64; SOUGHT]) -> Result<Fit, Box<dyn Error>> {
    let mut sought = Vector3::from(guess);
    let mut last: Option<(Cholesky<f64, _>, f64)> = None;
    for _ in 0..12 {
        let varied: [Number; SOUGHT] = std::array::from_fn(|i| Dual::along(sought[i], i));
        let (mut normal, mut right, mut squares) = (Matrix3::zeros(), Vector3::zeros(), 0.0);
        for (angle, measured) in swing(varied)?.iter().zip(measured) {
            let off = measured - angle.value;
            let slopes = Vector3::from(angle.slopes);
            normal += slopes * slopes.transpose();
            right += slopes * off;
            squares += off * off;
        }
        let factors = normal.cholesky().ok_or("the pictures do not tell")?;
        sought += factors.solve(&right);
        let picture = (squares / (measured.len() - SOUGHT) as f64).sqrt();
        last = Some((factors, picture));
    }
    let (factors, picture) = last.ok_or("no step was made")?;
    let variance = factors.inverse().diagonal();
    Ok(Fit {
        found: sought.into(),
        doubt: variance.map(|variance| picture * variance.sqrt()).into(),
        picture,
    })
}

/// Angles as a camera measures them, with a standard deviation in rad.
fn filmed(truth: [f64; SOUGHT], deviation: f64) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut noise = Noise(7);
    let angles = swing(truth)?;
    Ok(angles
        .iter()
        .map(|angle| angle + deviation * noise.normal())
        .collect())
}

fn main() -> Result<(), Box<dyn Error>> {
    let truth = [0.83, 0.06, 1.9];
    let fit = fit(&filmed(truth, 0.02)?, [1.0, 0.1, 1.6])?;
    println!("{PICTURES} pictures, off by {:.4} rad each", fit.picture);
    let names = ["length, m", "damping, N m s", "release, rad"];
    for (i, name) in names.into_iter().enumerate() {
        let (found, doubt) = (fit.found[i], fit.doubt[i]);
        println!("{name:15} {found:.4} ± {doubt:.4}, is {}", truth[i]);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Number, SOUGHT, Swing, SwingParameters, filmed, fit, swing};
    use hamel::Dual;

    const TRUTH: [f64; SOUGHT] = [0.83, 0.06, 1.9];

    #[test]
    fn slopes_of_a_run_are_those_of_differences() {
        let varied: [Number; SOUGHT] = std::array::from_fn(|i| Dual::along(TRUTH[i], i));
        let slopes = swing(varied).expect("a run");
        let d = 1e-5;
        for i in 0..SOUGHT {
            let moved = |by: f64| {
                let mut moved = TRUTH;
                moved[i] += by;
                swing(moved).expect("a run")
            };
            let (ahead, behind) = (moved(d), moved(-d));
            for ((slope, ahead), behind) in slopes.iter().zip(ahead).zip(behind) {
                let difference = (ahead - behind) / (2.0 * d);
                assert!((slope.slopes[i] - difference).abs() < 1e-6, "{i}");
            }
        }
    }

    /// Compares the emitted ∂ξ̇/∂p with the slopes of ξ̇ in dual numbers.
    #[test]
    fn slopes_of_a_state_are_those_of_dual_numbers() {
        let system = Swing::<f64>::default();
        let (sin, cos) = 0.7_f64.sin_cos();
        let [slopes] = system
            .parameter_slopes(&[cos, sin], &[1.3], &[])
            .expect("an inertia");
        let number = |value, i| Number::along(value, i);
        let varied = Swing::new(SwingParameters {
            l: number(1.0, 0),
            c: number(0.1, 1),
            g: number(9.81, 2),
        });
        let constant = Number::constant;
        let accel = varied.expect("an inertia").accel(
            &[constant(cos), constant(sin)],
            &[constant(1.3)],
            &[],
        );
        let [accel] = accel.expect("an inertia");
        for (one, other) in slopes.iter().zip(accel.slopes) {
            assert!(
                (one - other).abs() < 1e-13 * other.abs().max(1.0),
                "{slopes:?}"
            );
        }
    }

    #[test]
    fn the_swing_is_found_from_noisy_pictures() {
        let film = filmed(TRUTH, 0.02).expect("a run");
        let fit = fit(&film, [1.0, 0.1, 1.6]).expect("a fit");
        assert!((fit.picture - 0.02).abs() < 0.006, "{}", fit.picture);
        // Each estimate is within four of its standard deviations, and these are small.
        for i in 0..SOUGHT {
            let off = (fit.found[i] - TRUTH[i]).abs();
            assert!(off < 4.0 * fit.doubt[i], "{i}: {off}, {}", fit.doubt[i]);
            assert!(fit.doubt[i] < 0.02, "{i}: {}", fit.doubt[i]);
        }
    }
}
