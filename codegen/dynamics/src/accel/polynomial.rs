//! Polynomial route: the right-hand side of KR18 (30c) is expanded into run-time monomials with constant
//! coefficients, and factored again.
//!
//! This gives the shortest code for small systems. If M is constant, M⁻¹ can be multiplied into the coefficients.

use super::best::AccelerationCandidate;
use super::parts::EquationTerms;
use super::parts::{ReferencePoint, TracingVariant, trace_terms};
use super::solve::{EliminationPlan, solve};
use super::solve::{all_plans, describe_order};
use crate::calculus::Calculus;
use crate::normal::{NormalForms, RunTimePolynomial, collect_run_time_terms, variable_node};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::solve_symmetric;
use hamel_algebra::poly::factor::{Coefficient, Operand, Step, Term, Value, factor};
use hamel_algebra::poly::monomial::Var;
use hamel_algebra::topoly::OPAQUE;
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;
use hamel_language::syntax::ast::Axes;
use hamel_program::count::count;
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of run-time terms of a system that is expanded.
const MAX_TERMS: usize = 260;
/// Largest number of terms if M is constant but not inverted into the coefficients; for larger systems, tracing the
/// bodies gives a smaller right-hand side.
const MAX_CONSTANT_MASS_TERMS: usize = 40;
/// Number of products and sums of terms after which the expansion is abandoned in favour of the traced expressions.
const MAX_TERM_OPERATIONS: usize = 1_000_000;

/// Returns computations of ξ̇ from M and forces that are expanded to polynomials, of those that may cost less than
/// `most`; empty if the system is too large to expand.
pub fn polynomial_candidates(model: &Model, most: usize) -> Vec<AccelerationCandidate> {
    let mut traced = model.clone();
    let variant = TracingVariant {
        axes: Axes::World,
        reference: ReferencePoint::Com,
        shift: None,
    };
    let mut calculus = Calculus::new(model);
    let parts = trace_terms(&mut traced, &mut calculus, variant);
    let mut forms = NormalForms::with_budget(&model.points, MAX_TERM_OPERATIONS).keeping_powers();
    let mut all = Vec::new();
    let mut before: Option<System> = None;
    for reduced in [false, true] {
        let Some(system) = System::expand(model, &traced, &parts, &mut forms, reduced) else {
            continue;
        };
        if before
            .as_ref()
            .is_some_and(|before| before.right == system.right && before.varying == system.varying)
        {
            continue;
        }
        all.extend(system.inverted(most));
        all.extend(system.solved(model, most));
        before = Some(system);
    }
    all
}

/// Right-hand side and mass matrix as polynomials, in a graph that contains only the model and the polynomials'
/// coefficients.
struct System {
    graph: Graph,
    right: Vec<RunTimePolynomial>,
    /// Varying entries of the lower triangle of M, with their row and column.
    varying: Vec<(usize, usize, RunTimePolynomial)>,
    /// Mass matrix M; only its constant entries are filled in.
    mass: Vec<Vec<Edge>>,
    /// Expressions in `graph` for the variables that are not symbols.
    opaque: BTreeMap<Var, Edge>,
    reduced: bool,
}

impl System {
    fn expand(
        model: &Model,
        traced: &Model,
        parts: &EquationTerms,
        forms: &mut NormalForms,
        reduced: bool,
    ) -> Option<Self> {
        let n = model.n();
        let mut source = traced.graph.clone();
        let mut polynomial = |source: &mut Graph, edges: &[Edge]| -> Option<RunTimePolynomial> {
            let mut sum = hamel_algebra::poly::polynomial::Poly::zero();
            for &edge in edges {
                sum = sum.add(&forms.expand(source, edge)?);
            }
            let normal = if reduced {
                forms.reduce(source, &sum)
            } else {
                sum
            };
            let collected = collect_run_time_terms(source, &normal);
            (collected.len() <= MAX_TERMS).then_some(collected)
        };
        let mut graph = model.graph.clone();
        let mut right = Vec::new();
        for i in 0..n {
            let column: Vec<Edge> = parts.groups.iter().map(|group| group[i]).collect();
            right.push(polynomial(&mut source, &column)?);
        }
        let mut varying = Vec::new();
        let mut mass = vec![vec![graph.zero(); n]; n];
        for i in 0..n {
            for j in 0..=i {
                let edge = parts.mass[i][j];
                if source.is_free(edge.node()) {
                    mass[i][j] = rebuild(&source, &mut graph, &[edge])[0];
                    mass[j][i] = mass[i][j];
                } else {
                    varying.push((i, j, polynomial(&mut source, &[edge])?));
                }
            }
        }
        // Move the coefficients and the opaque variables to the small graph.
        let mut opaque = BTreeMap::new();
        for collected in right
            .iter_mut()
            .chain(varying.iter_mut().map(|(_, _, c)| c))
        {
            for (monomial, coefficient) in collected.iter_mut() {
                *coefficient = rebuild(&source, &mut graph, &[*coefficient])[0];
                for &(var, _) in monomial.powers() {
                    if var >= OPAQUE && !opaque.contains_key(&var) {
                        let node = variable_node(&source, var);
                        let moved = rebuild(&source, &mut graph, &[node])[0];
                        opaque.insert(var, moved);
                    }
                }
            }
        }
        let terms: usize = right.iter().map(|c| c.len()).sum();
        (terms <= MAX_TERMS).then_some(System {
            graph,
            right,
            varying,
            mass,
            opaque,
            reduced,
        })
    }

