//! Conversion of graph nodes to polynomials, where these are of bearable size.
//!
//! A symbol is the variable of its index. Any other node that is neither a sum nor a product (a function, a
//! quotient) is a variable of its own, numbered from `OPAQUE` on by its node. On request, this also applies
//! to linear forms of which a third or a higher power is taken, such as x − c in (x − c)³: near its zero
//! the expanded terms would cancel, and all digits would be lost.

use super::graph::{Edge, Graph, Node, NodeId};
use super::poly::field::Field;
use super::poly::monomial::Var;
use super::poly::polynomial::Poly;
use num_rational::BigRational;
use rustc_hash::{FxHashMap, FxHashSet};
use std::borrow::Cow;

/// First of the variables that stand for nodes which are not polynomials themselves.
pub const OPAQUE: Var = 1 << 24;

/// Largest number of terms of an intermediate polynomial.
pub const MAX_TERMS: usize = 4000;

/// Factor by which a polynomial may exceed the largest number of terms before it is reduced.
const UNREDUCED_FACTOR: usize = 4;

/// Largest number of terms of a polynomial that is short enough not to be reduced on the way.
const MAX_TERMS_LEFT_UNREDUCED: usize = 16;

/// Highest degree of an intermediate polynomial; otherwise towers of powers would reach degrees that no
/// exponent can hold.
pub const MAX_DEGREE: u32 = 100;

/// Budget for expanding a linear form whose powers are kept, in products and sums of terms.
const BASE_WORK: usize = 100;

/// a b, unless it has more than `most` terms or too high a degree.
fn product<F: Field>(a: &Poly<F>, b: &Poly<F>, most: usize) -> Option<Poly<F>> {
    if a.degree() + b.degree() > MAX_DEGREE {
        return None;
    }
    a.mul_limited(b, most)
}

/// Converter of nodes to polynomials over Q, which remembers its results.
pub struct Expander {
    memo: FxHashMap<NodeId, Option<Poly<BigRational>>>,
    /// Number of products and sums of terms that may still be made.
    work: usize,
    /// Largest number of terms of a polynomial, intermediate ones included.
    most_terms: usize,
    /// Linear forms that are variables, if powers are kept.
    bases: Option<FxHashSet<NodeId>>,
}

impl Default for Expander {
    fn default() -> Self {
        Expander::with_work_limit(usize::MAX)
    }
}

impl Expander {
    /// Creates an expander that gives up after `work` products and sums of terms. Whatever is not expanded
    /// by then has no polynomial.
    pub fn with_work_limit(work: usize) -> Self {
        Expander {
            memo: FxHashMap::default(),
            work,
            most_terms: MAX_TERMS,
            bases: None,
        }
    }

    /// Returns the expander with a limit on the number of terms of intermediate polynomials; longer ones
    /// are given up.
    pub fn with_term_limit(mut self, most: usize) -> Self {
        self.most_terms = most;
        self
    }

    /// Changes the limit on the number of terms from now on; what has been expanded stays.
    pub fn limit_terms(&mut self, most: usize) {
        self.most_terms = most;
    }

    /// Returns the expander with linear forms as variables if a third or a higher power of them is taken.
    pub fn with_kept_powers(mut self) -> Self {
        self.bases = Some(FxHashSet::default());
        self
    }

    /// Expands an expression to a polynomial; `None` if it has too many terms.
    pub fn expand(&mut self, graph: &Graph, edge: Edge) -> Option<Poly<BigRational>> {
        if self.bases.is_some() {
            self.keep_powers(graph, &graph.reachable(&[edge]));
        }
        for id in self.unexpanded(graph, edge) {
            let polynomial = self.expand_node(graph, id, self.most_terms);
            self.memo.insert(id, polynomial);
        }
        self.signed(edge).map(Cow::into_owned)
    }

