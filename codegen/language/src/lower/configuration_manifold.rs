//! The manifold X of the geometric constraints: φ in a graph with unconstrained points, and points that satisfy it.

use super::declare::{Declared, size};
use super::static_scope::{Constraint, StaticScope};
use super::{branch, component, start};
use crate::algebra::graph::{Edge, Function, Graph, Node};
use crate::algebra::residual_scale::relative_residuals;
use crate::algebra::residue_pair::{Random, ResiduePair};
use crate::algebra::topoly::is_polynomial;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::class;
use crate::model::layout::{Block, blocks, constraint};
use crate::model::points::{HIGHEST_DEGREE, Points};
use crate::model::value::Value;
use crate::symbols::Resolved;
use crate::syntax::ast::{ItemKind, Span, System};
use std::collections::BTreeMap;

/// Largest residual, relative to its size, of a start that satisfies its constraints.
const ROUNDING: f64 = 1e-9;

/// Origin of a row of φ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The kind of the coordinate of this index.
    Coordinate(usize),
    /// The user's constraint in the statement of this index.
    Statement(usize),
}

/// The manifold X, as far as the constraints could be read.
pub struct ConfigurationManifold {
    pub points: Points,
    /// Rows of φ in the graph with unconstrained points, each with its text.
    pub phi: Vec<(Edge, String)>,
    /// Origin of each row of φ.
    pub origins: Vec<Origin>,
    /// Whether all constraints are included; only then is dim X known.
    pub complete: bool,
    /// Seed of the graph whose points were chosen last.
    pub seed: u64,
    /// Values of all symbols at the start, if the user wrote constraints, so that the branch of the start matters.
    pub near: Option<Vec<f64>>,
    /// x at the start, if it was solved for from guesses so that it satisfies the constraints.
    pub assembled: Option<Vec<f64>>,
    /// For each statement, the errors that kept a constraint from having a value off X. Those that occur on X, too,
    /// are reported there; [`ConfigurationManifold::check`] gives the others as the reason.
    unread: BTreeMap<usize, Vec<Diagnostic>>,
}

impl ConfigurationManifold {
    /// Creates X of a description, from a graph whose symbols have independent values.
    ///
    /// Errors in names are kept for [`ConfigurationManifold::check`], which reports them on X, where expressions that are equal
    /// modulo φ are one node.
    pub fn of(system: &System, names: &Resolved, seed: u64, report: &mut Report) -> Self {
        let mut before = Report::new();
        let statics = StaticScope::free(system, names, seed, &mut before);
        let before = before.finish().err().unwrap_or_default();
        let StaticScope {
            mut graph,
            scope,
            declared,
            defaults,
            constraints: written,
            ..
        } = statics;
        let (mut rows, mut unread, mut complete) = (Vec::new(), BTreeMap::new(), !declared.faulty);
        for constraint in written {
            let Some(difference) = constraint.difference else {
                complete = false;
                let reasons = [constraint.errors, before.clone()].concat();
                unread.insert(constraint.item, reasons);
                continue;
            };
            match check(&graph, &difference, constraint.span) {
                Ok(edges) => rows.extend(edges.into_iter().map(|edge| (edge, constraint.item))),
                Err(error) => {
                    complete = false;
                    report.push(error);
                }
            }
        }
        let blocks: Vec<Block> = declared
            .coordinates
            .iter()
            .flat_map(|c| blocks(c.kind))
            .collect();
        let first = 1 + declared.params.iter().map(|group| group.len).sum::<usize>();
        let constraints: Vec<Edge> = rows.iter().map(|(edge, _)| *edge).collect();
        let mut assembled = None;
        let near = (!constraints.is_empty()).then(|| {
            // Errors in these are reported on X, where they are read for the model.
            let again = &mut Report::new();
            let mut start = start::read(system, &mut graph, &scope, &declared, &defaults, again);
            if let Some(start) = start.as_mut().filter(|start| start.guesses_coordinates()) {
                let numbers = declared.numbers(&defaults, Some(start));
                let graph = &mut graph;
                let places = (first, &declared.x[..]);
                assembled =
                    start::guess::assembled(graph, &constraints, &blocks, places, &numbers, start);
                start.x = assembled.clone().unwrap_or(std::mem::take(&mut start.x));
            }
            declared.numbers(&defaults, start.as_ref())
        });
        let near = near.filter(|near| near.iter().all(|number| number.is_finite()));
        let constraints = match &near {
            Some(near) => {
                let branch = constraints.into_iter();
                let branch = branch.map(|edge| branch::at_start(&graph, edge, near));
                branch.collect()
            }
            None => constraints,
        };
        let mut manifold = ConfigurationManifold {
            points: Points::new(graph, constraints, blocks, first),
            phi: Vec::new(),
            origins: Vec::new(),
            complete,
            seed,
            near,
            assembled,
            unread,
        };
        manifold.collect(&declared, &rows);
        if let Some(near) = manifold.near.clone().filter(|_| complete) {
            component::separate(&mut manifold.points, &manifold.phi, &near);
        }
        manifold
    }

