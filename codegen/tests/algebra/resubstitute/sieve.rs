//! The sieve of values passes all present values, and few others.

use hamel_algebra::prime::Residue;
use hamel_algebra::residue_pair::{Random, ResiduePair};
use included::Sieve;

// Included, since false positives only affect the duration of resubstitution.
#[path = "../../../algebra/src/resubstitute/sieve.rs"]
mod included;

#[test]
fn what_is_there_passes_with_either_sign_and_little_else_does() {
    let mut random = Random::new(3);
    let there: Vec<ResiduePair> = (0..400).map(|_| random.element()).collect();
    let i = ResiduePair(Residue::I, Residue::I);
    let all = there.iter().flat_map(|&value| [value, value * i]);
    let sieve = Sieve::new(all.clone().chain([ResiduePair::ZERO]));
    assert!(
        all.clone()
            .all(|value| sieve.passes(value.0) && sieve.passes((-value).0))
    );
    assert!(sieve.passes(Residue::ZERO));
    let others = (0..1000)
        .filter(|_| sieve.passes(random.element().0))
        .count();
    assert!(others < 100, "{others}");
}
