//! Components, parts and repetition, written out as the statements that they stand for.
//!
//! `for i in 1..n { … }` becomes its statements n times, `part left = Leg(hip);` the statements of the component `Leg`
//! with names of their own: `left.knee` is called `left_knee` then, `link[3]` is `link_3`, `leg[3].knee` is
//! `leg_3_knee`, and the velocity `j[2]_dot` of a joint `j[2]` is `j_2_dot`. A name depends on nothing but itself, so
//! that it stays when something else is added; two that would be one are refused.
//!
//! First all statements are copied (`copies`), and what they declare is noted; then names in them are
//! replaced (`replace`). Nothing after this stage knows of components: places of copies are regions of their own, and
//! [`Origins`](crate::syntax::ast::Origins) says of each which statement made it.

mod copies;
mod names;
mod numbers;
mod parts;
mod replace;

use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Item, ItemKind, System};
use names::{Context, World};
use std::collections::BTreeSet;

/// A description without components, parts and repetition.
pub struct Written {
    /// The description, which knows where its statements come from.
    pub system: System,
    /// Names that ranges and indices mention.
    pub used: BTreeSet<String>,
    /// What is declared and never used.
    pub warnings: Vec<Diagnostic>,
}

/// Writes out what stands for other statements; all independent errors are reported together.
pub fn expand(system: &System) -> Result<Written, Vec<Diagnostic>> {
    let unread: Vec<Diagnostic> = system.items.iter().filter_map(unread).collect();
    if !unread.is_empty() {
        // What is missing there is no further error.
        return Err(unread);
    }
    let mut world = World::new(system);
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

/// The error for a file that was not read.
fn unread(item: &Item) -> Option<Diagnostic> {
    let ItemKind::Include(name, span) = &item.kind else {
        return None;
    };
    let message = format!("nothing says in which folder `{name}` is");
    Some(Diagnostic::new(*span, message).help("read the description from its file"))
}
