//! Square roots modulo p that obey the laws of real roots: √(ab) = √a √b for a, b > 0.
//!
//! A root modulo p is one of two, and nothing there tells which one is positive. The roots of primes are
//! chosen freely, and the roots of positive rationals are products of these. For expressions, only points
//! are used at which the arguments of roots are squares of F_p; their roots that are squares themselves are
//! closed under multiplication.

use super::prime::Residue;
use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};
use rustc_hash::FxHashMap;
use std::cell::RefCell;

/// Bound below which primes are split off; the rest is a square or gets a freely chosen root.
const PRIME_BOUND: u32 = 1 << 12;

/// √c of a positive rational c; `None` where c ≤ 0 or p divides its denominator.
pub fn of_rational<const K: usize>(c: &BigRational) -> Option<Residue<K>> {
    if !c.is_positive() {
        return None;
    }
    Some(of_integer(c.numer()) * of_integer(c.denom()).inv()?)
}

thread_local! {
    /// Roots of long numbers in both fields. Points are tried by the thousand, with the same numbers under
    /// roots.
    static ROOT_CACHE: RefCell<FxHashMap<(BigInt, usize), [u64; 2]>> = RefCell::default();
}
/// Largest number of roots that are remembered.
const MAX_CACHED_ROOTS: usize = 10_000;

/// √n for n > 0, the product of the roots of its primes.
fn of_integer<const K: usize>(n: &BigInt) -> Residue<K> {
    if n.bits() <= 64 {
        return by_primes(n);
    }
    let key = (n.clone(), K);
    if let Some(known) = ROOT_CACHE.with_borrow(|known| known.get(&key).copied()) {
        return Residue::of_parts(known);
    }
    let root = by_primes(n);
    ROOT_CACHE.with_borrow_mut(|known| {
        if known.len() == MAX_CACHED_ROOTS {
            known.clear();
        }
        known.insert(key, root.parts());
    });
    root
}

fn by_primes<const K: usize>(n: &BigInt) -> Residue<K> {
    let (mut rest, mut root) = (n.clone(), Residue::ONE);
    let mut prime = 2;
    while prime < PRIME_BOUND && !rest.is_one() {
        // Numbers below 2^64 are divided faster as machine words.
        if let Some(small) = rest.to_u64() {
            let (small, factor) = split(small, prime);
            return root * factor * of_rough(&BigInt::from(small));
        }
        let divisor = BigInt::from(prime);
        loop {
            let (quotient, remainder) = rest.div_rem(&divisor);
            if !remainder.is_zero() {
                break;
            }
            rest = quotient;
            root = root * choose_root(u64::from(prime));
        }
        prime += if prime == 2 { 1 } else { 2 };
    }
    root * of_rough(&rest)
}

/// Returns the rest of n without its prime factors from `first` on, and the product of the roots of these.
fn split<const K: usize>(mut n: u64, first: u32) -> (u64, Residue<K>) {
    let mut root = Residue::ONE;
    let mut prime = u64::from(first);
    while prime < u64::from(PRIME_BOUND) && n > 1 {
        while n.is_multiple_of(prime) {
            n /= prime;
            root = root * choose_root(prime);
        }
        prime += if prime == 2 { 1 } else { 2 };
    }
    (n, root)
}

/// √n of a number without small prime factors.
fn of_rough<const K: usize>(n: &BigInt) -> Residue<K> {
    let whole = n.sqrt();
    if &whole * &whole == *n {
        return Residue::from_integer(&whole);
    }
    let residue = Residue::from_integer(n);
    residue.sqrt().unwrap_or(Residue::ONE)
}

/// Root that is chosen for a prime, in F_p or F_p(i).
fn choose_root<const K: usize>(prime: u64) -> Residue<K> {
    Residue::new(prime).sqrt().unwrap_or(Residue::ONE)
}
