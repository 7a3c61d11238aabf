//! Directions that entries of a sparse pattern share: none meets another in a row.

use super::seeds;

/// Entries of one row differ in direction, and no more directions are taken than the longest row needs where no row
/// forces them.
#[test]
fn entries_of_a_row_have_directions_of_their_own() {
    let hull = [0, 1, 2, 3, 4, 5, 8, 9, 10];
    let attitude = [3, 4, 5, 11, 12, 13];
    let mut rows = vec![hull.to_vec(), hull.to_vec(), hull.to_vec()];
    rows.extend([attitude.to_vec(), attitude.to_vec(), attitude.to_vec()]);
    rows.extend([vec![6, 14], vec![7, 15]]);
    let seeds = seeds(&rows, 17);
    for row in &rows {
        let mut own: Vec<usize> = row.iter().map(|&entry| seeds[entry]).collect();
        own.sort_unstable();
        own.dedup();
        assert_eq!(own.len(), row.len(), "{row:?}: {seeds:?}");
    }
    assert_eq!(seeds.iter().max(), Some(&8));
    // Entry 16 moves nothing.
    assert_eq!(seeds[16], 0);
}
