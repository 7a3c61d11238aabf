//! Hash-consed expression graph with signed edges.
//!
//! Every node carries its value at a point of the constraint variety X in each of two finite fields. Nodes
//! with equal values are merged, so "equal on X" is node identity; zero and small rationals are recognised
//! as constants. Where square roots are involved, real samples have to agree as well; numbers are compared
//! with certainty (`real_enclosure`). An edge is a node with a sign, so negation costs nothing, and a − b and b − a
//! are one node. Children precede their parents.

mod calls;
mod labels;
mod leaves;
mod merge;
mod order;
mod powers;
mod side;
pub use labels::Label;
pub(crate) use merge::canonical;
pub(crate) use powers::Power;

use super::external::External;
use super::field_point::{FieldPoint, Roots};
use super::function::{Law, Parity};
pub use super::node::{Component, Edge, Function, Node, NodeId, Symbol};
use super::prime::has_bad_prime;
use super::real_enclosure::RealValues;
use super::reals::Reals;
use super::residue_pair::ResiduePair;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Zero};
use rustc_hash::FxHashMap;
use std::cmp::Ordering;
use std::sync::Arc;

/// The expression graph.
#[derive(Clone, Debug)]
pub struct Graph {
    nodes: Vec<Node>,
    values: Vec<ResiduePair>,
    classes: Vec<u8>,
    by_value: FxHashMap<ResiduePair, Edge>,
    constants: Vec<BigRational>,
    symbols: Vec<Symbol>,
    point: FieldPoint,
    real_values: RealValues,
    /// Rational factors of the arguments of square roots, by the nodes of the arguments.
    contents: FxHashMap<NodeId, BigRational>,
    /// Value of the node of another graph, at the same points, that the next node is a copy of. That node
    /// is not a number, so a new node with this value is not a number either.
    copied: ResiduePair,
    /// Whether some number has no faithful image, because a prime divides it.
    bad_prime: bool,
    /// External functions, which are defined elsewhere.
    externals: Arc<Vec<External>>,
    /// Labels of nodes, as far as the last node that has one.
    labels: Vec<Option<Label>>,
    /// Class of the symbols that are constant at run time. Products and sums of these are kept together so
    /// that they can be computed once.
    free_class: u8,
}

impl Graph {
    /// Creates an empty graph, in which symbols of `free_class` are constant at run time.
    pub fn new(free_class: u8) -> Self {
        let mut graph = Graph {
            nodes: Vec::new(),
            values: Vec::new(),
            classes: Vec::new(),
            by_value: FxHashMap::default(),
            constants: Vec::new(),
            symbols: Vec::new(),
            point: FieldPoint::new(),
            real_values: RealValues::default(),
            contents: FxHashMap::default(),
            copied: ResiduePair::ZERO,
            bad_prime: false,
            externals: Arc::default(),
            labels: Vec::new(),
            free_class,
        };
        // Node 0 is the number 0, node 1 the number 1.
        graph.push(Node::Constant(0), ResiduePair::ZERO, 0);
        graph.constants.push(BigRational::zero());
        graph.rational(&BigRational::one());
        graph
    }

    /// Creates an empty graph at the same points, to be filled with some of the symbols.
    pub fn empty_copy(&self) -> Self {
        let mut graph = Graph::new(self.free_class);
        graph.point = self.point.without_symbols();
        graph.externals = self.externals.clone();
        graph
    }

    /// Sets which square roots have values, for use when no point has all of them.
    pub fn set_roots(&mut self, roots: Roots) {
        self.point.roots = roots;
    }

    /// Gives the symbols real values, in order of creation. Without real values, square roots are
    /// distinguished only modulo p.
    pub fn set_reals(&mut self, reals: Vec<Reals>) {
        self.real_values.set(reals);
    }

    /// Sets whether expressions that are equal at the point must also be equal at the first half of the
    /// real samples. These may lie on another branch of the constraints than the point.
    pub fn compare_samples(&mut self, watched: bool) {
        self.real_values.watched = watched;
    }

