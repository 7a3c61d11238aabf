//! Entries of a state that a file gives, by the velocities of the full frame.

use hamel_codegen::generate::Generated;
use hamel_codegen::model::{Group, Model};
use hamel_codegen::syntax::ast::JointKind;

/// Which entries of x and z a state gives, and the given values of ξ.
#[derive(Clone, Debug)]
pub struct GivenEntries {
    /// Given entries of x.
    pub x: Vec<bool>,
    /// Given values of ξ of the full frame.
    pub xi: Vec<Option<f64>>,
    /// Given entries of z.
    pub z: Vec<bool>,
}

impl GivenEntries {
    /// Creates the record of a state that gives nothing.
    pub fn none(generated: &Generated) -> Self {
        let model = &generated.model;
        GivenEntries {
            x: vec![false; model.nu()],
            xi: vec![None; model.n()],
            z: vec![false; model.start_z.len()],
        }
    }
}

/// Returns for each velocity of a state its index in ξ of the full frame.
pub fn full_frame_indices(generated: &Generated) -> Vec<usize> {
    let full = &generated.model;
    let solved = |place: &usize| generated.solved.iter().any(|(solved, _)| solved == place);
    let time = |place: usize| {
        let clock = full.clock.filter(|_| full.spans);
        clock.is_some_and(|clock| clock.xi == place)
    };
    let all = (0..full.n()).filter(|place| !solved(place) && !time(*place));
    all.collect()
}

/// Returns the velocities that a state may contain, by their indices in ξ of the full frame: all of the description
/// except the rate of time, and the entries that constraints leave of them.
pub fn velocities(generated: &Generated) -> Vec<Group> {
    let (full, active) = (&generated.model, &generated.active);
    let places = full_frame_indices(generated);
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

/// Velocities of a joint, by one of its names.
pub struct JointVelocities<'a> {
    /// Name.
    pub name: &'a str,
    /// Indices of its velocities in ξ.
    pub places: Vec<usize>,
    /// Number of linear velocities, if the others are angular.
    pub linear: Option<usize>,
}

/// Returns the joints with velocities, by their names in the robot's file and by those in the description unless
/// another joint has that name in the file; `names` are pairs of these.
pub fn joints<'a>(model: &'a Model, names: &'a [(String, String)]) -> Vec<JointVelocities<'a>> {
    let mut all = Vec::new();
    for joint in &model.joints {
        let groups = joint.velocities.iter().filter_map(|name| {
            let mut groups = model.velocities.iter();
            groups.find(|group| group.name == *name)
        });
        let places: Vec<usize> = groups
            .flat_map(|group| group.offset..group.offset + group.len)
            .collect();
        // Constraints may leave only some of them.
        let linear = match (joint.kind, places.len()) {
            (JointKind::Free, 6) => Some(3),
            (JointKind::Planar, 3) => Some(2),
            _ => None,
        };
        let written = names.iter().find(|(_, name)| *name == joint.name);
        let written = written.map(|(written, _)| written.as_str());
        let own = Some(joint.name.as_str());
        let own = own.filter(|own| names.iter().all(|(written, _)| written != own));
        let called = written.into_iter().chain(own);
        all.extend(
            called
                .filter(|_| !places.is_empty())
                .map(|name| JointVelocities {
                    name,
                    places: places.clone(),
                    linear,
                }),
        );
    }
    all
}
