//! Holds an arm on a ship that heaves, pitches and rolls: one part of the motion is prescribed, the other follows from
//! forces.
//!
//! The ship's motion is a prescribed function of time, so inverse dynamics includes the forces of the moving deck on
//! the joints. The same feedback holds the arm with and without this feedforward.
//!
//! `cargo run --release -p control --bin hybrid`

use hamel::methods::Rkmk4;
use hamel::{State, System, step};
use std::error::Error;

hamel::rigid_eom! {
    /// A tower that turns on the deck, and a boom on it.
    system ShipArm {
        param roll = 0.3, pitch = 0.1, heave = 0.4, s = 1.1;
        time t;
        frame ship = pose(rpy(roll * sin(s * t), pitch * cos(t), 0), [0, 0, heave * sin(2 * t)]);
        joint pan: revolute [0, 0, 1] on ship at pose(identity(3), [1, 0, 1]) moves tower;
        joint lift: revolute [0, 1, 0] on tower at pose(identity(3), [0.3, 0, 0]) moves boom;
        body on tower { mass 80; com [0.1, 0, 0.2]; inertia diag(4, 5, 3) about com; }
        body on boom { mass 40; com [0.8, 0, 0]; inertia diag(0.5, 9, 9) about com; }
        gravity [0, 0, -9.81];
        input tau: vec2;
        generalized force pan_dot = tau[1];
        generalized force lift_dot = tau[2];
        start lift = -0.4;
        generate accel, inverse_dynamics;
    }
}

/// The period of the controller, in s.
const PERIOD: f64 = 0.005;

/// The model that a controller uses.
#[derive(Clone, Copy)]
enum Knows {
    /// A deck at rest, so that only weights are compensated.
    Weight,
    /// The prescribed motion of the deck.
    Motion,
}

/// The greatest error of the joints (rad) and the greatest torque (N m) while the controller holds the arm fixed to the
/// deck for a time.
fn held(knows: Knows, seconds: f64) -> Result<(f64, f64), Box<dyn Error>> {
    let arm = ShipArm::<f64>::default();
    // The same arm on a deck at rest.
    let still = ShipArmParameters {
        roll: 0.0,
        pitch: 0.0,
        heave: 0.0,
        ..ShipArmParameters::default()
    };
    let docked = ShipArm::new(still)?;
    let (x, xi) = arm.start();
    // Coordinates are the time, pan and lift.
    let wanted = [x[1], x[2]];
    let mut state: State<ShipArm<f64>> = State { t: x[0], x, xi };
    let (mut error, mut torque) = (0.0_f64, 0.0_f64);
    for _ in 0..(seconds / PERIOD).round() as usize {
        let off = [0, 1].map(|i| state.x[1 + i] - wanted[i]);
        let wish = [0, 1].map(|i| -40.0 * off[i] - 12.0 * state.xi[i]);
        let known = match knows {
            Knows::Weight => &docked,
            Knows::Motion => &arm,
        };
        let tau = known.inverse_dynamics(&state.x, &state.xi, &wish);
        step(&arm, Rkmk4, &mut state, PERIOD, &|_, _, _| tau)?;
        error = error.max(off[0].abs()).max(off[1].abs());
        torque = torque.max(tau[0].abs()).max(tau[1].abs());
    }
    Ok((error, torque))
}

fn main() -> Result<(), Box<dyn Error>> {
    for (name, knows) in [
        ("weights alone", Knows::Weight),
        ("the deck's motion", Knows::Motion),
    ] {
        let (error, torque) = held(knows, 30.0)?;
        println!(
            "feedback with {name}: the joints are off by up to {:.3}°, torques up to {torque:.0} N m",
            error.to_degrees()
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Knows, held};

    #[test]
    fn the_prescribed_motion_is_compensated() {
        let (blind, _) = held(Knows::Weight, 10.0).expect("a run");
        let (seeing, _) = held(Knows::Motion, 10.0).expect("a run");
        // The remaining error comes from torques that are constant over a period.
        assert!(blind > 0.02 && seeing < 0.05 * blind, "{blind} {seeing}");
    }
}
