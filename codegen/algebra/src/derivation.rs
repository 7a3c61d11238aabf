//! Derivations of the graph: f ↦ Σ (seed of s) ∂f/∂s over its symbols.
//!
//! Nodes are merged modulo the constraints φ, so only derivations that are tangent to the constraint
//! variety X are meaningful: ∂ᵢ of KR18 (9), d/dt along ẋ = A ξ, and derivatives by symbols that φ does not
//! contain (ξ, inputs, parameters).

use super::function::Slope;
use super::graph::{Edge, Graph, Node, NodeId, Power};
use num_rational::BigRational;
use num_traits::One;
use rustc_hash::FxHashMap;

/// A derivation, given by its action on symbols; it remembers the derivatives it has computed.
#[derive(Clone, Debug, Default)]
pub struct Derivation {
    memo: FxHashMap<NodeId, Edge>,
}

impl Derivation {
    /// Creates the derivation that maps the node of each symbol to its seed, and all other symbols to 0.
    pub fn new(seeds: impl IntoIterator<Item = (NodeId, Edge)>) -> Self {
        Derivation {
            memo: seeds.into_iter().collect(),
        }
    }

    /// Differentiates one expression.
    pub fn of(&mut self, graph: &mut Graph, edge: Edge) -> Edge {
        self.run(graph, edge.node());
        self.known_derivative(graph, edge)
    }

    /// Differentiates several expressions.
    pub fn all(&mut self, graph: &mut Graph, edges: &[Edge]) -> Vec<Edge> {
        edges.iter().map(|&edge| self.of(graph, edge)).collect()
    }

    fn known_derivative(&self, graph: &Graph, edge: Edge) -> Edge {
        let value = self.memo.get(&edge.node()).copied().unwrap_or(graph.zero());
        value.signed(edge.is_negative())
    }

    /// Differentiates a node after its children, without recursion.
    fn run(&mut self, graph: &mut Graph, root: NodeId) {
        let mut stack = vec![root];
        while let Some(&id) = stack.last() {
            if self.memo.contains_key(&id) {
                stack.pop();
                continue;
            }
            let node = graph.node(id);
            let before = stack.len();
            stack.extend(
                node.children()
                    .map(Edge::node)
                    .filter(|child| !self.memo.contains_key(child)),
            );
            if stack.len() == before {
                let derivative = self.derive_node(graph, id, node);
                self.memo.insert(id, derivative);
                stack.pop();
            }
        }
    }

