//! Points on lines: N flat coordinates with ẋ = ξ, and any acceleration.

use hamel::{Block, Singular, System};

/// ξ̇ of (x, ξ)
pub type Accel<const N: usize> = fn(&[f64; N], &[f64; N]) -> Result<[f64; N], Singular>;

pub struct Points<const N: usize> {
    pub start: ([f64; N], [f64; N]),
    pub accel: Accel<N>,
}

impl<const N: usize> System for Points<N> {
    type Scalar = f64;
    type Coordinates = [f64; N];
    type Velocities = [f64; N];
    type Chart = [f64; N];
    type Inputs = [f64; 0];

    fn blocks(&self) -> &[Block] {
        &[const { Block::Flat(N) }]
    }
    fn zero_coordinates(&self) -> [f64; N] {
        [0.0; N]
    }
    fn zero_velocities(&self) -> [f64; N] {
        [0.0; N]
    }
    fn zero_chart(&self) -> [f64; N] {
        [0.0; N]
    }
    fn zero_inputs(&self) -> [f64; 0] {
        []
    }
    fn start(&self) -> ([f64; N], [f64; N]) {
        self.start
    }
    fn rate(&self, _: &[f64; N], xi: &[f64; N]) -> [f64; N] {
        *xi
    }
    fn chart_rate(&self, _: &[f64; N], xi: &[f64; N]) -> [f64; N] {
        *xi
    }
    fn accel(&self, x: &[f64; N], xi: &[f64; N], _: &[f64; 0]) -> Result<[f64; N], Singular> {
        (self.accel)(x, xi)
    }
    fn correction(&self, _: &[f64; N]) -> [f64; N] {
        [0.0; N]
    }
    fn constraint_norm(&self, _: &[f64; N]) -> f64 {
        0.0
    }
    fn kinetic_energy(&self, _: &[f64; N], xi: &[f64; N]) -> f64 {
        0.5 * xi.iter().map(|v| v * v).sum::<f64>()
    }
    fn potential_energy(&self, _: &[f64; N]) -> f64 {
        0.0
    }
}
