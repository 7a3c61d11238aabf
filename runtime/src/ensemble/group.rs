//! Groups of members that share SIMD lanes, and conversion of their states to and from lanes.

use crate::error::StepError;
use crate::lanes::Lanes;
use crate::state::State;
use crate::system::System;

/// A group of members that are computed together, one per lane.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// Indices in the list of states; at least one.
    members: Vec<usize>,
}

impl Group {
    /// Creates a group from `chosen`, the positions of at least one member within a part that starts at index `first`.
    pub(super) fn new(first: usize, chosen: &[usize]) -> Self {
        Self {
            members: chosen.iter().map(|local| first + local).collect(),
        }
    }

    /// Returns the member in a lane, as an index in the list of states; lanes beyond the members repeat the last one,
    /// and their results are not used.
    pub fn member(&self, lane: usize) -> usize {
        let member = self.members.get(lane).or(self.members.last());
        member.copied().unwrap_or_default()
    }

    /// Returns the members, as indices in the list of states.
    pub fn members(&self) -> &[usize] {
        &self.members
    }

    /// Creates lanes from a value for each member.
    pub fn gather<L: Lanes>(&self, mut value: impl FnMut(usize) -> L::Element) -> L {
        L::from_lanes(|lane| value(self.member(lane)))
    }
}

/// Combines the states of the chosen members of a part into one state of lanes.
pub(super) fn gather<Wide, Single>(
    system: &Wide,
    states: &[State<Single>],
    chosen: &[usize],
) -> Result<State<Wide>, StepError>
where
    Wide: System<Scalar: Lanes>,
    Single: System<Scalar = <Wide::Scalar as Lanes>::Element>,
{
    let of = |lane: usize| {
        let local = chosen.get(lane).or(chosen.last());
        local.and_then(|local| states.get(*local))
    };
    let mut x = system.zero_coordinates();
    let mut xi = system.zero_velocities();
    for lane in 0..chosen.len() {
        let Some(state) = of(lane) else { continue };
        same_length("coordinates", x.as_ref().len(), state.x.as_ref().len())?;
        same_length("velocities", xi.as_ref().len(), state.xi.as_ref().len())?;
    }
    let pick = |list: Option<&[_]>, entry: usize| {
        list.and_then(|list: &[<Wide::Scalar as Lanes>::Element]| list.get(entry).copied())
            .unwrap_or_default()
    };
    for (entry, value) in x.as_mut().iter_mut().enumerate() {
        *value = Lanes::from_lanes(|lane| pick(of(lane).map(|s| s.x.as_ref()), entry));
    }
    for (entry, value) in xi.as_mut().iter_mut().enumerate() {
        *value = Lanes::from_lanes(|lane| pick(of(lane).map(|s| s.xi.as_ref()), entry));
    }
    let t = of(0).map_or(f64::NAN, |state| state.t);
    Ok(State { t, x, xi })
}

/// Writes the lanes of a state back to the chosen members: the inverse of [`gather`].
pub(super) fn scatter<Wide, Single>(
    from: &State<Wide>,
    states: &mut [State<Single>],
    chosen: &[usize],
) where
    Wide: System<Scalar: Lanes>,
    Single: System<Scalar = <Wide::Scalar as Lanes>::Element>,
{
    for (lane, local) in chosen.iter().enumerate() {
        let Some(state) = states.get_mut(*local) else {
            continue;
        };
        state.t = from.t;
        copy_lane(from.x.as_ref(), state.x.as_mut(), lane);
        copy_lane(from.xi.as_ref(), state.xi.as_mut(), lane);
    }
}

fn copy_lane<L: Lanes>(from: &[L], to: &mut [L::Element], lane: usize) {
    for (value, to) in from.iter().zip(to) {
        if let Some(value) = value.lanes().as_ref().get(lane) {
            *to = *value;
        }
    }
}

fn same_length(part: &'static str, expected: usize, found: usize) -> Result<(), StepError> {
    if expected == found {
        Ok(())
    } else {
        Err(StepError::Shape {
            part,
            expected,
            found,
        })
    }
}
