//! Samples of runs: the state at one time, with derived quantities.

use crate::mechanism::{Instance, Output};
use hamel::{Energies, State};

/// State of a run at one time, with derived quantities.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The time since the start of the run.
    pub t: f64,
    /// x.
    pub x: Vec<f64>,
    /// ξ, followed by the states of first order.
    pub xi: Vec<f64>,
    /// Entries of all outputs, in sequence.
    pub outputs: Vec<f64>,
    /// Entries of all invariants except the energy.
    pub invariants: Vec<f64>,
    /// M ξ.
    pub momentum: Vec<f64>,
    /// T + V.
    pub energy: f64,
}

impl Sample {
    /// Evaluates all recorded quantities at a state.
    pub fn of(system: &Instance, state: &State<Instance>) -> Self {
        let (x, xi) = (&state.x, &state.xi);
        let values = |list: &[Output]| -> Vec<f64> {
            let values = list
                .iter()
                .map(|output| system.output(output, state.t, x, xi));
            values.flat_map(|value| value.to_vec()).collect()
        };
        Sample {
            t: state.t,
            outputs: values(system.outputs()),
            invariants: values(system.invariants()),
            momentum: system.momentum(x, xi).to_vec(),
            energy: system.kinetic_energy(x, xi) + system.potential_energy(x),
            x: x.to_vec(),
            xi: xi.to_vec(),
        }
    }
}
