//! Turns nodes of the graph into expressions, with shared subexpressions as named temporaries.
//!
//! First a plan is made of how each node is shown and how often it is used, then expressions are built
//! from the leaves up. Nothing is recursive, since graphs are deep.

use super::entries::Definition;
use super::expression::{Atom, Term};
use super::naming::Temporaries;
use super::polish::{Letters, polish};
use super::simplify::Simplifier;
use super::style::Style;
use hamel_algebra::graph::{Edge, Function, Graph, Node, NodeId};
use hamel_algebra::poly::monomial::Var;
use hamel_algebra::poly::polynomial::Poly;
use hamel_algebra::topoly::OPAQUE;
use hamel_dynamics::normal::variable_node;
use num_rational::BigRational;
use num_traits::One;
use rustc_hash::{FxHashMap, FxHashSet};

enum Plan {
    Leaf,
    Polynomial(Poly<BigRational>),
    Structure,
}

/// Writes the expressions of one table.
pub struct Writer<'a> {
    graph: &'a Graph,
    simplifier: &'a mut Simplifier,
    style: Style,
    names: Temporaries,
    plans: FxHashMap<NodeId, Plan>,
    uses: FxHashMap<NodeId, usize>,
    kept: FxHashSet<NodeId>,
    terms: FxHashMap<NodeId, Term>,
}

impl<'a> Writer<'a> {
    /// Creates a writer for expressions of a graph.
    pub fn new(
        graph: &'a Graph,
        simplifier: &'a mut Simplifier,
        style: Style,
        names: Temporaries,
    ) -> Self {
        Writer {
            graph,
            simplifier,
            style,
            names,
            plans: FxHashMap::default(),
            uses: FxHashMap::default(),
            kept: FxHashSet::default(),
            terms: FxHashMap::default(),
        }
    }

    /// Prepares the expressions of all roots, which `value` and `polynomial` then return.
    pub fn prepare(&mut self, roots: &[Edge]) {
        self.plan(roots);
        for root in roots {
            self.build(root.node());
        }
    }

    /// Returns the expression of a root.
    pub fn value(&self, root: Edge) -> Term {
        self.term(root.node()).signed(root.is_negative())
    }

    /// Returns the polynomial of a root that is shown as one and has no name.
    pub fn polynomial(&self, root: Edge) -> Option<Poly<BigRational>> {
        if self.is_named(root.node()) {
            return None;
        }
        match self.plans.get(&root.node())? {
            Plan::Polynomial(polynomial) if root.is_negative() => Some(polynomial.neg()),
            Plan::Polynomial(polynomial) => Some(polynomial.clone()),
            Plan::Leaf | Plan::Structure => {
                let polynomial = match self.graph.node(root.node()) {
                    Node::Constant(index) => Poly::constant(self.graph.constant(index).clone()),
                    Node::Symbol(index) => Poly::var(index),
                    _ => return None,
                };
                Some(if root.is_negative() {
                    polynomial.neg()
                } else {
                    polynomial
                })
            }
        }
    }

    /// Polishes a polynomial in variables that have been written.
    pub fn polish(&self, polynomial: &Poly<BigRational>) -> Term {
        let is_free = |var| self.graph.is_free(variable_node(self.graph, var).node());
        let letters = Letters {
            atom: &|var| self.variable(var),
            is_free: &is_free,
        };
        polish(polynomial, &letters)
    }

    /// Returns the named values: those that depend on parameters alone, then the others.
    pub fn definitions(self) -> (Vec<Definition>, Vec<Definition>) {
        self.names.definitions()
    }

    fn plan(&mut self, roots: &[Edge]) {
        let mut stack: Vec<(NodeId, bool)> = roots.iter().map(|root| (root.node(), true)).collect();
        stack.reverse();
        if self.style == Style::Route {
            for root in roots {
                self.kept.insert(root.node());
            }
        }
        while let Some((id, whole)) = stack.pop() {
            *self.uses.entry(id).or_default() += 1;
            if self.plans.contains_key(&id) {
                continue;
            }
            let plan = self.choose(id, whole);
            let children = self.children(&plan, id);
            let inside = matches!(
                (&plan, self.graph.node(id)),
                (Plan::Structure, Node::Add(..) | Node::Mul(..))
            );
            if !self.graph.is_free(id) {
                self.kept.extend(&children);
            }
            stack.extend(children.into_iter().rev().map(|child| (child, !inside)));
            self.plans.insert(id, plan);
        }
    }

