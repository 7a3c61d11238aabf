//! Velocities that constraints determine, and that states therefore do not contain.

use crate::names;
use hamel_codegen::derive::undetermined::undetermined_multipliers;
use hamel_codegen::generate::Generated;
use hamel_codegen::model::pfaffian::{Kind, Pfaffian};

/// Largest number of names listed.
const MAX_LISTED: usize = 12;

/// Describes a constraint by its text and its line in the description.
pub fn describe_constraint(constraint: &Pfaffian, text: &str) -> String {
    let before = constraint
        .span
        .range()
        .and_then(|range| text.get(..range.start));
    let line = before.map(|before| 1 + before.matches('\n').count());
    let written = match constraint.kind {
        Kind::Inactive => format!("inactive {}", constraint.written),
        _ => constraint.written.clone(),
    };
    let entry = match constraint.entry.as_str() {
        "" => String::new(),
        entry => format!(", entry {entry}"),
    };
    match line {
        Some(line) => format!("the constraint on line {line}, `{written}`{entry}"),
        None => format!("the constraint `{written}`{entry}"),
    }
}

/// Lists the velocities that constraints determine, each with its constraint, and the remaining ones.
pub fn constraint_lines(generated: &Generated, text: &str) -> Vec<String> {
    let (full, active) = (&generated.model, &generated.active);
    if full.constraints.is_empty() {
        return Vec::new();
    }
    let all = names::velocities(full);
    let row = |place: usize| {
        generated
            .solved
            .iter()
            .find(|(velocity, _)| *velocity == place)
    };
    let width = all
        .iter()
        .map(|name| name.chars().count())
        .max()
        .unwrap_or(0);
    let mut lines = Vec::new();
    for (place, name) in all.iter().enumerate() {
        let clock = full.clock.is_some_and(|clock| clock.xi == place);
        lines.push(
            match row(place).and_then(|(_, row)| full.constraints.get(*row)) {
                Some(row) => format!(
                    "velocity {name:width$}  follows from {}",
                    describe_constraint(row, text)
                ),
                None if clock => format!("velocity {name:width$}  is 1, the rate of time"),
                None => format!("velocity {name:width$}  stays in the state"),
            },
        );
    }
    let free = undetermined_multipliers(full);
    let said = full.constraints.iter().filter(|row| !row.redundant);
    let free = said.zip(free).filter(|(_, free)| *free);
    let free: Vec<(String, _)> = free
        .map(|(row, _)| (row.label(), row.span.range()))
        .collect();
    for row in &active.constraints {
        let shown = describe_constraint(row, text);
        let place = (row.label(), row.span.range());
        let which = match free.contains(&place) {
            true => ": not determined, as rows depend on it",
            false => "",
        };
        lines.push(format!("multiplier of {shown}{which}"));
    }
    lines
}

/// Returns the names of velocities that constraints determine, and of joints without other velocities, each with the
/// message for a state that contains it.
pub fn dependent_velocities(generated: &Generated, text: &str) -> Vec<(String, String)> {
    let full = &generated.model;
    let stay: Vec<String> = {
        let groups = generated.active.velocities.iter();
        groups.map(|group| group.name.clone()).collect()
    };
    let mut reasons = Vec::new();
    for group in &full.velocities {
        if stay.contains(&group.name) {
            continue;
        }
        let entry = |name: &&String| {
            let number = name.strip_prefix(group.name.as_str());
            number.is_some_and(|rest| rest.starts_with('_') && rest[1..].parse::<usize>().is_ok())
        };
        let entries: Vec<&str> = stay.iter().filter(entry).map(String::as_str).collect();
        let of_group = generated
            .solved
            .iter()
            .filter(|(velocity, _)| (group.offset..group.offset + group.len).contains(velocity));
        let rows = of_group.filter_map(|(_, row)| full.constraints.get(*row));
        let mut rows: Vec<String> = rows.map(|row| describe_constraint(row, text)).collect();
        rows.dedup();
        let rows = listed(&rows, " and ");
        let why = match entries[..] {
            [] if rows.is_empty() => format!(
                "not a velocity of the state, which has {}; leave it out",
                listed(&stay, ", ")
            ),
            [] => format!("follows from {rows}; leave it out"),
            _ => format!(
                "follows in part from {rows}; give {}",
                entries.join(" and ")
            ),
        };
        if let Some(joint) = group.name.strip_suffix("_dot") {
            reasons.push((joint.to_string(), why.clone()));
        }
        reasons.push((group.name.clone(), why));
    }
    reasons
}

fn listed(names: &[String], between: &str) -> String {
    match names.get(..MAX_LISTED) {
        Some(first) if names.len() > MAX_LISTED => format!("{} and others", first.join(between)),
        _ => names.join(between),
    }
}
