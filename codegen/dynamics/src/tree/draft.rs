//! Derivation of links and joints from frames: the joint follows from the coordinates on which the
//! frame's pose in its parent depends.

use super::link::{Freedom, Link};
use super::mass::LinkInertia;
use super::revolute::{Hinge, find_hinge};
use super::turn::RotationFactor;
use crate::calculus::Calculus;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{
    Mat3, Vec3, add3, apply_transposed, apply3, identity3, multiply3, zero3,
};
use hamel_language::model::Model;
use hamel_program::provenance::Quantity;

/// A link whose frame can still be moved.
#[derive(Clone, Debug)]
pub struct LinkDraft {
    /// Index of the frame that the joint carries.
    pub frame: usize,
    /// Index of the parent link.
    pub parent: Option<usize>,
    /// Constant axes of the joint in those of the parent link.
    pub base: Mat3,
    /// Origin of the link in the axes of its parent.
    pub position: Vec3,
    /// Motion of the link relative to its parent.
    pub motion: JointMotion,
    /// Inertia of the link.
    pub mass: LinkInertia,
}

/// Motion of a link relative to its parent.
#[derive(Clone, Debug)]
pub enum JointMotion {
    /// Revolute joint about the third axis of the link's frame.
    Hinge {
        /// Cosine and sine of the joint angle as in the description.
        angle: (Edge, Edge),
        /// Cosine and sine of a constant offset that is added to the joint angle.
        phase: (Edge, Edge),
        /// Plane rotations whose product is `base`, up to a rotation about the third axis.
        turns: Vec<RotationFactor>,
        /// Rate of the joint angle, Σ k ξⁱ, as pairs (i, k).
        rate: Vec<(usize, Edge)>,
    },
    /// Any other joint: its rotation after `base`, its freedoms and their velocity-product
    /// acceleration.
    Other(Option<Mat3>, Vec<Freedom>, (Vec3, Vec3)),
}

impl LinkDraft {
    /// Converts the draft to a link.
    pub fn finish(self, graph: &mut Graph) -> Link {
        let zero = zero3(graph);
        let (turns, freedoms, velocity_product) = match self.motion {
            JointMotion::Hinge {
                angle: (cos, sin),
                phase: (c, s),
                mut turns,
                rate,
            } => {
                let (cc, ss) = (graph.mul(cos, c), graph.mul(sin, s));
                let (sc, cs) = (graph.mul(sin, c), graph.mul(cos, s));
                turns.push(RotationFactor::About {
                    axis: 2,
                    cos: graph.sub(cc, ss),
                    sin: graph.add(sc, cs),
                });
                let freedom = Freedom {
                    angular: [graph.zero(), graph.zero(), graph.one()],
                    linear: zero,
                    rate,
                };
                (turns, vec![freedom], (zero, zero))
            }
            JointMotion::Other(rotation, freedoms, velocity_product) => {
                let mut turns = Vec::new();
                let identity = identity3(graph);
                match rotation {
                    Some(rotation) if is_permutation(graph, &self.base) => {
                        turns.push(RotationFactor::By(multiply3(graph, &self.base, &rotation)));
                    }
                    rotation => {
                        if self.base != identity {
                            turns.push(RotationFactor::By(self.base));
                        }
                        turns.extend(rotation.map(RotationFactor::By));
                    }
                }
                (turns, freedoms, velocity_product)
            }
        };
        for turn in &turns {
            turn.label(graph, Quantity::LinkRotation.of(self.frame));
        }
        Link {
            frame: self.frame,
            parent: self.parent,
            turns,
            position: self.position,
            freedoms,
            velocity_product,
            mass: self.mass,
            unshared: self.mass,
        }
    }
}

/// Returns whether a rotation matrix only permutes axes and changes their signs.
fn is_permutation(graph: &Graph, matrix: &Mat3) -> bool {
    let plain = |edge: &Edge| *edge == graph.zero() || edge.abs() == graph.one();
    matrix.iter().flatten().all(plain)
}

/// Pose of a frame of the description: its link, and its constant pose in the link's frame.
#[derive(Clone, Copy)]
struct FixedPose {
    link: Option<usize>,
    rotation: Mat3,
    position: Vec3,
}

/// Derives the links of a model; `None` as for [`draft_links_with_frames`].
pub fn draft_links(model: &mut Model, calculus: &mut Calculus) -> Option<Vec<LinkDraft>> {
    Some(draft_links_with_frames(model, calculus)?.0)
}

