//! Tests: no two entries of one row share a direction.

use super::seeds;

/// Entries of one row get different directions, and no more directions are used than the longest row needs, as long as
/// the pattern allows it.
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
    // Entry 16 occurs in no row.
    assert_eq!(seeds[16], 0);
}
