//! Normal forms modulo φ of small expressions, for output that people read and for expressions that
//! are expanded to be factored anew.

use crate::calculus::Calculus;
use hamel_algebra::graph::{Edge, Function, Graph, Node};
use hamel_algebra::poly::buchberger::{Limits, groebner};
use hamel_algebra::poly::ideals;
use hamel_algebra::poly::monomial::{Monomial, Var};
use hamel_algebra::poly::normal_form::Basis;
use hamel_algebra::poly::order::Order;
use hamel_algebra::poly::polynomial::Poly;
use hamel_algebra::topoly::{Expander, OPAQUE};
use hamel_language::model::layout::Block;
use hamel_language::model::points::Points;
use num_rational::BigRational;
use std::collections::BTreeMap;

/// Expander of expressions to polynomials with their normal forms modulo the ideal of φ, over the rationals.
///
/// One instance serves one graph, which may grow.
pub struct NormalForms {
    /// Polynomials without reduction.
    expander: Expander,
    /// Polynomials in normal form.
    reduced: Expander,
    ideal: Ideal,
}

/// Largest number of products and sums of terms for one normal form.
const MAX_TERM_OPERATIONS: usize = 60_000;

/// Largest number of terms of an intermediate normal form.
const MAX_NORMAL_FORM_TERMS: usize = 200;

impl NormalForms {
    /// Computes the Gröbner bases of φ; constraints whose basis is too large are left out.
    pub fn new(points: &Points) -> Self {
        NormalForms::with_budget(points, usize::MAX)
    }

    /// As [`NormalForms::new`], with a budget of `work` products and sums of terms for all
    /// expansions together.
    ///
    /// Expressions that are not expanded within the budget count as too large.
    pub fn with_budget(points: &Points, work: usize) -> Self {
        let mut expander = Expander::default();
        let mut generators: Vec<Vec<Poly<BigRational>>> = Vec::new();
        let mut place = points.first as Var;
        for &block in &points.blocks {
            match block {
                Block::Flat(_) => {}
                Block::Circle => generators.push(ideals::circle(place, place + 1)),
                Block::Quaternion => {
                    generators.push(ideals::quaternion(std::array::from_fn(|i| {
                        place + i as Var
                    })))
                }
                Block::Rotation => {
                    generators.push(ideals::rotation(std::array::from_fn(|i| place + i as Var)))
                }
            }
            place += block.len() as Var;
        }
        for &constraint in &points.constraints {
            let Some(polynomial) = expander.expand(&points.free, constraint) else {
                continue;
            };
            // A function or a quotient is a node of the free graph and has no meaning in other
            // graphs.
            if polynomial.variables().iter().any(|v| *v >= OPAQUE) {
                continue;
            }
            // Join the constraint with the ideals that share coordinates with it.
            let mut joined = vec![polynomial];
            let mut rest = Vec::new();
            for ideal in generators {
                let first = points.first as Var;
                let shares = |a: &Poly<BigRational>| {
                    joined.iter().any(|b| {
                        a.variables()
                            .iter()
                            .any(|v| *v >= first && b.variables().contains(v))
                    })
                };
                if ideal.iter().any(shares) {
                    joined.extend(ideal)
                } else {
                    rest.push(ideal)
                }
            }
            generators = rest;
            generators.push(joined);
        }
        let bases = generators
            .iter()
            .filter_map(|ideal| groebner(ideal, Order::Grevlex, Limits::default()).ok())
            .collect();
        NormalForms {
            expander: Expander::with_work_limit(work),
            reduced: Expander::default().with_term_limit(MAX_NORMAL_FORM_TERMS),
            ideal: Ideal {
                angles: Angles::default(),
                bases,
                circles: BTreeMap::new(),
            },
        }
    }

    /// Limits the number of terms of intermediate polynomials; larger expressions are given up.
    pub fn with_max_terms(mut self, most: usize) -> Self {
        self.expander = self.expander.with_term_limit(most);
        self
    }

    /// Limits the number of terms of intermediate normal forms from now on.
    pub fn limit_terms(&mut self, most: usize) {
        self.reduced.limit_terms(most);
    }

    /// Keeps powers of linear forms unexpanded, which preserves the digits of, e.g., (x − c)³ near
    /// c.
    pub fn keeping_powers(mut self) -> Self {
        self.expander = self.expander.with_kept_powers();
        self
    }

    /// Expands an expression to a polynomial, without reduction modulo φ; `None` if it is none, or too large.
    pub fn expand(&mut self, graph: &Graph, edge: Edge) -> Option<Poly<BigRational>> {
        self.expander.expand(graph, edge)
    }

    /// Returns the normal form of a polynomial modulo the ideal of φ.
    pub fn reduce(&mut self, graph: &Graph, polynomial: &Poly<BigRational>) -> Poly<BigRational> {
        self.ideal.reduce(graph, polynomial.clone())
    }

    /// Returns the normal form of an expression; intermediate polynomials are reduced, too, where
    /// they are long.
    pub fn normal_form(&mut self, graph: &Graph, edge: Edge) -> Option<Poly<BigRational>> {
        let ideal = &mut self.ideal;
        let mut reduce = |graph: &Graph, polynomial| ideal.reduce(graph, polynomial);
        let polynomial =
            self.reduced
                .expand_modulo(graph, edge, MAX_TERM_OPERATIONS, &mut reduce)?;
        Some(self.ideal.reduce(graph, polynomial))
    }
}

