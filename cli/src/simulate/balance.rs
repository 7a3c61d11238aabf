//! Whether a run still follows the motion: its energy may change by the work of loads alone, and does so otherwise where a
//! step has jumped across a singularity, or is far too long.

use crate::mechanism::Instance;
use hamel::{Energies, State};

/// A change of energy that no load accounts for means that the motion is lost where it is larger than this
/// part of the energy that moves on average, or than so many tolerances of what moves here.
const LOST: f64 = 1e-2;
const TOLERANCES: f64 = 100.0;
/// In equal steps nobody says what a step may err by, and methods of low order gain or lose energy as they go: the motion
/// is lost where the change is so many times the energy.
const GROSS: f64 = 10.0;
/// A mechanism at rest may have no energy at all: what rounding makes of it is no loss.
const ROUNDING: f64 = 1e-13;
/// The work of loads is estimated from the ends of steps, and may be so many times as much.
const WORK: f64 = 10.0;

/// What is known of the energy so far.
#[derive(Clone, Copy, Debug)]
pub struct Balance {
    start: f64,
    initial: f64,
    time: f64,
    power: f64,
    /// ∫ |f ξ| dt.
    work: f64,
    /// ∫ T dt, without what the run has made of nothing.
    moving: f64,
    /// Whether T + V changes with the time, or by drives: then it says nothing of the run.
    driven: bool,
    /// T and the change of T + V at the last state.
    kinetic: f64,
    change: f64,
}

impl Balance {
    /// Starts at a state.
    pub fn new(system: &Instance, state: &State<Instance>) -> Self {
        Balance {
            start: state.t,
            initial: energy(system, state),
            time: state.t,
            power: system.power(state.t, &state.x, &state.xi).abs(),
            work: 0.0,
            moving: 0.0,
            driven: system.is_driven(),
            kinetic: system.kinetic_energy(&state.x, &state.xi),
            change: 0.0,
        }
    }

    /// What is known with one more state.
    pub fn after(mut self, system: &Instance, state: &State<Instance>) -> Self {
        let h = (state.t - self.time).abs();
        let power = system.power(state.t, &state.x, &state.xi).abs();
        let gained = energy(system, state) - self.initial;
        let kinetic = system.kinetic_energy(&state.x, &state.xi);
        self.kinetic = (kinetic - gained.max(0.0)).max(0.0);
        self.work += h * power.max(self.power);
        self.moving += h * self.kinetic;
        self.change = gained;
        self.time = state.t;
        self.power = power;
        self
    }

    /// The change of energy here, where no load accounts for it; without a tolerance, where steps are equal.
    pub fn lost(&self, tolerance: Option<f64>) -> Option<f64> {
        if self.driven {
            return None;
        }
        let elapsed = (self.time - self.start).abs();
        let mean = if elapsed > 0.0 {
            self.moving / elapsed
        } else {
            0.0
        };
        let scale = mean.max(self.initial.abs());
        let allowed = match tolerance {
            Some(tolerance) => {
                let rough = TOLERANCES * tolerance;
                LOST.max(rough) * scale + rough * self.kinetic
            }
            None => GROSS * scale + ROUNDING,
        };
        // What is not a number is said by the method itself.
        let lost = self.change.abs() > allowed + WORK * self.work;
        lost.then_some(self.change)
    }
}

fn energy(system: &Instance, state: &State<Instance>) -> f64 {
    system.kinetic_energy(&state.x, &state.xi) + system.potential_energy(&state.x)
}
