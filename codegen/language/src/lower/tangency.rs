//! Checks ẋ = A ξ: that it is linear in ξ and tangent to φ = 0, and that A is a basis of the tangent space.

use super::affine::Affine;
use super::configuration_manifold::{ConfigurationManifold, Origin};
use super::declare::Declared;
use super::rate::{Rate, advised};
use super::time;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::numeric::rank;
use crate::algebra::residue_pair::ResiduePair;
use crate::algebra::text::short;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::class;
use crate::syntax::ast::{CoordKind, Expr, ItemKind, Span, System};

/// Largest length of a residual that is shown.
const LONGEST: usize = 60;

/// Returns A = ∂ẋ/∂ξ, after checking that ẋ − A ξ = 0 and that A does not depend on ξ and u; rows without a rate are
/// empty.
pub fn linear_part(
    system: &System,
    graph: &mut Graph,
    rates: &mut [Option<Rate>],
    declared: &Declared,
    report: &mut Report,
) -> Option<Vec<Vec<Edge>>> {
    // ẋ = A ξ + a(x, t): the term without a velocity is multiplied by ξ⁰.
    for rate in rates.iter_mut().flatten() {
        rate.edge = time::linear(graph, declared, rate.edge);
    }
    let edges: Vec<Edge> = rates.iter().flatten().map(|rate| rate.edge).collect();
    let mut parts = Affine::of_each(graph, &edges, &declared.xi).into_iter();
    let mut a = vec![Vec::new(); rates.len()];
    // At most one error is reported for a statement.
    let mut bad: Vec<usize> = Vec::new();
    for (row, rate) in a.iter_mut().zip(rates.iter()) {
        let Some(rate) = rate else { continue };
        let Some(affine) = parts.next() else { continue };
        let (class, rest) = affine.classes(graph);
        let linear = affine.linear == rate.edge;
        *row = affine.slopes;
        if (linear && class & !(class::PARAM | class::CONFIGURATION) == 0)
            || bad.contains(&rate.item)
        {
            continue;
        }
        bad.push(rate.item);
        let Some(span) = value_of(system, rate.item).map(|value| value.span) else {
            continue;
        };
        let error = if (class | rest) & class::INPUT != 0 {
            Diagnostic::new(span, "the rate of a coordinate cannot depend on inputs or states").help(
                "make them act by `force`, `torque`, `wrench` or `generalized force`; write one that gives the rate of a velocity as `prescribe rate(v) = a;`",
            )
        } else if class & class::VELOCITY == 0 && rest & class::VELOCITY == 0 {
            Diagnostic::new(span, "this rate has a term without a velocity").help(
                "a rate is A(x) ξ: every term has exactly one velocity as a factor, times coordinates and parameters; with the time declared, `time t;`, it may have terms without one",
            )
        } else {
            Diagnostic::new(span, "this rate is not linear in the velocities").help(
                "a rate is A(x) ξ: every term has exactly one velocity as a factor, times coordinates and parameters",
            )
        };
        report.push(error);
    }
    bad.is_empty().then_some(a)
}

fn value_of(system: &System, item: usize) -> Option<&Expr> {
    match system.items.get(item).map(|item| &item.kind) {
        Some(ItemKind::Rate { value, .. }) => Some(value),
        _ => None,
    }
}

/// Returns the place of a constraint.
pub fn constraint_span(system: &System, item: usize) -> Span {
    match &system.items[item].kind {
        ItemKind::Constraint { left, right } => left.span.to(right.span),
        _ => system.items[item].span,
    }
}

/// Checks the relations between A, ξ and φ one by one.
pub struct Checker<'a> {
    pub system: &'a System,
    pub graph: &'a Graph,
    pub manifold: &'a ConfigurationManifold,
    pub declared: &'a Declared,
    /// ∂φ/∂x.
    pub jacobian: &'a [Vec<Edge>],
    pub report: &'a mut Report,
}

