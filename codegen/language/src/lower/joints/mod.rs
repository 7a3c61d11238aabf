//! Expands joints into coordinates, velocities, rates and frames.
//!
//! | kind | coordinates | velocities | pose of the frame that it carries, at its place |
//! |---|---|---|---|
//! | `revolute n` | `j` | `j_dot` | turn by j about n |
//! | `continuous n` | `j: S1` | `j_dot` | turn by (c, s) about n |
//! | `prismatic n` | `j` | `j_dot` | shift by j n |
//! | `spherical` | `j: SO3` (`S3`) | `j_dot: vec3`, angular velocity in the axes of the frame | rotation j |
//! | `free` | `j_r: R3`, `j_R: SO3` | `j_v: vec3`, `j_w: vec3`, its twist in its axes | rotation `j_R`, shift `j_r` |
//! | `planar n` | `j_r: R2`, `j` | `j_r_dot: vec2`, `j_dot` | shift by `j_r` in the plane, turn by j about n |
//! | `universal a, b` | `j_1`, `j_2` | `j_1_dot`, `j_2_dot` | turn about a, then about the turned b |
//! | `cylindrical n` | `j`, `j_d` | `j_dot`, `j_d_dot` | turn by j about n, shift by `j_d` n |
//! | `fixed` | | | none |
//!
//! The result is exactly what a user would write without joints; its spans are those of the joint, so that every
//! later error points at the joint.

mod fields;
mod written;

use crate::algebra::graph::Graph;
use crate::diagnostics::{Diagnostic, Report};
use crate::lower::axes;
use crate::lower::expression::Evaluator;
use crate::lower::scope::Scope;
use crate::model::joints::Joint;
use crate::syntax::ast::{self, Ident, ItemKind, JointField, System};
use crate::syntax::joint_endings;
use written::JointExpansion;

pub(super) use fields::armature;

/// Reads the joints, and reports errors in their fields.
pub fn read(system: &System, graph: &mut Graph, scope: &Scope, report: &mut Report) -> Vec<Joint> {
    let mut joints = Vec::new();
    for item in &system.items {
        if let ItemKind::Joint(joint) = &item.kind {
            fields::check(joint, report);
            let mut numbers = |field| fields::numbers(joint, field, graph, scope, report);
            let limit = numbers(JointField::Limit);
            let speed = numbers(JointField::MaxSpeed);
            let force = numbers(JointField::MaxForce);
            let axes = directions(joint, graph, scope);
            let (coordinates, velocities) = names(joint);
            joints.push(Joint {
                name: joint.name.name.clone(),
                kind: joint.kind.0,
                frame: joint.moves.name.clone(),
                axes,
                coordinates,
                velocities,
                limit: limit.and_then(|list| <[f64; 2]>::try_from(list).ok()),
                max_speed: speed.and_then(|list| list.first().copied()),
                max_force: force.and_then(|list| list.first().copied()),
            });
        }
    }
    joints
}

/// Returns the unit vectors of a joint's axes; errors in them are reported where the frame is read.
fn directions(joint: &ast::Joint, graph: &mut Graph, scope: &Scope) -> Vec<[f64; 3]> {
    let mut reported = Report::default();
    let mut direction = |axis: &ast::Expr| {
        let value = Evaluator::new(graph, scope, &mut reported).value(axis)?;
        let [a, b, c] = axes::unit(graph, value.as_vec3()?)
            .ok()?
            .map(|entry| fields::number(graph, entry));
        Some([a?, b?, c?])
    };
    joint.axes.iter().filter_map(&mut direction).collect()
}

/// Returns the names of a joint's coordinates and velocities.
fn names(joint: &ast::Joint) -> (Vec<String>, Vec<String>) {
    let (coordinates, velocities) = joint_endings(joint);
    let named = |endings: &[&str]| {
        let of = |ending: &&str| format!("{}{ending}", joint.name.name);
        endings.iter().map(of).collect()
    };
    (named(coordinates), named(velocities))
}

/// Returns the system with every joint expanded.
pub fn expand(system: &System, report: &mut Report) -> System {
    let mut items = Vec::new();
    let mut moved: Vec<&Ident> = Vec::new();
    let frames = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Frame { name, .. } => Some(name),
        _ => None,
    });
    moved.extend(frames);
    for item in &system.items {
        let ItemKind::Joint(joint) = &item.kind else {
            items.push(item.clone());
            continue;
        };
        let mut expansion = JointExpansion {
            joint,
            span: item.span,
            items: Vec::new(),
        };
        let poses = expansion.motion();
        match moved.iter().find(|other| other.name == joint.moves.name) {
            Some(first) => report.push(twice(joint, first)),
            None => expansion.frames(poses),
        }
        expansion.push_loads();
        moved.push(&joint.moves);
        items.extend(expansion.items);
        // The joint is kept for its name and its constants.
        items.push(item.clone());
    }
    System {
        items,
        ..system.clone()
    }
}

/// Returns the error for a frame that is placed already.
fn twice(joint: &ast::Joint, first: &Ident) -> Diagnostic {
    let message = format!("the frame `{}` is placed twice", first.name);
    Diagnostic::new(joint.moves.span, message)
        .help("each joint moves a new frame; close a mechanism by a `loop` between coordinates")
        .note(first.span, "already placed here")
}
