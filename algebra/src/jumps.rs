//! Whether expressions jump where they change from one branch to another.
//!
//! An expression is compared with itself on both sides of c = 0 for every c that it chooses by: with the branches of
//! c > 0, and with those of c < 0. At c = 0 both have to be equal. Such a point is found along a symbol s in which c
//! is linear: s − c / (∂c/∂s) takes the place of s.

use super::derivation::Derivation;
use super::graph::{Edge, Function, Graph, Node, NodeId};
use super::transplant::{merged, read};
use std::collections::BTreeSet;

impl Graph {
    /// What the expressions may jump by: the first c at which they were not found to be equal on both sides. What is
    /// written in `still` classes alone never changes, and symbols that are not `free` cannot be moved alone.
    pub fn jump(&self, edges: &[Edge], still: u8, free: &dyn Fn(NodeId) -> bool) -> Option<Edge> {
        let chosen = |&id: &NodeId| match self.node(id) {
            // |c| is continuous.
            Node::Apply(Function::Abs, _) => None,
            _ => self.chosen_by(id),
        };
        let moves = |by: &Edge| self.class(by.node()) & !still != 0;
        let reachable = self.reachable(edges);
        let all: BTreeSet<Edge> = reachable.iter().filter_map(chosen).map(Edge::abs).collect();
        let mut all = all.into_iter().filter(moves).peekable();
        all.peek()?;
        let mut graph = self.clone();
        all.find(|by| !graph.meets(edges, *by, still, free))
    }

    /// Whether the expressions are found to be equal on both sides of c = 0.
    fn meets(
        &mut self,
        edges: &[Edge],
        by: Edge,
        still: u8,
        free: &dyn Fn(NodeId) -> bool,
    ) -> bool {
        let nodes: Vec<NodeId> = self.symbols().iter().map(|symbol| symbol.node).collect();
        for symbol in nodes {
            if self.class(symbol) & !still == 0 || !free(symbol) {
                continue;
            }
            let mut along = Derivation::new([(symbol, self.one())]);
            let slope = along.of(self, by);
            let linear = slope != self.zero() && along.of(self, slope) == self.zero();
            // A slope that is chosen itself is another one elsewhere.
            let whole = |graph: &Graph| {
                let below = graph.reachable(&[by]).into_iter();
                below.filter_map(|id| graph.chosen_by(id)).count() == 0
            };
            if !linear || !whole(self) {
                continue;
            }
            let Some(back) = self.div(by, slope) else {
                continue;
            };
            let moved = self.sub(Edge::of(symbol), back);
            let [above, below] =
                [false, true].map(|below| self.beside(edges, by, below, (symbol, moved)));
            return above == below;
        }
        false
    }

    /// The expressions with the branches of one side of c = 0, and an expression in the place of a symbol.
    fn beside(&mut self, edges: &[Edge], by: Edge, below: bool, set: (NodeId, Edge)) -> Vec<Edge> {
        let mut image = vec![Edge::of(0); self.len()];
        for id in self.reachable(edges) {
            let negative = |c: Edge| c.is_negative() != below;
            image[id as usize] = match self.node(id) {
                Node::Constant(_) => Edge::of(id),
                Node::Symbol(_) if id == set.0 => set.1,
                Node::Symbol(_) => Edge::of(id),
                Node::Select(c, a, b) if c.abs() == by => {
                    read(&image, if negative(c) { b } else { a })
                }
                Node::Apply(Function::Sign, c) if c.abs() == by => self.one().signed(negative(c)),
                node => merged(self, node.over(|child| read(&image, child))),
            };
        }
        edges.iter().map(|&edge| read(&image, edge)).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::fp::Random;
    use crate::graph::{Edge, Function, Graph, NodeId};

    #[test]
    fn what_jumps_is_found() {
        let mut random = Random::new(17);
        let mut g = Graph::new(2, 1);
        let [p, a, b] = [("p", 1), ("a", 2), ("b", 2)]
            .map(|(name, class)| g.symbol(name, class, random.element()));
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
        let jumps = |edge: Edge| {
            let every = |_: NodeId| true;
            g.jump(&[edge], 1, &every).is_some()
        };
        let found: Vec<bool> = smooth.iter().map(|&edge| jumps(edge)).collect();
        assert_eq!(found, [false, false, false, false, false, true]);
        assert!(jumps(sign) && jumps(step) && jumps(curved) && !jumps(product));
        // Where nothing may be moved, nothing is found.
        assert!(g.jump(&[inner], 1, &|_| false).is_some());
    }
}
