//! Real values of a graph's nodes, computed where they are needed to distinguish expressions: certified
//! bounds for numbers, and samples for expressions that contain a square root.

use super::external;
use super::interval::Interval;
use super::node::{Edge, Node, NodeId};
use super::numbers::{Arithmetic, Form, Step};
use super::reals::{Real, Reals, SAMPLES, contradict};
use num_rational::BigRational;
use num_traits::ToPrimitive;
use rustc_hash::FxHashMap;
use std::cmp::Ordering;

/// Real values of nodes, computed when they are first needed.
#[derive(Clone, Debug, Default)]
pub(super) struct RealValues {
    /// Samples of the symbols.
    symbols: Vec<Reals>,
    /// Samples of the first nodes, as far as they have been computed.
    values: Vec<Reals>,
    /// Whether each node contains a square root.
    rooted: Vec<bool>,
    /// Whether the first half of the samples is compared for all nodes, with or without square roots.
    pub(super) watched: bool,
    /// Whether such a comparison contradicted the values modulo p.
    pub(super) contradicted: bool,
    /// Certified bounds of numbers; `None` if none are known.
    numbers: FxHashMap<NodeId, Option<Interval>>,
    /// Merges of expressions that contain square roots: a node, and the edge that replaced it.
    taken: Vec<(Node, Edge)>,
    /// Whether expressions that contain a square root are never merged with others.
    pub(super) separate_roots: bool,
}

/// Smallest number of samples at which two merged expressions must both be known.
const MIN_COMMON_SAMPLES: usize = 16;

impl RealValues {
    /// Sets the samples of the symbols.
    pub(super) fn set(&mut self, symbols: Vec<Reals>) {
        self.symbols = symbols;
        self.values.clear();
    }

    /// Returns the samples of a symbol.
    pub(super) fn symbol(&self, index: usize) -> Reals {
        let known = self.symbols.get(index).copied();
        known.unwrap_or([Real::UNKNOWN; SAMPLES])
    }

    /// Takes note of a node that was added to the graph.
    pub(super) fn push(&mut self, node: Node) {
        self.rooted.push(self.has_root(node));
    }

    /// Whether a node contains a square root.
    pub(super) fn is_rooted(&self, id: NodeId) -> bool {
        self.rooted[id as usize]
    }

    fn has_root(&self, node: Node) -> bool {
        let below = |edge: Edge| self.rooted[edge.node() as usize];
        node.is_root() || node.children().any(below)
    }

    /// Whether samples or settings forbid taking a node for `known`. Samples are compared if one of the two
    /// contains a square root, and otherwise only if `watched` is set.
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
        if rooted && self.separate_roots {
            return true;
        }
        self.fill(nodes, constants);
        if !rooted {
            let half = SAMPLES / 2;
            let (a, b) = (self.value(constants, node), self.read(known));
            let contradicts = contradict(&a[..half], &b[..half]);
            self.contradicted |= contradicts;
            return contradicts;
        }
        let contradicts = contradict(&self.value(constants, node), &self.read(known));
        if !contradicts {
            self.taken.push((node, known));
        }
        contradicts
    }

    /// Whether some merged expression differs from its replacement at one of many samples, or both are
    /// known at too few of them.
    pub(super) fn has_doubtful_merges(
        &self,
        nodes: &[Node],
        constants: &[BigRational],
        samples: impl Iterator<Item = Vec<Reals>>,
    ) -> bool {
        if self.taken.is_empty() {
            return false;
        }
        let mut counts = vec![0; self.taken.len()];
        let mut real_values = RealValues::default();
        for symbols in samples {
            real_values.set(symbols);
            real_values.fill(nodes, constants);
            for (&(node, known), count) in self.taken.iter().zip(&mut counts) {
                let (a, b) = (real_values.value(constants, node), real_values.read(known));
                if contradict(&a, &b) {
                    return true;
                }
                let both = a.iter().zip(&b);
                *count += both.filter(|(a, b)| a.is_known() && b.is_known()).count();
            }
        }
        counts.iter().any(|&count| count < MIN_COMMON_SAMPLES)
    }

    fn fill(&mut self, nodes: &[Node], constants: &[BigRational]) {
        for &node in &nodes[self.values.len()..] {
            let value = self.value(constants, node);
            self.values.push(value);
        }
    }

    /// Returns a copy with the samples of all nodes, if one of the given nodes contains a square root.
    pub(super) fn filled(
        &self,
        nodes: &[Node],
        constants: &[BigRational],
        ids: &[NodeId],
    ) -> Option<RealValues> {
        let mut real_values = ids
            .iter()
            .any(|&id| self.rooted[id as usize])
            .then(|| self.clone())?;
        real_values.fill(nodes, constants);
        Some(real_values)
    }

    /// Whether `other` cannot replace a node whose samples have been computed: it is a different number, or
    /// it is neither a sum nor a product.
    pub(super) fn refuses(&self, node: NodeId, other: Node) -> bool {
        let is_known = matches!(other, Node::Add(..) | Node::Mul(..));
        !is_known || contradict(&self.values[node as usize], &self.value(&[], other))
    }

    /// Whether a node that depends on no symbol differs from `known`, or the bounds of one of them are not
    /// known.
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

    /// Returns certified bounds of a node that depends on no symbol but π.
    pub(super) fn number(
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
        for child in node.children() {
            self.number(nodes, constants, child)?;
        }
        let at = |edge: Edge| self.numbers.get(&edge.node()).and_then(Option::as_ref);
        match node {
            Node::Constant(index) => Bounds.make(Step::Constant(&constants[index as usize])),
            node => Bounds.node(node, at, &Form::new),
        }
    }

    fn read(&self, edge: Edge) -> Reals {
        let signed = |value: Real| value.signed(edge.is_negative());
        self.values[edge.node() as usize].map(signed)
    }

    fn value(&self, constants: &[BigRational], node: Node) -> Reals {
        let mut samples = Samples(&self.symbols);
        let at = |edge: Edge| self.values.get(edge.node() as usize);
        let value = match node {
            Node::Constant(index) => samples.make(Step::Constant(&constants[index as usize])),
            node => samples.node(node, at, &Form::new),
        };
        value.unwrap_or([Real::UNKNOWN; SAMPLES])
    }
}