    /// Collects φ of every block and of the user, in the free graph, with the text of each row.
    fn collect(&mut self, declared: &Declared, rows: &[(Edge, usize)]) {
        for (index, coordinate) in declared.coordinates.iter().enumerate() {
            let mut place = coordinate.offset;
            for block in blocks(coordinate.kind) {
                let name = if size(coordinate.kind) == 12 && block == Block::Rotation {
                    format!("{}.R", coordinate.name)
                } else {
                    coordinate.name.clone()
                };
                let x = &declared.x[place..place + block.len()];
                self.phi
                    .extend(constraint(&mut self.points.free, block, x, &name));
                place += block.len();
            }
            self.origins
                .resize(self.phi.len(), Origin::Coordinate(index));
        }
        for (number, &(edge, item)) in rows.iter().enumerate() {
            self.phi.push((edge, format!("constraint {}", number + 1)));
            self.origins.push(Origin::Statement(item));
        }
    }

    /// Returns the rows of φ that the user wrote; they follow those of the coordinates' kinds.
    pub fn user_rows(&self) -> std::ops::Range<usize> {
        let kinds = self
            .origins
            .iter()
            .filter(|o| matches!(o, Origin::Coordinate(_)));
        kinds.count()..self.origins.len()
    }

    /// Returns whether the start satisfies the user's constraints, up to rounding.
    fn holds_at_start(&self) -> bool {
        let rows: Vec<Edge> = self.phi.iter().map(|(edge, _)| *edge).collect();
        self.near.as_ref().is_some_and(|near| {
            let left = relative_residuals(&self.points.free, &rows, near, self.points.places());
            left.iter().all(|left| left.abs() < ROUNDING)
        })
    }

    /// Returns a point of X. If there is none, reports the statement to blame and drops the user's constraints, so
    /// that the rest can still be read.
    pub fn choose(&mut self, system: &System, seed: u64, report: &mut Report) -> Vec<ResiduePair> {
        self.seed = seed;
        let mut random = Random::new(seed ^ 0x5eed);
        let mut point = |points: &Points| points.choose(&mut random);
        if let Some(point) = point(&self.points) {
            return point;
        }
        // Only roots lack values: the graph will tell, and more kinds of roots are allowed then.
        if let Some(point) = point(&self.points.without_roots()) {
            return point;
        }
        let statements: Vec<usize> = self
            .origins
            .iter()
            .filter_map(|origin| match origin {
                Origin::Statement(item) => Some(*item),
                Origin::Coordinate(_) => None,
            })
            .collect();
        let all = std::mem::take(&mut self.points.constraints);
        let blamed = (0..all.len()).find(|&last| {
            self.points.constraints = all[..=last].to_vec();
            point(&self.points).is_none()
        });
        if let Some(&item) = blamed.and_then(|last| statements.get(last)) {
            report.push(contradiction(
                system,
                item,
                &statements,
                self.holds_at_start(),
            ));
        }
        self.complete = false;
        let user = self.phi.len() - statements.len();
        self.phi.truncate(user);
        self.origins.truncate(user);
        self.points.constraints.clear();
        point(&self.points).unwrap_or_else(|| vec![ResiduePair::ONE; self.points.symbols])
    }

    /// Reports errors in constraints in the graph with points on X, and why a constraint has a value there but not
    /// elsewhere.
    pub fn check(&self, constraints: &[Constraint], graph: &Graph, report: &mut Report) {
        for constraint in constraints {
            let errors = constraint.errors.iter().cloned();
            errors.for_each(|error| report.push(error));
            let Some(difference) = &constraint.difference else {
                continue;
            };
            let off = |edge: &Edge| !graph.value(*edge).is_zero();
            if let Some(reasons) = self.unread.get(&constraint.item) {
                let error = Diagnostic::new(
                    constraint.span,
                    "this constraint has no value where it does not hold",
                )
                .help("write it without terms that other constraints make 0 or 1");
                let mut reasons = reasons.iter();
                report.push(match reasons.find(|reason| !report.has(reason)) {
                    Some(reason) => error.note(reason.span, &reason.message),
                    None => error,
                });
            } else if self.origins.contains(&Origin::Statement(constraint.item))
                && difference.entries().iter().any(off)
            {
                report.push(
                    Diagnostic::new(
                        constraint.span,
                        "this constraint does not hold where it was solved",
                    )
                    .help("write it as a polynomial equation of coordinates"),
                );
            }
        }
    }
}

