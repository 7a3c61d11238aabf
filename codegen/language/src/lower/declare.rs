//! Declares every symbol of a description, with values at points of X.

use super::expression::Evaluator;
use super::scope::Scope;
use super::{curves, externals, time};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::residue_pair::ResiduePair;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::layout::{blocks, entry_names};
use crate::model::value::Value;
use crate::model::{Clock, Coordinate, Group, class, samples};
use crate::symbols::Kind;
use crate::syntax::ast::{CoordKind, Declaration, Ident, ItemKind, ShapeKind, Span, System};
use crate::units::Unit;

/// Function that returns the value of the next symbol: drawn at random for free points, read from the point for those
/// on X.
pub type NextValue<'a> = dyn FnMut(&mut Graph) -> ResiduePair + 'a;

/// The symbols of everything that a description declares: parameters, x, ξ, u, z, ξ̇, p.
#[derive(Clone, Debug, Default)]
pub struct Declared {
    pub params: Vec<Group>,
    pub coordinates: Vec<Coordinate>,
    pub x: Vec<Edge>,
    pub velocities: Vec<Group>,
    pub xi: Vec<Edge>,
    pub velocity_spans: Vec<Span>,
    pub inputs: Vec<Group>,
    /// Inputs, followed by the states z, which act on the motion like inputs.
    pub u: Vec<Edge>,
    /// First-order states, with their offsets in z.
    pub states: Vec<Group>,
    pub z: Vec<Edge>,
    pub xi_dot: Vec<Edge>,
    pub momenta: Vec<Edge>,
    /// Place of the time, if it is declared.
    pub clock: Option<Clock>,
    /// Whether a coordinate or velocity is missing because its name was taken; then there is no point in counting
    /// them.
    pub faulty: bool,
}

/// Declares everything in the order pi, parameters, x, ξ, u, z, ξ̇, p, and defines the constants.
pub fn declare(
    system: &System,
    graph: &mut Graph,
    next: &mut NextValue,
    scope: &mut Scope,
    report: &mut Report,
) -> Declared {
    let mut declared = Declared::default();
    next(graph);
    graph.symbol("pi", 0, ResiduePair::PI);
    graph.set_reals(samples::pi());
    for item in &system.items {
        if let ItemKind::Const(list) = &item.kind {
            for declaration in list {
                define_const(declaration, graph, scope, report);
            }
        }
    }
    curves::declare(system, graph, scope, report);
    externals::declare(system, graph, scope, report);
    let mut declarer = Declarer {
        time: time::name(system).map(|time| time.name.as_str()),
        graph,
        next,
        scope,
    };
    let mut params = Vec::new();
    for item in &system.items {
        if let ItemKind::Param(list) = &item.kind {
            declarer.groups(
                list,
                Kind::Param,
                class::PARAM,
                &mut declared.params,
                &mut params,
            );
        }
    }
    for item in &system.items {
        if let ItemKind::Coord(list) = &item.kind {
            declarer.coordinates(list, &mut declared);
        }
    }
    for item in &system.items {
        if let ItemKind::Velocity(list) = &item.kind {
            let (groups, xi) = (&mut declared.velocities, &mut declared.xi);
            let complete = declarer.groups(list, Kind::Velocity, class::VELOCITY, groups, xi);
            declared.faulty |= !complete;
            for declaration in list {
                let group = declared
                    .velocities
                    .iter()
                    .find(|g| g.name == declaration.name.name);
                let len = group.map_or(0, |group| group.offset + group.len);
                let spans = declared.velocity_spans.len().max(len);
                declared.velocity_spans.resize(spans, declaration.name.span);
            }
        }
    }
    for item in &system.items {
        if let ItemKind::Input(list) = &item.kind {
            let (groups, u) = (&mut declared.inputs, &mut declared.u);
            declarer.groups(list, Kind::Input, class::INPUT, groups, u);
        }
    }
    for item in &system.items {
        if let ItemKind::State(list) = &item.kind {
            let (groups, z) = (&mut declared.states, &mut declared.z);
            declarer.groups(list, Kind::State, class::INPUT, groups, z);
        }
    }
    declared.u.extend(&declared.z);
    let velocities = graph
        .symbols()
        .iter()
        .filter(|s| s.class == class::VELOCITY);
    let names: Vec<String> = velocities.map(|s| s.name.clone()).collect();
    for name in &names {
        let value = next(graph);
        declared
            .xi_dot
            .push(graph.symbol(&format!("d_{name}"), class::ACCEL, value));
    }
    for name in &names {
        let value = next(graph);
        declared
            .momenta
            .push(graph.symbol(&format!("p_{name}"), class::MOMENTUM, value));
    }
    declared.clock = time::clock(system, &declared);
    declared
}

