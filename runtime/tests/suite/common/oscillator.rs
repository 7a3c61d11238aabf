//! A damped oscillator with a force.

use hamel::{Block, Singular, System};

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

    fn zero_coordinates(&self) -> [f64; 1] {
        [0.0]
    }

    fn zero_velocities(&self) -> [f64; 1] {
        [0.0]
    }

    fn zero_chart(&self) -> [f64; 1] {
        [0.0]
    }

    fn zero_inputs(&self) -> [f64; 1] {
        [0.0]
    }

    fn start(&self) -> ([f64; 1], [f64; 1]) {
        ([1.0], [0.0])
    }

    fn rate(&self, _: &[f64; 1], xi: &[f64; 1]) -> [f64; 1] {
        *xi
    }

    fn chart_rate(&self, _: &[f64; 1], xi: &[f64; 1]) -> [f64; 1] {
        *xi
    }

    fn accel(&self, x: &[f64; 1], xi: &[f64; 1], u: &[f64; 1]) -> Result<[f64; 1], Singular> {
        Ok([u[0] - self.frequency.powi(2) * x[0] - self.damping * xi[0]])
    }

    fn correction(&self, _: &[f64; 1]) -> [f64; 1] {
        [0.0]
    }

    fn constraint_norm(&self, _: &[f64; 1]) -> f64 {
        0.0
    }

    fn kinetic_energy(&self, _: &[f64; 1], xi: &[f64; 1]) -> f64 {
        0.5 * xi[0] * xi[0]
    }

    fn potential_energy(&self, x: &[f64; 1]) -> f64 {
        0.5 * self.frequency.powi(2) * x[0] * x[0]
    }
}
