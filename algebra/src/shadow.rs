//! The real values of a graph's nodes, found where they are needed to tell expressions apart: those of
//! numbers with certainty, those of what has a square root below it at samples.

use super::graph::{Edge, Function, Node, NodeId};
use super::interval::Interval;
use super::reals::{Real, Reals, SAMPLES, contradict};
use num_rational::BigRational;
use num_traits::ToPrimitive;
use rustc_hash::FxHashMap;

/// Real values of nodes, found when they are first asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct Shadow {
    /// Those of the symbols.
    symbols: Vec<Reals>,
    /// Those of the first nodes.
    values: Vec<Reals>,
    /// Whether a square root is below a node.
    rooted: Vec<bool>,
    /// Whether the first half of the samples speaks of all nodes.
    pub(super) watched: bool,
    /// Whether it did.
    pub(super) contradicted: bool,
    /// Numbers between certain bounds; `None` where none are known.
    numbers: FxHashMap<NodeId, Option<Interval>>,
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
        let rooted = self.has_root(node) || self.rooted[known.node() as usize];
        if !rooted && !self.watched {
            return false;
        }
        self.fill(nodes, constants);
        if !rooted {
            let half = SAMPLES / 2;
            let (a, b) = (self.value(constants, node), self.read(known));
            let contradicts = contradict(&a[..half], &b[..half]);
            self.contradicted |= contradicts;
            return contradicts;
        }
        contradict(&self.value(constants, node), &self.read(known))
    }

    fn fill(&mut self, nodes: &[Node], constants: &[BigRational]) {
        for &node in &nodes[self.values.len()..] {
            let value = self.value(constants, node);
            self.values.push(value);
        }
    }

    /// Itself with the values of all nodes, where a square root is below one of the given nodes.
    pub(super) fn filled(
        &self,
        nodes: &[Node],
        constants: &[BigRational],
        ids: &[NodeId],
    ) -> Option<Shadow> {
        let mut shadow = ids
            .iter()
            .any(|&id| self.rooted[id as usize])
            .then(|| self.clone())?;
        shadow.fill(nodes, constants);
        Some(shadow)
    }

    /// Whether a node of values that were filled in is another number than what is to stand for it.
    pub(super) fn refuses(&self, node: NodeId, other: Node) -> bool {
        let pair = |a: Edge, b: Edge, of: fn(Real, Real) -> Real| -> Reals {
            let (a, b) = (self.read(a), self.read(b));
            std::array::from_fn(|sample| of(a[sample], b[sample]))
        };
        let other = match other {
            Node::Add(a, b) => pair(a, b, Real::plus),
            Node::Mul(a, b) => pair(a, b, Real::times),
            _ => return true,
        };
        contradict(&self.values[node as usize], &other)
    }

    /// Whether a node that depends on no symbol, or what it is said to equal, is another number, or a
    /// number that is not known.
    pub(super) fn disputes_number(
        &mut self,
        nodes: &[Node],
        constants: &[BigRational],
        node: Node,
        known: Edge,
    ) -> bool {
        let found = self.bounds(nodes, constants, node);
        match (found, self.number(nodes, constants, known)) {
            (Some(a), Some(b)) => a.differs(&b),
            _ => true,
        }
    }

    /// The bounds of a node that depends on no symbol but π.
    fn number(
        &mut self,
        nodes: &[Node],
        constants: &[BigRational],
        edge: Edge,
    ) -> Option<Interval> {
        let id = edge.node();
        if !self.numbers.contains_key(&id) {
            let bounds = self.bounds(nodes, constants, nodes[id as usize]);
            self.numbers.insert(id, bounds);
        }
        let bounds = self.numbers.get(&id)?.as_ref()?;
        Some(bounds.signed(edge.is_negative()))
    }

    fn bounds(
        &mut self,
        nodes: &[Node],
        constants: &[BigRational],
        node: Node,
    ) -> Option<Interval> {
        let mut read = |edge: Edge| self.number(nodes, constants, edge);
        match node {
            Node::Constant(index) => Some(Interval::rational(&constants[index as usize])),
            // π is the only symbol that is a number.
            Node::Symbol(_) => Some(Interval::pi()),
            Node::Add(a, b) => Some(read(a)?.plus(&read(b)?)),
            Node::Mul(a, b) => Some(read(a)?.times(&read(b)?)),
            Node::Div(a, b) => Some(read(a)?.times(&read(b)?.inverse()?)),
            Node::Apply(function, a) => read(a)?.apply(function),
            Node::Atan2(..) => None,
        }
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
