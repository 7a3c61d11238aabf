//! Evaluates named expressions and frames, in the order in which they become known.

use super::frames::{self, define_let, parent_pose, relative_pose};
use super::scope::Scope;
use crate::algebra::graph::Graph;
use crate::diagnostics::Report;
use crate::model::Frame;
use crate::model::value::Value;
use crate::symbols::{Kind, Relation, Step};

/// Values of the `let` and `frame` statements.
#[derive(Default)]
pub struct Names {
    /// Named expressions, in the order in which they became known.
    pub lets: Vec<(String, Value)>,
    /// Frames, in the order in which they became known.
    pub frames: Vec<Frame>,
}

impl Names {
    /// Reads statements in an order in which all names that they mention are known.
    pub fn read(
        &mut self,
        steps: &[Step],
        graph: &mut Graph,
        scope: &mut Scope,
        report: &mut Report,
    ) {
        for step in steps {
            match step {
                Step::Let(declaration) => {
                    if let Some(value) = define_let(declaration, graph, scope, report) {
                        self.lets.push((declaration.name.name.clone(), value));
                    }
                }
                Step::Frame(relation, back) => self.frame(relation, *back, graph, scope, report),
            }
        }
    }

    /// Reads a frame f = g P, or g = f P⁻¹ if the statement is used backwards.
    fn frame(
        &mut self,
        relation: &Relation,
        back: bool,
        graph: &mut Graph,
        scope: &mut Scope,
        report: &mut Report,
    ) {
        let pose = relative_pose(relation, graph, scope, report);
        let (name, on, relative) = match relation.on.filter(|_| back) {
            Some(on) => {
                let back = pose.map(|pose| frames::inverse(graph, &pose));
                (on, Some(relation.name), back)
            }
            None => (relation.name, relation.on, pose),
        };
        let value = match on {
            Some(on) => parent_pose(on, graph, scope)
                .zip(relative.as_ref())
                .map(|(parent, pose)| frames::ahead(graph, &parent, pose)),
            None => relative.clone(),
        };
        let free = scope.define(name, Kind::Frame, value.clone());
        let poses = value.zip(relative);
        if let (Some((Value::Pose(rotation, position), Value::Pose(turn, shift))), true) =
            (poses, free)
        {
            let parent = on.and_then(|on| self.frames.iter().position(|f| f.name == on.name));
            self.frames.push(Frame {
                name: name.name.clone(),
                parent,
                relative: (turn, shift),
                rotation,
                position,
            });
        }
    }
}
