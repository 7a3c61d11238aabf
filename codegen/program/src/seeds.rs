//! Shared directions for the entries of a sparse pattern (colouring of columns).

#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

/// Assigns a direction to each entry (column) of a sparse pattern, so that no two entries of one row share one.
///
/// `rows` lists the entries of each row. The assignment is greedy: entries that occur in most rows come first, and each
/// takes the lowest direction that is free in all of its rows. Entries in no row get direction 0.
pub fn seeds(rows: &[Vec<usize>], entries: usize) -> Vec<usize> {
    let meeting: Vec<Vec<usize>> = (0..entries)
        .map(|entry| {
            (0..rows.len())
                .filter(|&i| rows[i].contains(&entry))
                .collect()
        })
        .collect();
    let mut order: Vec<usize> = (0..entries)
        .filter(|&entry| !meeting[entry].is_empty())
        .collect();
    order.sort_by_key(|&entry| usize::MAX - meeting[entry].len());
    let mut taken = vec![BTreeSet::new(); rows.len()];
    let mut seeds = vec![0; entries];
    for entry in order {
        let free = |direction: &usize| {
            meeting[entry]
                .iter()
                .all(|&i| !taken[i].contains(direction))
        };
        let direction = (0..entries).find(free).unwrap_or_default();
        for &i in &meeting[entry] {
            taken[i].insert(direction);
        }
        seeds[entry] = direction;
    }
    seeds
}
