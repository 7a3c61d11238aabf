//! A sieve for values: most values that are looked up belong to no node, and one bit of a hash of their
//! part modulo p rejects nearly all of these.

use super::{Residue, ResiduePair};

/// Number of bits of a hash: 2 KB of flags suffice for the values of some hundred nodes.
const HASH_BITS: u32 = 14;

/// Flags for the hashes of values, the same for a value and its negative.
pub(super) struct Sieve(Vec<u64>);

impl Sieve {
    pub(super) fn new(values: impl Iterator<Item = ResiduePair>) -> Self {
        let mut words = vec![0; (1 << HASH_BITS) / 64];
        for value in values {
            let place = place(value.0);
            words[place / 64] |= 1 << (place % 64);
        }
        Sieve(words)
    }

    /// Whether a value with this part may be among the values.
    pub(super) fn passes(&self, part: Residue<0>) -> bool {
        let place = place(part);
        self.0[place / 64] >> (place % 64) & 1 == 1
    }
}

/// Hash of ±a.
fn place(part: Residue<0>) -> usize {
    let [real, imaginary] = part
        .parts()
        .map(|part| part.min(Residue::<0>::P.wrapping_sub(part)));
    let mixed = (real ^ imaginary.rotate_left(7)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (mixed >> (64 - HASH_BITS)) as usize
}
