//! Test for jumps: whether expressions are continuous where they change from one branch to another.
//!
//! For every c that decides a branch of an expression, the expression is compared with itself on both sides
//! of c = 0: once with the branches for c > 0, and once with those for c < 0. Both have to be equal at c =
//! 0. Each factor f of c is examined separately. At f = 0, f itself can be replaced by 0, a term of f by
//! the negative sum of the others, and a symbol s in which f is linear by the right-hand side of s = s − f
//! / (∂f/∂s). One such replacement is made on both sides. If it makes them equal, they are equal at f = 0,
//! whatever else holds there; if none does, nothing is known.

use super::derivation::Derivation;
use super::graph::{Edge, Function, Graph, Node, NodeId};
use super::transplant::merge;
use num_traits::Signed;
use std::collections::BTreeSet;

/// Largest number of terms of a sum that are tried.
const MAX_TERMS: usize = 12;

/// Largest number of symbols that are tried.
const MAX_SYMBOLS: usize = 8;

/// Rule for what can change: nothing that is written in `still` classes only; symbols that are not `free`
/// cannot be moved alone.
#[derive(Clone, Copy)]
struct Motion<'a> {
    still: u8,
    free: &'a dyn Fn(NodeId) -> bool,
}

/// A node, and an expression that it equals.
type Equation = (NodeId, Edge);

impl Graph {
    /// Finds an expression at whose zeros the expressions may jump: the first c for which they were not
    /// found to be equal on both sides. Whatever is written in `still` classes only never changes, and
    /// symbols that are not `free` cannot be moved alone.
    pub fn find_discontinuity(
        &self,
        edges: &[Edge],
        still: u8,
        free: &dyn Fn(NodeId) -> bool,
    ) -> Option<Edge> {
        let chosen = |&id: &NodeId| match self.node(id) {
            // |c| is continuous.
            Node::Apply(Function::Abs, _) => None,
            _ => self.condition_of(id),
        };
        let moving = Motion { still, free };
        let reachable = self.reachable(edges);
        let all: BTreeSet<Edge> = reachable.iter().filter_map(chosen).map(Edge::abs).collect();
        let mut all = all
            .into_iter()
            .filter(|by| self.is_moving(*by, moving))
            .peekable();
        all.peek()?;
        let mut graph = self.clone();
        all.find(|by| !graph.is_continuous_at(edges, *by, moving))
    }

    fn is_moving(&self, edge: Edge, moving: Motion<'_>) -> bool {
        self.class(edge.node()) & !moving.still != 0
    }

    /// Whether the expressions are found to be equal on both sides of c = 0.
    fn is_continuous_at(&mut self, edges: &[Edge], by: Edge, moving: Motion<'_>) -> bool {
        let factors = self.factors(by, moving);
        factors.into_iter().all(|factor| {
            let equal = |graph: &mut Graph, set: Equation| {
                let above = graph.one_sided_values(edges, by, false, set);
                above.is_some() && above == graph.one_sided_values(edges, by, true, set)
            };
            let terms = self.solve_for_terms(factor, moving);
            let zero = (factor.node(), self.zero());
            terms.into_iter().chain([zero]).any(|set| equal(self, set)) || {
                let lines = self.solve_for_symbols(factor, moving);
                lines.into_iter().any(|set| equal(self, set))
            }
        })
    }

    /// Returns the factors that change sign, or are 0, where c changes sign, or is 0.
    fn factors(&self, by: Edge, moving: Motion<'_>) -> BTreeSet<Edge> {
        let mut factors = BTreeSet::new();
        let mut rest = vec![by.abs()];
        while let Some(edge) = rest.pop() {
            match self.node(edge.node()) {
                _ if !self.is_moving(edge, moving) => {}
                Node::Mul(a, b) => rest.extend([a, b]),
                Node::Div(a, b) if self.is_positive(b) => rest.push(a),
                Node::Div(a, b) => rest.extend([a, b]),
                Node::Apply(Function::Exp | Function::Cosh, _) => {}
                Node::Apply(Function::Abs | Function::Sqrt | Function::Norm, a) => {
                    rest.push(a.abs());
                }
                _ => {
                    factors.insert(edge.abs());
                }
            }
        }
        factors
    }

    /// Whether a divisor is positive, as far as its form tells.
    fn is_positive(&self, edge: Edge) -> bool {
        if let Some(number) = self.as_rational(edge) {
            return number.is_positive();
        }
        match self.node(edge.node()) {
            _ if edge.is_negative() => false,
            Node::Add(a, b) => self.is_positive(a) && self.is_positive(b),
            Node::Mul(a, b) => a == b || self.is_positive(a) && self.is_positive(b),
            Node::Apply(Function::Exp | Function::Cosh | Function::Abs, _) => true,
            node => node.is_root(),
        }
    }

    /// Solves sum = 0 for each of its terms, and for the moving factor of a term whose other factor does
    /// not move.
    fn solve_for_terms(&mut self, sum: Edge, moving: Motion<'_>) -> Vec<Equation> {
        let mut found = Vec::new();
        let mut rest = vec![sum];
        while let Some(edge) = rest.pop() {
            let negative = |other: Edge| other.signed(edge.is_negative());
            let node = self.node(edge.node());
            if let Node::Add(a, b) = node {
                rest.extend([negative(b), negative(a)]);
            } else if self.is_moving(edge, moving) && edge.node() != sum.node() {
                found.push((edge, self.one()));
                if let Node::Mul(a, b) = node {
                    let pairs = [(a, b), (b, a)].into_iter();
                    let pairs = pairs.filter(|(_, factor)| !self.is_moving(*factor, moving));
                    found.extend(pairs.map(|(term, factor)| (negative(term), factor)));
                }
            }
            if found.len() > MAX_TERMS {
                break;
            }
        }
        let equation = |(term, factor): (Edge, Edge)| {
            let all = self.div(sum, factor)?;
            let value = self.sub(term, all);
            Some((term.node(), value.signed(term.is_negative())))
        };
        found.into_iter().filter_map(equation).collect()
    }

