//! Shortens polynomials by c² + s² = 1. A normal form applies this in one direction only, and
//! c² → 1 − s² may lengthen a polynomial that s² → 1 − c² shortens.

use hamel_algebra::graph::{Edge, Function, Graph, Node};
use hamel_algebra::poly::monomial::{Monomial, Var};
use hamel_algebra::poly::order::Order;
use hamel_algebra::poly::polynomial::Poly;
use hamel_algebra::topoly::OPAQUE;
use hamel_language::model::layout::Block;
use num_rational::BigRational;

/// Largest number of terms of a polynomial that is processed.
const MAX_TERMS: usize = 300;

/// Returns pairs of variables on a unit circle: coordinates on S¹, and cosine and sine of a common angle.
pub fn pairs(
    graph: &Graph,
    first: Var,
    blocks: &[Block],
    polynomial: &Poly<BigRational>,
) -> Vec<(Var, Var)> {
    let mut pairs = Vec::new();
    let mut place = first;
    for block in blocks {
        if *block == Block::Circle {
            pairs.push((place, place + 1));
        }
        place += block.len() as Var;
    }
    let angle = |var: Var, wanted: Function| -> Option<Edge> {
        match graph.node(var.checked_sub(OPAQUE)?) {
            Node::Apply(function, angle) if function == wanted => Some(angle),
            _ => None,
        }
    };
    let variables = polynomial.variables();
    for &cos in &variables {
        let Some(of) = angle(cos, Function::Cos) else {
            continue;
        };
        let sines = variables.iter().copied();
        let mut sines = sines.filter(|&var| angle(var, Function::Sin) == Some(of));
        pairs.extend(sines.next().map(|sin| (cos, sin)));
    }
    pairs
}

/// Returns the shortest polynomial found by substituting squares on circles, one circle after
/// the other.
pub fn shorten(polynomial: Poly<BigRational>, pairs: &[(Var, Var)]) -> Poly<BigRational> {
    let mut best = polynomial;
    for &(c, s) in pairs {
        for (square, other) in [(c, s), (s, c)] {
            if best.terms().len() > MAX_TERMS {
                return best;
            }
            match replace_square(&best, square, other) {
                Some(replace_square) if replace_square.terms().len() < best.terms().len() => {
                    best = replace_square
                }
                _ => (),
            }
        }
    }
    best
}

/// Replaces every square² by 1 − other²; `None` if there is no square.
fn replace_square(
    polynomial: &Poly<BigRational>,
    square: Var,
    other: Var,
) -> Option<Poly<BigRational>> {
    let squares = |monomial: &Monomial| monomial.exponent(square) / 2;
    if polynomial.terms().iter().all(|term| squares(&term.0) == 0) {
        return None;
    }
    let circle = Poly::one().sub(&Poly::var(other).pow(2));
    let mut terms = Vec::new();
    for (monomial, c) in polynomial.terms() {
        let squares = squares(monomial);
        if squares == 0 {
            terms.push((monomial.clone(), c.clone()));
            continue;
        }
        let rest = monomial.powers().iter().copied();
        let rest = rest.filter(|&(var, _)| var != square);
        let rest = Monomial::from_powers(rest.chain([(square, monomial.exponent(square) % 2)]));
        let power = circle.pow(squares);
        let products = power.terms().iter();
        terms.extend(products.map(|(factor, sign)| (rest.mul(factor), sign * c)));
    }
    Some(Poly::from_terms(Order::default(), terms))
}
