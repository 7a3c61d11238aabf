//! A damped oscillator with a force.

use hamel::{Block, Energies, Singular, System};

/// q̈ = −w² q − d q̇ + u, let go at q = 1.
pub struct Oscillator {
    /// w.
    pub frequency: f64,
    /// d.
    pub damping: f64,
}

impl System for Oscillator {
    type Scalar = f64;
    type Coordinates = [f64; 1];
    type Velocities = [f64; 1];
    type Chart = [f64; 1];
    type Inputs = [f64; 1];

    fn blocks(&self) -> &[Block] {
        &[Block::Flat(1)]
    }

    fn start(&self) -> ([f64; 1], [f64; 1]) {
        ([1.0], [0.0])
    }

    fn chart_rate(&self, _: &[f64; 1], xi: &[f64; 1]) -> [f64; 1] {
        *xi
    }

    fn forward_dynamics(
        &self,
        x: &[f64; 1],
        xi: &[f64; 1],
        u: &[f64; 1],
    ) -> Result<[f64; 1], Singular> {
        Ok([u[0] - self.frequency.powi(2) * x[0] - self.damping * xi[0]])
    }
}

impl Energies for Oscillator {
    fn kinetic_energy(&self, _: &[f64; 1], xi: &[f64; 1]) -> f64 {
        0.5 * xi[0] * xi[0]
    }
    fn potential_energy(&self, x: &[f64; 1]) -> f64 {
        0.5 * self.frequency.powi(2) * x[0] * x[0]
    }
}
