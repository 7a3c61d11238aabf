//! Powers of sums, and powers with a fractional exponent, which are products with a root √s or with exp(f
//! log s).

use super::{Edge, Function, Graph, Node, NodeId};
use num_rational::BigRational;
use std::cmp::Ordering;

/// Largest number of factors of a product that is analysed.
const MAX_FACTORS: usize = 12;

/// A product w a sᶠ, where a is a constant multiple of s up to the signs of its factors.
pub(crate) struct Power {
    /// Factors of w.
    pub rest: Vec<Edge>,
    /// Factors of a.
    pub base: Vec<Edge>,
    /// The root sᶠ: √s or exp(f log s).
    pub root: Edge,
    /// Exponent f.
    pub exponent: BigRational,
    /// Factors of s that are constant at run time.
    pub constants: Vec<Edge>,
}

impl Graph {
    /// Reads √s or exp(f log s) as the pair of s and f.
    fn root_of(&self, root: Edge) -> Option<(Edge, BigRational)> {
        match self.node(root.node()) {
            Node::Apply(Function::Sqrt, square) => {
                Some((square, BigRational::new(1.into(), 2.into())))
            }
            Node::Apply(Function::Exp, product) => {
                let Node::Mul(a, b) = self.node(product.node()) else {
                    return None;
                };
                let (factor, log) = match self.as_rational(a) {
                    Some(factor) => (factor, b),
                    None => (self.as_rational(b)?, a),
                };
                match self.node(log.node()) {
                    Node::Apply(Function::Log, base) if !log.is_negative() => {
                        let sign = if product.is_negative() { -1 } else { 1 };
                        Some((base, factor * BigRational::from_integer(sign.into())))
                    }
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// Reads a product as a fractional power w a sᶠ. If s has a factor |v|, then a may have v in its place.
    pub(crate) fn fractional_power(&self, id: NodeId) -> Option<Power> {
        let factors = self.whole_factors(Edge::of(id))?;
        (0..factors.len()).find_map(|place| {
            let root = factors[place];
            let (square, exponent) = self.root_of(root)?;
            let mut rest = factors.clone();
            rest.remove(place);
            let (mut base, mut constants) = (Vec::new(), Vec::new());
            for factor in self.whole_factors(square)? {
                if self.is_free(factor.node()) {
                    constants.push(factor);
                    continue;
                }
                let is_there = |wanted: Edge| rest.iter().position(|f| f.abs() == wanted.abs());
                let place = is_there(factor).or_else(|| match self.node(factor.node()) {
                    Node::Apply(Function::Abs, signed) => is_there(signed),
                    _ => None,
                })?;
                base.push(rest.remove(place).abs());
            }
            (!base.is_empty()).then(|| {
                // The signs of the factors that were taken out, including that of the root, are moved to
                // the rest.
                let negative = factors.iter().filter(|f| f.is_negative()).count();
                let left = rest.iter().filter(|f| f.is_negative()).count();
                if (negative - left) % 2 == 1 {
                    rest.push(-self.one());
                }
                Power {
                    rest,
                    base,
                    root: root.abs(),
                    exponent,
                    constants,
                }
            })
        })
    }

    /// Finds a sum of which a product contains the third or a higher power.
    pub(crate) fn power_of_sum(&self, id: NodeId) -> Option<NodeId> {
        let Node::Mul(..) = self.node(id) else {
            return None;
        };
        let factors = self.whole_factors(Edge::of(id))?;
        let times = |base: NodeId| factors.iter().filter(|f| f.node() == base).count();
        let sum = |factor: &Edge| matches!(self.node(factor.node()), Node::Add(..));
        let mut sums = factors.iter().filter(|factor| sum(factor));
        sums.find(|sum| times(sum.node()) > 2).map(|sum| sum.node())
    }

    /// Takes the root of a product of even powers: √(c a⁴ b⁶) = √c a² |b| b², which is differentiable where
    /// a and b are 0. `None` if another factor varies, or if no power is higher than a square.
    pub(super) fn even_root(&mut self, square: Edge) -> Option<Edge> {
        let mut factors = self.whole_factors(square)?;
        let negative = factors.iter().filter(|factor| factor.is_negative()).count();
        if factors.len() < 2 || negative % 2 == 1 {
            return None;
        }
        factors.iter_mut().for_each(|factor| *factor = factor.abs());
        factors.sort_unstable();
        let (constants, varying): (Vec<Edge>, Vec<Edge>) =
            (factors.into_iter()).partition(|factor| self.class(factor.node()) == 0);
        let powers: Vec<&[Edge]> = varying.chunk_by(|a, b| a == b).collect();
        let is_odd = |power: &&[Edge]| power.len() % 2 == 1;
        if powers.iter().any(is_odd) || powers.iter().all(|power| power.len() < 4) {
            return None;
        }
        let mut constant = self.one();
        for factor in constants {
            constant = self.mul(constant, factor);
        }
        if self.side(constant) != Some(Ordering::Greater) {
            return None;
        }
        let mut root = self.apply(Function::Sqrt, constant);
        for power in powers {
            let (base, half) = (power[0], power.len() / 2);
            let size = match half {
                // √(e²)² is e² at every point, whereas |e|² is e² only for real e.
                1 => {
                    let square = self.mul(base, base);
                    self.apply(Function::Sqrt, square)
                }
                half if half % 2 == 1 => self.apply(Function::Abs, base),
                _ => self.one(),
            };
            root = self.mul(root, size);
            for _ in 0..half - half % 2 {
                root = self.mul(root, base);
            }
        }
        Some(root)
    }

    /// Returns the factors of a product, with the sign of the edge moved to one of them; `None` if there
    /// are too many.
    fn whole_factors(&self, edge: Edge) -> Option<Vec<Edge>> {
        let (mut factors, mut stack) = (Vec::new(), vec![edge]);
        while let Some(edge) = stack.pop() {
            match self.node(edge.node()) {
                Node::Mul(a, b) => stack.extend([b, a.signed(edge.is_negative())]),
                _ => factors.push(edge),
            }
            if factors.len() + stack.len() > MAX_FACTORS {
                return None;
            }
        }
        Some(factors)
    }
}
