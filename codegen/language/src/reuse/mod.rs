//! Expansion of components, parts and repetition into plain statements.
//!
//! `for i in 1..n { … }` becomes n copies of its statements. `part left = Leg(hip);` becomes the statements of the
//! component `Leg`, with names of their own: `left.knee` becomes `left_knee`, `link[3]` becomes `link_3`, `leg[3].knee`
//! becomes `leg_3_knee`, and the velocity `j[2]_dot` of a joint `j[2]` becomes `j_2_dot`. A plain name depends only on
//! the name as written, so it stays the same when something else is added. Two names that would become the same plain
//! name are refused.
//!
//! The first pass copies all statements (`copies`) and records what they declare; the second pass replaces the names in
//! them (`replace`). Later stages know nothing of components. Each copy has a region of places of its own, and
//! [`Origins`](crate::syntax::ast::Origins) records which statement made it.

mod copies;
mod names;
mod numbers;
mod parts;
mod replace;

use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Item, ItemKind, Remarks, System};
use names::{Context, Expansion};
use std::collections::BTreeSet;

/// A description in which components, parts and repetition have been written out.
pub struct Written {
    /// The description. It records where its statements come from.
    pub system: System,
    /// Names used in ranges and indices.
    pub used: BTreeSet<String>,
    /// Warnings about unused components and parameters.
    pub warnings: Vec<Diagnostic>,
}

/// Expands all statements that stand for others. All independent errors are reported together.
pub fn expand(system: &System) -> Result<Written, Vec<Diagnostic>> {
    let unread: Vec<Diagnostic> = system.items.iter().filter_map(unread).collect();
    if !unread.is_empty() {
        // Errors caused by the missing statements would be spurious, so these are reported alone.
        return Err(unread);
    }
    let mut world = Expansion::new(system);
    for item in &system.items {
        if let ItemKind::Component(component) = &item.kind {
            world.component(component, item.span);
        }
    }
    world.statements(&system.items, &Context::default());
    world.frames_after_on();
    let pending = std::mem::take(&mut world.pending);
    let items = replace::replace(&mut world, pending);
    let mut warnings = world.unused();
    let used = std::mem::take(&mut world.used).into_inner();
    let (mut origins, report) = world.finish();
    if let Err(errors) = report.finish() {
        return Err(origins.0.located_all(errors));
    }
    warnings = origins.0.located_all(warnings);
    origins.0.name(std::mem::take(&mut origins.1));
    Ok(Written {
        system: System {
            items,
            origins: origins.0,
            remarks: Remarks::default(),
            docs: system.docs.clone(),
            public: system.public,
            name: system.name.clone(),
            shows_frames: system.shows_frames,
            starts_anywhere: system.starts_anywhere,
        },
        used,
        warnings,
    })
}

/// Returns the error for an `include` whose file was not read.
fn unread(item: &Item) -> Option<Diagnostic> {
    let ItemKind::Include(name, span) = &item.kind else {
        return None;
    };
    let message = format!("the folder of `{name}` is not known");
    Some(Diagnostic::new(*span, message).help("read the description from its file"))
}
