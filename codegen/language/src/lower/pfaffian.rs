//! Reads constraints B(x) ξ = 0 on the velocities of a frame: inactive velocities, nonholonomic constraints, and the
//! rates of closed loops.

use super::affine::Affine;
use super::declare::Declared;
use super::expression::Evaluator;
use super::rate::Kinematics;
use super::scope::Scope;
use super::time;
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::Vec3;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::class;
use crate::model::pfaffian::{Kind, Pfaffian};
use crate::model::value::Value;
use crate::syntax::ast::{Expr, ExprKind, ItemKind, Span, System};
use crate::syntax::written::{equation, written};

/// Reads all rows in the order of the text, the pairs of points that loops bring together, and warnings about rows
/// that always hold.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    kinematics: Option<&Kinematics>,
    report: &mut Report,
) -> (Vec<Pfaffian>, Vec<(Vec3, Vec3)>, Vec<Diagnostic>) {
    let mut all = Vec::new();
    let mut closures: Vec<Sides> = Vec::new();
    let mut reader = Reader {
        evaluator: Evaluator::new(graph, scope, report),
        declared,
        kinematics,
        sides: None,
        idle: Vec::new(),
    };
    for item in &system.items {
        match &item.kind {
            ItemKind::Inactive(list) => {
                for expr in list {
                    let rows = reader.inactive(expr, &all);
                    all.extend(rows.unwrap_or_default());
                }
            }
            ItemKind::Nonholonomic {
                left,
                right,
                stabilized,
            } => all.extend(
                reader
                    .nonholonomic(left, right, stabilized.as_ref())
                    .unwrap_or_default(),
            ),
            ItemKind::Loop {
                left,
                right,
                stabilized,
            } => {
                let rows = reader.closed_loop(left, right, stabilized.as_ref());
                if let Some(rows) = rows {
                    all.extend(rows);
                    if let Some(sides) = reader.sides.take() {
                        let known = closures
                            .iter_mut()
                            .find(|other| other.points == sides.points);
                        match known {
                            Some(known) => (0..3).for_each(|k| known.closed[k] |= sides.closed[k]),
                            None => closures.push(sides),
                        }
                    }
                }
            }
            _ => {}
        }
    }
    let idle = reader.idle;
    let closures = closures.into_iter().filter(Sides::meet);
    let closures = closures.map(|sides| sides.points).collect();
    (all, closures, idle)
}

/// Two points in space, and which of their components loops make equal.
struct Sides {
    points: (Vec3, Vec3),
    closed: [bool; 3],
}

impl Sides {
    /// Returns whether the other components are equal anyway, as in a plane.
    fn meet(&self) -> bool {
        let (left, right) = &self.points;
        (0..3).all(|k| self.closed[k] || left[k] == right[k])
    }
}

struct Reader<'a> {
    evaluator: Evaluator<'a>,
    declared: &'a Declared,
    kinematics: Option<&'a Kinematics>,
    /// Both sides of the last equation, if they are points in space or the same component of two points.
    sides: Option<Sides>,
    /// Warnings about rows that always hold.
    idle: Vec<Diagnostic>,
}

