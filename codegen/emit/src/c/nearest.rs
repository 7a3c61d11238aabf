//! From where an array is given to a part, so that most of its places are near.

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

/// From where in an array most of these places are near, so many before or behind: 0 where no other is better.
pub fn nearest(places: impl Iterator<Item = usize>, near: usize, length: usize) -> usize {
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
