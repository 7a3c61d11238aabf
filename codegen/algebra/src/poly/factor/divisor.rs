//! Divisors that several products, or two products of one sum, have in common.
//!
//! * A kernel c₁ ± c₂ (coprime products) occurs in a sum that has m c₁ ± m c₂ for some m; with
//!   K = c₁ ± c₂ the two become m K.
//! * A cube l₁ l₂ (two literals) occurs in a product that has both; with P = l₁ l₂ they become P.
//!
//! Fast extraction of these two kinds is due to Rajski and Vasudevamurthi (1992); for polynomials
//! see Hosangadi, Fallah and Kastner (2006). Larger divisors arise by repetition.

use super::system::Literal;

/// Two products m c₁, m c₂ of a sum; `size` is the number of literals of m.
#[derive(Clone, Copy)]
pub(super) struct Occurrence {
    pub(super) first: usize,
    pub(super) second: usize,
    pub(super) size: usize,
    /// Operations saved by writing m K, not counting those of K.
    pub(super) saved: i64,
    /// Index of the previous occurrence of the same kernel.
    pub(super) previous: Option<usize>,
}

/// A kernel c₁ ± c₂.
pub(super) struct Kernel {
    /// Operations of c₁ ± c₂.
    pub(super) cost: i64,
    /// Operations saved by all occurrences together, less those of the kernel itself.
    pub(super) saved: i64,
    /// Index of the latest occurrence.
    pub(super) latest: Option<usize>,
}

/// A cube l₁ l₂.
pub(super) struct Cube {
    pub(super) pair: (Literal, Literal),
    /// Operations saved in all nodes together, less the one of the cube itself.
    pub(super) saved: i64,
    pub(super) nodes: Vec<usize>,
}

/// A divisor: an index into `kernels` or `cubes`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Divisor {
    Kernel(usize),
    Cube(usize),
}

/// Choice of the next divisor: the best one by weight × operations saved + noise.
#[derive(Clone, Copy)]
pub(super) struct Strategy {
    pub(super) kernel: i64,
    pub(super) cube: i64,
    pub(super) noise: u64,
    pub(super) seed: u64,
}

impl Strategy {
    /// Returns the score of a divisor that saves this number of operations.
    pub(super) fn score(&self, divisor: Divisor, saved: i64) -> i64 {
        let (weight, key) = match divisor {
            Divisor::Kernel(index) => (self.kernel, 2 * index as u64),
            Divisor::Cube(index) => (self.cube, 2 * index as u64 + 1),
        };
        let noise = mix(key ^ self.seed) % (self.noise + 1);
        weight * saved + noise as i64
    }
}

/// Operations for a product of this number of literals.
pub(super) fn multiplications(literals: usize) -> i64 {
    literals.saturating_sub(1) as i64
}

/// Returns the number of common literals, and a hash of them.
pub(super) fn common(a: &[Literal], b: &[Literal]) -> (usize, u64) {
    let (mut i, mut j, mut size, mut hash) = (0, 0, 0, 0u64);
    while let (Some(x), Some(y)) = (a.get(i), b.get(j)) {
        if x == y {
            size += 1;
            hash = hash.wrapping_add(mix(u64::from(*x)));
        }
        (i, j) = (i + usize::from(x <= y), j + usize::from(y <= x));
    }
    (size, hash)
}

/// The finalizer of splitmix64, for hashes of literals and for noise.
pub(super) fn mix(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