    /// Builds ξ̇ = M⁻¹ f with the constant M⁻¹ multiplied into the coefficients of f.
    fn inverted(&self, most: usize) -> Option<AccelerationCandidate> {
        if !self.varying.is_empty() {
            return None;
        }
        let n = self.mass.len();
        let mut graph = self.graph.clone();
        let identity: Vec<Vec<Edge>> = (0..n)
            .map(|i| {
                (0..n)
                    .map(|j| if i == j { graph.one() } else { graph.zero() })
                    .collect()
            })
            .collect();
        let inverse = solve_symmetric(&mut graph, &self.mass, &identity)?;
        let polynomials: Vec<RunTimePolynomial> = (0..n)
            .map(|i| {
                let mut sum = RunTimePolynomial::new();
                for j in 0..n {
                    if inverse[i][j] == graph.zero() {
                        continue;
                    }
                    for (monomial, &coefficient) in &self.right[j] {
                        let product = graph.mul(inverse[i][j], coefficient);
                        let entry = sum.entry(monomial.clone()).or_insert(graph.zero());
                        *entry = graph.add(*entry, product);
                    }
                }
                sum.retain(|_, coefficient| *coefficient != graph.zero());
                sum
            })
            .collect();
        let terms: usize = polynomials.iter().map(BTreeMap::len).sum();
        if terms > MAX_TERMS || min_operations(&graph, &polynomials) >= most {
            return None;
        }
        let xi_dot = self.factored(&mut graph, &polynomials);
        // The pivots of the constant M must still be checked for being positive.
        let parts = EquationTerms {
            mass: self.mass.clone(),
            groups: Vec::new(),
            inertia: Vec::new(),
            conservative: Vec::new(),
            applied: Vec::new(),
            ..EquationTerms::default()
        };
        let plan = EliminationPlan {
            order: (0..n).collect(),
            apart: 0,
            scale: false,
            inverse: false,
        };
        let pivots = solve(&mut graph, &parts, &plan)?.pivots;
        Some(self.finish(graph, xi_dot, pivots, "M⁻¹ in its coefficients"))
    }

    /// Builds candidates that solve M ξ̇ = f, with f and the varying entries of M factored together.
    fn solved(&self, model: &Model, most: usize) -> Vec<AccelerationCandidate> {
        let n = self.mass.len();
        let mut graph = self.graph.clone();
        let polynomials: Vec<RunTimePolynomial> = self
            .right
            .iter()
            .chain(self.varying.iter().map(|(_, _, c)| c))
            .cloned()
            .collect();
        let terms: usize = polynomials.iter().map(BTreeMap::len).sum();
        let constant = self.varying.is_empty() && terms > MAX_CONSTANT_MASS_TERMS;
        if constant || min_operations(&graph, &polynomials) >= most {
            return Vec::new();
        }
        let values = self.factored(&mut graph, &polynomials);
        let mut mass = self.mass.clone();
        for ((i, j, _), &value) in self.varying.iter().zip(&values[n..]) {
            mass[*i][*j] = value;
            mass[*j][*i] = value;
        }
        let parts = EquationTerms {
            mass,
            groups: vec![values[..n].to_vec()],
            inertia: Vec::new(),
            conservative: Vec::new(),
            applied: Vec::new(),
            ..EquationTerms::default()
        };
        all_plans(&graph, &parts)
            .into_iter()
            .filter_map(|plan| {
                let mut graph = graph.clone();
                let solution = solve(&mut graph, &parts, &plan)?;
                let how = describe_order(model, &plan.order);
                Some(self.finish(graph, solution.xi_dot, solution.pivots, &how))
            })
            .collect()
    }