    fn choose(&mut self, id: NodeId, whole: bool) -> Plan {
        let polynomial = match (self.graph.node(id), self.style) {
            (Node::Constant(_) | Node::Symbol(_), _) => return Plan::Leaf,
            (Node::Add(..) | Node::Mul(..), Style::Table) if whole => {
                self.simplifier.whole(self.graph, id)
            }
            (Node::Add(..) | Node::Mul(..), Style::Table) => self.simplifier.part(self.graph, id),
            (Node::Add(..) | Node::Mul(..), Style::Route) if self.graph.is_free(id) => {
                let short = self.simplifier.part(self.graph, id);
                short.filter(|p| p.terms().len() <= 4 && p.variables().iter().all(|&v| v < OPAQUE))
            }
            _ => None,
        };
        polynomial.map_or(Plan::Structure, Plan::Polynomial)
    }

    fn children(&self, plan: &Plan, id: NodeId) -> Vec<NodeId> {
        match plan {
            Plan::Leaf => Vec::new(),
            Plan::Structure => self.graph.node(id).children().map(Edge::node).collect(),
            Plan::Polynomial(polynomial) => {
                let powers = polynomial.terms().iter().flat_map(|(m, _)| m.powers());
                powers
                    .filter_map(|&(var, _)| var.checked_sub(OPAQUE))
                    .collect()
            }
        }
    }

    fn build(&mut self, root: NodeId) {
        let mut stack = vec![(root, false)];
        while let Some((id, ready)) = stack.pop() {
            if self.terms.contains_key(&id) {
                continue;
            }
            if ready {
                let term = self.local(id);
                let term = self.name_if_shared(id, term);
                self.terms.insert(id, term);
                continue;
            }
            stack.push((id, true));
            let children = self.plans.get(&id).map(|plan| self.children(plan, id));
            let children = children.unwrap_or_default();
            stack.extend(children.into_iter().rev().map(|child| (child, false)));
        }
    }

    fn local(&self, id: NodeId) -> Term {
        if let Some(Plan::Polynomial(polynomial)) = self.plans.get(&id) {
            return self.polish(polynomial);
        }
        let call = |function, arguments: Vec<Term>| Term::atom(Atom::Call(function, arguments));
        match self.graph.node(id) {
            Node::Constant(index) => Term::number(self.graph.constant(index).clone()),
            Node::Symbol(index) => self.variable(index),
            Node::Add(a, b) => Term::sum(vec![self.value(a), self.value(b)]),
            Node::Mul(a, b) => self.value(a).times(&self.value(b)),
            Node::Div(a, b) => self.value(a).divided(&self.value(b)),
            Node::Apply(function, a) => call(function, vec![self.value(a)]),
            Node::Atan2(y, x) => call(Function::Atan2, vec![self.value(y), self.value(x)]),
            // Read only by the call that it belongs to.
            Node::Listed(..) => Term::number(BigRational::one()),
            Node::External(component, list) => {
                let name = self.graph.external_call_text(component, "");
                let (head, part) = name.split_once("()").unwrap_or((&name, ""));
                let given = self.graph.list(list).into_iter();
                Term::atom(Atom::External {
                    name: head.into(),
                    arguments: given.map(|edge| self.value(edge)).collect(),
                    part: part.into(),
                })
            }
            Node::Select(c, a, b) => {
                let list = [c, a, b].map(|edge| self.value(edge));
                call(Function::Select, list.into())
            }
        }
    }

    /// Returns the name of a value if it should have one, or else the value itself.
    fn name_if_shared(&mut self, id: NodeId, term: Term) -> Term {
        if matches!(self.plans.get(&id), Some(Plan::Leaf)) {
            return term;
        }
        let weight = term.weight();
        let uses = self.uses.get(&id).copied().unwrap_or(0);
        let free = self.graph.is_free(id);
        let route = self.style == Style::Route;
        let shared = uses > 1 && weight >= self.style.shared();
        let long = weight > self.style.longest() && !(self.names.is_root(id) && uses < 2);
        let kept = route && free && self.kept.contains(&id);
        let user_names = route && self.names.is_user_named(id);
        if shared || long || kept || user_names {
            self.names.claim(id, term, route && free)
        } else {
            term
        }
    }

    fn is_named(&self, id: NodeId) -> bool {
        self.names.is_named(id)
    }

    fn variable(&self, var: Var) -> Term {
        match var.checked_sub(OPAQUE) {
            Some(id) => self.term(id),
            None => Term::name(&self.graph.symbols()[var as usize].name),
        }
    }

    fn term(&self, id: NodeId) -> Term {
        // The children of a planned node are planned, and written before it: none is missing here.
        let known = self.terms.get(&id).cloned();
        known.unwrap_or_else(|| Term::number(BigRational::one()))
    }
}
