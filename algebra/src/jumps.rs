//! Whether expressions jump where they change from one branch to another.
//!
//! An expression is compared with itself on both sides of c = 0 for every c that it chooses by: with the branches of
//! c > 0, and with those of c < 0. At c = 0 both have to be equal. There, every factor f of c being looked at apart,
//! f itself is 0, a term of f is the negative sum of the others, and so is a symbol s in which f is linear:
//! s = s − f / (∂f/∂s). One such equation is put into both sides. Where it makes them equal they are equal at f = 0,
//! whatever else is true there; where none does, nothing is known.

use super::derivation::Derivation;
use super::graph::{Edge, Function, Graph, Node, NodeId};
use super::transplant::merged;
use num_traits::Signed;
use std::collections::BTreeSet;

/// So many terms of a sum are tried.
const MOST_TERMS: usize = 12;

/// So many symbols are tried.
const MOST_SYMBOLS: usize = 8;

/// What of an expression may change.
#[derive(Clone, Copy)]
struct Moving<'a> {
    still: u8,
    free: &'a dyn Fn(NodeId) -> bool,
}

/// A node, and what it is equal to.
type Equation = (NodeId, Edge);

impl Graph {
    /// What the expressions may jump by: the first c at which they were not found to be equal on both sides. What is
    /// written in `still` classes alone never changes, and symbols that are not `free` cannot be moved alone.
    pub fn jump(&self, edges: &[Edge], still: u8, free: &dyn Fn(NodeId) -> bool) -> Option<Edge> {
        let chosen = |&id: &NodeId| match self.node(id) {
            // |c| is continuous.
            Node::Apply(Function::Abs, _) => None,
            _ => self.chosen_by(id),
        };
        let moving = Moving { still, free };
        let reachable = self.reachable(edges);
        let all: BTreeSet<Edge> = reachable.iter().filter_map(chosen).map(Edge::abs).collect();
        let mut all = all
            .into_iter()
            .filter(|by| self.moves(*by, moving))
            .peekable();
        all.peek()?;
        let mut graph = self.clone();
        all.find(|by| !graph.meets(edges, *by, moving))
    }

    fn moves(&self, edge: Edge, moving: Moving<'_>) -> bool {
        self.class(edge.node()) & !moving.still != 0
    }

    /// Whether the expressions are found to be equal on both sides of c = 0.
    fn meets(&mut self, edges: &[Edge], by: Edge, moving: Moving<'_>) -> bool {
        let factors = self.factors(by, moving);
        factors.into_iter().all(|factor| {
            let equal = |graph: &mut Graph, set: Equation| {
                let above = graph.beside(edges, by, false, set);
                above.is_some() && above == graph.beside(edges, by, true, set)
            };
            let terms = self.terms(factor, moving);
            let zero = (factor.node(), self.zero());
            terms.into_iter().chain([zero]).any(|set| equal(self, set)) || {
                let lines = self.lines(factor, moving);
                lines.into_iter().any(|set| equal(self, set))
            }
        })
    }

