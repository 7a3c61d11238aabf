//! Removes redundant equations of a robot's closing joints. The importer writes all equations; which of them are
//! redundant is known only after the description is read and derived.

use crate::derive::reduction::reduce;
use crate::lower;
use crate::model::Model;
use crate::model::closure::Closure;
use crate::model::pfaffian::Kind;
use crate::render::span_bytes;
use crate::syntax;
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
    let model = model(&imported.text)?;
    let idle = idle(&model, imported)?;
    if idle.is_empty() {
        return None;
    }
    let fewer = import_without(xml, options, &idle).ok()?;
    let mut start = self::model(&fewer.text)?.start_x;
    let given = vec![true; start.len()];
    let all = Closure::of(&model, &model.defaults);
    all.close_loops(&mut start, &given).ok()?;
    Some(fewer)
}

/// Builds the model of a robot's description.
fn model(text: &str) -> Option<Model> {
    let mut system = syntax::parse_text(text).ok()?;
    system.starts_anywhere = true;
    lower::build(&system).ok()
}

/// Finds equations without a row, since both sides are equal, and those whose row follows from others.
fn idle(model: &Model, imported: &Imported) -> Option<BTreeMap<usize, Idle>> {
    let dropped = reduce(model).ok()?.map_or(Vec::new(), |of| of.dropped);
    let constraints = model.constraints.iter().enumerate();
    let loops = constraints.filter(|(_, row)| row.kind == Kind::Loop);
    let rows: BTreeMap<usize, usize> = loops
        .filter_map(|(place, row)| {
            let start = span_bytes(row.span, &imported.text)?.start;
            let before = imported.text.get(..start)?;
            Some((before.matches('\n').count(), place))
        })
        .collect();
    let reason = |line: &usize| match rows.get(line) {
        None => Some(Idle::Holds),
        Some(row) => dropped.contains(row).then_some(Idle::Follows),
    };
    let equations = imported.equations.iter().enumerate();
    let idle = equations.filter_map(|(place, line)| Some((place, reason(line)?)));
    Some(idle.collect())
}
