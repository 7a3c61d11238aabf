//! Decides how each joint moves: freely, not at all, or following another joint.

use crate::decimal::Decimal;
use crate::options::{Mimic, Options};
use crate::problem::Problems;
use crate::robot::{Joint, Kind, Robot};
use crate::tree::{near, unknown};
use std::collections::BTreeMap;

/// How a joint moves.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Mobility {
    /// It has coordinates of its own.
    Free,
    /// The type of the joint is `fixed`.
    Fixed,
    /// The joint is locked at an angle or a length.
    Locked(Linear),
    /// The joint follows the joint of this index: each step (factor, offset) maps q to factor · q + offset. There are
    /// several steps if the joint mimics a joint that itself mimics another.
    Follows(usize, Vec<(Decimal, Decimal)>),
}

/// A number written as an expression: start with `value`, then multiply by the factor and add the offset of each
/// step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Linear {
    pub(crate) value: Decimal,
    pub(crate) steps: Vec<(Decimal, Decimal)>,
}

/// Mobility of all joints, by index.
#[derive(Debug)]
pub(crate) struct Plan {
    pub(crate) motions: Vec<Mobility>,
    /// Whether some joint follows this one, whose angle then has to be a coordinate.
    pub(crate) followed: Vec<bool>,
}

/// Decides how each joint moves, as the options say.
pub(crate) fn plan(
    robot: &Robot,
    options: &Options,
    errors: &mut Problems<'_>,
    warnings: &mut Problems<'_>,
) -> Plan {
    let index: BTreeMap<&str, usize> = robot
        .joints
        .iter()
        .enumerate()
        .map(|(index, joint)| (joint.name.name.as_str(), index))
        .collect();
    let locks = locks(robot, options, &index, errors);
    let mut motions = Vec::new();
    for (number, joint) in robot.joints.iter().enumerate() {
        motions.push(match (joint.kind, locks.get(&number), &joint.mimic) {
            (Kind::Fixed, ..) => Mobility::Fixed,
            (_, Some(value), _) => Mobility::Locked(Linear {
                value: value.clone(),
                steps: Vec::new(),
            }),
            (_, None, Some(_)) if options.mimic == Mimic::Follow => {
                follow(robot, number, &index, &locks, errors)
            }
            _ => Mobility::Free,
        });
    }
    let mut followed = vec![false; motions.len()];
    for motion in &motions {
        if let Mobility::Follows(source, _) = motion {
            followed[*source] = true;
        }
    }
    if options.mimic == Mimic::Free {
        for joint in &robot.joints {
            if let Some(mimic) = &joint.mimic
                && !index.contains_key(mimic.source.name.as_str())
            {
                unknown("joint", &mimic.source, index.keys().copied(), warnings);
            }
        }
    }
    Plan { motions, followed }
}

/// Reads the values of the locked joints.
fn locks(
    robot: &Robot,
    options: &Options,
    index: &BTreeMap<&str, usize>,
    errors: &mut Problems<'_>,
) -> BTreeMap<usize, Decimal> {
    let mut locks = BTreeMap::new();
    for (name, value) in &options.locks {
        let Some(&number) = index.get(name.as_str()) else {
            let movable = robot
                .joints
                .iter()
                .filter(|joint| joint.kind != Kind::Fixed);
            let names: Vec<&str> = movable.map(|joint| joint.name.name.as_str()).collect();
            let help = match near(name, names.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None if names.is_empty() => "this robot has no moving joint".into(),
                None => format!("the moving joints are {}", names.join(", ")),
            };
            errors.push(
                &robot.range,
                format!("there is no joint `{name}` to lock"),
                help,
            );
            continue;
        };
        let joint = &robot.joints[number];
        let one = joint.kind.is_single();
        match Decimal::parse(value.trim()) {
            _ if !one => errors.push(
                &joint.name.range,
                format!("`{name}` cannot be locked: it has no single angle or length"),
                "lock only revolute, continuous and prismatic joints",
            ),
            None => errors.push(
                &joint.name.range,
                format!("`{name}` is locked at `{value}`, which is not a number"),
                "write an angle in rad or a length in m, as in `0.25`",
            ),
            Some(value) => {
                if locks.insert(number, value).is_some() {
                    errors.push(
                        &joint.name.range,
                        format!("`{name}` is locked twice"),
                        "lock it once",
                    );
                }
            }
        }
    }
    locks
}

/// Follows a chain of mimicking joints to its end.
fn follow(
    robot: &Robot,
    number: usize,
    index: &BTreeMap<&str, usize>,
    locks: &BTreeMap<usize, Decimal>,
    errors: &mut Problems<'_>,
) -> Mobility {
    let mut steps = Vec::new();
    let mut at = number;
    loop {
        let joint: &Joint = &robot.joints[at];
        if let Some(value) = locks.get(&at) {
            steps.reverse();
            let value = value.clone();
            return Mobility::Locked(Linear { value, steps });
        }
        let Some(mimic) = &joint.mimic else {
            steps.reverse();
            return Mobility::Follows(at, steps);
        };
        let source = index.get(mimic.source.name.as_str()).copied();
        let Some(next) = source else {
            // Reported only for the joint that names it.
            if at == number {
                unknown("joint", &mimic.source, index.keys().copied(), errors);
            }
            return Mobility::Free;
        };
        if !robot.joints[next].kind.is_single() || !joint.kind.is_single() {
            if at == number {
                errors.push(
                    &mimic.source.range,
                    format!("`{}` cannot mimic `{}`", joint.name.name, mimic.source.name),
                    "both have to be revolute, continuous or prismatic",
                );
            }
            return Mobility::Free;
        }
        steps.push((mimic.multiplier.clone(), mimic.offset.clone()));
        if next == number || steps.len() > robot.joints.len() {
            if next == number {
                errors.push(
                    &mimic.source.range,
                    format!("`{}` mimics itself", robot.joints[number].name.name),
                    "one joint of the cycle has to move independently",
                );
            }
            return Mobility::Free;
        }
        at = next;
    }
}
