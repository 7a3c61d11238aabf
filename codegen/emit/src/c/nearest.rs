//! Picks the origin from which a part addresses an array, so that most entries that it uses are near.

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

/// Returns the index in an array from which most of `places` are within `near` entries before or behind, to be the
/// offset of a pointer. Returns 0 if no other origin is better.
pub fn best_origin(places: impl Iterator<Item = usize>, near: usize, length: usize) -> usize {
    let mut count: BTreeMap<usize, usize> = BTreeMap::new();
    for place in places {
        *count.entry(place).or_default() += 1;
    }
    let within = |origin: usize| -> usize {
        let places = count.range(origin.saturating_sub(near)..origin + near);
        places.map(|(_, count)| count).sum()
    };
    let mut best = (within(0), 0);
    for origin in count.keys().map(|first| (first + near).min(length)) {
        let found = within(origin);
        if found > best.0 {
            best = (found, origin);
        }
    }
    best.1
}