/// Frame of the description that a joint carries.
#[derive(Clone, Copy, Debug)]
pub struct JointFrame {
    /// Index of the frame in the model.
    pub frame: usize,
    /// Axes of the frame in those of the link.
    pub axes: Mat3,
    /// Origin of the link in this frame.
    pub origin: Vec3,
    /// Inertia of the link about the origin of this frame, in the axes of the link.
    pub mass: LinkInertia,
}

/// Derives the links of a model, and the frame from which each of them was made.
///
/// Returns `None` if the model has neither bodies nor particles, has other kinetic energy than
/// theirs and that of armatures, or has a particle that is not fixed to a frame.
pub fn draft_links_with_frames(
    model: &mut Model,
    calculus: &mut Calculus,
) -> Option<(Vec<LinkDraft>, Vec<JointFrame>)> {
    if model.bodies.len() + model.particles.len() == 0 || has_more_inertia(model) {
        return None;
    }
    let mut links: Vec<LinkDraft> = Vec::new();
    let mut places: Vec<FixedPose> = Vec::new();
    let mut joint_frames: Vec<JointFrame> = Vec::new();
    for (index, frame) in model.frames.clone().into_iter().enumerate() {
        let world = FixedPose {
            link: None,
            rotation: identity3(&model.graph),
            position: zero3(&model.graph),
        };
        let on = frame
            .parent
            .map_or(Some(world), |parent| places.get(parent).copied())?;
        let (turn, shift) = frame.relative;
        let graph = &mut model.graph;
        let constant =
            |graph: &Graph, edges: &[Edge]| edges.iter().all(|e| graph.is_free(e.node()));
        let moved = apply3(graph, &on.rotation, shift);
        let position = add3(graph, on.position, moved);
        if constant(graph, &turn.concat()) && constant(graph, &shift) {
            places.push(FixedPose {
                link: on.link,
                rotation: multiply3(graph, &on.rotation, &turn),
                position,
            });
            continue;
        }
        let (motion, base, rotation) = joint(model, calculus, &on.rotation, &turn, shift)?;
        let graph = &model.graph;
        links.push(LinkDraft {
            frame: index,
            parent: on.link,
            base,
            position,
            motion,
            mass: LinkInertia::zero(graph),
        });
        joint_frames.push(JointFrame {
            frame: index,
            axes: rotation,
            origin: zero3(graph),
            mass: LinkInertia::zero(graph),
        });
        places.push(FixedPose {
            link: Some(links.len() - 1),
            rotation,
            position: zero3(graph),
        });
    }
    for body in model.bodies.clone() {
        let mass = LinkInertia::of_body(&mut model.graph, &body);
        add_inertia(&mut model.graph, &mut links, places.get(body.frame)?, &mass);
    }
    for particle in model.particles.clone() {
        let (frame, position) = frame_of_point(model, particle.position)?;
        let mass = LinkInertia::of_particle(&model.graph, particle.mass)
            .shift_origin(&mut model.graph, position);
        add_inertia(&mut model.graph, &mut links, places.get(frame)?, &mass);
    }
    for (joint_frame, link) in joint_frames.iter_mut().zip(&links) {
        joint_frame.mass = link.mass;
    }
    Some((links, joint_frames))
}

/// Returns whether there is kinetic energy in addition to that of bodies, particles and armatures.
pub fn has_more_inertia(model: &mut Model) -> bool {
    let graph = &mut model.graph;
    let half = graph.ratio(1, 2);
    let mut rest = model.kinetic;
    for (&xi, &armature) in model.xi.iter().zip(&model.armature) {
        let factors = [half, armature, xi, xi];
        let energy = factors
            .into_iter()
            .fold(graph.one(), |a, b| graph.mul(a, b));
        rest = graph.sub(rest, energy);
    }
    rest != graph.zero()
}

/// Finds a frame to which a point is fixed, and its position in that frame.
fn frame_of_point(model: &mut Model, point: Vec3) -> Option<(usize, Vec3)> {
    let frames = model.frames.clone();
    frames.iter().enumerate().find_map(|(index, frame)| {
        let graph = &mut model.graph;
        let away: Vec3 = std::array::from_fn(|i| graph.sub(point[i], frame.position[i]));
        let place = apply_transposed(graph, &frame.rotation, away);
        let fixed = place.iter().all(|entry| graph.is_free(entry.node()));
        fixed.then_some((index, place))
    })
}

