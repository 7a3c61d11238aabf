//! Random numbers that depend only on the seed, the member and the varied entry, not on the order of computation.
//!
//! The generator is ChaCha with 8 rounds: the seed is the key, the member the stream, the entry the position in the
//! stream. Functions are those of `libm`, so that the numbers are the same on every machine.

use super::permutation::Permutation;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// Words of the stream reserved for each entry; no entry uses more.
const WORDS_PER_ENTRY: u128 = 16;
/// Purposes of keys.
const MEMBER_KEYS: u8 = 1;
const PERMUTATION_KEYS: u8 = 2;

/// The draws of one sweep.
#[derive(Clone, Debug)]
pub struct Draws {
    seed: u64,
}

impl Draws {
    /// Creates the draws for a seed.
    pub fn new(seed: u64) -> Self {
        Draws { seed }
    }

    fn generator(&self, purpose: u8, stream: u64, entry: usize) -> ChaCha8Rng {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&self.seed.to_le_bytes());
        key[8] = purpose;
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(stream);
        generator.set_word_pos(entry as u128 * WORDS_PER_ENTRY);
        generator
    }

    /// Returns a uniform number in 0 ≤ u < 1.
    pub fn uniform(&self, member: u64, entry: usize) -> f64 {
        unit(&mut self.generator(MEMBER_KEYS, member, entry))
    }

    /// Returns a normal number with mean 0 and standard deviation 1 (G. E. P. Box, M. E. Muller, 1958).
    pub fn normal(&self, member: u64, entry: usize) -> f64 {
        let mut generator = self.generator(MEMBER_KEYS, member, entry);
        // Avoid the logarithm of 0.
        let (length, angle) = (1.0 - unit(&mut generator), unit(&mut generator));
        libm::sqrt(-2.0 * libm::log(length)) * libm::cos(TAU * angle)
    }

    /// Returns the permutation of members for an entry.
    pub fn permutation(&self, entry: usize, members: u64) -> Permutation {
        let mut generator = self.generator(PERMUTATION_KEYS, 0, entry);
        Permutation::new(members, || generator.next_u64())
    }
}

/// Returns a number of 53 bits, 0 ≤ u < 1.
fn unit(generator: &mut ChaCha8Rng) -> f64 {
    (generator.next_u64() >> 11) as f64 * f64::EPSILON / 2.0
}

#[cfg(test)]
mod tests {
    use super::Draws;

    /// The numbers for this seed must not change between versions, so that sweeps can be resumed.
    #[test]
    fn draws_are_fixed() {
        let draws = Draws::new(7);
        let found: Vec<f64> = (0..3).map(|member| draws.uniform(member, 0)).collect();
        assert_eq!(found, FIXED, "{found:?}");
        assert_ne!(draws.uniform(0, 1), draws.uniform(0, 0));
        assert_ne!(Draws::new(8).uniform(0, 0), draws.uniform(0, 0));
    }

    const FIXED: [f64; 3] = [0.8698576442058795, 0.6669447311777823, 0.06134548734472989];
}
