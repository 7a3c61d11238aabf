//! Degrees of expressions as rational functions of the random numbers that a point is made of: what the
//! chance of an error of a comparison follows from.
//!
//! Schwartz and Zippel: a polynomial of degree D that is not 0 vanishes at a random point of F_p^k with
//! probability ≤ D/p. Every node is N / Π d^m over the numerators d of what is divided by, where m may be
//! negative; sums are brought to common powers. Then N has at most the degree
//!
//! | node | degree of N, powers m |
//! |---|---|
//! | a + b | max over both of N + Σ (m − mᵃ) deg d; m = max(mᵃ, mᵇ) |
//! | a b | Nᵃ + Nᵇ; mᵃ + mᵇ |
//! | a / b | Nᵃ; mᵃ − mᵇ + 1 for the numerator of b |
//! | coordinates of a circle, a sphere, a rotation | 2; 1 for 1 + t² and its kind |
//! | sin, cos of Σ c a/12 | 2 Σ \|c\|; \|c\| for the circle of a |
//! | sinh, cosh, tanh of Σ c a/12 | the same for the powers of a |
//! | a where c > 0, else b | 1 more than that of a + b |
//! | what depends on the side of 0, of a | Nᵃ + 1 |
//! | √a | ⌈(Nᵃ + Σ m deg d)/2⌉; the bound of the whole is taken four times |
//!
//! A root is a number r with r² = a: a polynomial in r vanishes only where its product with that of −r
//! does, and points at which a is a square are half of all.

use super::function::Law;
use super::graph::{Edge, Function, Graph, Node, NodeId};
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// What is divided by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Divisor {
    /// The numerator of a node.
    Node(NodeId),
    /// The norm that a group of coordinates is divided by, 1 + t² of a circle.
    Group(usize),
    /// The same of the circle of an atom of angles.
    Angle(NodeId),
    /// The powers e and 1 + e² of an atom of exponents.
    Power(NodeId),
}

/// A node as N / Π d^m.
#[derive(Clone, Debug, Default)]
struct Fraction {
    degree: f64,
    powers: BTreeMap<Divisor, f64>,
}

/// Bounds of degrees of nodes of a graph.
pub struct Degrees<'a> {
    graph: &'a Graph,
    /// The group that a symbol belongs to, by its index: those of a coordinate kind with a norm.
    group: &'a dyn Fn(usize) -> Option<usize>,
    fractions: FxHashMap<NodeId, Fraction>,
    divisors: BTreeMap<Divisor, f64>,
    roots: u32,
}

/// The degree of a difference of sums of products of the expressions of a graph: N over a denominator
/// that is common to all of them. Coordinates of a kind with a norm have a group.
pub fn bound(graph: &Graph, roots: &[Edge], group: &dyn Fn(usize) -> Option<usize>) -> f64 {
    let mut degrees = Degrees {
        graph,
        group,
        fractions: FxHashMap::default(),
        divisors: BTreeMap::new(),
        roots: 0,
    };
    for id in graph.reachable(roots) {
        let fraction = degrees.fraction(id);
        degrees.fractions.insert(id, fraction);
    }
    degrees.common(roots) * 4f64.powi(degrees.roots as i32)
}

