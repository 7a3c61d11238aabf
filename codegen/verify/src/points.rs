//! Fresh points of X: those at which both sides of an identity are evaluated, and no expression was built.

#[cfg(test)]
mod tests;

use hamel_algebra::lane::Lane;

/// Points at which everything is compared.
pub const POINTS: u64 = 4;
/// Points tried: roots have values at some of them only.
const TRIES: u64 = 400;
/// Points that are nowhere to be found, each looked for thousands of times, after which there are none.
pub const MISSING: u64 = 2;

/// Why a comparison said nothing or ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unequal<E> {
    /// What differs at a point.
    Differs(E),
    /// There were fewer points at which both sides have values than are wanted.
    Nowhere,
}

/// Compares at fresh points until both sides had values at as many as are wanted, or differ. `lane` makes the
/// point of a number, `at` compares there; `None` of either is a point without values.
pub fn at_fresh_points<E>(
    lane: impl Fn(u64) -> Option<Lane>,
    mut at: impl FnMut(&Lane, u64) -> Option<Result<(), E>>,
) -> Result<(), Unequal<E>> {
    let (mut compared, mut missing) = (0, 0);
    for number in 1..=TRIES {
        let Some(lane) = lane(number) else {
            missing += 1;
            match missing {
                MISSING => break,
                _ => continue,
            }
        };
        match at(&lane, number) {
            None => continue,
            Some(Ok(())) => compared += 1,
            Some(Err(what)) => return Err(Unequal::Differs(what)),
        }
        if compared == POINTS {
            return Ok(());
        }
    }
    Err(Unequal::Nowhere)
}