    /// What changes its sign, or is 0, where c does or is.
    fn factors(&self, by: Edge, moving: Moving<'_>) -> BTreeSet<Edge> {
        let mut factors = BTreeSet::new();
        let mut rest = vec![by.abs()];
        while let Some(edge) = rest.pop() {
            match self.node(edge.node()) {
                _ if !self.moves(edge, moving) => {}
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

    /// Whether a divisor is of one sign by its form.
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

    /// The terms of a sum that is 0, by the others; those that have a factor which moves have no equation.
    fn terms(&mut self, sum: Edge, moving: Moving<'_>) -> Vec<Equation> {
        let mut found = Vec::new();
        let mut rest = vec![sum];
        while let Some(edge) = rest.pop() {
            let negative = |other: Edge| other.signed(edge.is_negative());
            let node = self.node(edge.node());
            if let Node::Add(a, b) = node {
                rest.extend([negative(b), negative(a)]);
            } else if self.moves(edge, moving) && edge.node() != sum.node() {
                found.push((edge, self.one()));
                if let Node::Mul(a, b) = node {
                    let pairs = [(a, b), (b, a)].into_iter();
                    let pairs = pairs.filter(|(_, factor)| !self.moves(*factor, moving));
                    found.extend(pairs.map(|(term, factor)| (negative(term), factor)));
                }
            }
            if found.len() > MOST_TERMS {
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

    /// The symbols in which an expression is linear, where it is 0.
    fn lines(&mut self, zero: Edge, moving: Moving<'_>) -> Vec<Equation> {
        let below = self.reachable(&[zero]);
        // What is chosen inside has other slopes elsewhere.
        if below.iter().any(|&id| self.chosen_by(id).is_some()) {
            return Vec::new();
        }
        let symbol = |id: &NodeId| matches!(self.node(*id), Node::Symbol(_));
        let symbols: Vec<NodeId> = below.into_iter().filter(symbol).collect();
        let line = |symbol: NodeId| self.line(symbol, zero, moving);
        symbols
            .into_iter()
            .filter_map(line)
            .take(MOST_SYMBOLS)
            .collect()
    }

    fn line(&mut self, symbol: NodeId, zero: Edge, moving: Moving<'_>) -> Option<Equation> {
        if !self.moves(Edge::of(symbol), moving) {
            return None;
        }
        let slope = self.linear(symbol, zero)?;
        // Where the slope is 0, too, nothing is said of the symbol: that must not be all of a place with f = 0.
        if !self
            .factors(slope, moving)
            .into_iter()
            .all(|factor| self.apart(factor, zero, moving))
        {
            return None;
        }
        let back = self.div(zero, slope)?;
        Some((symbol, self.sub(Edge::of(symbol), back)))
    }

    /// The slope along a symbol in which an expression is linear.
    fn linear(&mut self, symbol: NodeId, edge: Edge) -> Option<Edge> {
        let mut along = Derivation::new([(symbol, self.one())]);
        let slope = along.of(self, edge);
        (slope != self.zero() && along.of(self, slope) == self.zero()).then_some(slope)
    }

    /// Whether an expression is not 0 where a factor is: the factor is made 0 by one of its symbols.
    fn apart(&mut self, factor: Edge, edge: Edge, moving: Moving<'_>) -> bool {
        let symbol = |id: &NodeId| matches!(self.node(*id), Node::Symbol(_));
        let symbols = self.reachable(&[factor]).into_iter().filter(symbol);
        let symbols: Vec<NodeId> = symbols.filter(|&id| (moving.free)(id)).collect();
        symbols.into_iter().any(|symbol| {
            let Some(slope) = self
                .linear(symbol, factor)
                .filter(|slope| !self.moves(*slope, moving))
            else {
                return false;
            };
            let Some(back) = self.div(factor, slope) else {
                return false;
            };
            let moved = self.sub(Edge::of(symbol), back);
            let none = self.zero();
            let there = self.beside(&[edge], none, false, (symbol, moved));
            there.is_some_and(|there| there[0] != none)
        })
    }

    /// The expressions with the branches of one side of c = 0, and an expression in the place of a node. None where
    /// they have no value there, or one that depends on the side of something else that is 0, too.
    fn beside(
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
        let node = node.over(|child| {
            let known = of(image, child);
            whole &= known.is_some();
            known.unwrap_or(child)
        });
        whole.then(|| merged(self, node))
    }
}

/// An edge by the images of nodes, as far as they have one.
fn of(image: &[Option<Edge>], edge: Edge) -> Option<Edge> {
    let known = image[edge.node() as usize]?;
    Some(known.signed(edge.is_negative()))
}

#[cfg(test)]
mod tests {
    use crate::fp::Random;
    use crate::graph::{Edge, Function, Graph, NodeId};

    fn made() -> (Graph, [Edge; 4]) {
        let mut random = Random::new(17);
        let mut g = Graph::new(2, 1);
        let symbols = [("p", 1), ("a", 2), ("b", 2), ("d", 2)]
            .map(|(name, class)| g.symbol(name, class, random.element()));
        (g, symbols)
    }

    fn jumps(g: &Graph, edge: Edge) -> bool {
        let every = |_: NodeId| true;
        g.jump(&[edge], 1, &every).is_some()
    }

    #[test]
    fn what_jumps_is_found() {
        let (mut g, [p, a, b, _]) = made();
        let one = g.one();
        let less = g.sub(a, one);
        let square = g.mul(less, less);
        let (difference, back) = (g.sub(a, b), g.sub(b, a));
        let size = g.apply(Function::Abs, less);
        let inner = g.select(difference, a, b);
        let steep = g.mul(p, inner);
        let nested = g.select(less, size, -square);
        let still = g.select(p, one, a);
        let smooth = [
            size,
            inner,
            steep,
            nested,
            still,
            g.select(back, size, nested),
        ];
        // The last: b − a = 0 is where |a − 1| and what is nested differ.
        let sign = g.apply(Function::Sign, less);
        let product = g.mul(sign, less);
        let step = g.select(less, one, p);
        // Not linear in a symbol: nothing is known.
        let curved = g.select(square, a, b);
        let found: Vec<bool> = smooth.iter().map(|&edge| jumps(&g, edge)).collect();
        assert_eq!(found, [false, false, false, false, false, true]);
        assert!(jumps(&g, sign) && jumps(&g, step) && jumps(&g, curved) && !jumps(&g, product));
        // A symbol that cannot be moved alone is what c = 0 says all the same.
        assert!(g.jump(&[inner], 1, &|_| false).is_none());
        assert!(g.jump(&[step], 1, &|_| false).is_some());
    }

    /// The greater of two is continuous whatever the two are; so is what is made of it.
    #[test]
    fn the_greater_of_two_never_jumps() {
        let (mut g, [p, a, b, d]) = made();
        let zero = g.zero();
        let squares = g.dot(&[a, b, d], &[a, b, d]);
        let length = g.apply(Function::Norm, squares);
        let (sine, root) = (g.apply(Function::Sin, a), g.apply(Function::Abs, b));
        let product = g.mul(a, sine);
        let ratio = g.div(sine, squares).expect("is not 0");
        let ten = g.ratio(1, 10);
        let all = [squares, length, sine, root, product, ratio, a];
        for of in all {
            for with in [p, zero, ten, d] {
                let more = g.sub(of, with);
                let greater = g.select(more, of, with);
                let excess = g.select(more, more, zero);
                let (square, further) = (g.mul(excess, excess), g.select(-more, p, greater));
                // Twice the same, the one within the other.
                let least = g.sub(greater, b);
                let twice = g.select(least, b, greater);
                assert!(
                    ![greater, excess, square, twice]
                        .iter()
                        .any(|&e| jumps(&g, e))
                );
                // p or of where of > with.
                assert!(with == p || jumps(&g, further), "{of:?} {with:?}");
                let cut = g.select(more, of, zero);
                assert!(with == zero || jumps(&g, cut), "{of:?} {with:?}");
            }
        }
    }

    #[test]
    fn every_place_at_which_a_side_changes_is_seen() {
        let (mut g, [p, a, b, d]) = made();
        let (zero, one) = (g.zero(), g.one());
        // a b > 0 changes at a = 0 and at b = 0, a/b, too; c = a b + a d is a (b + d).
        let (product, ratio) = (g.mul(a, b), g.div(a, b).expect("is not 0"));
        let other = g.mul(a, d);
        let sum = g.add(product, other);
        for by in [product, ratio, sum] {
            let choice = g.select(by, a, zero);
            assert!(jumps(&g, choice), "{by:?}");
            let choice = g.select(by, product, zero);
            assert!(by == sum || !jumps(&g, choice));
        }
        // What has no value at a = 0 is not continuous there.
        let inverse = g.div(one, a).expect("is not 0");
        let infinite = g.select(a, inverse, zero);
        assert!(jumps(&g, infinite));
        // 2a > 0 is where a > 0: neither shows the jump of the other away.
        let double = g.add(a, a);
        let hidden = g.select(double, one, zero);
        let step = g.select(a, hidden, zero);
        assert!(jumps(&g, step));
        // p a = 0 wherever p = 0, but p does not move.
        let scaled = g.mul(p, a);
        let kink = g.select(scaled, a, zero);
        assert!(!jumps(&g, kink));
    }
}