/// Ideal of φ, and those of the circles of cos a and sin a.
struct Ideal {
    angles: Angles,
    bases: Vec<Basis<BigRational>>,
    circles: BTreeMap<Var, Option<Basis<BigRational>>>,
}

impl Ideal {
    fn reduce(&mut self, graph: &Graph, polynomial: Poly<BigRational>) -> Poly<BigRational> {
        let mut result = polynomial;
        for basis in &self.bases {
            if !basis.is_reduced(&result) {
                result = basis.normal_form(&result);
            }
        }
        for var in result.variables() {
            if let Some((cos, sin)) = self.angles.pair(graph, var) {
                let ideal =
                    || groebner(&ideals::circle(cos, sin), Order::Grevlex, Limits::default()).ok();
                let Some(basis) = self.circles.entry(cos).or_insert_with(ideal) else {
                    continue;
                };
                if !basis.is_reduced(&result) {
                    result = basis.normal_form(&result);
                }
            }
        }
        result
    }
}

/// Nodes of sin a and cos a, by angle; each node of the growing graph is scanned once.
#[derive(Default)]
struct Angles {
    scanned: u32,
    known: BTreeMap<Edge, [Option<Var>; 2]>,
}

impl Angles {
    /// Returns the variables of cos a and sin a if `var` is one of them and both exist.
    fn pair(&mut self, graph: &Graph, var: Var) -> Option<(Var, Var)> {
        let Node::Apply(Function::Sin | Function::Cos, angle) =
            graph.node(var.checked_sub(OPAQUE)?)
        else {
            return None;
        };
        for id in self.scanned..graph.len() as u32 {
            if let Node::Apply(function @ (Function::Sin | Function::Cos), angle) = graph.node(id) {
                self.known.entry(angle.abs()).or_default()[(function == Function::Sin) as usize]
                    .get_or_insert(OPAQUE + id);
            }
        }
        self.scanned = graph.len() as u32;
        let [cos, sin] = self.known.get(&angle.abs())?;
        Some(((*cos)?, (*sin)?))
    }
}

/// Returns the node that a variable stands for.
pub fn variable_node(graph: &Graph, var: Var) -> Edge {
    match var.checked_sub(OPAQUE) {
        Some(id) => Edge::of(id),
        None => Edge::of(graph.symbols()[var as usize].node),
    }
}

/// Polynomial in the variables that vary at run time, with expressions that do not vary as
/// coefficients.
pub type RunTimePolynomial = BTreeMap<Monomial, Edge>;

/// Groups the terms of a polynomial by monomials in what varies at run time; the coefficients are built in the graph.
pub fn collect_run_time_terms(
    graph: &mut Graph,
    polynomial: &Poly<BigRational>,
) -> RunTimePolynomial {
    let mut collected = RunTimePolynomial::new();
    for (monomial, number) in polynomial.terms() {
        let mut coefficient = graph.rational(number);
        let mut powers = Vec::new();
        for &(var, exponent) in monomial.powers() {
            let node = variable_node(graph, var);
            if graph.is_free(node.node()) {
                for _ in 0..exponent {
                    coefficient = graph.mul(coefficient, node);
                }
            } else {
                powers.push((var, exponent));
            }
        }
        let entry = collected
            .entry(Monomial::from_powers(powers))
            .or_insert(graph.zero());
        *entry = graph.add(*entry, coefficient);
    }
    collected.retain(|_, coefficient| *coefficient != graph.zero());
    collected
}

/// Rewrites an expression that is constant on X so that it contains no coordinates; returns it unchanged if that fails.
///
/// If all ∂ᵢf = 0, no coordinate is left in the normal form. Other expressions are returned
/// unchanged. The bases are computed when they are first needed.
pub fn eliminate_coordinates(
    graph: &mut Graph,
    calculus: &mut Calculus,
    points: &Points,
    forms: &mut Option<NormalForms>,
    edge: Edge,
) -> Edge {
    let coord = hamel_language::model::class::COORD;
    if graph.class(edge.node()) & coord == 0
        || (0..calculus.n()).any(|i| calculus.along(graph, i, edge) != graph.zero())
    {
        return edge;
    }
    let forms = forms.get_or_insert_with(|| NormalForms::new(points));
    let Some(polynomial) = forms.expand(graph, edge) else {
        return edge;
    };
    let reduced = forms.reduce(graph, &polynomial);
    let result = build_expression(graph, &reduced);
    if graph.class(result.node()) & coord == 0 {
        result
    } else {
        edge
    }
}

/// Builds the expression of a polynomial, term by term.
pub fn build_expression(graph: &mut Graph, polynomial: &Poly<BigRational>) -> Edge {
    let collected = collect_run_time_terms(graph, polynomial);
    let mut sum = graph.zero();
    for (monomial, coefficient) in collected {
        let mut term = coefficient;
        for &(var, exponent) in monomial.powers() {
            let node = variable_node(graph, var);
            for _ in 0..exponent {
                term = graph.mul(term, node);
            }
        }
        sum = graph.add(sum, term);
    }
    sum
}