    /// Expands an expression to a polynomial modulo an ideal. `reduce` returns a representative of each
    /// intermediate polynomial that has more than `MAX_TERMS_LEFT_UNREDUCED` terms.
    ///
    /// Returns `None` if a representative has too many terms, if a product before reduction has far too
    /// many, or if more than `work` products and sums of terms are needed. Parts that were not reached then
    /// are expanded when they are requested again. One expander serves one ideal.
    pub fn expand_modulo(
        &mut self,
        graph: &Graph,
        edge: Edge,
        work: usize,
        reduce: &mut dyn FnMut(&Graph, Poly<BigRational>) -> Poly<BigRational>,
    ) -> Option<Poly<BigRational>> {
        self.work = work;
        for id in self.unexpanded(graph, edge) {
            let mut polynomial = self.expand_node(graph, id, UNREDUCED_FACTOR * self.most_terms);
            if self.work == 0 {
                return None;
            }
            let terms = |polynomial: &Poly<BigRational>| polynomial.terms().len();
            let length = polynomial.as_ref().map_or(0, terms);
            if length > MAX_TERMS_LEFT_UNREDUCED {
                // Each term may be replaced by others, which have to be inserted among the rest.
                self.spend(length * length / 8)?;
                polynomial = polynomial.map(|polynomial| reduce(graph, polynomial));
            }
            let polynomial = polynomial.filter(|polynomial| terms(polynomial) <= self.most_terms);
            self.memo.insert(id, polynomial);
        }
        self.signed(edge).map(Cow::into_owned)
    }

    /// Returns the parts of an expression that have not been expanded, children first.
    fn unexpanded(&self, graph: &Graph, edge: Edge) -> Vec<NodeId> {
        let mut found = FxHashSet::default();
        let mut open = vec![edge.node()];
        while let Some(id) = open.pop() {
            if !self.memo.contains_key(&id) && found.insert(id) {
                open.extend(graph.node(id).children().map(Edge::node));
            }
        }
        let mut found: Vec<NodeId> = found.into_iter().collect();
        found.sort_unstable();
        found
    }

    /// Finds the linear forms whose powers are kept. If there are new ones, everything expanded before is
    /// expanded again.
    fn keep_powers(&mut self, graph: &Graph, ids: &[NodeId]) {
        let Some(mut bases) = self.bases.take() else {
            return;
        };
        let before = bases.len();
        for &id in ids.iter().filter(|id| !self.memo.contains_key(id)) {
            let Some(base) = graph.power_of_sum(id).filter(|base| !bases.contains(base)) else {
                continue;
            };
            let expanded = Expander::with_work_limit(BASE_WORK).expand(graph, Edge::of(base));
            if expanded.is_some_and(|form| form.degree() == 1) {
                bases.insert(base);
            }
        }
        if bases.len() > before {
            self.memo.clear();
        }
        for &base in &bases {
            self.memo.insert(base, Some(Poly::var(OPAQUE + base)));
        }
        self.bases = Some(bases);
    }

    fn signed(&self, edge: Edge) -> Option<Cow<'_, Poly<BigRational>>> {
        let polynomial = self.memo.get(&edge.node())?.as_ref()?;
        Some(if edge.is_negative() {
            Cow::Owned(polynomial.neg())
        } else {
            Cow::Borrowed(polynomial)
        })
    }

    /// Takes work from the budget; `None` if the budget does not suffice.
    fn spend(&mut self, work: usize) -> Option<()> {
        let left = self.work.checked_sub(work);
        self.work = left.unwrap_or(0);
        left.map(|_| ())
    }

    fn terms(&self, edge: Edge) -> Option<usize> {
        Some(self.memo.get(&edge.node())?.as_ref()?.terms().len())
    }

    fn expand_node(&mut self, graph: &Graph, id: NodeId, most: usize) -> Option<Poly<BigRational>> {
        match graph.node(id) {
            Node::Add(a, b) => self.spend(self.terms(a)? + self.terms(b)?)?,
            Node::Mul(a, b) => self.spend(self.terms(a)? * self.terms(b)?)?,
            _ => {}
        }
        match graph.node(id) {
            Node::Constant(index) => Some(Poly::constant(graph.constant(index).clone())),
            Node::Symbol(index) => Some(Poly::var(index)),
            Node::Add(a, b) => {
                let (a, b) = (self.signed(a)?, self.signed(b)?);
                let sum = a.add(&b);
                (sum.terms().len() <= most).then_some(sum)
            }
            Node::Mul(a, b) => {
                let (a, b) = (self.signed(a)?, self.signed(b)?);
                product(&a, &b, most)
            }
            _ => Some(Poly::var(OPAQUE + id)),
        }
    }
}

/// Whether an expression is polynomial in the symbols of these classes.
pub fn is_polynomial(graph: &Graph, edge: Edge, classes: u8) -> bool {
    graph
        .reachable(&[edge])
        .into_iter()
        .all(|id| match graph.node(id) {
            Node::Constant(_) | Node::Symbol(_) | Node::Add(..) | Node::Mul(..) => true,
            Node::Div(_, b) => graph.class(b.node()) & classes == 0,
            _ => graph.class(id) & classes == 0,
        })
}
