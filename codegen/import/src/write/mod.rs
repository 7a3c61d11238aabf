//! Writes the description: joints and bodies in the order of the tree.

mod body;
mod draft;
mod header;
mod joint;
mod ties;

use crate::names::Names;
use crate::options::{Idle, Imported, Options};
use crate::plan::{Mobility, Plan};
use crate::problem::Problem;
use crate::robot::{Kind, Read, Robot};
use crate::tree::{Edge, Tree};
use draft::Draft;
use hamel_language::expression::ident;
use hamel_language::syntax::ast::{
    Components, Declaration, Expr, Ident, ItemKind, Joint, JointKind, Load, Shape, ShapeKind, Span,
    System,
};
use std::collections::BTreeMap;

/// Writer of the statements.
struct Writer<'a> {
    robot: &'a Robot,
    tree: &'a Tree,
    plan: &'a Plan,
    options: &'a Options,
    names: Names,
    /// Indices of the statements that are equations of loop-closing joints.
    equations: Vec<usize>,
    draft: Draft,
}

/// Writes the description of a robot that was read and checked, without the redundant equations `idle` of
/// loop-closing joints.
pub(crate) fn write(
    xml: &str,
    read: &Read,
    (tree, plan): (&Tree, &Plan),
    (options, idle): (&Options, &BTreeMap<usize, Idle>),
    warnings: Vec<Problem>,
) -> Imported {
    let names = Names::of(&read.robot, options.name.as_deref());
    let cleaned = header::cleaned(xml, &read.cleaned);
    let mut writer = Writer {
        robot: &read.robot,
        tree,
        plan,
        options,
        names,
        equations: Vec::new(),
        draft: Draft::of(xml),
    };
    writer.draft.remarks.head = writer.notes(&cleaned, &warnings);
    writer.parameters();
    let gravity = [0.0, 0.0, -9.81].into();
    writer
        .draft
        .statement(&read.robot.range, ItemKind::Gravity(gravity));
    writer.inputs();
    writer.base();
    let moving = writer.moving();
    for edge in &tree.joints {
        writer.draft.blank();
        writer.joint(edge);
        if moving[edge.child] {
            writer.body(edge.child);
        }
    }
    writer.springs();
    writer.loops(idle);
    let joints = writer.own_joints();
    let link = |link: usize| {
        let written = writer.robot.links[link].name.name.clone();
        (written, writer.names.links[link].clone())
    };
    let root = tree.root;
    let moved = tree.joints.iter().map(|edge| link(edge.child));
    let (base, ground) = match options.floating {
        true => (Some(link(root)), None),
        false => (None, Some(link(root))),
    };
    let links = base.into_iter().chain(moved).collect();
    let has_masses = !writer.bodies().is_empty();
    let system = writer.system();
    Imported {
        links,
        ground,
        joints,
        has_masses,
        cleaned,
        warnings,
        system,
        equations: writer.equations,
    }
}

impl Writer<'_> {
    /// Returns whether each link moves relative to the world.
    fn moving(&self) -> Vec<bool> {
        let mut moving = vec![self.options.floating; self.robot.links.len()];
        for edge in &self.tree.joints {
            let motion = &self.plan.motions[edge.joint];
            let still = matches!(motion, Mobility::Fixed | Mobility::Locked(_));
            moving[edge.child] = moving[edge.parent] || !still;
        }
        moving
    }

    /// Returns the joints with coordinates of their own, in the order of the tree.
    fn free(&self) -> impl Iterator<Item = &Edge> {
        let free = |edge: &&Edge| self.plan.motions[edge.joint] == Mobility::Free;
        self.tree.joints.iter().filter(free)
    }

    fn own_joints(&self) -> Vec<(String, String)> {
        let root = self
            .options
            .floating
            .then(|| (self.names.root.clone(), self.names.root.clone()));
        let joints = self.free().flat_map(|edge| {
            let joint = &self.robot.joints[edge.joint];
            let pair = (
                joint.name.name.clone(),
                self.names.joints[edge.joint].clone(),
            );
            // A universal joint has one name for each of its two angles.
            match joint.kind {
                Kind::Universal => ["_1", "_2"]
                    .map(|angle| (pair.0.clone() + angle, pair.1.clone() + angle))
                    .to_vec(),
                _ => vec![pair],
            }
        });
        root.into_iter().chain(joints).collect()
    }

    /// Returns the description of what was written.
    fn system(&mut self) -> System {
        let docs = self.docs();
        let mut origins = std::mem::take(&mut self.draft.origins);
        let name = self.names.system.clone();
        let span = origins.import(self.robot.range.clone(), format!("pub system {name} {{"));
        System {
            docs,
            public: true,
            name: Ident { name, span },
            items: std::mem::take(&mut self.draft.items),
            origins,
            remarks: std::mem::take(&mut self.draft.remarks),
            shows_frames: false,
            // A robot's coordinates start at 0, whatever that is.
            starts_anywhere: true,
        }
    }

    /// Declares inputs for the forces and torques of all free joints.
    fn inputs(&mut self) {
        use ShapeKind::{Scalar, Vector};
        let mut inputs = Vec::new();
        let mut add = |joint: &str, suffix: &str, shape| {
            inputs.push(declared(&format!("{joint}_{suffix}"), shape, None));
        };
        if self.options.floating {
            add(&self.names.root, "force", Vector(3));
            add(&self.names.root, "torque", Vector(3));
        }
        for edge in self.free() {
            let name = &self.names.joints[edge.joint];
            match self.robot.joints[edge.joint].kind {
                Kind::Floating => {
                    add(name, "force", Vector(3));
                    add(name, "torque", Vector(3));
                }
                Kind::Spherical => add(name, "tau", Vector(3)),
                Kind::Universal => add(name, "tau", Vector(2)),
                Kind::Planar => {
                    add(name, "force", Vector(2));
                    add(name, "tau", Scalar);
                }
                _ => add(name, "tau", Scalar),
            }
        }
        if !inputs.is_empty() {
            self.draft
                .statement(&self.robot.range, ItemKind::Input(inputs));
        }
    }

    /// Writes the root link: a free body, or part of the world.
    fn base(&mut self) {
        let link = &self.robot.links[self.tree.root].name;
        self.draft.blank();
        if !self.options.floating {
            self.draft
                .comment(format!("`{}` is fixed in the world.", link.name));
            return;
        }
        let (root, frame) = (&self.names.root, &self.names.links[self.tree.root]);
        let joint = Joint {
            name: ident(root),
            kind: (JointKind::Free, Span::NOWHERE),
            axes: Vec::new(),
            on: None,
            at: None,
            moves: ident(frame),
            follows: None,
            fields: Vec::new(),
        };
        let wrench = ItemKind::Load {
            load: Load::Wrench {
                force: Expr::name(&format!("{root}_force")),
                torque: Expr::name(&format!("{root}_torque")),
                at: None,
            },
            frame: ident(frame),
            from: None,
            axes: Components::Body,
        };
        self.draft
            .statement(&link.range, ItemKind::Joint(Box::new(joint)));
        self.draft.statement(&link.range, wrench);
        self.body(self.tree.root);
    }
}

/// Returns the declaration of a symbol.
fn declared(name: &str, kind: ShapeKind, value: Option<Expr>) -> Declaration {
    let span = Span::NOWHERE;
    Declaration {
        name: ident(name),
        shape: Shape { kind, span },
        unit: None,
        value,
    }
}
