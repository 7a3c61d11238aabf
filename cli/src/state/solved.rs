//! Velocities that the constraints give by others: a state has no place for them.

use hamel_codegen::generate::Generated;
use hamel_codegen::model::Group;

/// Names listed at most.
const LISTED: usize = 12;

/// The names of velocities that were solved away, and of joints that have no others, each with what to do
/// where a state gives it.
pub fn solved(generated: &Generated) -> Vec<(String, String)> {
    let active = &generated.active.velocities;
    let whole = |group: &&Group| active.iter().all(|left| left.name != group.name);
    let mut reasons = Vec::new();
    for group in generated.model.velocities.iter().filter(whole) {
        let entry = |name: &str| {
            let number = name.strip_prefix(group.name.as_str());
            number.is_some_and(|rest| rest.starts_with('_') && rest[1..].parse::<usize>().is_ok())
        };
        let entries = active.iter().map(|left| left.name.as_str());
        let entries: Vec<&str> = entries.filter(|name| entry(name)).collect();
        let why = match entries[..] {
            [] => format!(
                "solved away, since constraints give it by {}; leave it out",
                names(active)
            ),
            _ => format!(
                "solved away in part, since constraints give the rest by {}; give {}",
                names(active),
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

fn names(groups: &[Group]) -> String {
    let names: Vec<&str> = groups.iter().map(|group| group.name.as_str()).collect();
    match names.get(..LISTED) {
        Some(first) if names.len() > LISTED => format!("{} and others", first.join(", ")),
        _ => names.join(", "),
    }
}
