//! Splitting of sums that are too long to examine all pairs of their products: f = Σ_l l q_l + r, by their
//! most frequent literals l, until every sum is short.

use super::system::{Literal, Literals, Product, System};
use std::collections::BTreeMap;

/// Affordable number of pairs of products in all sums together.
const MAX_PAIRS: usize = 60_000;

/// Splits the long sums of a system.
pub(super) fn split(mut system: System) -> System {
    let pairs = |system: &System| -> usize {
        let sums = system.sums.iter();
        sums.map(|sum| sum.len() * sum.len() / 2).sum()
    };
    if pairs(&system) <= MAX_PAIRS {
        return system;
    }
    let products: usize = system.sums.iter().map(Vec::len).sum();
    let most = (2 * MAX_PAIRS / products.max(1)).clamp(8, 200);
    let mut index = 0;
    while index < system.sums.len() {
        while system.sums[index].len() > most {
            let (part, literal) = take_part(&mut system.sums[index], most);
            let new = (system.inputs.len() + system.sums.len()) as Literal;
            let mut literals = Literals::from_slice(&[new]);
            literals.extend(literal);
            literals.sort_unstable();
            system.sums[index].push(Product {
                negative: false,
                literals,
            });
            system.sums.push(part);
        }
        index += 1;
    }
    system
}

/// Takes q_l and its literal l from a sum; if no literal occurs twice, takes some products without a
/// literal.
fn take_part(sum: &mut Vec<Product>, most: usize) -> (Vec<Product>, Option<Literal>) {
    let mut counts: BTreeMap<Literal, usize> = BTreeMap::new();
    for product in sum.iter() {
        for power in product.literals.chunk_by(|a, b| a == b) {
            *counts.entry(power[0]).or_default() += 1;
        }
    }
    let most_frequent = counts.iter().max_by_key(|entry| entry.1);
    let Some((&literal, _)) = most_frequent.filter(|entry| *entry.1 > 1) else {
        let kept = sum.len() - most;
        return (sum.split_off(kept), None);
    };
    let (with, without): (Vec<Product>, Vec<Product>) = std::mem::take(sum)
        .into_iter()
        .partition(|product| product.literals.contains(&literal));
    *sum = without;
    let divided = with.into_iter().map(|mut product| {
        if let Ok(position) = product.literals.binary_search(&literal) {
            product.literals.remove(position);
        }
        product
    });
    (divided.collect(), Some(literal))
}
