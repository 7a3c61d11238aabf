//! Declarations: every symbol of the description, with values at points of X.

use super::expression::Evaluator;
use super::layout::{blocks, entry_names};
use super::scope::{NameKind, Scope};
use super::value::Value;
use super::{Coordinate, Group, class};
use crate::algebra::fp::Fp;
use crate::algebra::graph::{Edge, Graph, LANES};
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{CoordKind, Declaration, ItemKind, ShapeKind, System};

/// Makes the next symbol of a graph: free points draw a random value, constrained ones read it.
pub type NextValue<'a> = dyn FnMut(&mut Graph) -> [Fp; LANES] + 'a;

/// All declared symbols.
#[derive(Clone, Debug, Default)]
pub struct Declared {
    pub params: Vec<Group>,
    pub coordinates: Vec<Coordinate>,
    pub x: Vec<Edge>,
    pub velocities: Vec<Group>,
    pub xi: Vec<Edge>,
    pub inputs: Vec<Group>,
    pub u: Vec<Edge>,
    pub xi_dot: Vec<Edge>,
}

/// Declares everything, in the order pi, parameters, x, ξ, u, ξ̇, and defines the constants.
pub fn declare(
    system: &System,
    graph: &mut Graph,
    next: &mut NextValue,
    scope: &mut Scope,
    report: &mut Report,
) -> Declared {
    let mut declared = Declared::default();
    let value = next(graph);
    graph.symbol("pi", 0, value);
    for item in &system.items {
        if let ItemKind::Const(list) = &item.kind {
            for declaration in list {
                define_const(declaration, graph, scope, report);
            }
        }
    }
    let groups = |graph: &mut Graph,
                  next: &mut NextValue,
                  scope: &mut Scope,
                  report: &mut Report,
                  list: &[Declaration],
                  kind,
                  class,
                  all: &mut Vec<Group>,
                  edges: &mut Vec<Edge>| {
        for declaration in list {
            let name = &declaration.name;
            let (value, symbols) =
                symbols_of(graph, next, &name.name, declaration.shape.kind, class);
            scope.define(name, kind, Some(value.clone()), report);
            all.push(Group {
                name: name.name.clone(),
                shape: declaration.shape.kind,
                value,
                offset: edges.len(),
                len: symbols.len(),
            });
            edges.extend(symbols);
        }
    };
    let mut params = Vec::new();
    for item in &system.items {
        if let ItemKind::Param(list) = &item.kind {
            groups(
                graph,
                next,
                scope,
                report,
                list,
                NameKind::Param,
                class::PARAM,
                &mut declared.params,
                &mut params,
            );
        }
    }
    for item in &system.items {
        if let ItemKind::Coord(list) = &item.kind {
            for (name, kind) in list {
                let offset = declared.x.len();
                let entries: Vec<Edge> = entry_names(&name.name, *kind)
                    .iter()
                    .map(|entry| {
                        let value = next(graph);
                        graph.symbol(entry, class::COORD, value)
                    })
                    .collect();
                scope.define(
                    name,
                    NameKind::Coord(*kind),
                    Some(coordinate_value(*kind, &entries)),
                    report,
                );
                declared.x.extend(entries);
                declared.coordinates.push(Coordinate {
                    name: name.name.clone(),
                    kind: *kind,
                    offset,
                    span: name.span,
                });
            }
        }
    }
    for item in &system.items {
        if let ItemKind::Velocity(list) = &item.kind {
            groups(
                graph,
                next,
                scope,
                report,
                list,
                NameKind::Velocity,
                class::VELOCITY,
                &mut declared.velocities,
                &mut declared.xi,
            );
        }
    }
    for item in &system.items {
        if let ItemKind::Input(list) = &item.kind {
            groups(
                graph,
                next,
                scope,
                report,
                list,
                NameKind::Input,
                class::INPUT,
                &mut declared.inputs,
                &mut declared.u,
            );
        }
    }
    let names: Vec<String> = graph
        .symbols()
        .iter()
        .filter(|s| s.class == class::VELOCITY)
        .map(|s| s.name.clone())
        .collect();
    for name in names {
        let value = next(graph);
        declared
            .xi_dot
            .push(graph.symbol(&format!("d_{name}"), class::ACCEL, value));
    }
    declared
}