/// Returns the rows of a constraint, or an error if it is not a valid one.
fn check(graph: &Graph, difference: &Value, span: Span) -> Result<Vec<Edge>, Diagnostic> {
    let rows: Vec<Edge> = difference
        .entries()
        .into_iter()
        .filter(|e| e.abs() != graph.zero())
        .collect();
    if rows.is_empty() {
        return Err(Diagnostic::new(span, "this constraint always holds")
            .help("remove it: both sides are the same expression"));
    }
    for &edge in &rows {
        let class = graph.class(edge.node());
        let error = |message: &str, help: &str| Err(Diagnostic::new(span, message).help(help));
        if class & !(class::PARAM | class::CONFIGURATION) != 0 {
            return error(
                "a constraint may depend only on coordinates, not on velocities, inputs or states",
                "constrain velocities by the choice of `velocity` and `rate`",
            );
        }
        if class & class::COORD == 0 {
            return error(
                "this constraint contains no coordinate",
                "a constraint is an equation of coordinates, such as `x^2 + y^2 = l^2`",
            );
        }
        if !is_polynomial(graph, edge, class::COORD) {
            return error(
                "a constraint has to be polynomial in the coordinates",
                polynomial_help(graph, edge),
            );
        }
        if degree(graph, edge) > HIGHEST_DEGREE {
            let message = format!("the degree of this constraint is above {HIGHEST_DEGREE}");
            return Err(Diagnostic::new(span, message).help("write it with further coordinates"));
        }
    }
    Ok(rows)
}

/// Suggests what to write instead of a function that a constraint cannot contain.
fn polynomial_help(graph: &Graph, edge: Edge) -> &'static str {
    let of_coordinates = |id: &u32| graph.class(*id) & class::COORD != 0;
    let nodes = graph.reachable(&[edge]);
    let found = nodes
        .iter()
        .filter(|id| of_coordinates(id))
        .find_map(|&id| match graph.node(id) {
            Node::Apply(function, _) => Some(function),
            Node::Atan2(..) => Some(Function::Atan2),
            Node::Select(..) => Some(Function::Select),
            Node::External(..) => Some(Function::External),
            _ => None,
        });
    match found {
        Some(Function::Sqrt) => "square both sides: `dot(r, r) = l^2` for `norm(r) = l`",
        Some(Function::Sin | Function::Cos | Function::Atan2) => {
            "use an S1 coordinate for an angle, its parts `.c` and `.s` for cos and sin"
        }
        Some(Function::Sign | Function::Abs | Function::Select) => {
            "a constraint has no branches: choose one of them"
        }
        Some(_) => "take the expression itself as a coordinate",
        None => "multiply both sides by the denominator",
    }
}

/// Returns an upper bound of the degree in the coordinates.
fn degree(graph: &Graph, edge: Edge) -> u32 {
    let mut degrees = vec![0u32; graph.len()];
    for id in graph.reachable(&[edge]) {
        let of = |edge: Edge| degrees[edge.node() as usize];
        degrees[id as usize] = match graph.node(id) {
            Node::Symbol(_) => u32::from(graph.class(id) & class::COORD != 0),
            Node::Add(a, b) => of(a).max(of(b)),
            Node::Mul(a, b) => of(a).saturating_add(of(b)),
            Node::Div(a, _) => of(a),
            _ => 0,
        };
    }
    degrees[edge.node() as usize]
}

/// Returns the error for a statement with which no point was found: it contradicts those before it, or they are too
/// large for the search.
fn contradiction(
    system: &System,
    item: usize,
    statements: &[usize],
    holds_at_start: bool,
) -> Diagnostic {
    let place = |item: usize| match &system.items[item].kind {
        ItemKind::Constraint { left, right } => left.span.to(right.span),
        _ => system.items[item].span,
    };
    let mut earlier: Vec<usize> = statements
        .iter()
        .copied()
        .filter(|&other| other < item)
        .collect();
    earlier.dedup();
    let message = match (holds_at_start, earlier.is_empty()) {
        (false, true) => "no configuration satisfies this constraint",
        (false, false) => {
            "no configuration satisfies this constraint together with those before it"
        }
        (true, true) => "this constraint is too large to be solved in exact arithmetic",
        (true, false) => {
            "this constraint, together with those before it, is too large to be solved in exact arithmetic"
        }
    };
    let error = Diagnostic::new(place(item), message).help(match holds_at_start {
        false => "remove the contradiction, or replace a value in it by a coordinate or a parameter",
        true => "lower its degree with further coordinates for powers and products, or write a `loop`, which multipliers enforce",
    });
    earlier.into_iter().fold(error, |error, other| {
        error.note(place(other), "one of those before")
    })
}
