//! Sums of sorted lists of terms; terms with coefficient 0 are dropped.

use super::field::Field;
use super::monomial::Monomial;
use super::order::Order;
use std::cmp::Ordering;

/// Adds a few descending terms to an ascending list, without visiting entries below all of them.
pub(super) fn insert_terms<F: Field>(
    order: Order,
    mut list: Vec<(Monomial, F)>,
    terms: impl Iterator<Item = (Monomial, F)>,
) -> Vec<(Monomial, F)> {
    let mut above = list.len();
    for (monomial, value) in terms {
        let found = list[..above].binary_search_by(|known| order.compare(&known.0, &monomial));
        let (Ok(place) | Err(place)) = found;
        above = place;
        let sum = match found {
            Ok(_) => list[place].1.add(&value),
            Err(_) => value,
        };
        match (found, sum.is_zero()) {
            (Ok(_), false) => list[place].1 = sum,
            (Ok(_), true) => drop(list.remove(place)),
            (Err(_), false) => list.insert(place, (monomial, sum)),
            (Err(_), true) => {}
        }
    }
    list
}

/// Adds `count` ascending terms to an ascending list.
pub(super) fn merge_terms<F: Field>(
    order: Order,
    list: Vec<(Monomial, F)>,
    terms: impl Iterator<Item = (Monomial, F)>,
    count: usize,
) -> Vec<(Monomial, F)> {
    let mut result = Vec::with_capacity(list.len() + count);
    let mut list = list.into_iter().peekable();
    for (monomial, value) in terms {
        let mut same = None;
        while let Some(next) = list.peek() {
            match order.compare(&next.0, &monomial) {
                Ordering::Greater => break,
                Ordering::Less => result.extend(list.next()),
                Ordering::Equal => {
                    same = list.next();
                    break;
                }
            }
        }
        let sum = match same {
            Some((_, old)) => old.add(&value),
            None => value,
        };
        if !sum.is_zero() {
            result.push((monomial, sum));
        }
    }
    result.extend(list);
    result
}
