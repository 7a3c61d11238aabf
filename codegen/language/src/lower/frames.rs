//! Reads single `let` statements, and the poses that `frame` statements give.

use super::declare::declared_value;
use super::expression::Evaluator;
use super::scope::Scope;
use crate::algebra::graph::Graph;
use crate::algebra::linear::{add3, apply3, identity3, multiply3, transpose3};
use crate::diagnostics::{Diagnostic, Report};
use crate::model::class;
use crate::model::value::Value;
use crate::symbols::{Kind, Relation};
use crate::syntax::ast::{Declaration, Ident};

/// Defines a named expression, and returns its value if it has one.
pub fn define_let(
    declaration: &Declaration,
    graph: &mut Graph,
    scope: &mut Scope,
    report: &mut Report,
) -> Option<Value> {
    let name = &declaration.name;
    let missing = format!("write `let {} = …;`", name.name);
    let value = declared_value(declaration, &missing, graph, scope, report);
    let free = scope.define(name, Kind::Let, value.clone());
    value.filter(|_| free)
}

/// Returns the world pose f = g P of a frame with the pose P in g, from the world pose g.
pub fn ahead(graph: &mut Graph, parent: &Value, pose: &Value) -> Value {
    match (parent, pose) {
        (Value::Pose(r, p), Value::Pose(rotation, position)) => {
            let moved = apply3(graph, r, *position);
            let position = add3(graph, *p, moved);
            Value::Pose(multiply3(graph, r, rotation), position)
        }
        _ => pose.clone(),
    }
}

/// Returns the inverse P⁻¹ of a pose, the pose of g in f.
pub fn inverse(graph: &mut Graph, pose: &Value) -> Value {
    match pose {
        Value::Pose(rotation, position) => {
            let rotation = transpose3(rotation);
            let moved = apply3(graph, &rotation, *position);
            Value::Pose(rotation, moved.map(|entry| -entry)).unsigned_zeros(graph)
        }
        _ => pose.clone(),
    }
}

/// Reads P and checks that it is a rotation and a position that depend on the configuration alone.
pub fn relative_pose(
    relation: &Relation,
    graph: &mut Graph,
    scope: &Scope,
    report: &mut Report,
) -> Option<Value> {
    let Relation { name, pose, .. } = relation;
    let mut evaluator = Evaluator::new(graph, scope, report);
    let mut value = evaluator.value(pose)?;
    if let Some(point) = value.as_vec3() {
        value = Value::Pose(identity3(evaluator.graph), point);
    }
    let Value::Pose(rotation, position) = value else {
        return evaluator.miss();
    };
    let all = Value::Pose(rotation, position).entries();
    let class = all
        .iter()
        .fold(0, |class, edge| class | evaluator.graph.class(edge.node()));
    if class & !(class::PARAM | class::CONFIGURATION) != 0 {
        let message = format!(
            "frame `{}` depends on velocities, inputs or states",
            name.name
        );
        let error = Diagnostic::new(pose.span, message);
        return evaluator.error(error.help("a frame is a function of coordinates and parameters"));
    }
    if !scope.free {
        let pose_entries = Value::Pose(rotation, position);
        evaluator.continuous(&pose_entries, pose.span, "a frame")?;
    }
    let graph = &mut *evaluator.graph;
    let gram = multiply3(graph, &transpose3(&rotation), &rotation);
    let identity = identity3(graph);
    let mut places = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    if let Some((i, j)) = places.find(|&(i, j)| !scope.free && gram[i][j] != identity[i][j]) {
        let message = format!(
            "the matrix of frame `{}` is not a rotation: entry [{},{}] of R.T * R is not {}",
            name.name,
            i + 1,
            j + 1,
            u8::from(i == j)
        );
        return evaluator.error(
            Diagnostic::new(pose.span, message)
                .help("use an SO3 coordinate, `rot(q)`, `rotx(angle)` and their products"),
        );
    }
    // An orthogonal matrix has determinant 1 or −1, and so have its values modulo p.
    let [x, y, z] = rotation.map(|row| row.map(|entry| graph.value(entry)));
    let minor = |i: usize, j: usize| y[i] * z[j] - y[j] * z[i];
    let determinant = x[0] * minor(1, 2) - x[1] * minor(0, 2) + x[2] * minor(0, 1);
    if !scope.free && determinant != graph.value(graph.one()) {
        let message = format!(
            "the matrix of frame `{}` is a reflection: its determinant is -1",
            name.name
        );
        return evaluator.error(
            Diagnostic::new(pose.span, message)
                .help("use an SO3 coordinate, `rot(q)`, `rotx(angle)` and their products"),
        );
    }
    Some(Value::Pose(rotation, position))
}

/// Returns the world pose of the frame after `on`.
pub fn parent_pose(parent: &Ident, graph: &Graph, scope: &Scope) -> Option<Value> {
    match scope.symbols.kind(&parent.name) {
        Some(Kind::Frame) => scope.value(&parent.name).cloned(),
        None if parent.name == "world" => Some(Value::Pose(identity3(graph), [graph.zero(); 3])),
        _ => None,
    }
}
