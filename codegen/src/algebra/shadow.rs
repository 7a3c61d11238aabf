//! The real values of a graph's nodes, for as long as no square root takes part: none.

use super::graph::{Edge, Function, Node};
use super::reals::{Real, Reals, SAMPLES, contradict};
use num_rational::BigRational;
use num_traits::ToPrimitive;

/// Real values of nodes, found when they are first asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct Shadow {
    /// Those of the symbols.
    symbols: Vec<Reals>,
    /// Those of the first nodes.
    values: Vec<Reals>,
    /// Whether a square root is below a node.
    rooted: Vec<bool>,
}

impl Shadow {
    /// Other values of the symbols.
    pub(super) fn set(&mut self, symbols: Vec<Reals>) {
        self.symbols = symbols;
        self.values.clear();
    }

    /// The values of a symbol.
    pub(super) fn symbol(&self, index: usize) -> Reals {
        let known = self.symbols.get(index).copied();
        known.unwrap_or([Real::UNKNOWN; SAMPLES])
    }

    /// A node was added to the graph.
    pub(super) fn follow(&mut self, node: Node) {
        self.rooted.push(self.has_root(node));
    }

    fn has_root(&self, node: Node) -> bool {
        let below = |edge: Edge| self.rooted[edge.node() as usize];
        matches!(node, Node::Apply(Function::Sqrt, _)) || node.children().any(below)
    }

    /// Whether a node with square roots below it, or what it is said to equal, is another number.
    pub(super) fn disputes(
        &mut self,
        nodes: &[Node],
        constants: &[BigRational],
        node: Node,
        known: Edge,
    ) -> bool {
        if !self.has_root(node) && !self.rooted[known.node() as usize] {
            return false;
        }
        for &node in &nodes[self.values.len()..] {
            let value = self.value(constants, node);
            self.values.push(value);
        }
        contradict(&self.value(constants, node), &self.read(known))
    }

    fn read(&self, edge: Edge) -> Reals {
        let signed = |value: Real| value.signed(edge.is_negative());
        self.values[edge.node() as usize].map(signed)
    }

    fn value(&self, constants: &[BigRational], node: Node) -> Reals {
        let pair = |a: Edge, b: Edge, of: fn(Real, Real) -> Real| {
            let (a, b) = (self.read(a), self.read(b));
            std::array::from_fn(|sample| of(a[sample], b[sample]))
        };
        match node {
            Node::Constant(index) => {
                let value = constants[index as usize].to_f64().unwrap_or(f64::NAN);
                [Real::new(value, value.abs() * f64::EPSILON); SAMPLES]
            }
            Node::Symbol(index) => self.symbol(index as usize),
            Node::Add(a, b) => pair(a, b, Real::plus),
            Node::Mul(a, b) => pair(a, b, Real::times),
            Node::Div(a, b) => pair(a, b, Real::over),
            Node::Apply(function, a) => self.read(a).map(|a| a.apply(function)),
            Node::Atan2(y, x) => pair(y, x, Real::atan2),
        }
    }
}
