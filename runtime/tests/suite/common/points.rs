//! Points on lines: N flat coordinates with ẋ = ξ, and any acceleration.

use hamel::{Block, Energies, Singular, System};

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
    fn start(&self) -> ([f64; N], [f64; N]) {
        self.start
    }
    fn chart_rate(&self, _: &[f64; N], xi: &[f64; N]) -> [f64; N] {
        *xi
    }
    fn forward_dynamics(
        &self,
        x: &[f64; N],
        xi: &[f64; N],
        _: &[f64; 0],
    ) -> Result<[f64; N], Singular> {
        (self.accel)(x, xi)
    }
}

impl<const N: usize> Energies for Points<N> {
    fn kinetic_energy(&self, _: &[f64; N], xi: &[f64; N]) -> f64 {
        0.5 * xi.iter().map(|v| v * v).sum::<f64>()
    }
    fn potential_energy(&self, _: &[f64; N]) -> f64 {
        0.0
    }
}
