//! Finds the configuration nearest to a start that violates φ, for error messages.

use super::points::Points;
use crate::algebra::graph::Edge;
use crate::algebra::residue_pair::Random;

/// Largest number of steps from one initial guess.
const STEPS: usize = 200;
/// Number of random initial guesses, in addition to the start and its neighbours along each coordinate.
const GUESSES: usize = 12;

/// Result of the search.
#[derive(Clone, Debug, PartialEq)]
pub enum Nearest {
    /// A configuration that satisfies φ = 0.
    Found(Vec<f64>),
    /// No configuration; the smallest |φ| that was reached.
    Nowhere(f64),
}

/// Searches for x with φ(x) = 0 near a start; `numbers` are the values of all symbols there.
pub fn nearest(points: &Points, phi: &[(Edge, String)], numbers: &[f64], x: &[f64]) -> Nearest {
    let equations = points.equations(phi);
    let mut least = f64::INFINITY;
    for guess in guesses(x) {
        let end = equations.descend(guess, numbers, STEPS, true);
        if end.is_close {
            return Nearest::Found(end.x);
        }
        least = least.min(end.residual);
    }
    Nearest::Nowhere(least)
}

/// Returns the start, its neighbours along each coordinate, and some random points around it.
fn guesses(x: &[f64]) -> Vec<Vec<f64>> {
    let mut all = vec![x.to_vec()];
    for alpha in 0..x.len() {
        let mut guess = x.to_vec();
        guess[alpha] += 1.0;
        all.push(guess);
    }
    let mut random = Random::new(0x6e65_6172);
    let mut unit = || (random.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
    all.extend((0..GUESSES).map(|_| x.iter().map(|x| x + unit()).collect()));
    all
}
