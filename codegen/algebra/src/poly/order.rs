//! Monomial orders: total orders with 1 ≤ m, and a ≤ b implies a m ≤ b m.
//!
//! In all of them, a variable with a smaller index is bigger: x_0 > x_1 > ….

use super::monomial::{Monomial, Var};
use std::cmp::Ordering;

/// A monomial order, which decides which of two monomials is bigger.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Order {
    /// Degree first; then the smaller exponent of the smallest variable in which they differ.
    #[default]
    Grevlex,
    /// The bigger exponent of the biggest variable in which they differ.
    Lex,
    /// Eliminates the variables below the split: these are compared by grevlex first, then the others.
    Block(Var),
}

impl Order {
    /// Compares two monomials.
    pub fn compare(self, a: &Monomial, b: &Monomial) -> Ordering {
        let (a, b) = (a.powers(), b.powers());
        match self {
            Order::Grevlex => grevlex(a, b),
            Order::Lex => lex(a, b),
            Order::Block(split) => {
                let (a_big, a_small) = a.split_at(a.partition_point(|power| power.0 < split));
                let (b_big, b_small) = b.split_at(b.partition_point(|power| power.0 < split));
                grevlex(a_big, b_big).then_with(|| grevlex(a_small, b_small))
            }
        }
    }
}

fn lex(a: &[(Var, u32)], b: &[(Var, u32)]) -> Ordering {
    for (x, y) in a.iter().zip(b) {
        match y.0.cmp(&x.0).then(x.1.cmp(&y.1)) {
            Ordering::Equal => {}
            decided => return decided,
        }
    }
    a.len().cmp(&b.len())
}

fn grevlex(a: &[(Var, u32)], b: &[(Var, u32)]) -> Ordering {
    let degree = |powers: &[(Var, u32)]| powers.iter().map(|power| power.1).sum::<u32>();
    let by_degree = degree(a).cmp(&degree(b));
    if by_degree != Ordering::Equal {
        return by_degree;
    }
    for (x, y) in a.iter().rev().zip(b.iter().rev()) {
        match y.0.cmp(&x.0).then(y.1.cmp(&x.1)) {
            Ordering::Equal => {}
            decided => return decided,
        }
    }
    // With equal degrees and one list a tail of the other, the monomials are equal.
    Ordering::Equal
}
