//! Bounds on the degrees of expressions as rational functions of the random numbers that define a point.
//! They bound the probability that a comparison of values modulo p is wrong.
//!
//! By the lemma of Schwartz and Zippel, a polynomial of degree D that is not 0 vanishes at a random point
//! of F_p^k with probability ≤ D/p. Every node is written as N / Π d^m, where the divisors d are the
//! numerators of expressions that are divided by, and m may be negative. Sums are brought to common powers.
//! Then the degree of N and the powers m are at most
//!
//! | node | degree of N, powers m |
//! |---|---|
//! | a + b | max over both of N + Σ (m − mᵃ) deg d; m = max(mᵃ, mᵇ) |
//! | a b | Nᵃ + Nᵇ; mᵃ + mᵇ |
//! | a / b | Nᵃ; mᵃ − mᵇ + 1 for the numerator of b |
//! | coordinates of a circle, a sphere, a rotation | 2; 1 for the norm, such as 1 + t² |
//! | sin, cos of Σ c a/12 | 2 Σ \|c\|; \|c\| for the norm of the circle of a |
//! | sinh, cosh, tanh of Σ c a/12 | the same for the powers of a |
//! | a where c > 0, else b | 1 more than that of a + b |
//! | functions of the sign of a | Nᵃ + 1 |
//! | √a | ⌈(Nᵃ + Σ m deg d)/2⌉; each root multiplies the final bound by 4 |
//!
//! A root is a number r with r² = a. A polynomial in r vanishes only where its product with the same
//! polynomial in −r does, and a is a square at half of all points.

use super::function::Law;
use super::graph::{Edge, Function, Graph, Node, NodeId};
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive};
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// Divisor d of a fraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Divisor {
    /// Numerator of a node that is divided by.
    Node(NodeId),
    /// Norm that a group of coordinates is divided by, such as 1 + t² of a circle.
    Group(usize),
    /// Norm 1 + t² of the circle of an atom of angles.
    Angle(NodeId),
    /// Powers e and 1 + e² of an atom of exponents.
    Power(NodeId),
}

/// Nonzero powers m of divisors, sorted by the numbers of the divisors.
type Powers = Vec<(u32, f64)>;

/// A node as N / Π d^m. Powers are shared, because many nodes have the same denominator.
#[derive(Clone, Debug, Default)]
struct Fraction {
    degree: f64,
    powers: Rc<Powers>,
}

impl Fraction {
    /// Creates the fraction of a polynomial.
    fn of_degree(degree: f64) -> Self {
        Fraction {
            degree,
            ..Fraction::default()
        }
    }
}

/// Calculator of bounds on the degrees of the nodes of a graph.
pub struct DegreeBounds<'a> {
    graph: &'a Graph,
    /// Group of each symbol, by symbol index; only coordinates of a kind with a norm have one.
    groups: Vec<Option<usize>>,
    fractions: FxHashMap<NodeId, Fraction>,
    /// Numbers of the divisors, which are indices into `degrees`.
    numbers: FxHashMap<Divisor, u32>,
    degrees: Vec<f64>,
}

impl<'a> DegreeBounds<'a> {
    /// Creates a calculator of bounds on the degrees of nodes, as rational functions of the random numbers of a point.
    /// `groups` holds the group of every coordinate of a kind with a norm; symbols
    /// beyond the end of the list have none.
    pub fn new(graph: &'a Graph, groups: Vec<Option<usize>>) -> Self {
        DegreeBounds {
            graph,
            groups,
            fractions: FxHashMap::default(),
            numbers: FxHashMap::default(),
            degrees: Vec::new(),
        }
    }

    /// Bounds the degree of a difference of sums of products of expressions: N over a denominator that is
    /// common to all of them.
    pub fn bound(&mut self, expressions: &[Edge]) -> f64 {
        let mut roots = 0;
        for id in self.graph.reachable(expressions) {
            roots += i32::from(self.graph.node(id).is_root());
            if !self.fractions.contains_key(&id) {
                let fraction = self.fraction(id);
                self.fractions.insert(id, fraction);
            }
        }
        self.common_degree(expressions) * 4f64.powi(roots)
    }

    fn read(&self, edge: Edge) -> Fraction {
        self.fractions
            .get(&edge.node())
            .cloned()
            .unwrap_or_default()
    }

    fn fraction(&mut self, id: NodeId) -> Fraction {
        match self.graph.node(id) {
            Node::Constant(_) => Fraction::default(),
            Node::Symbol(index) => match self.groups.get(index as usize).copied().flatten() {
                Some(group) => self.norm_product([(Divisor::Group(group), 1.0)]),
                None => Fraction::of_degree(1.0),
            },
            Node::Add(a, b) => self.sum(&self.read(a), &self.read(b)),
            Node::Mul(a, b) => product(&self.read(a), &self.read(b)),
            Node::Div(a, b) => {
                let (above, below) = (self.read(a), self.read(b));
                let divisor = self.number(Divisor::Node(b.node()), below.degree);
                let inverse = below.powers.iter().map(|&(d, m)| (d, -m)).collect();
                let once = vec![(divisor, 1.0)];
                Fraction {
                    degree: above.degree,
                    powers: Rc::new(merge_powers(
                        &above.powers,
                        &merge_powers(&inverse, &once, |m, n| m + n),
                        |m, n| m + n,
                    )),
                }
            }
            Node::Apply(function, a) => self.apply(function, a),
            Node::Select(_, a, b) => {
                let mut fraction = self.sum(&self.read(a), &self.read(b));
                fraction.degree += 1.0;
                fraction
            }
            Node::Atan2(..) | Node::Listed(..) | Node::External(..) => Fraction::of_degree(1.0),
        }
    }

