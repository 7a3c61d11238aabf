//! Fresh points of X: points at which both sides of an identity are evaluated, and which no derivation has used.

#[cfg(test)]
mod tests;

use hamel_algebra::field_point::FieldPoint;

/// Number of points at which everything is compared.
pub const COMPARED_POINTS: u64 = 4;
/// Largest number of points tried; square roots have values at some points only.
const MAX_TRIED_POINTS: u64 = 400;
/// Number of searches for a point, each of thousands of attempts, that have to fail until no points are assumed to
/// exist.
pub const MAX_FAILED_SEARCHES: u64 = 2;

/// Reason why a comparison failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Disagreement<E> {
    /// Both sides differ at a point.
    Differs(E),
    /// Both sides have values at too few points.
    Nowhere,
}

/// Compares two sides by `at` at random points that `point` draws by number, until they differ or have had values at
/// [`COMPARED_POINTS`] points.
///
/// `point` creates the point of a number, and `at` compares there; either returns `None` if there are no values.
pub fn compare_at_fresh_points<E>(
    point: impl Fn(u64) -> Option<FieldPoint>,
    mut at: impl FnMut(&FieldPoint, u64) -> Option<Result<(), E>>,
) -> Result<(), Disagreement<E>> {
    let (mut compared, mut missing) = (0, 0);
    for number in 1..=MAX_TRIED_POINTS {
        let Some(point) = point(number) else {
            missing += 1;
            match missing {
                MAX_FAILED_SEARCHES => break,
                _ => continue,
            }
        };
        match at(&point, number) {
            None => continue,
            Some(Ok(())) => compared += 1,
            Some(Err(what)) => return Err(Disagreement::Differs(what)),
        }
        if compared == COMPARED_POINTS {
            return Ok(());
        }
    }
    Err(Disagreement::Nowhere)
}
