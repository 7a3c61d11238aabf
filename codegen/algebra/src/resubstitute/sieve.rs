//! Which values there may be among many: nearly all that are asked for are not there, as one bit of their part modulo p says.

use super::{Fp, Residue};

/// So many bits, 2 KB, for the values of some hundred nodes.
const BITS: u32 = 14;

/// A bit for each value and its negative.
pub(super) struct Sieve(Vec<u64>);

impl Sieve {
    pub(super) fn new(values: impl Iterator<Item = Fp>) -> Self {
        let mut words = vec![0; (1 << BITS) / 64];
        for value in values {
            let place = place(value.0);
            words[place / 64] |= 1 << (place % 64);
        }
        Sieve(words)
    }

    /// Whether a value with this part may be there.
    pub(super) fn passes(&self, part: Residue<0>) -> bool {
        let place = place(part);
        self.0[place / 64] >> (place % 64) & 1 == 1
    }
}

/// The bit of ±a.
fn place(part: Residue<0>) -> usize {
    let [real, imaginary] = part
        .parts()
        .map(|part| part.min(Residue::<0>::P.wrapping_sub(part)));
    let mixed = (real ^ imaginary.rotate_left(7)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (mixed >> (64 - BITS)) as usize
}
