//! Detects runs that no longer follow the motion: energy changes not accounted for by loads occur if a step has jumped
//! across a singularity, or is far too long.

use crate::mechanism::Instance;
use hamel::{Energies, State};

/// Largest unexplained change of energy relative to the mean kinetic energy, and the same in multiples of the
/// tolerance.
const MAX_RELATIVE_CHANGE: f64 = 1e-2;
const MAX_CHANGE_IN_TOLERANCES: f64 = 100.0;
/// Likewise for equal steps, where no tolerance is known and methods of low order gain or lose energy: the motion is
/// lost only if the change exceeds the energy by this factor.
const MAX_RELATIVE_CHANGE_EQUAL_STEPS: f64 = 10.0;
/// Absolute limit for a mechanism at rest without energy: rounding errors are not a loss.
const ROUNDING_ERROR: f64 = 1e-13;
/// Safety factor for the work of loads, which is estimated from the ends of steps.
const WORK_SAFETY_FACTOR: f64 = 10.0;

/// Energy of a run so far, with the work of its loads, to notice energy that no load accounts for.
#[derive(Clone, Copy, Debug)]
pub struct EnergyBalance {
    start: f64,
    initial: f64,
    time: f64,
    power: f64,
    /// ∫ |f ξ| dt.
    work: f64,
    /// ∫ T dt, without energy created by the run.
    moving: f64,
    /// Whether T + V changes with the time, or by drives; then it is not checked.
    driven: bool,
    /// T and the change of T + V at the last state.
    kinetic: f64,
    change: f64,
}

impl EnergyBalance {
    /// Begins the balance at the start of a run.
    pub fn new(system: &Instance, state: &State<Instance>) -> Self {
        EnergyBalance {
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

    /// Returns the balance after one more state.
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

    /// Returns the change of energy at this state if no load accounts for it, `None` otherwise; `tolerance` is `None`
    /// for equal steps.
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
                let rough = MAX_CHANGE_IN_TOLERANCES * tolerance;
                MAX_RELATIVE_CHANGE.max(rough) * scale + rough * self.kinetic
            }
            None => MAX_RELATIVE_CHANGE_EQUAL_STEPS * scale + ROUNDING_ERROR,
        };
        // The method itself reports NaN.
        let lost = self.change.abs() > allowed + WORK_SAFETY_FACTOR * self.work;
        lost.then_some(self.change)
    }
}

fn energy(system: &Instance, state: &State<Instance>) -> f64 {
    system.kinetic_energy(&state.x, &state.xi) + system.potential_energy(&state.x)
}