    fn derive_node(&mut self, graph: &mut Graph, id: NodeId, node: Node) -> Edge {
        let zero = graph.zero();
        match node {
            Node::Constant(_) | Node::Symbol(_) => zero,
            Node::Add(a, b) => {
                let (da, db) = (
                    self.known_derivative(graph, a),
                    self.known_derivative(graph, b),
                );
                graph.add(da, db)
            }
            Node::Mul(a, b) => {
                if let Some(derivative) = self.of_power(graph, id) {
                    return derivative;
                }
                let (da, db) = (
                    self.known_derivative(graph, a),
                    self.known_derivative(graph, b),
                );
                let left = graph.mul(da, b);
                let right = graph.mul(a, db);
                graph.add(left, right)
            }
            Node::Div(a, b) => {
                // (a/b)' = (a' − (a/b) b')/b; b is not the zero node, or the quotient would not exist.
                let (da, db) = (
                    self.known_derivative(graph, a),
                    self.known_derivative(graph, b),
                );
                let product = graph.mul(Edge::of(id), db);
                let numerator = graph.sub(da, product);
                graph.div(numerator, b).unwrap_or(zero)
            }
            Node::Apply(function, a) => {
                let da = self.known_derivative(graph, a);
                if da == zero {
                    return zero;
                }
                match function.row().slope {
                    Slope::FunctionOfArgument(other) => {
                        let slope = graph.apply(other, a);
                        graph.mul(slope, da)
                    }
                    Slope::MinusFunctionOfArgument(other) => {
                        let slope = graph.apply(other, a);
                        -graph.mul(slope, da)
                    }
                    Slope::OwnValue => graph.mul(Edge::of(id), da),
                    Slope::InversePolynomial(coefficients) => {
                        let mut divisor = zero;
                        for &coefficient in coefficients.iter().rev() {
                            let product = graph.mul(divisor, a);
                            let coefficient = graph.ratio(coefficient.into(), 1);
                            divisor = graph.add(product, coefficient);
                        }
                        graph.div(da, divisor).unwrap_or(zero)
                    }
                    Slope::HalfInverseOfValue => {
                        let half = graph.ratio(1, 2);
                        let numerator = graph.mul(half, da);
                        graph.div(numerator, Edge::of(id)).unwrap_or(zero)
                    }
                    Slope::HalfFunctionOfValue(other) => {
                        let half = graph.ratio(1, 2);
                        let numerator = graph.mul(half, da);
                        let inverse = graph.apply(other, Edge::of(id));
                        graph.mul(numerator, inverse)
                    }
                    Slope::MinusSquareOfValue => {
                        let square = graph.mul(Edge::of(id), Edge::of(id));
                        -graph.mul(square, da)
                    }
                    Slope::OneMinusSquareOfValue => {
                        let square = graph.mul(Edge::of(id), Edge::of(id));
                        let slope = graph.sub(graph.one(), square);
                        graph.mul(slope, da)
                    }
                    Slope::ValueAtOne => graph.apply(function, da),
                    Slope::Zero | Slope::SeveralArguments => zero,
                }
            }
            Node::Select(c, a, b) => {
                let (da, db) = (
                    self.known_derivative(graph, a),
                    self.known_derivative(graph, b),
                );
                graph.select(c, da, db)
            }
            Node::Listed(..) => zero,
            Node::External(component, list) => {
                let terms = graph.list(list).into_iter().enumerate();
                let terms: Vec<Edge> = terms
                    .map(|(place, a)| {
                        let da = self.known_derivative(graph, a);
                        if da == zero {
                            return zero;
                        }
                        let slope = graph.external_of(component.differentiate(place), list);
                        graph.mul(slope, da)
                    })
                    .collect();
                graph.sum(&terms)
            }
            Node::Atan2(y, x) => {
                // (x y' − y x')/(x² + y²)
                let (dy, dx) = (
                    self.known_derivative(graph, y),
                    self.known_derivative(graph, x),
                );
                if dy == zero && dx == zero {
                    return zero;
                }
                let (xdy, ydx) = (graph.mul(x, dy), graph.mul(y, dx));
                let numerator = graph.sub(xdy, ydx);
                let (xx, yy) = (graph.mul(x, x), graph.mul(y, y));
                let square = graph.add(xx, yy);
                graph.div(numerator, square).unwrap_or(zero)
            }
        }
    }

    /// (w a sᶠ)′ = w′ a sᶠ + (1 + f) w a′ sᶠ, where a is a constant multiple of s, possibly after replacing
    /// factors v of a by |v|. This avoids dividing by an expression that may be 0. `None` for other
    /// products.
    fn of_power(&self, graph: &mut Graph, id: NodeId) -> Option<Edge> {
        let power = graph.fractional_power(id)?;
        let Power {
            rest,
            base,
            root,
            exponent,
            constants,
        } = power;
        let all = || rest.iter().chain(&base).chain(&constants);
        let is_known = |factor: &Edge| {
            let number = graph.as_rational(*factor).is_some();
            number || self.memo.contains_key(&factor.node())
        };
        if !all().all(is_known) {
            return None;
        }
        let constant = |factor: &Edge| self.known_derivative(graph, *factor) == graph.zero();
        if !constants.iter().all(constant) {
            return None;
        }
        let (rest, d_rest) = self.of_product(graph, &rest);
        let (base, d_base) = self.of_product(graph, &base);
        let with_root = graph.mul(base, root);
        let left = graph.mul(d_rest, with_root);
        let ratio = graph.rational(&(exponent + BigRational::one()));
        let right = graph.mul(rest, d_base);
        let right = graph.mul(right, root);
        let right = graph.mul(ratio, right);
        Some(graph.add(left, right))
    }

    /// Returns a product and its derivative.
    fn of_product(&self, graph: &mut Graph, factors: &[Edge]) -> (Edge, Edge) {
        let start = (graph.one(), graph.zero());
        factors.iter().fold(start, |(product, slope), &factor| {
            let own = self.known_derivative(graph, factor);
            let (left, right) = (graph.mul(slope, factor), graph.mul(product, own));
            (graph.mul(product, factor), graph.add(left, right))
        })
    }
}
