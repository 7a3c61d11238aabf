//! Writes the description: joints and bodies in the order of the tree.

mod body;
mod header;
mod joint;
mod page;
mod ties;

use crate::names::Names;
use crate::options::{Idle, Imported, Options};
use crate::plan::{Mobility, Plan};
use crate::problem::Problem;
use crate::robot::{Kind, Read, Robot};
use crate::tree::{Edge, Tree};
use page::Page;
use std::collections::BTreeMap;

/// Writer of the statements.
struct Writer<'a> {
    robot: &'a Robot,
    tree: &'a Tree,
    plan: &'a Plan,
    options: &'a Options,
    names: Names,
    /// Line numbers of the equations of loop-closing joints.
    equations: Vec<usize>,
    page: Page,
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
        page: Page::default(),
    };
    writer.header(&cleaned, &warnings);
    writer.parameters();
    writer.page.line(None, "gravity [0, 0, -9.81];");
    writer.inputs();
    writer.base();
    let moving = writer.moving();
    for edge in &tree.joints {
        writer.page.blank();
        writer.joint(edge);
        if moving[edge.child] {
            writer.body(edge.child);
        }
    }
    writer.springs();
    writer.loops(idle);
    writer.page.close();
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
    let has_masses = !writer.bodies().is_empty();
    Imported {
        links: base.into_iter().chain(moved).collect(),
        ground,
        name: writer.names.system,
        joints,
        has_masses,
        cleaned,
        warnings,
        text: writer.page.text,
        origins: writer.page.origins,
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

    /// Declares inputs for the forces and torques of all free joints.
    fn inputs(&mut self) {
        let mut inputs = Vec::new();
        if self.options.floating {
            let root = &self.names.root;
            inputs.push(format!("{root}_force: vec3"));
            inputs.push(format!("{root}_torque: vec3"));
        }
        for edge in self.free() {
            let name = &self.names.joints[edge.joint];
            match self.robot.joints[edge.joint].kind {
                Kind::Floating => {
                    inputs.push(format!("{name}_force: vec3"));
                    inputs.push(format!("{name}_torque: vec3"));
                }
                Kind::Spherical => inputs.push(format!("{name}_tau: vec3")),
                Kind::Universal => inputs.push(format!("{name}_tau: vec2")),
                Kind::Planar => {
                    inputs.push(format!("{name}_force: vec2"));
                    inputs.push(format!("{name}_tau"));
                }
                _ => inputs.push(format!("{name}_tau")),
            }
        }
        self.page.list("input", &inputs);
    }

    /// Writes the root link: a free body, or part of the world.
    fn base(&mut self) {
        let link = &self.robot.links[self.tree.root];
        let (name, range) = (link.name.name.clone(), link.name.range.clone());
        self.page.blank();
        if !self.options.floating {
            self.page
                .comment(&range, &format!("`{name}` is fixed in the world."));
            return;
        }
        let (root, frame) = (&self.names.root, &self.names.links[self.tree.root]);
        let joint = format!("joint {root}: free moves {frame};");
        let wrench = format!("wrench ({root}_force, {root}_torque) on {frame} in body;");
        self.page.line(Some(&range), &joint);
        self.page.line(Some(&range), &wrench);
        self.body(self.tree.root);
    }
}