/// Arithmetic on real samples, with the samples of the symbols.
struct Samples<'a>(&'a [Reals]);

impl Arithmetic for Samples<'_> {
    type Number = Reals;

    fn make(&mut self, step: Step<Reals>) -> Option<Reals> {
        let pair = |a: &Reals, b: &Reals, of: fn(Real, Real) -> Real| -> Reals {
            std::array::from_fn(|sample| of(a[sample], b[sample]))
        };
        Some(match step {
            Step::Whole(value) => [Real::new(value.into(), 0.0); SAMPLES],
            Step::Constant(value) => {
                let value = value.to_f64().unwrap_or(f64::NAN);
                [Real::new(value, value.abs() * f64::EPSILON); SAMPLES]
            }
            Step::Symbol(index) => *self.0.get(index)?,
            Step::Neg(a) => a.map(|a| a.signed(true)),
            Step::Add(a, b) => pair(a, b, Real::plus),
            Step::Sub(a, b) => pair(a, b, |a, b| a.plus(b.signed(true))),
            Step::Mul(a, b) => pair(a, b, Real::times),
            Step::Div(a, b) => pair(a, b, Real::over),
            Step::Apply(function, a, _) => a.map(|a| a.apply(function)),
            Step::Atan2(y, x) => pair(y, x, Real::atan2),
            Step::Select(c, a, b) => {
                std::array::from_fn(|sample| c[sample].select(a[sample], b[sample]))
            }
            // A stand-in for the external function: whatever holds for all functions holds for this one.
            Step::Listed(rest, a) => pair(rest, a, |rest, a| {
                rest.times(Real::new(external::STAND_IN_WEIGHT, 0.0))
                    .plus(a)
            }),
            Step::External(component, list, _) => {
                let [constant, factor] = component.stand_in().map(|c| Real::new(c, 0.0));
                list.map(|list| list.times(factor).plus(constant))
            }
        })
    }
}

/// Interval arithmetic, in which π is the only symbol.
struct Bounds;

impl Arithmetic for Bounds {
    type Number = Interval;

    fn make(&mut self, step: Step<Interval>) -> Option<Interval> {
        match step {
            Step::Whole(value) => {
                Some(Interval::rational(&BigRational::from_integer(value.into())))
            }
            Step::Constant(value) => Some(Interval::rational(value)),
            Step::Symbol(_) => Some(Interval::pi()),
            Step::Neg(a) => Some(a.signed(true)),
            Step::Add(a, b) => Some(a.plus(b)),
            Step::Sub(a, b) => Some(a.plus(&b.signed(true))),
            Step::Mul(a, b) => Some(a.times(b)),
            Step::Div(a, b) => Some(a.times(&b.inverse()?)),
            Step::Apply(function, a, _) => (function.row().interval)(a),
            Step::Atan2(y, x) => y.atan2(x),
            Step::Select(c, a, b) => Some(match c.side()? {
                Ordering::Greater => a.clone(),
                _ => b.clone(),
            }),
            Step::Listed(..) | Step::External(..) => None,
        }
    }
}