impl Reader<'_> {
    /// Reads velocities that stay zero.
    fn inactive(&mut self, expr: &Expr, before: &[Pfaffian]) -> Option<Vec<Pfaffian>> {
        let value = self.evaluator.value(expr)?;
        let mut rows = Vec::new();
        for entry in value.entries() {
            let Some(which) = self.declared.xi.iter().position(|&xi| xi == entry) else {
                return self.evaluator.error(
                    Diagnostic::new(expr.span, "only a velocity can be inactive").help(
                        "write `inactive v;`, or `inactive v[2];` for an entry; write a combination of velocities as `nonholonomic … = 0;`",
                    ),
                );
            };
            let graph = &mut *self.evaluator.graph;
            let mut row = vec![graph.zero(); self.declared.xi.len()];
            row[which] = graph.one();
            let first = before.iter().chain(&rows).find(|other| other.row == row);
            if let Some(first) = first.map(|first: &Pfaffian| first.span) {
                let error = Diagnostic::new(expr.span, "this velocity is already inactive");
                return self.evaluator.error(
                    error
                        .help("remove one of the two")
                        .note(first, "first here"),
                );
            }
            rows.push(Pfaffian {
                kind: Kind::Inactive,
                row,
                shift: graph.zero(),
                residual: graph.zero(),
                stabilized: None,
                written: written(expr),
                entry: String::new(),
                redundant: false,
                span: expr.span,
            });
        }
        Some(rows)
    }

    fn nonholonomic(
        &mut self,
        left: &Expr,
        right: &Expr,
        stabilized: Option<&Expr>,
    ) -> Option<Vec<Pfaffian>> {
        let (span, difference, stabilized) = self.equation(left, right, stabilized)?;
        let graph = &mut *self.evaluator.graph;
        let (mut rows, mut idle) = (Vec::new(), Vec::new());
        for (edge, entry) in difference.entries().into_iter().zip(names(&difference)) {
            // B ξ = b(x, t): the term without a velocity is multiplied by ξ⁰.
            let edge = time::linear(graph, self.declared, edge);
            let affine = Affine::of(graph, edge, &self.declared.xi);
            let (class, rest) = affine.classes(graph);
            let (row, whole) = (affine.slopes, affine.linear);
            if whole != edge || class & !(class::PARAM | class::CONFIGURATION) != 0 {
                let without = (class | rest) & class::VELOCITY == 0;
                let inputs = (class | rest) & class::INPUT != 0;
                let message = if inputs {
                    "a nonholonomic constraint cannot depend on inputs or states"
                } else if without {
                    "this nonholonomic constraint has a term without a velocity"
                } else {
                    "this nonholonomic constraint is not linear in the velocities"
                };
                let help = "it is B(x) ξ = 0: every term has exactly one velocity as a factor, times coordinates and parameters";
                let help = match without && !inputs {
                    true => format!(
                        "{help}; with the time declared, `time t;`, it may have terms without one"
                    ),
                    false => help.to_string(),
                };
                return self
                    .evaluator
                    .error(Diagnostic::new(span, message).help(help));
            }
            if row.iter().all(|&entry| entry == graph.zero()) {
                idle.push(entry);
                continue;
            }
            rows.push(Pfaffian {
                kind: Kind::Nonholonomic,
                row,
                shift: graph.zero(),
                residual: graph.zero(),
                stabilized,
                written: equation(left, right),
                entry,
                redundant: false,
                span,
            });
        }
        if !idle.is_empty() {
            let warning = holding(span, "nonholonomic constraint", &idle, rows.is_empty());
            self.idle.push(warning);
        }
        Some(rows)
    }

    fn closed_loop(
        &mut self,
        left: &Expr,
        right: &Expr,
        stabilized: Option<&Expr>,
    ) -> Option<Vec<Pfaffian>> {
        let (span, difference, stabilized) = self.equation(left, right, stabilized)?;
        let graph = &mut *self.evaluator.graph;
        let entries = difference.entries();
        let class = entries
            .iter()
            .fold(0, |class, edge| class | graph.class(edge.node()));
        if class & !(class::PARAM | class::CONFIGURATION) != 0 {
            return self.evaluator.error(
                Diagnostic::new(
                    span,
                    "a loop may depend only on coordinates, not on velocities, inputs or states",
                )
                .help("a constraint on velocities is written `nonholonomic … = …;`"),
            );
        }
        let value = Value::Vector(entries.clone());
        self.evaluator.continuous(&value, span, "a loop")?;
        let kinematics = self.kinematics?;
        let graph = &mut *self.evaluator.graph;
        let (mut rows, mut idle) = (Vec::new(), Vec::new());
        for (edge, entry) in entries.into_iter().zip(names(&difference)) {
            if edge.abs() == graph.zero() {
                idle.push(entry);
                continue;
            }
            let row: Vec<Edge> = (0..self.declared.xi.len())
                .map(|i| {
                    let seeds = self.declared.x.iter().zip(&kinematics.a);
                    Derivation::new(seeds.map(|(x, row)| (x.node(), row[i]))).of(graph, edge)
                })
                .collect();
            if row.iter().all(|&entry| entry == graph.zero()) {
                return self.evaluator.error(
                    Diagnostic::new(span, "this loop contains nothing that moves").help(
                        "a loop is an equation of coordinates that velocities of the tree change",
                    ),
                );
            }
            rows.push(Pfaffian {
                kind: Kind::Loop,
                row,
                shift: graph.zero(),
                residual: edge,
                stabilized,
                written: equation(left, right),
                entry,
                redundant: false,
                span,
            });
        }
        if !idle.is_empty() {
            let warning = holding(span, "loop", &idle, rows.is_empty());
            self.idle.push(warning);
        }
        Some(rows)
    }

    /// Reads a constraint: its place, left − right, and λ.
    fn equation(
        &mut self,
        left: &Expr,
        right: &Expr,
        stabilized: Option<&Expr>,
    ) -> Option<(Span, Value, Option<Edge>)> {
        let difference = self.difference(left, right);
        let stabilized = self.rate_of_decay(stabilized)?;
        Some((left.span.to(right.span), difference?, stabilized))
    }

    /// Returns left − right, entry by entry.
    fn difference(&mut self, left: &Expr, right: &Expr) -> Option<Value> {
        let (a, b) = (self.evaluator.value(left), self.evaluator.value(right));
        let (a, b) = (a?, b?);
        self.sides = self.component(left, right, (&a, &b));
        let graph = &mut *self.evaluator.graph;
        // `… = 0` means that every entry is 0.
        let is_zero = matches!(b, Value::Scalar(edge) if edge.abs() == graph.zero());
        if is_zero {
            return Some(a);
        }
        if !a.same_shape(&b) {
            return self.evaluator.miss();
        }
        if let Some(points) = a.as_vec3().zip(b.as_vec3()) {
            self.sides = Some(Sides {
                points,
                closed: [true; 3],
            });
        }
        Some(a.zip(&b, |x, y| graph.sub(x, y)))
    }

    /// Returns the points of `a[1] = b[1]`, if both have three components.
    fn component(&mut self, left: &Expr, right: &Expr, of: (&Value, &Value)) -> Option<Sides> {
        let (ExprKind::Index(left, _), ExprKind::Index(right, _)) = (&left.kind, &right.kind)
        else {
            return None;
        };
        let (Value::Scalar(a), Value::Scalar(b)) = of else {
            return None;
        };
        let points = (
            self.evaluator.value(left)?.as_vec3()?,
            self.evaluator.value(right)?.as_vec3()?,
        );
        let closed = std::array::from_fn(|k| points.0[k] == *a && points.1[k] == *b);
        Some(Sides { points, closed })
    }

    /// Reads λ, which is constant at run time. The outer `None` means an error.
    fn rate_of_decay(&mut self, expr: Option<&Expr>) -> Option<Option<Edge>> {
        let Some(expr) = expr else { return Some(None) };
        let edge = self.evaluator.scalar(expr)?;
        if self.evaluator.graph.class(edge.node()) & !class::PARAM != 0 {
            return self.evaluator.error(
                Diagnostic::new(expr.span, "a rate of stabilisation has to be constant")
                    .help("write a number or a parameter (1/s), of the order of 10"),
            );
        }
        Some((edge.abs() != self.evaluator.graph.zero()).then_some(edge))
    }
}

