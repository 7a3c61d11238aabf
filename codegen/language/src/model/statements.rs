//! Places of the statements that a model refers to by name.

use crate::syntax::ast::{Ident, ItemKind, Span, System};
use std::collections::BTreeMap;

/// Places of statements that a model refers to by name.
#[derive(Clone, Debug, Default)]
pub struct Statements {
    /// `let`, `frame` and `output` statements, by the name that they define.
    pub names: BTreeMap<String, Span>,
    /// The first `body` or `particle` on each frame.
    pub bodies: BTreeMap<String, Span>,
    /// The first `force`, `torque` or `wrench` on each frame.
    pub loads: BTreeMap<String, Span>,
}

impl Statements {
    /// Collects the places of the statements of a description.
    pub fn of(system: &System) -> Self {
        let mut all = Statements::default();
        for item in &system.items {
            let mut name = |ident: &Ident| {
                all.names.entry(ident.name.clone()).or_insert(item.span);
            };
            match &item.kind {
                ItemKind::Let(list) => list.iter().for_each(|one| {
                    all.names.insert(one.name.name.clone(), one.name.span);
                }),
                ItemKind::Frame { name: frame, .. } => name(frame),
                ItemKind::Output { name: output, .. } => name(output),
                ItemKind::Body(body) => {
                    let bodies = all.bodies.entry(body.frame.name.clone());
                    bodies.or_insert(item.span);
                }
                ItemKind::Particle {
                    on: Some(frame), ..
                } => {
                    all.bodies.entry(frame.name.clone()).or_insert(item.span);
                }
                ItemKind::Load { frame, .. } => {
                    all.loads.entry(frame.name.clone()).or_insert(item.span);
                }
                _ => {}
            }
        }
        all
    }
}