impl Checker<'_> {
    /// Returns ∂φ/∂x at the first point.
    fn slopes(&self) -> Vec<Vec<ResiduePair>> {
        let value = |&edge: &Edge| self.graph.value(edge);
        let rows = self.jacobian.iter();
        rows.map(|row| row.iter().map(value).collect()).collect()
    }

    /// Returns whether no constraint of the user is singular on all of X; reports an error otherwise.
    pub fn regular(&mut self) -> bool {
        let zero = self.graph.zero();
        let mut regular = true;
        let mut reported = Vec::new();
        for (row, origin) in self.jacobian.iter().zip(&self.manifold.origins) {
            let Origin::Statement(item) = *origin else {
                continue;
            };
            if reported.contains(&item) || row.iter().any(|edge| edge.abs() != zero) {
                continue;
            }
            regular = false;
            reported.push(item);
            self.report.push(
                Diagnostic::new(
                    constraint_span(self.system, item),
                    "the derivative of this constraint vanishes where it holds",
                )
                .help("write the equation without its square: `a = b` for `(a - b)^2 = 0`"),
            );
        }
        regular
    }

    /// Returns whether (∂φ/∂x) A = 0 on X; reports an error otherwise.
    pub fn tangent(&mut self, rates: &[Option<Rate>], a: &[Vec<Edge>]) -> bool {
        let mut tangent = true;
        let mut reported: Vec<usize> = Vec::new();
        for row in 0..self.manifold.phi.len() {
            for i in 0..self.declared.xi.len() {
                if !self.leaves(a, row, i) {
                    continue;
                }
                tangent = false;
                let item = self.culprit(rates, a, row, i);
                if let Some(item) = item.filter(|item| !reported.contains(item)) {
                    reported.push(item);
                    self.report_tangent(a, row, i, item);
                }
            }
        }
        tangent
    }

    /// Returns whether a motion along ξⁱ changes a row of φ.
    fn leaves(&self, a: &[Vec<Edge>], row: usize, i: usize) -> bool {
        let terms = a.iter().zip(&self.jacobian[row]);
        let change = terms.fold(ResiduePair::ZERO, |sum, (entries, &slope)| {
            sum + self.graph.value(slope) * self.graph.value(entries[i])
        });
        !change.is_zero()
    }

    /// Returns the statement to blame: the first rate that takes part in the change.
    fn culprit(
        &self,
        rates: &[Option<Rate>],
        a: &[Vec<Edge>],
        row: usize,
        i: usize,
    ) -> Option<usize> {
        let zero = self.graph.zero();
        let takes_part =
            |&alpha: &usize| self.jacobian[row][alpha].abs() != zero && a[alpha][i] != zero;
        let mut given = (0..a.len())
            .filter(takes_part)
            .filter_map(|alpha| rates[alpha]);
        given.next().map(|rate| rate.item)
    }

    /// Returns (∂φ/∂x) A of a row and a velocity as text, if it is short.
    fn residual(&self, a: &[Vec<Edge>], row: usize, i: usize) -> Option<String> {
        let mut graph = self.graph.clone();
        let column: Vec<Edge> = a.iter().map(|row| row[i]).collect();
        let change = graph.dot(&self.jacobian[row], &column);
        short(&graph, change, LONGEST)
    }

    fn velocity(&self, i: usize) -> &str {
        let node = self.declared.xi[i].node();
        self.graph
            .symbols()
            .iter()
            .find(|s| s.node == node)
            .map_or("", |s| s.name.as_str())
    }

    fn report_tangent(&mut self, a: &[Vec<Edge>], row: usize, i: usize, item: usize) {
        let Some(value) = value_of(self.system, item) else {
            return;
        };
        let velocity = self.velocity(i);
        let text = &self.manifold.phi[row].1;
        let error = match self.manifold.origins[row] {
            Origin::Coordinate(index) => {
                let coordinate = &self.declared.coordinates[index];
                let message = match text.split_once(", entry ") {
                    Some((text, entry)) => format!(
                        "this rate leaves the constraint {text}: a motion along `{velocity}` changes entry {entry}"
                    ),
                    None => format!(
                        "this rate leaves the constraint {text}: a motion along `{velocity}` changes it"
                    ),
                };
                let help = match (coordinate.kind, &value.kind) {
                    (CoordKind::S1, _) => format!(
                        "write `rate {0} = w;` with its angular velocity w, which stands for (-{0}.s * w, {0}.c * w)",
                        coordinate.name
                    ),
                    _ => advised(coordinate, Some(value), self.declared),
                };
                Diagnostic::new(value.span, message).help(help)
            }
            Origin::Statement(statement) => Diagnostic::new(
                value.span,
                match self.residual(a, row, i) {
                    Some(residual) => format!(
                        "this rate leaves a constraint: a motion along `{velocity}` changes it by {residual}, should be 0"
                    ),
                    None => format!(
                        "this rate leaves a constraint: a motion along `{velocity}` changes it"
                    ),
                },
            )
            .help("choose rates whose motion keeps the constraint: (∂φ/∂x) A = 0")
            .note(constraint_span(self.system, statement), "this constraint"),
        };
        self.report.push(error);
    }

    /// Returns whether n = dim X = ν − rank ∂φ/∂x; reports an error otherwise.
    pub fn count(&mut self) -> bool {
        let n = self.declared.xi.len();
        let nu = self.declared.x.len();
        let rank_phi = rank(self.slopes());
        let dimension = nu - rank_phi;
        if n == dimension {
            return true;
        }
        let (few, help) = if n < dimension {
            (
                "too few",
                "add velocities until there are as many as degrees of freedom",
            )
        } else {
            (
                "too many",
                "remove velocities, or a constraint that is not intended",
            )
        };
        let plural = if rank_phi == 1 { "" } else { "s" };
        let message = format!(
            "{few} velocities: {n}, for a configuration space of dimension {dimension} ({nu} coordinates less {rank_phi} independent constraint{plural})"
        );
        self.report
            .push(Diagnostic::new(self.velocities_span(), message).help(help));
        false
    }

    /// Returns whether A has rank n; reports an error otherwise.
    pub fn independent(&mut self, a: &[Vec<Edge>]) -> bool {
        let n = self.declared.xi.len();
        let value = |edge: &Edge| self.graph.value(*edge);
        let values: Vec<Vec<ResiduePair>> = a
            .iter()
            .map(|row| row.iter().map(value).collect())
            .collect();
        let rank_a = rank(values.clone());
        if rank_a == n {
            return true;
        }
        // The first column that depends on those before it.
        let first = |i: usize| values.iter().map(|row| row[..=i].to_vec()).collect();
        let dependent = (0..n).find(|&i| rank(first(i)) <= i).unwrap_or(0);
        let name = self.velocity(dependent);
        let help = format!("`{name}` moves nothing that the velocities before it do not move");
        let message = format!("the velocities are not independent: A has rank {rank_a}, not {n}");
        self.report
            .push(Diagnostic::new(self.velocities_span(), message).help(help));
        false
    }

    /// Returns the range from the first to the last velocity of the first such statement.
    fn velocities_span(&self) -> Span {
        let spans = self.system.items.iter().find_map(|item| match &item.kind {
            ItemKind::Velocity(list) => Some(list.first()?.name.span.to(list.last()?.name.span)),
            _ => None,
        });
        spans.unwrap_or(self.system.name.span)
    }
}