struct Declarer<'a, 'b, 's> {
    time: Option<&'a str>,
    graph: &'a mut Graph,
    next: &'a mut NextValue<'b>,
    scope: &'a mut Scope<'s>,
}

impl Declarer<'_, '_, '_> {
    /// Declares groups of symbols, and returns whether all their names were free.
    fn groups(
        &mut self,
        list: &[Declaration],
        kind: Kind,
        class: u8,
        all: &mut Vec<Group>,
        edges: &mut Vec<Edge>,
    ) -> bool {
        let mut complete = true;
        for declaration in list {
            let (name, shape) = (&declaration.name, declaration.shape.kind);
            if !self.scope.claim(name, kind) {
                complete = false;
                continue;
            }
            let (value, symbols) = symbols_of(self.graph, self.next, &name.name, shape, class);
            self.scope.set(name, Some(value.clone()));
            let (offset, len) = (edges.len(), symbols.len());
            all.push(Group {
                name: name.name.clone(),
                shape,
                value,
                offset,
                len,
                unit: None,
            });
            edges.extend(symbols);
        }
        complete
    }

    fn coordinates(&mut self, list: &[(Ident, CoordKind, Option<Unit>)], declared: &mut Declared) {
        for (name, kind, _) in list {
            if !self.scope.claim(name, Kind::Coord(*kind)) {
                declared.faulty = true;
                continue;
            }
            let offset = declared.x.len();
            let names = entry_names(&name.name, *kind);
            let class = match self.time == Some(&name.name) {
                true => class::TIME,
                false => class::COORD,
            };
            let entries: Vec<Edge> = names
                .iter()
                .map(|entry| {
                    let value = (self.next)(self.graph);
                    self.graph.symbol(entry, class, value)
                })
                .collect();
            self.scope
                .set(name, Some(coordinate_value(*kind, &entries)));
            declared.x.extend(entries);
            let (name, span) = (name.name.clone(), name.span);
            declared.coordinates.push(Coordinate {
                name,
                kind: *kind,
                offset,
                span,
            });
        }
    }
}

fn define_const(
    declaration: &Declaration,
    graph: &mut Graph,
    scope: &mut Scope,
    report: &mut Report,
) {
    let name = &declaration.name;
    let missing = format!("write `const {} = 1;`", name.name);
    let value = declared_value(declaration, &missing, graph, scope, report);
    scope.define(name, Kind::Const, value);
}

/// Returns the mandatory value of a declaration, if it fits the declared shape.
pub fn declared_value(
    declaration: &Declaration,
    missing: &str,
    graph: &mut Graph,
    scope: &Scope,
    report: &mut Report,
) -> Option<Value> {
    let name = &declaration.name;
    let Some(expr) = &declaration.value else {
        let error = Diagnostic::new(name.span, format!("`{}` has no value", name.name));
        report.push(error.help(missing));
        return None;
    };
    let value = Evaluator::new(graph, scope, report).value(expr);
    value.filter(|value| shape_fits(declaration, value, report))
}

/// Returns whether a value has the declared shape and is symmetric if so declared; reports an error if it is not
/// symmetric. A declaration without a shape accepts any value.
pub fn shape_fits(declaration: &Declaration, value: &Value, report: &mut Report) -> bool {
    let (name, shape) = (&declaration.name.name, declaration.shape);
    let fits = match shape.kind {
        ShapeKind::Scalar => return true,
        ShapeKind::Vector(n) => matches!(value, Value::Vector(v) if v.len() == n),
        ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => {
            matches!(value, Value::Matrix(m) if m.len() == n && m.iter().all(|row| row.len() == n))
        }
    };
    if !fits {
        return false;
    }
    if let (ShapeKind::Symmetric(n), Value::Matrix(m)) = (shape.kind, value) {
        let mut pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        if let Some((i, j)) = pairs.find(|&(i, j)| m[i][j] != m[j][i]) {
            let (i, j) = (i + 1, j + 1);
            let value = declaration.value.as_ref();
            report.push(
                Diagnostic::new(
                    value.map_or(declaration.name.span, |value| value.span),
                    format!("`{name}` is not symmetric: entries [{i},{j}] and [{j},{i}] differ"),
                )
                .help(format!(
                    "write the same value in both places, or declare it `mat{n}`"
                ))
                .note(shape.span, "declared symmetric here"),
            );
            return false;
        }
    }
    true
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

/// Returns the value that a coordinate's name has in expressions: a scalar, vector, matrix or pose of its entries.
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

/// Returns the number of entries in x of a coordinate of this kind.
pub fn size(kind: CoordKind) -> usize {
    blocks(kind).iter().map(|block| block.len()).sum()
}
