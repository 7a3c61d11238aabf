//! Random numbers for the examples.

/// A linear congruential generator, so that every run is the same.
#[derive(Clone, Debug)]
pub struct Noise(pub u64);

impl Noise {
    /// Returns a number between 0 and 1.
    pub fn uniform(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    /// Returns a normal number of mean 0 and deviation 1, by the Box-Muller method.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
