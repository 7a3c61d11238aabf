//! Joints of a description, recognised by the names of coordinates and velocities, for states by joints.
//!
//! | velocity | coordinate | as a joint |
//! |---|---|---|
//! | `j_dot` | `j` | an angle or a length |
//! | `j_dot` | `j: S1` | an angle |
//! | `j_dot: vec2` and so on | `j: R2` | a list |
//! | `j_dot: vec3` | `j: SO3` or `S3` | a rotation |
//! | `j_v: vec3`, `j_w: vec3` | `j_r: R3`, `j_R: SO3` | a free body, `j` |
//! | `j_r_dot: vec2`, `j_dot` | `j_r: R2`, `j` | a planar joint `j` |
//!
//! `joint` statements declare these names; coordinates that are declared one by one count as well, except as planar
//! joints.

use crate::names;
use hamel_codegen::model::{Coordinate, Group, Model};
use hamel_codegen::syntax::ast::{CoordKind, JointKind, ShapeKind};

/// Form of a joint's coordinates, with their indices in x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointCoordinates {
    /// Plain numbers.
    Plain(usize),
    /// Cosine and sine.
    Circle(usize),
    /// A unit quaternion.
    Quaternion(usize),
    /// A rotation matrix.
    Rotation(usize),
    /// Position and rotation matrix.
    Free(usize, usize),
    /// Position in a plane and angle about its normal.
    Planar(usize, usize),
}

impl JointCoordinates {
    /// Returns the number of the `linear` velocities, if the others are `angular`.
    pub fn linear(self) -> Option<usize> {
        match self {
            JointCoordinates::Free(..) => Some(3),
            JointCoordinates::Planar(..) => Some(2),
            _ => None,
        }
    }
}

/// Joint with its coordinates and velocities.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name; for a robot, that in its file.
    pub name: String,
    /// Coordinates.
    pub place: JointCoordinates,
    /// Index of its first velocity in ξ, and the number of velocities.
    pub velocities: (usize, usize),
}

/// Returns the joints of a model in the order of their velocities; `names` are pairs of a joint's name in the robot's
/// file and in the description.
pub fn joints(model: &Model, names: &[(String, String)]) -> Vec<Joint> {
    let mut joints = Vec::new();
    let mut groups = model.velocities.iter().peekable();
    while let Some(group) = groups.next() {
        let found = match groups.peek() {
            Some(next) => free(model, group, next).or_else(|| planar(model, group, next)),
            None => None,
        };
        let found = found
            .inspect(|_| {
                groups.next();
            })
            .or_else(|| single(model, group));
        if let Some((own, place, velocities)) = found {
            let written = names.iter().find(|(_, name)| *name == own);
            joints.push(Joint {
                name: written.map_or(own, |(written, _)| written.clone()),
                place,
                velocities,
            });
        }
    }
    joints
}

/// Returns the name of the joint that each row of M belongs to; rows without a joint have the names of their
/// velocities.
pub fn rows(model: &Model, joints: &[Joint]) -> Vec<String> {
    let mut rows = names::velocities(model);
    for joint in joints {
        let (first, count) = joint.velocities;
        for row in rows.iter_mut().skip(first).take(count) {
            row.clone_from(&joint.name);
        }
    }
    rows
}

type Found = (String, JointCoordinates, (usize, usize));

fn coordinate<'a>(model: &'a Model, name: &str) -> Option<&'a Coordinate> {
    model
        .coordinates
        .iter()
        .find(|coordinate| coordinate.name == name)
}

fn free(model: &Model, first: &Group, second: &Group) -> Option<Found> {
    let name = first.name.strip_suffix("_v")?;
    let twist = second.name.strip_suffix("_w")? == name
        && [first, second]
            .iter()
            .all(|group| group.shape == ShapeKind::Vector(3));
    let position = coordinate(model, &format!("{name}_r"))?;
    let rotation = coordinate(model, &format!("{name}_R"))?;
    let pose = position.kind == CoordKind::Euclidean(3) && rotation.kind == CoordKind::SO3;
    (twist && pose).then(|| {
        let place = JointCoordinates::Free(position.offset, rotation.offset);
        (name.to_string(), place, (first.offset, 6))
    })
}

fn planar(model: &Model, first: &Group, second: &Group) -> Option<Found> {
    let of_both = [&first.name, &second.name];
    let joint = model
        .joints
        .iter()
        .find(|joint| joint.kind == JointKind::Planar && joint.velocities.iter().eq(of_both))?;
    let position = coordinate(model, joint.coordinates.first()?)?;
    let angle = coordinate(model, joint.coordinates.get(1)?)?;
    let place = JointCoordinates::Planar(position.offset, angle.offset);
    Some((joint.name.clone(), place, (first.offset, 3)))
}

fn single(model: &Model, group: &Group) -> Option<Found> {
    let name = group.name.strip_suffix("_dot")?;
    let found = coordinate(model, name)?;
    let at = found.offset;
    let place = match (found.kind, group.shape) {
        (CoordKind::Real, ShapeKind::Scalar) => JointCoordinates::Plain(at),
        (CoordKind::S1, ShapeKind::Scalar) => JointCoordinates::Circle(at),
        (CoordKind::Euclidean(n), ShapeKind::Vector(m)) if n == m => JointCoordinates::Plain(at),
        (CoordKind::S3, ShapeKind::Vector(3)) => JointCoordinates::Quaternion(at),
        (CoordKind::SO3, ShapeKind::Vector(3)) => JointCoordinates::Rotation(at),
        _ => return None,
    };
    Some((name.to_string(), place, (group.offset, group.len)))
}