impl Degrees<'_> {
    fn read(&self, edge: Edge) -> Fraction {
        self.fractions
            .get(&edge.node())
            .cloned()
            .unwrap_or_default()
    }

    fn fraction(&mut self, id: NodeId) -> Fraction {
        match self.graph.node(id) {
            Node::Constant(_) => Fraction::default(),
            Node::Symbol(index) => match (self.group)(index as usize) {
                Some(group) => self.over([(Divisor::Group(group), 1.0)]),
                None => Fraction {
                    degree: 1.0,
                    ..Fraction::default()
                },
            },
            Node::Add(a, b) => self.sum(&self.read(a), &self.read(b)),
            Node::Mul(a, b) => product(self.read(a), &self.read(b), 1.0),
            Node::Div(a, b) => {
                let below = self.read(b);
                let divisor = Divisor::Node(b.node());
                self.divisors.insert(divisor, below.degree);
                let inverse = Fraction {
                    degree: 0.0,
                    powers: below.powers,
                };
                let mut quotient = product(self.read(a), &inverse, -1.0);
                *quotient.powers.entry(divisor).or_default() += 1.0;
                quotient
            }
            Node::Apply(function, a) => self.apply(function, a),
            Node::Select(_, a, b) => {
                let side = Fraction {
                    degree: 1.0,
                    ..Fraction::default()
                };
                let [a, b] = [a, b].map(|edge| product(self.read(edge), &side, 1.0));
                self.sum(&a, &b)
            }
            Node::Atan2(..) | Node::Listed(..) | Node::External(..) => Fraction {
                degree: 1.0,
                ..Fraction::default()
            },
        }
    }

    fn apply(&mut self, function: Function, argument: Edge) -> Fraction {
        let form = || self.graph.form(function, argument);
        // Whole multiples of twelfths, and what is none as one of its own.
        let count = |c: &BigRational| {
            let parts = c * BigRational::from_integer(12.into());
            let parts = if parts.is_integer() {
                parts.abs()
            } else {
                BigRational::one()
            };
            parts.to_f64().unwrap_or(f64::INFINITY)
        };
        match function.row().law {
            law @ (Law::Angle | Law::Hyperbola) => {
                let divisor = match law {
                    Law::Angle => Divisor::Angle,
                    _ => Divisor::Power,
                };
                let angles = form().into_iter();
                let angles = angles.map(|(atom, c)| (divisor(atom), count(&c)));
                let angles: Vec<(Divisor, f64)> = angles.collect();
                self.over(angles)
            }
            Law::Power => Fraction {
                degree: form().iter().map(|(_, c)| count(c)).sum(),
                ..Fraction::default()
            },
            Law::Radical => {
                let below = self.read(argument);
                self.roots += 1;
                Fraction {
                    degree: (self.whole(&below) / 2.0).ceil(),
                    ..Fraction::default()
                }
            }
            // A random number that belongs to the value of a, and may be a factor of a.
            Law::Side => {
                let mut fraction = self.read(argument);
                fraction.degree += 1.0;
                fraction
            }
            Law::Free => Fraction {
                degree: 1.0,
                ..Fraction::default()
            },
        }
    }

    /// Products of coordinates of norms.
    fn over(&mut self, norms: impl IntoIterator<Item = (Divisor, f64)>) -> Fraction {
        let mut fraction = Fraction::default();
        for (divisor, power) in norms {
            self.divisors.insert(divisor, 2.0);
            fraction.degree += 2.0 * power;
            *fraction.powers.entry(divisor).or_default() += power;
        }
        fraction
    }

    fn degree(&self, divisor: &Divisor) -> f64 {
        self.divisors.get(divisor).copied().unwrap_or(0.0)
    }

    /// N and denominator together.
    fn whole(&self, fraction: &Fraction) -> f64 {
        let powers = fraction.powers.iter();
        fraction.degree + powers.map(|(d, m)| m.abs() * self.degree(d)).sum::<f64>()
    }

    fn sum(&self, a: &Fraction, b: &Fraction) -> Fraction {
        let mut powers = a.powers.clone();
        // A divisor that one side lacks has the power 0 there.
        for divisor in a.powers.keys().chain(b.powers.keys()) {
            let of = |f: &Fraction| f.powers.get(divisor).copied().unwrap_or(0.0);
            powers.insert(*divisor, of(a).max(of(b)));
        }
        let raised = |f: &Fraction| {
            let more = powers.iter().map(|(divisor, power)| {
                let own = f.powers.get(divisor).copied().unwrap_or(0.0);
                (power - own) * self.degree(divisor)
            });
            f.degree + more.sum::<f64>()
        };
        Fraction {
            degree: raised(a).max(raised(b)),
            powers,
        }
    }

    /// The largest numerator of the roots over their common denominator, with that.
    fn common(&self, roots: &[Edge]) -> f64 {
        let mut powers: BTreeMap<Divisor, f64> = BTreeMap::new();
        let mut most: f64 = 0.0;
        for root in roots {
            let fraction = self.read(*root);
            most = most.max(self.whole(&fraction));
            for (divisor, power) in fraction.powers {
                let known = powers.entry(divisor).or_default();
                *known = known.max(power.abs());
            }
        }
        most + powers.iter().map(|(d, m)| m * self.degree(d)).sum::<f64>()
    }
}

fn product(mut a: Fraction, b: &Fraction, sign: f64) -> Fraction {
    a.degree += b.degree;
    for (divisor, power) in &b.powers {
        *a.powers.entry(*divisor).or_default() += sign * power;
    }
    a.powers.retain(|_, power| *power != 0.0);
    a
}

#[cfg(test)]
mod tests {
    use super::bound;
    use crate::fp::Random;
    use crate::graph::{Function, Graph};

    #[test]
    fn degrees_are_those_of_the_functions() {
        let mut graph = Graph::new(5, 1);
        let mut random = Random::new(6);
        let [a, b, c] = ["a", "b", "c"].map(|name| graph.symbol(name, 2, random.element()));
        let free = |_: usize| None;
        let product = graph.mul(a, b);
        let cubic = graph.mul(product, c);
        let sum = graph.add(cubic, a);
        assert_eq!(bound(&graph, &[sum], &free), 3.0);
        // 1/(a b c + a) + 1/b: numerator of degree 3, denominator of degree 4; the sum of both, and the
        // denominator once more for sums with others.
        let one = graph.one();
        let (x, y) = (
            graph.div(one, sum).expect("not 0"),
            graph.div(one, b).expect("not 0"),
        );
        let both = graph.add(x, y);
        assert_eq!(bound(&graph, &[both], &free), 3.0 + 4.0 + 4.0);
        // (a b c + a)/(a b c + a + 1) · (a b c + a + 1) never grows.
        let more = graph.add(sum, one);
        let quotient = graph.div(sum, more).expect("not 0");
        let inverse = graph.div(one, quotient).expect("not 0");
        let back = graph.div(b, inverse).expect("not 0");
        assert!(bound(&graph, &[back], &free) <= 4.0 + 3.0 + 3.0 + 6.0);
        // A coordinate of a circle, the sine of 3 a, and a root.
        let circle = |index: usize| (index == 0).then_some(0);
        assert_eq!(bound(&graph, &[a], &circle), 2.0 + 2.0 + 2.0);
        let three = graph.ratio(3, 1);
        let triple = graph.mul(three, a);
        let sine = graph.apply(Function::Sin, triple);
        assert_eq!(bound(&graph, &[sine], &free), 36.0 * 6.0);
        let root = graph.apply(Function::Sqrt, sum);
        assert_eq!(bound(&graph, &[root], &free), 2.0 * 4.0);
    }
}