/// Adds a mass that is fixed to a frame to the link of the frame.
fn add_inertia(graph: &mut Graph, links: &mut [LinkDraft], place: &FixedPose, mass: &LinkInertia) {
    let Some(link) = place.link.and_then(|link| links.get_mut(link)) else {
        return;
    };
    let mass = mass
        .rotate_axes(graph, &RotationFactor::By(place.rotation))
        .shift_origin(graph, place.position);
    link.mass = link.mass.plus(graph, &mass);
}

/// Derives the joint of a relative pose.
///
/// Returns its motion, its constant base in the axes of the parent link (in which the parent frame
/// has the axes `on`), and the axes of the frame in those of the new link.
fn joint(
    model: &mut Model,
    calculus: &mut Calculus,
    on: &Mat3,
    turn: &Mat3,
    shift: Vec3,
) -> Option<(JointMotion, Mat3, Mat3)> {
    let moving = columns(model, calculus, turn, shift);
    let graph = &mut model.graph;
    let free3 = |graph: &Graph, v: &Vec3| v.iter().all(|e| graph.is_free(e.node()));
    let zero = zero3(graph);
    let constant = |graph: &Graph, pick: fn(&(usize, Vec3, Vec3)) -> Vec3| {
        moving.iter().all(|column| free3(graph, &pick(column)))
    };
    if constant(graph, |c| c.1)
        && moving.iter().all(|c| c.2 == zero)
        && free3(graph, &shift)
        && let Some(found) = find_hinge(model, turn, &moving)
    {
        let Hinge {
            base,
            axes,
            angle,
            rate,
        } = found;
        let graph = &mut model.graph;
        let motion = JointMotion::Hinge {
            angle,
            phase: (graph.one(), graph.zero()),
            turns: Vec::new(),
            rate,
        };
        let base = multiply3(graph, on, &base);
        return Some((motion, base, hamel_algebra::linear::transpose3(&axes)));
    }
    let graph = &mut model.graph;
    let identity = identity3(graph);
    let sliding = turn.iter().all(|row| free3(graph, row));
    // A link that only translates keeps the axes of its parent link.
    let (base, rotation, frame) = if sliding {
        (identity, None, multiply3(graph, on, turn))
    } else {
        (*on, Some(*turn), identity)
    };
    let mut velocity_product = (zero, zero);
    let mut freedoms = Vec::new();
    for (i, angular, linear) in moving {
        // Transforms to the axes of the link: those of the frame, or of the parent link if it only
        // translates.
        let into = |graph: &mut Graph, v: Vec3| apply3(graph, &frame, v);
        for (sum, column) in [
            (&mut velocity_product.0, angular),
            (&mut velocity_product.1, linear),
        ] {
            if !free3(&model.graph, &column) {
                let rate = calculus.rate3(&mut model.graph, column);
                let rate = rate.map(|rate| model.graph.mul(rate, model.xi[i]));
                let rate = into(&mut model.graph, rate);
                *sum = add3(&mut model.graph, *sum, rate);
            }
        }
        let one = model.graph.one();
        freedoms.push(Freedom {
            angular: into(&mut model.graph, angular),
            linear: into(&mut model.graph, linear),
            rate: vec![(i, one)],
        });
    }
    Some((
        JointMotion::Other(rotation, freedoms, velocity_product),
        base,
        frame,
    ))
}

/// Returns (i, vee(Eᵀ ∂ᵢE), Eᵀ ∂ᵢp) for every velocity ξⁱ that moves the frame in its parent.
fn columns(
    model: &mut Model,
    calculus: &mut Calculus,
    turn: &Mat3,
    shift: Vec3,
) -> Vec<(usize, Vec3, Vec3)> {
    let graph = &mut model.graph;
    let mut roots = turn.concat();
    roots.extend(shift);
    let nodes = graph.reachable(&roots);
    let moves = |i: usize| {
        let coordinates = model.x.iter().zip(&model.a);
        coordinates
            .filter(|(_, row)| row[i] != Edge::of(0))
            .any(|(x, _)| nodes.binary_search(&x.node()).is_ok())
    };
    let moving: Vec<usize> = (0..model.xi.len()).filter(|&i| moves(i)).collect();
    let zero = zero3(graph);
    let mut columns = Vec::new();
    for i in moving {
        let angular = calculus.spin_along(graph, i, turn);
        let change = shift.map(|entry| calculus.along(graph, i, entry));
        let linear = apply_transposed(graph, turn, change);
        if angular != zero || linear != zero {
            columns.push((i, angular, linear));
        }
    }
    columns
}
