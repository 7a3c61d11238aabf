//! What was given of a state, by the velocities of the full frame.

use hamel_codegen::generate::Generated;
use hamel_codegen::model::{Group, Model};

/// The entries of x that were given, and what was given of ξ.
#[derive(Clone, Debug)]
pub struct Given {
    /// Entries of x.
    pub x: Vec<bool>,
    /// Values of ξ of the full frame.
    pub xi: Vec<Option<f64>>,
    /// Entries of z.
    pub z: Vec<bool>,
}

impl Given {
    /// Nothing.
    pub fn nothing(generated: &Generated) -> Self {
        let model = &generated.model;
        Given {
            x: vec![false; model.nu()],
            xi: vec![None; model.n()],
            z: vec![false; model.start_z.len()],
        }
    }
}

/// Places of the velocities of states in ξ of the full frame.
pub fn places(generated: &Generated) -> Vec<usize> {
    let full = &generated.model;
    let solved = |place: &usize| generated.solved.iter().any(|(solved, _)| solved == place);
    let time = |place: usize| {
        let clock = full.clock.filter(|_| full.spans);
        clock.is_some_and(|clock| clock.xi == place)
    };
    let all = (0..full.n()).filter(|place| !solved(place) && !time(*place));
    all.collect()
}

/// Velocities that a state may give, by their places in ξ of the full frame: all of the description but the rate of time,
/// and those that constraints leave of them.
pub fn velocities(generated: &Generated) -> Vec<Group> {
    let (full, active) = (&generated.model, &generated.active);
    let places = places(generated);
    let clock = full.clock.map(|clock| clock.xi);
    let own = full.velocities.iter();
    let mut all: Vec<Group> = own
        .filter(|group| clock != Some(group.offset))
        .cloned()
        .collect();
    for group in &active.velocities {
        if !all.iter().any(|known| known.name == group.name)
            && let Some(&offset) = places.get(group.offset)
        {
            all.push(Group {
                offset,
                ..group.clone()
            });
        }
    }
    all
}

/// The joints that have velocities, with the places of these in ξ.
pub fn joints(model: &Model) -> Vec<(&str, Vec<usize>)> {
    let places = |names: &[String]| -> Vec<usize> {
        let groups = names.iter().filter_map(|name| {
            let mut groups = model.velocities.iter();
            groups.find(|group| group.name == *name)
        });
        groups
            .flat_map(|group| group.offset..group.offset + group.len)
            .collect()
    };
    let all = model.joints.iter();
    all.map(|joint| (joint.name.as_str(), places(&joint.velocities)))
        .filter(|(_, places)| !places.is_empty())
        .collect()
}