    /// Whether expressions that are equal at the point were found to differ at real samples, which then lie
    /// on another branch of the constraints.
    pub fn has_contradicted_samples(&self) -> bool {
        self.real_values.contradicted
    }

    /// From now on, an expression that contains a square root is merged only with the same expression, not
    /// with others of equal value.
    pub fn forbid_root_merges(&mut self) {
        self.real_values.separate_roots = true;
    }

    /// Whether some expression that contains a square root was merged with one that differs from it at one
    /// of these samples (real values of the symbols), or that has a value at too few of them.
    pub fn has_doubtful_merges(&self, samples: impl Iterator<Item = Vec<Reals>>) -> bool {
        self.real_values
            .has_doubtful_merges(&self.nodes, &self.constants, samples)
    }

    /// Whether an expression contains a square root, so that a different number may have the same value
    /// modulo p.
    pub fn has_root_below(&self, edge: Edge) -> bool {
        self.real_values.is_rooted(edge.node())
    }

    /// Real samples of a symbol.
    pub fn reals(&self, symbol: usize) -> Reals {
        self.real_values.symbol(symbol)
    }

    /// Records the rational factor of the argument of a square root, once for all points.
    fn note_content(&mut self, function: Function, argument: Edge) {
        let id = argument.node();
        if function.row().law == Law::Radical && !self.contents.contains_key(&id) {
            let content = self.content(argument);
            self.contents.insert(id, content);
        }
    }

    /// Returns the recorded rational factor of the argument of a square root, 1 if there is none.
    pub(super) fn noted_content(&self, argument: Edge) -> BigRational {
        let known = self.contents.get(&argument.node()).cloned();
        known.unwrap_or_else(BigRational::one)
    }

    /// The number 0.
    pub fn zero(&self) -> Edge {
        Edge::of(0)
    }

    /// The number 1.
    pub fn one(&self) -> Edge {
        Edge::of(1)
    }

    /// Number of nodes in the graph.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Always false: the numbers 0 and 1 are in every graph.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Operation of a node.
    pub fn node(&self, id: NodeId) -> Node {
        self.nodes[id as usize]
    }

    /// Classes of the symbols that a node is written in, one bit each.
    pub fn class(&self, id: NodeId) -> u8 {
        self.classes[id as usize]
    }

    /// Whether a node depends on numbers and parameters only, so that it is constant at run time.
    pub fn is_free(&self, id: NodeId) -> bool {
        self.classes[id as usize] & !self.free_class == 0
    }

    /// Value of an edge at the point.
    pub fn value(&self, edge: Edge) -> ResiduePair {
        let value = self.values[edge.node() as usize];
        if edge.is_negative() { -value } else { value }
    }

    /// Symbols, in order of creation.
    pub fn symbols(&self) -> &[Symbol] {
        &self.symbols
    }

    /// Whether a square root of a non-square was requested; then other points have to be chosen.
    pub fn has_missing_root(&self) -> bool {
        self.point.has_missing_root()
    }

    /// Whether a number occurred that one of the primes divides, so that comparisons with it prove nothing.
    pub fn has_bad_prime(&self) -> bool {
        self.bad_prime
    }

    fn both_rational(&self, a: Edge, b: Edge) -> Option<(BigRational, BigRational)> {
        let numbers = self.is_number(a) && self.is_number(b);
        numbers.then(|| Some((self.as_rational(a)?, self.as_rational(b)?)))?
    }

    /// Constant at an index of the table of constants.
    pub fn constant(&self, index: u32) -> &BigRational {
        &self.constants[index as usize]
    }

    /// Creates a symbol with its value at the point.
    pub fn symbol(&mut self, name: &str, class: u8, value: ResiduePair) -> Edge {
        self.point.push_symbol(value);
        let index = self.symbols.len() as u32;
        let edge = self.push(Node::Symbol(index), value, class);
        self.symbols.push(Symbol {
            name: name.to_string(),
            class,
            node: edge.node(),
        });
        edge
    }

    /// Returns the edge of an exact number.
    pub fn rational(&mut self, value: &BigRational) -> Edge {
        match ResiduePair::from_rational(value) {
            Some(image) => self.number(value, image),
            None => self.new_number(value, ResiduePair::ZERO),
        }
    }