/// Returns the labels of all entries of a difference of two sides, in order; the label of a single entry is empty.
fn names(difference: &Value) -> Vec<String> {
    let matrix = |rows: usize, columns: usize, of: &str| -> Vec<String> {
        let places = (0..rows).flat_map(|i| (0..columns).map(move |j| (i + 1, j + 1)));
        places.map(|(i, j)| format!("{of}[{i}, {j}]")).collect()
    };
    let vector = |entries: usize, of: &str| -> Vec<String> {
        (1..=entries).map(|i| format!("{of}[{i}]")).collect()
    };
    match difference {
        Value::Scalar(_) => vec![String::new()],
        Value::Vector(entries) => vector(entries.len(), ""),
        Value::Matrix(rows) => matrix(rows.len(), rows.first().map_or(0, Vec::len), ""),
        Value::Pose(..) => [vector(3, "p"), matrix(3, 3, "R")].concat(),
    }
}

/// Returns the warning about entries of an equation whose sides are identical.
fn holding(span: Span, what: &str, entries: &[String], all: bool) -> Diagnostic {
    if all {
        return Diagnostic::new(span, format!("this {what} always holds, and is left out"))
            .help("remove it: both sides are equal wherever the system is");
    }
    let message = match entries {
        [entry] => format!("entry {entry} of this {what} always holds, and is left out"),
        _ => format!(
            "entries {} of this {what} always hold, and are left out",
            entries.join(", ")
        ),
    };
    Diagnostic::new(span, message)
        .help("write the other entries one by one, as in `a[1] = b[1], a[2] = b[2]`")
}
