//! A permutation of the numbers below any count, evaluated at single numbers.
//!
//! It is a Feistel network on numbers with an even count of bits, iterated until the result is below the count
//! (J. Black, P. Rogaway, *Ciphers with arbitrary finite domains*, 2002).

/// Rounds of the network.
const FEISTEL_ROUNDS: usize = 8;

/// A permutation.
#[derive(Clone, Debug)]
pub struct Permutation {
    count: u64,
    /// Half the number of bits of the permuted numbers.
    half: u32,
    keys: [u64; FEISTEL_ROUNDS],
}

impl Permutation {
    /// Creates the permutation of the numbers below a count, with keys from a generator.
    pub fn new(count: u64, mut key: impl FnMut() -> u64) -> Self {
        let bits = u64::BITS - count.saturating_sub(1).leading_zeros();
        Permutation {
            count,
            half: bits.div_ceil(2).max(1),
            keys: std::array::from_fn(|_| key()),
        }
    }

    /// Returns the image of a number, which must be below the count.
    pub fn at(&self, index: u64) -> u64 {
        let mut place = index;
        loop {
            place = self.shuffle(place);
            if place < self.count {
                return place;
            }
        }
    }

    fn shuffle(&self, place: u64) -> u64 {
        let mask = (1 << self.half) - 1;
        let (mut left, mut right) = (place >> self.half, place & mask);
        for key in self.keys {
            (left, right) = (right, left ^ (mix(right ^ key) & mask));
        }
        left << self.half | right
    }
}

/// Applies the finaliser of SplitMix64: every bit of the result depends on all bits of z.
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::Permutation;

    fn permutation_of(count: u64, seed: u64) -> Permutation {
        let mut key = seed;
        Permutation::new(count, move || {
            key = key.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            key
        })
    }

    #[test]
    fn every_number_has_one_place() {
        for count in (1..70).chain([1000, 4096, 4097]) {
            let permutation = permutation_of(count, count);
            let mut places: Vec<u64> = (0..count).map(|index| permutation.at(index)).collect();
            places.sort_unstable();
            assert_eq!(places, (0..count).collect::<Vec<u64>>());
        }
        let large = permutation_of(u64::MAX, 1);
        assert_ne!(large.at(0), large.at(1));
    }

    #[test]
    fn places_are_spread() {
        // Images of 0 for all keys, and of neighbours for one key: the mean of a uniform variable within five standard
        // errors.
        let count = 1000;
        let of_zero: Vec<u64> = (0..2000)
            .map(|seed| permutation_of(count, seed).at(0))
            .collect();
        let mean = of_zero.iter().sum::<u64>() as f64 / 2000.0;
        let deviation = count as f64 / 12_f64.sqrt();
        assert!(
            (mean - 499.5).abs() < 5.0 * deviation / 2000_f64.sqrt(),
            "{mean}"
        );
        let one = permutation_of(count, 3);
        let product = |i: u64| (one.at(i) as f64 - 499.5) * (one.at(i + 1) as f64 - 499.5);
        let correlation = (0..count - 1).map(product).sum::<f64>() / deviation.powi(2) / 999.0;
        assert!(correlation.abs() < 5.0 / 999_f64.sqrt(), "{correlation}");
    }
}