    /// Returns the edge of a number with this image in the two fields.
    pub(super) fn number(&mut self, value: &BigRational, image: ResiduePair) -> Edge {
        if let Some(edge) = self.lookup(image)
            && self.is_number(edge)
            && self.as_rational(edge).as_ref() == Some(value)
        {
            return edge;
        }
        self.new_number(value, image)
    }

    fn new_number(&mut self, value: &BigRational, image: ResiduePair) -> Edge {
        self.bad_prime |= has_bad_prime(value);
        let index = self.constants.len() as u32;
        self.constants.push(value.clone());
        self.push(Node::Constant(index), image, 0)
    }

    /// n/d; d must not be 0.
    pub fn ratio(&mut self, n: i64, d: i64) -> Edge {
        self.rational(&BigRational::new(BigInt::from(n), BigInt::from(d)))
    }

    /// a + b.
    pub fn add(&mut self, a: Edge, b: Edge) -> Edge {
        if a == self.zero() {
            return b;
        }
        if b == self.zero() {
            return a;
        }
        if a == -b {
            return self.zero();
        }
        if a == b {
            let two = self.ratio(2, 1);
            return self.mul(two, a);
        }
        if let Some((x, y)) = self.both_rational(a, b) {
            return self.rational(&(x + y));
        }
        let value = self.value(a) + self.value(b);
        let class = self.class(a.node()) | self.class(b.node());
        if let Some(known) = self.find_equal(Node::Add(a, b), value, class) {
            return known;
        }
        if let Some(factored) = self.factor(a, b) {
            return factored;
        }
        if let Some(regrouped) = self.regroup(a, b, Node::Add as fn(Edge, Edge) -> Node) {
            return regrouped;
        }
        // The positive operand comes first; if both are negative, the sum is negated.
        match (a.is_negative(), b.is_negative()) {
            (true, true) => {
                let (a, b) = ordered(-a, -b);
                -self.push(Node::Add(a, b), -value, class)
            }
            (true, false) => self.push(Node::Add(b, a), value, class),
            (false, true) => self.push(Node::Add(a, b), value, class),
            (false, false) => {
                let (a, b) = ordered(a, b);
                self.push(Node::Add(a, b), value, class)
            }
        }
    }

    /// a − b.
    pub fn sub(&mut self, a: Edge, b: Edge) -> Edge {
        self.add(a, -b)
    }

    /// a · b.
    pub fn mul(&mut self, a: Edge, b: Edge) -> Edge {
        let negative = a.is_negative() ^ b.is_negative();
        let (a, b) = ordered(a.abs(), b.abs());
        if a == self.zero() || b == self.zero() {
            return self.zero();
        }
        if a == self.one() {
            return b.signed(negative);
        }
        if b == self.one() {
            return a.signed(negative);
        }
        if let Some((x, y)) = self.both_rational(a, b) {
            return self.rational(&(x * y)).signed(negative);
        }
        if let (true, Node::Apply(Function::Sqrt, square)) = (a == b, self.node(a.node()))
            && self.class(square.node()) == 0
        {
            return square.signed(negative);
        }
        let value = self.value(a) * self.value(b);
        let class = self.class(a.node()) | self.class(b.node());
        if let Some(known) = self.find_equal(Node::Mul(a, b), value, class) {
            return known.signed(negative);
        }
        if let Some(regrouped) = self.regroup(a, b, Node::Mul as fn(Edge, Edge) -> Node) {
            return regrouped.signed(negative);
        }
        self.push(Node::Mul(a, b), value, class).signed(negative)
    }