    /// Solves an expression that is 0 for the symbols in which it is linear.
    fn solve_for_symbols(&mut self, zero: Edge, moving: Motion<'_>) -> Vec<Equation> {
        let below = self.reachable(&[zero]);
        // Choices inside the expression have other slopes elsewhere.
        if below.iter().any(|&id| self.condition_of(id).is_some()) {
            return Vec::new();
        }
        let symbol = |id: &NodeId| matches!(self.node(*id), Node::Symbol(_));
        let symbols: Vec<NodeId> = below.into_iter().filter(symbol).collect();
        let line = |symbol: NodeId| self.solve_for_symbol(symbol, zero, moving);
        symbols
            .into_iter()
            .filter_map(line)
            .take(MAX_SYMBOLS)
            .collect()
    }

    fn solve_for_symbol(
        &mut self,
        symbol: NodeId,
        zero: Edge,
        moving: Motion<'_>,
    ) -> Option<Equation> {
        if !self.is_moving(Edge::of(symbol), moving) {
            return None;
        }
        let slope = self.linear_slope(symbol, zero)?;
        // Where the slope is 0 as well, the equation says nothing about the symbol. That must not be the
        // case on a whole component of f = 0.
        if !self
            .factors(slope, moving)
            .into_iter()
            .all(|factor| self.is_nonzero_on(factor, zero, moving))
        {
            return None;
        }
        let back = self.div(zero, slope)?;
        Some((symbol, self.sub(Edge::of(symbol), back)))
    }

    /// Returns the slope along a symbol, if the expression is linear in it.
    fn linear_slope(&mut self, symbol: NodeId, edge: Edge) -> Option<Edge> {
        let mut along = Derivation::new([(symbol, self.one())]);
        let slope = along.of(self, edge);
        (slope != self.zero() && along.of(self, slope) == self.zero()).then_some(slope)
    }

    /// Whether an expression is not identically 0 where a factor is. The factor is made 0 by solving it for
    /// one of its symbols.
    fn is_nonzero_on(&mut self, factor: Edge, edge: Edge, moving: Motion<'_>) -> bool {
        let symbol = |id: &NodeId| matches!(self.node(*id), Node::Symbol(_));
        let symbols = self.reachable(&[factor]).into_iter().filter(symbol);
        let symbols: Vec<NodeId> = symbols.filter(|&id| (moving.free)(id)).collect();
        symbols.into_iter().any(|symbol| {
            let Some(slope) = self
                .linear_slope(symbol, factor)
                .filter(|slope| !self.is_moving(*slope, moving))
            else {
                return false;
            };
            let Some(back) = self.div(factor, slope) else {
                return false;
            };
            let moved = self.sub(Edge::of(symbol), back);
            let none = self.zero();
            let there = self.one_sided_values(&[edge], none, false, (symbol, moved));
            there.is_some_and(|there| there[0] != none)
        })
    }

    /// Returns the expressions with the branches for one side of c = 0, and with a node replaced by the
    /// expression that it equals. `None` if they have no value there, or one that depends on the sign of
    /// another expression that is 0, too.
    fn one_sided_values(
        &mut self,
        edges: &[Edge],
        by: Edge,
        below: bool,
        set: Equation,
    ) -> Option<Vec<Edge>> {
        let mut image: Vec<Option<Edge>> = vec![None; self.len()];
        for id in self.reachable(edges) {
            image[id as usize] = match id == set.0 {
                true => Some(set.1),
                false => self.on_side(id, by, below, &image),
            };
        }
        edges.iter().map(|&edge| of(&image, edge)).collect()
    }

    fn on_side(
        &mut self,
        id: NodeId,
        by: Edge,
        below: bool,
        image: &[Option<Edge>],
    ) -> Option<Edge> {
        let negative = |c: Edge| c.is_negative() != below;
        let node = self.node(id);
        match node {
            Node::Constant(_) | Node::Symbol(_) => return Some(Edge::of(id)),
            Node::Select(c, a, b) if c.abs() == by => {
                return of(image, if negative(c) { b } else { a });
            }
            Node::Apply(Function::Sign, c) if c.abs() == by => {
                return Some(self.one().signed(negative(c)));
            }
            Node::Select(c, a, b) => {
                let c = of(image, c)?;
                if let Some(number) = self.as_rational(c) {
                    let (a, b) = (of(image, a), of(image, b));
                    return match number {
                        number if number.is_positive() => a,
                        number if number.is_negative() => b,
                        _ => a.filter(|_| a == b),
                    };
                }
            }
            Node::Apply(Function::Sign, c) if of(image, c)? == self.zero() => return None,
            Node::Div(_, b) if of(image, b)? == self.zero() => return None,
            _ => {}
        }
        let mut whole = true;
        let node = node.map_children(|child| {
            let known = of(image, child);
            whole &= known.is_some();
            known.unwrap_or(child)
        });
        whole.then(|| merge(self, node))
    }
}

/// Maps an edge by the images of nodes; `None` if its node has no image.
fn of(image: &[Option<Edge>], edge: Edge) -> Option<Edge> {
    let known = image[edge.node() as usize]?;
    Some(known.signed(edge.is_negative()))
}
