//! Named expressions and frames.

use super::declare::shape_fits;
use super::expression::Evaluator;
use super::scope::{NameKind, Scope};
use super::value::Value;
use super::{Frame, class};
use crate::algebra::graph::Graph;
use crate::algebra::linear::{add3, apply3, identity3, multiply3, transpose3};
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{Declaration, Expr, Ident};

/// Defines a `let`; its value, where it has one.
pub fn define_let(
    declaration: &Declaration,
    graph: &mut Graph,
    scope: &mut Scope,
    report: &mut Report,
) -> Option<Value> {
    let name = &declaration.name;
    let value = match &declaration.value {
        Some(expr) => {
            let value = Evaluator {
                graph,
                scope,
                report,
            }
            .value(expr);
            value.filter(|value| shape_fits(declaration, value, report))
        }
        None => {
            report.push(
                Diagnostic::new(name.span, format!("`{}` has no value", name.name))
                    .help(format!("write `let {} = …;`", name.name)),
            );
            None
        }
    };
    let free = scope.define(name, NameKind::Let, value.clone(), report);
    value.filter(|_| free)
}

/// Defines a frame.
pub fn define_frame(
    name: &Ident,
    on: Option<&Ident>,
    pose: &Expr,
    graph: &mut Graph,
    scope: &mut Scope,
    frames: &mut Vec<Frame>,
    report: &mut Report,
) {
    let value = frame_value(name, on, pose, graph, scope, report);
    let free = scope.define(name, NameKind::Frame, value.clone(), report);
    if let (Some(Value::Pose(rotation, position)), true) = (value, free) {
        frames.push(Frame {
            name: name.name.clone(),
            rotation,
            position,
        });
    }
}

fn frame_value(
    name: &Ident,
    on: Option<&Ident>,
    pose: &Expr,
    graph: &mut Graph,
    scope: &Scope,
    report: &mut Report,
) -> Option<Value> {
    let mut evaluator = Evaluator {
        graph,
        scope,
        report,
    };
    let parent = on.map(|parent| parent_pose(&mut evaluator, parent));
    let value = evaluator.value(pose)?;
    let Value::Pose(rotation, position) = value else {
        let message = format!("a frame has to be a pose, this is {}", value.shape());
        let help = match value.shape().as_str() {
            "a 3×3 matrix" => format!("write `frame {} = pose(R, [0, 0, 0]);`", name.name),
            _ => format!("write `frame {} = pose(R, p);`", name.name),
        };
        return evaluator.error(Diagnostic::new(pose.span, message).help(help));
    };
    let all = Value::Pose(rotation, position).entries();
    let class = all
        .iter()
        .fold(0, |class, edge| class | evaluator.graph.class(edge.node()));
    if class & !(class::PARAM | class::COORD) != 0 {
        let message = format!("frame `{}` depends on velocities or inputs", name.name);
        let error = Diagnostic::new(pose.span, message);
        return evaluator.error(error.help("a frame is a function of coordinates and parameters"));
    }
    let graph = &mut *evaluator.graph;
    let gram = multiply3(graph, &transpose3(&rotation), &rotation);
    let identity = identity3(graph);
    let mut places = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    if let Some((i, j)) = places.find(|&(i, j)| !scope.free && gram[i][j] != identity[i][j]) {
        let message = format!(
            "the matrix of frame `{}` is no rotation: entry [{},{}] of R.T * R is not {}",
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
    let Some(parent) = parent else {
        return Some(Value::Pose(rotation, position));
    };
    let Value::Pose(r, p) = parent? else {
        return None;
    };
    let graph = evaluator.graph;
    let moved = apply3(graph, &r, position);
    let position = add3(graph, p, moved);
    Some(Value::Pose(multiply3(graph, &r, &rotation), position))
}

fn parent_pose(evaluator: &mut Evaluator, parent: &Ident) -> Option<Value> {
    match evaluator.scope.get(&parent.name) {
        Some(entry) if entry.kind == NameKind::Frame => entry.value.clone(),
        None if parent.name == "world" => Some(evaluator.world()),
        _ => {
            let is_frame = |kind| kind == NameKind::Frame;
            let scope = evaluator.scope;
            let error = scope.unknown(parent.span, &parent.name, Some("frame"), is_frame);
            evaluator.error(error)
        }
    }
}