    /// a / b; `None` where b vanishes identically on X.
    pub fn div(&mut self, a: Edge, b: Edge) -> Option<Edge> {
        let negative = a.is_negative() ^ b.is_negative();
        let (a, b) = (a.abs(), b.abs());
        if b == self.zero() {
            return None;
        }
        if a == b {
            return Some(self.one().signed(negative));
        }
        if let Some(divisor) = self.as_rational(b) {
            let inverse = self.rational(&divisor.recip());
            return Some(self.mul(a, inverse).signed(negative));
        }
        let value = self.value(a) * self.value(b).inv()?;
        let class = self.class(a.node()) | self.class(b.node());
        if let Some(known) = self.find_equal(Node::Div(a, b), value, class) {
            return Some(known.signed(negative));
        }
        // Division by a run-time constant is done once: x / p = x · (1/p).
        if a != self.one() && self.is_free(b.node()) {
            let inverse = self.div(self.one(), b)?;
            return Some(self.mul(a, inverse).signed(negative));
        }
        Some(self.push(Node::Div(a, b), value, class).signed(negative))
    }

    /// Applies a function of one argument.
    pub fn apply(&mut self, function: Function, argument: Edge) -> Edge {
        let row = function.row();
        let (argument, negative) = match row.parity {
            Parity::Odd => (argument.abs(), argument.is_negative()),
            Parity::Even => (argument.abs(), false),
            Parity::Neither => (argument, false),
        };
        if let Some([a, value]) = row.at
            && argument == Edge::of(a)
        {
            return Edge::of(value);
        }
        if row.law == Law::Side
            && let Some(side) = self.side(argument)
        {
            let unsigned = match function {
                Function::Abs => argument,
                _ => self.one(),
            };
            return unsigned.signed((side == Ordering::Less) ^ negative);
        }
        if row.law == Law::Radical {
            let exact = self.exact_root(argument);
            if let Some(exact) = exact.or_else(|| self.known_number_root(argument)) {
                return exact;
            }
        }
        self.note_content(function, argument);
        let form = self.form(function, argument);
        if row.law == Law::Angle
            && let Some(turned) = self.without_right_angles(function, argument, &form)
        {
            return turned.signed(negative);
        }
        let form = form
            .iter()
            .map(|(atom, c)| (self.value(Edge::of(*atom)), c.clone()))
            .collect();
        let value = self.point.function(function, self.value(argument), &form);
        let value = match row.law {
            Law::Radical => self.distinguish_from_root(argument, value),
            _ => value,
        };
        let class = self.class(argument.node());
        let node = Node::Apply(function, argument);
        let edge = match self.find_equal(node, value, class) {
            Some(known) => known,
            None => match (function == Function::Sqrt).then(|| self.even_root(argument)) {
                Some(Some(root)) => root,
                _ => self.push(node, value, class),
            },
        };
        edge.signed(negative)
    }

    /// atan2(y, x).
    pub fn atan2(&mut self, y: Edge, x: Edge) -> Edge {
        let value = self
            .point
            .opaque(Function::Atan2, self.value(y), self.value(x));
        let class = self.class(y.node()) | self.class(x.node());
        let node = Node::Atan2(y, x);
        match self.find_equal(node, value, class) {
            Some(known) => known,
            None => self.push(node, value, class),
        }
    }

    /// a^n for an integer n; `None` for a negative power of zero.
    pub fn powi(&mut self, base: Edge, exponent: i64) -> Option<Edge> {
        let mut result = self.one();
        let mut square = base;
        let mut rest = exponent.unsigned_abs();
        while rest > 0 {
            if rest & 1 == 1 {
                result = self.mul(result, square);
            }
            rest >>= 1;
            if rest > 0 {
                square = self.mul(square, square);
            }
        }
        if exponent < 0 {
            self.div(self.one(), result)
        } else {
            Some(result)
        }
    }

    /// Σ terms.
    pub fn sum(&mut self, terms: &[Edge]) -> Edge {
        terms
            .iter()
            .fold(self.zero(), |sum, &term| self.add(sum, term))
    }

    /// Σ aᵢ bᵢ.
    pub fn dot(&mut self, a: &[Edge], b: &[Edge]) -> Edge {
        let mut sum = self.zero();
        for (&x, &y) in a.iter().zip(b) {
            let product = self.mul(x, y);
            sum = self.add(sum, product);
        }
        sum
    }
}

fn ordered(a: Edge, b: Edge) -> (Edge, Edge) {
    if a <= b { (a, b) } else { (b, a) }
}
