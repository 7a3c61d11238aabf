//! Balances a pole on a cart: the gain of the linear-quadratic regulator comes from the exact slopes of a step of the
//! controller's period.
//!
//! `cargo run --release -p control --bin lqr`

use hamel::methods::Rkmk4;
use hamel::{State, StepError, step, step_slopes};
use nalgebra::{Matrix1, Matrix4, RowVector4, Vector4};

hamel::rigid_eom! {
    /// A cart with a pole on it, pushed by a force; the angle is 0 where the pole stands upright.
    system CartPole {
        param cart = 1.2, pole = 0.3, l = 0.5;
        input push;
        joint rail: prismatic [1, 0, 0] moves car;
        joint hinge: revolute [0, 1, 0] on car moves rod;
        body on car { mass cart; inertia diag(0, 0, 0) about com; }
        body on rod { mass pole; com [0, 0, l]; inertia diag(pole * l^2 / 3, pole * l^2 / 3, 0) about com; }
        gravity [0, 0, -9.81];
        generalized force rail_dot = push;
        generate all, linearize;
    }
}

/// The period of the controller, in s.
const PERIOD: f64 = 0.02;

/// The gain K of push = −K (h, δξ): the discrete Riccati equation P = Q + Aᵀ P (A − B K), K = (R + Bᵀ P B)⁻¹ Bᵀ P A,
/// iterated to convergence.
fn regulator(system: &CartPole<f64>) -> Result<RowVector4<f64>, StepError> {
    let upright = State {
        t: 0.0,
        x: [0.0, 0.0],
        xi: [0.0, 0.0],
    };
    let (_, slopes) = step_slopes(&Rkmk4, system, &upright, &[0.0], PERIOD)?;
    let a = Matrix4::from_fn(|i, j| slopes[i][j]);
    let b = Vector4::from_fn(|i, _| slopes[i][4]);
    let weight = Matrix4::from_diagonal(&Vector4::new(10.0, 10.0, 1.0, 1.0));
    let (mut p, mut gain) = (weight, RowVector4::zeros());
    for _ in 0..2000 {
        let inverse = 1.0 / (Matrix1::new(0.1) + b.transpose() * p * b).x;
        gain = inverse * b.transpose() * p * a;
        p = weight + a.transpose() * p * (a - b * gain);
    }
    Ok(gain)
}

/// Returns the greatest force, and the state after some periods from a leaning pole.
fn balanced(periods: u32) -> Result<(f64, State<CartPole<f64>>), StepError> {
    let system = CartPole::default();
    let gain = regulator(&system)?;
    let mut state = State {
        t: 0.0,
        x: [0.0, 0.35],
        xi: [0.0, 0.0],
    };
    let mut most: f64 = 0.0;
    for _ in 0..periods {
        let [place, angle] = state.x;
        let [speed, rate] = state.xi;
        let push = -(gain * Vector4::new(place, angle, speed, rate)).x;
        most = most.max(push.abs());
        step(&system, Rkmk4, &mut state, PERIOD, &|_, _, _| [push])?;
    }
    Ok((most, state))
}

fn main() -> Result<(), StepError> {
    let gain = regulator(&CartPole::default())?;
    println!("push = −K (place, angle, speed, rate), K = {gain:.3}");
    for seconds in [0, 1, 2, 4, 8] {
        let (most, state) = balanced(50 * seconds)?;
        println!(
            "{:4.1} s: x = {:8.5?}, ξ = {:8.5?}, greatest force {most:.1} N",
            state.t, state.x, state.xi
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{CartPole, PERIOD, balanced, regulator, step_slopes};
    use hamel::State;
    use hamel::methods::Rkmk4;
    use nalgebra::{Matrix4, Vector4};

    /// A lean of 20 degrees is corrected, and all eigenvalues of A_d − B_d K are within the unit circle.
    #[test]
    fn the_pole_stands() {
        let (_, state) = balanced(500).expect("a run");
        assert!(
            state
                .x
                .iter()
                .chain(&state.xi)
                .all(|entry| entry.abs() < 1e-3),
            "{state:?}"
        );
        let system = CartPole::default();
        let gain = regulator(&system).expect("a gain");
        let upright = State {
            t: 0.0,
            x: [0.0; 2],
            xi: [0.0; 2],
        };
        let (_, slopes) = step_slopes(&Rkmk4, &system, &upright, &[0.0], PERIOD).expect("a step");
        let open = Matrix4::from_fn(|i, j| slopes[i][j]);
        let closed = open - Vector4::from_fn(|i, _| slopes[i][4]) * gain;
        let radius = |m: Matrix4<f64>| {
            m.complex_eigenvalues()
                .iter()
                .map(|value| value.norm())
                .fold(0.0, f64::max)
        };
        assert!(radius(open) > 1.05 && radius(closed) < 0.995);
    }
}