fn define_const(
    declaration: &Declaration,
    graph: &mut Graph,
    scope: &mut Scope,
    report: &mut Report,
) {
    let value = match &declaration.value {
        Some(expr) => {
            let value = Evaluator {
                graph,
                scope,
                report,
            }
            .value(expr);
            value.filter(|value| {
                let constant = value
                    .entries()
                    .iter()
                    .all(|edge| graph.class(edge.node()) == 0);
                if !constant {
                    report.push(
                        Diagnostic::new(
                            expr.span,
                            format!(
                                "`{}` is no constant: it depends on symbols",
                                declaration.name.name
                            ),
                        )
                        .help(format!("write `let {} = …;`", declaration.name.name)),
                    );
                }
                constant && shape_fits(declaration, value, report)
            })
        }
        None => {
            report.push(
                Diagnostic::new(
                    declaration.name.span,
                    format!("`{}` has no value", declaration.name.name),
                )
                .help(format!("write `const {} = 1;`", declaration.name.name)),
            );
            None
        }
    };
    scope.define(&declaration.name, NameKind::Const, value, report);
}

/// Whether a value has the declared shape; a declaration without a shape takes any.
pub fn shape_fits(declaration: &Declaration, value: &Value, report: &mut Report) -> bool {
    let fits = match declaration.shape.kind {
        ShapeKind::Scalar => return true,
        ShapeKind::Vector(n) => matches!(value, Value::Vector(v) if v.len() == n),
        ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => {
            matches!(value, Value::Matrix(m) if m.len() == n && m.iter().all(|row| row.len() == n))
        }
    };
    if !fits {
        let span = declaration
            .value
            .as_ref()
            .map_or(declaration.name.span, |value| value.span);
        report.push(
            Diagnostic::new(
                span,
                format!(
                    "`{}` was declared as {}, its value is {}",
                    declaration.name.name,
                    shape_words(declaration.shape.kind),
                    value.shape()
                ),
            )
            .note(declaration.shape.span, "declared here"),
        );
    }
    fits
}

/// A declared shape in words.
pub fn shape_words(shape: ShapeKind) -> String {
    match shape {
        ShapeKind::Scalar => "a scalar".into(),
        ShapeKind::Vector(n) => format!("a vector of {n}"),
        ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => format!("a {n}×{n} matrix"),
    }
}

fn symbols_of(
    graph: &mut Graph,
    next: &mut NextValue,
    name: &str,
    shape: ShapeKind,
    class: u8,
) -> (Value, Vec<Edge>) {
    let mut symbols = Vec::new();
    let mut new = |graph: &mut Graph, name: String| {
        let value = next(graph);
        let edge = graph.symbol(&name, class, value);
        symbols.push(edge);
        edge
    };
    let value = match shape {
        ShapeKind::Scalar => Value::Scalar(new(graph, name.to_string())),
        ShapeKind::Vector(n) => Value::Vector(
            (1..=n)
                .map(|i| new(graph, format!("{name}[{i}]")))
                .collect(),
        ),
        ShapeKind::Matrix(n) => Value::Matrix(
            (1..=n)
                .map(|i| {
                    (1..=n)
                        .map(|j| new(graph, format!("{name}[{i},{j}]")))
                        .collect()
                })
                .collect(),
        ),
        ShapeKind::Symmetric(n) => {
            let mut rows = vec![vec![graph.zero(); n]; n];
            for i in 0..n {
                for j in i..n {
                    let entry = new(graph, format!("{name}[{},{}]", i + 1, j + 1));
                    rows[i][j] = entry;
                    rows[j][i] = entry;
                }
            }
            Value::Matrix(rows)
        }
    };
    (value, symbols)
}

/// The value of a coordinate in expressions.
pub fn coordinate_value(kind: CoordKind, entries: &[Edge]) -> Value {
    let matrix = |e: &[Edge]| Value::Matrix(e.chunks(3).map(<[Edge]>::to_vec).collect());
    match kind {
        CoordKind::Real => Value::Scalar(entries[0]),
        CoordKind::Euclidean(_) | CoordKind::S1 | CoordKind::S3 => Value::Vector(entries.to_vec()),
        CoordKind::SO3 => matrix(entries),
        CoordKind::SE3 => {
            let rotation = std::array::from_fn(|i| std::array::from_fn(|j| entries[3 + 3 * i + j]));
            Value::Pose(rotation, [entries[0], entries[1], entries[2]])
        }
    }
}

/// Number of entries of x.
pub fn size(kind: CoordKind) -> usize {
    blocks(kind).iter().map(|block| block.len()).sum()
}
