//! Removes redundant equations of a robot's closing joints. The importer writes all equations; which of them are
//! redundant is known only after the description is derived.

use crate::derive::reduction::reduce;
use crate::lower;
use crate::model::Model;
use crate::model::loop_closure::LoopClosure;
use hamel_import::{Idle, Imported, Options, import_without};
use std::collections::BTreeMap;

/// Imports the robot again without those equations of closing joints that say nothing new in any configuration of its
/// tree. The robot stays as it was if there are none, if the description has errors (they are reported when it is
/// derived), or if the remaining equations lead to a start in which the removed ones do not hold.
pub(super) fn without_idle(xml: &str, options: &Options, imported: Imported) -> Imported {
    fewer(xml, options, &imported).unwrap_or(imported)
}

fn fewer(xml: &str, options: &Options, imported: &Imported) -> Option<Imported> {
    if imported.equations.is_empty() {
        return None;
    }
    let model = lower::build(&imported.system).ok()?;
    let idle = idle(&model, imported)?;
    if idle.is_empty() {
        return None;
    }
    let fewer = import_without(xml, options, &idle).ok()?;
    let mut start = lower::build(&fewer.system).ok()?.start_x;
    let given = vec![true; start.len()];
    let all = LoopClosure::of(&model, &model.defaults);
    all.close_loops(&mut start, &given).ok()?;
    Some(fewer)
}

/// Finds equations without a row, since both sides are equal, and those whose row follows from others.
fn idle(model: &Model, imported: &Imported) -> Option<BTreeMap<usize, Idle>> {
    let dropped = reduce(model).ok()?.map_or(Vec::new(), |of| of.dropped);
    let reason = |&statement: &usize| {
        // Each statement has places of its own, which its row keeps.
        let place = imported.system.items.get(statement)?.span.range();
        let mut rows = model.constraints.iter();
        match rows.position(|row| row.span.range() == place) {
            None => Some(Idle::Holds),
            Some(row) => dropped.contains(&row).then_some(Idle::Follows),
        }
    };
    let equations = imported.equations.iter().enumerate();
    let idle = equations.filter_map(|(place, statement)| Some((place, reason(statement)?)));
    Some(idle.collect())
}