    fn apply(&mut self, function: Function, argument: Edge) -> Fraction {
        let form = || self.graph.form(function, argument);
        // Coefficients in twelfths; one that is not a whole multiple counts as a single part of its own.
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
                self.norm_product(angles)
            }
            Law::Power => Fraction::of_degree(form().iter().map(|(_, c)| count(c)).sum()),
            Law::Radical => {
                let below = self.read(argument);
                Fraction::of_degree((self.degree_of(&below) / 2.0).ceil())
            }
            // The value is a random number that belongs to the value of a, possibly times a.
            Law::Side => {
                let mut fraction = self.read(argument);
                fraction.degree += 1.0;
                fraction
            }
            Law::Linear => self.read(argument),
            Law::Free => Fraction::of_degree(1.0),
        }
    }

    /// Returns the number of a divisor; a new divisor is entered with this degree.
    fn number(&mut self, divisor: Divisor, degree: f64) -> u32 {
        let next = self.degrees.len() as u32;
        let number = *self.numbers.entry(divisor).or_insert(next);
        if number == next {
            self.degrees.push(degree);
        }
        number
    }

    /// Returns the fraction of a product of coordinates with norms, given by the norms and their powers.
    fn norm_product(&mut self, norms: impl IntoIterator<Item = (Divisor, f64)>) -> Fraction {
        let (mut degree, mut powers) = (0.0, Powers::new());
        for (divisor, power) in norms {
            let number = self.number(divisor, 2.0);
            degree += 2.0 * power;
            powers = merge_powers(&powers, &vec![(number, power)], |m, n| m + n);
        }
        Fraction {
            degree,
            powers: Rc::new(powers),
        }
    }

    /// Σ |m| deg d.
    fn norm_degree(&self, powers: &Powers) -> f64 {
        let degrees = powers
            .iter()
            .map(|&(d, m)| m.abs() * self.degrees[d as usize]);
        degrees.sum()
    }

    /// Degree of N plus that of the powers, N + Σ |m| deg d.
    fn degree_of(&self, fraction: &Fraction) -> f64 {
        fraction.degree + self.norm_degree(&fraction.powers)
    }

    fn sum(&self, a: &Fraction, b: &Fraction) -> Fraction {
        if Rc::ptr_eq(&a.powers, &b.powers) {
            return Fraction {
                degree: a.degree.max(b.degree),
                powers: a.powers.clone(),
            };
        }
        // A divisor that is missing on one side has the power 0 there.
        let powers = merge_powers(&a.powers, &b.powers, f64::max);
        // So one with a negative power on the other side has the power 0 in the sum.
        let raised = |f: &Fraction| {
            let mut degree = f.degree;
            merge(&powers, &f.powers, |number, all, own| {
                degree += (all - own) * self.degrees[number as usize];
            });
            degree
        };
        Fraction {
            degree: raised(a).max(raised(b)),
            powers: if powers == *a.powers {
                a.powers.clone()
            } else {
                Rc::new(powers)
            },
        }
    }

    /// Largest degree of the numerators of the roots over their common denominator, plus the degree of that
    /// denominator.
    fn common_degree(&self, roots: &[Edge]) -> f64 {
        let mut powers = Powers::new();
        let mut most: f64 = 0.0;
        for root in roots {
            let fraction = self.read(*root);
            most = most.max(self.degree_of(&fraction));
            powers = merge_powers(&powers, &fraction.powers, |m, n| m.max(n.abs()));
        }
        most + self.norm_degree(&powers)
    }
}

/// Calls `each` with every divisor of either list and its powers in both, 0 where it is missing.
fn merge(a: &Powers, b: &Powers, mut each: impl FnMut(u32, f64, f64)) {
    let take = |side: &Powers, place: &mut usize, number: u32| match side.get(*place) {
        Some(&(known, power)) if known == number => {
            *place += 1;
            power
        }
        _ => 0.0,
    };
    let (mut in_a, mut in_b) = (0, 0);
    loop {
        let next = [a.get(in_a), b.get(in_b)].into_iter().flatten();
        let Some(number) = next.map(|(number, _)| *number).min() else {
            return;
        };
        each(
            number,
            take(a, &mut in_a, number),
            take(b, &mut in_b, number),
        );
    }
}

/// Merges two lists of powers with the function `by`, and drops powers of 0.
fn merge_powers(a: &Powers, b: &Powers, by: impl Fn(f64, f64) -> f64) -> Powers {
    let mut all = Powers::with_capacity(a.len().max(b.len()));
    merge(a, b, |number, m, n| {
        let power = by(m, n);
        if power != 0.0 {
            all.push((number, power));
        }
    });
    all
}

fn product(a: &Fraction, b: &Fraction) -> Fraction {
    let powers = match (a.powers.is_empty(), b.powers.is_empty()) {
        (_, true) => a.powers.clone(),
        (true, _) => b.powers.clone(),
        _ => Rc::new(merge_powers(&a.powers, &b.powers, |m, n| m + n)),
    };
    Fraction {
        degree: a.degree + b.degree,
        powers,
    }
}
