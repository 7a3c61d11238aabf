//! Tests that arrays are passed from the place near which most of their uses lie.

use super::best_origin;

#[test]
fn arrays_are_given_from_where_most_is_near() {
    let from = |places: &[usize]| best_origin(places.iter().copied(), 16, 100);
    assert_eq!(from(&[]), 0);
    assert_eq!(from(&[0, 5, 15, 40]), 0);
    // 0 to 31 are near 16.
    assert_eq!(from(&[0, 5, 15, 31, 40]), 16);
    assert_eq!(from(&[3, 60, 61, 75]), 76);
    // The origin is within the array, or one behind it at most.
    assert_eq!(from(&[3, 97, 98, 99]), 100);
}