    fn finish(
        &self,
        graph: Graph,
        xi_dot: Vec<Edge>,
        pivots: Vec<Edge>,
        how: &str,
    ) -> AccelerationCandidate {
        let mut roots = xi_dot.clone();
        roots.extend(pivots.iter().filter(|pivot| !graph.is_free(pivot.node())));
        let (count, depth) = (count(&graph, &roots), graph.depth(&roots));
        let modulo = if self.reduced { " modulo φ" } else { "" };
        AccelerationCandidate {
            other: None,
            loss: 0,
            multipliers: Vec::new(),
            projections: None,
            route: format!("right-hand side expanded{modulo} and factored, {how}"),
            graph,
            xi_dot,
            pivots,
            twist: false,
            count,
            depth,
        }
    }

    /// Builds the polynomials as expressions with few operations.
    fn factored(&self, graph: &mut Graph, polynomials: &[RunTimePolynomial]) -> Vec<Edge> {
        // Coefficient 0 is the number 1; the others are numbered by first use.
        let mut coefficients = vec![graph.one()];
        let terms: Vec<Vec<Term>> = polynomials
            .iter()
            .map(|collected| {
                collected
                    .iter()
                    .map(|(monomial, &edge)| {
                        let place = coefficients
                            .iter()
                            .position(|&known| known == edge.abs())
                            .unwrap_or_else(|| {
                                coefficients.push(edge.abs());
                                coefficients.len() - 1
                            });
                        Term {
                            coefficient: Coefficient {
                                id: place as u32,
                                negative: edge.is_negative(),
                            },
                            monomial: monomial.clone(),
                        }
                    })
                    .collect()
            })
            .collect();
        let program = factor(&terms);
        let mut values: Vec<Edge> = Vec::with_capacity(program.steps.len());
        let read = |graph: &Graph, values: &[Edge], operand: Operand| {
            let edge = match operand.value {
                Value::Zero => graph.zero(),
                Value::Coefficient(id) => coefficients[id as usize],
                Value::Var(var) => self
                    .opaque
                    .get(&var)
                    .copied()
                    .unwrap_or_else(|| variable_node(graph, var)),
                Value::Step(index) => values[index],
            };
            edge.signed(operand.negative)
        };
        for step in &program.steps {
            let value = match *step {
                Step::Mul(a, b) => {
                    let (a, b) = (read(graph, &values, a), read(graph, &values, b));
                    graph.mul(a, b)
                }
                Step::Add(a, b) => {
                    let (a, b) = (read(graph, &values, a), read(graph, &values, b));
                    graph.add(a, b)
                }
            };
            values.push(value);
        }
        program
            .outputs
            .iter()
            .map(|&output| read(graph, &values, output))
            .collect()
    }
}

/// Returns a lower bound on the number of operations, which no factoring can go below.
///
/// Every coefficient other than 1 takes part in a product. Terms whose coefficient occurs in only one polynomial
/// cannot be summed anywhere else. Polynomials that have such terms of degree two or more are independent, so each
/// of them needs a product of variables of its own.
fn min_operations(graph: &Graph, polynomials: &[RunTimePolynomial]) -> usize {
    let mut rows: BTreeMap<Edge, BTreeSet<usize>> = BTreeMap::new();
    for (row, collected) in polynomials.iter().enumerate() {
        for coefficient in collected.values() {
            rows.entry(coefficient.abs()).or_default().insert(row);
        }
    }
    rows.remove(&graph.one());
    let own = |edge: &Edge| rows.get(&edge.abs()).is_some_and(|rows| rows.len() == 1);
    let sums: usize = polynomials
        .iter()
        .map(|collected| {
            collected
                .values()
                .filter(|edge| own(edge))
                .count()
                .saturating_sub(1)
        })
        .sum();
    let products = polynomials
        .iter()
        .filter(|collected| {
            collected
                .iter()
                .any(|(monomial, edge)| monomial.degree() > 1 && own(edge))
        })
        .count();
    rows.len() + sums + products
}
