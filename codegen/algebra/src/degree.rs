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
use std::rc::Rc;

/// What is divided by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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

/// Powers m other than 0 of divisors, by their numbers in order.
type Powers = Vec<(u32, f64)>;

/// A node as N / Π d^m; many nodes have the same denominator.
#[derive(Clone, Debug, Default)]
struct Fraction {
    degree: f64,
    powers: Rc<Powers>,
}

impl Fraction {
    /// A polynomial.
    fn of_degree(degree: f64) -> Self {
        Fraction {
            degree,
            ..Fraction::default()
        }
    }
}

/// Bounds of degrees of nodes of a graph.
pub struct Degrees<'a> {
    graph: &'a Graph,
    /// The groups that symbols belong to, by their indices: those of a coordinate kind with a norm.
    groups: Vec<Option<usize>>,
    fractions: FxHashMap<NodeId, Fraction>,
    /// The divisors by their numbers, and their degrees.
    numbers: FxHashMap<Divisor, u32>,
    degrees: Vec<f64>,
}

impl<'a> Degrees<'a> {
    /// Coordinates of a kind with a norm have a group; symbols beyond the end of the list have none.
    pub fn new(graph: &'a Graph, groups: Vec<Option<usize>>) -> Self {
        Degrees {
            graph,
            groups,
            fractions: FxHashMap::default(),
            numbers: FxHashMap::default(),
            degrees: Vec::new(),
        }
    }

    /// The degree of a difference of sums of products of expressions: N over a denominator that is common
    /// to all of them.
    pub fn bound(&mut self, expressions: &[Edge]) -> f64 {
        let mut roots = 0;
        for id in self.graph.reachable(expressions) {
            roots += i32::from(self.graph.node(id).is_root());
            if !self.fractions.contains_key(&id) {
                let fraction = self.fraction(id);
                self.fractions.insert(id, fraction);
            }
        }
        self.common(expressions) * 4f64.powi(roots)
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
                Some(group) => self.over([(Divisor::Group(group), 1.0)]),
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
                    powers: Rc::new(merged(
                        &above.powers,
                        &merged(&inverse, &once, |m, n| m + n),
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
            Law::Power => Fraction::of_degree(form().iter().map(|(_, c)| count(c)).sum()),
            Law::Radical => {
                let below = self.read(argument);
                Fraction::of_degree((self.whole(&below) / 2.0).ceil())
            }
            // A random number that belongs to the value of a, and may be a factor of a.
            Law::Side => {
                let mut fraction = self.read(argument);
                fraction.degree += 1.0;
                fraction
            }
            Law::Linear => self.read(argument),
            Law::Free => Fraction::of_degree(1.0),
        }
    }

    /// The number of a divisor, of this degree.
    fn number(&mut self, divisor: Divisor, degree: f64) -> u32 {
        let next = self.degrees.len() as u32;
        let number = *self.numbers.entry(divisor).or_insert(next);
        if number == next {
            self.degrees.push(degree);
        }
        number
    }

    /// Products of coordinates of norms.
    fn over(&mut self, norms: impl IntoIterator<Item = (Divisor, f64)>) -> Fraction {
        let (mut degree, mut powers) = (0.0, Powers::new());
        for (divisor, power) in norms {
            let number = self.number(divisor, 2.0);
            degree += 2.0 * power;
            powers = merged(&powers, &vec![(number, power)], |m, n| m + n);
        }
        Fraction {
            degree,
            powers: Rc::new(powers),
        }
    }

    /// Σ |m| deg d.
    fn below(&self, powers: &Powers) -> f64 {
        let degrees = powers
            .iter()
            .map(|&(d, m)| m.abs() * self.degrees[d as usize]);
        degrees.sum()
    }

    /// N and denominator together.
    fn whole(&self, fraction: &Fraction) -> f64 {
        fraction.degree + self.below(&fraction.powers)
    }

    fn sum(&self, a: &Fraction, b: &Fraction) -> Fraction {
        if Rc::ptr_eq(&a.powers, &b.powers) {
            return Fraction {
                degree: a.degree.max(b.degree),
                powers: a.powers.clone(),
            };
        }
        // A divisor that one side lacks has the power 0 there.
        let powers = merged(&a.powers, &b.powers, f64::max);
        // One with a negative power lacks it in the sum.
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

    /// The largest numerator of the roots over their common denominator, with that.
    fn common(&self, roots: &[Edge]) -> f64 {
        let mut powers = Powers::new();
        let mut most: f64 = 0.0;
        for root in roots {
            let fraction = self.read(*root);
            most = most.max(self.whole(&fraction));
            powers = merged(&powers, &fraction.powers, |m, n| m.max(n.abs()));
        }
        most + self.below(&powers)
    }
}

/// Each divisor of either with its powers in both; 0 where a side has none.
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

/// The powers that a function makes of those of both.
fn merged(a: &Powers, b: &Powers, by: impl Fn(f64, f64) -> f64) -> Powers {
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
        _ => Rc::new(merged(&a.powers, &b.powers, |m, n| m + n)),
    };
    Fraction {
        degree: a.degree + b.degree,
        powers,
    }
}
