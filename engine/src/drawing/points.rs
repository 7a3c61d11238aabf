//! The drawn parts of a model as expressions, and the frames that they move with.
//!
//! A point is fixed to a frame if the rates of its coordinates in that frame vanish along ẋ = A ξ, and two points keep
//! their distance if the rate of its square vanishes. Both tests are exact, since expressions that are equal on X are
//! one node of the graph.

use super::scene::LineKind;
use hamel_codegen::algebra::derivation::Derivation;
use hamel_codegen::algebra::graph::{Edge, Graph};
use hamel_codegen::algebra::linear::{Vec3, apply_transposed, sub3, zero3};
use hamel_codegen::model::elements::Along;
use hamel_codegen::model::{Model, class};

/// Expressions of the places and properties of the drawn parts, in a graph.
pub(super) struct Points {
    /// Mass, centre of mass and inertia about it of each body, 13 expressions; masses of particles.
    pub masses: Vec<Edge>,
    /// Vectors of three: four for each frame, one for each particle, two for each line, rod and loop, and gravity.
    pub moving: Vec<Edge>,
    /// Whether the origin of a frame is fixed in the frame that it was placed on.
    pub attached: Vec<bool>,
    /// Whether the axes of a frame turn in the frame that it was placed on.
    pub turns: Vec<bool>,
    /// The frame that each particle is fixed to.
    pub particles: Vec<Option<usize>>,
    /// Kinds of the lines, with the frames to which their ends are fixed.
    pub lines: Vec<(LineKind, [Option<usize>; 2])>,
    /// Number of rods.
    pub rods: usize,
}

impl Points {
    /// Collects the expressions of a model.
    pub fn new(model: &Model, graph: &mut Graph) -> Self {
        let bodies = model.bodies.iter().flat_map(|body| {
            let inertia = body.inertia_com.as_flattened().iter().copied();
            [body.mass].into_iter().chain(body.com).chain(inertia)
        });
        let masses = model.particles.iter().map(|particle| particle.mass);
        let masses = bodies.chain(masses).collect();
        let frames = model.frames.iter();
        let attached = frames.map(|frame| is_constant(model, graph, &frame.relative.1));
        let attached = attached.collect();
        let frames = model.frames.iter();
        let turns = frames.map(|frame| !is_constant(model, graph, frame.relative.0.as_flattened()));
        let turns = turns.collect();
        let poses = model.frames.iter().flat_map(|frame| {
            let rotation = frame.rotation.as_flattened().iter().copied();
            rotation.chain(frame.position)
        });
        let mut moving: Vec<Edge> = poses.collect();
        let particles: Vec<Vec3> = model.particles.iter().map(|one| one.position).collect();
        moving.extend(particles.as_flattened());
        let mut lines = Vec::new();
        for (acts, from, to) in along(model) {
            let frames = [from, to].map(|end| carrier(model, graph, end));
            lines.push((acts, frames));
            moving.extend(from.into_iter().chain(to));
        }
        let fixed = particles.iter().map(|&at| carrier(model, graph, at));
        let fixed: Vec<Option<usize>> = fixed.collect();
        let rods = rods(model, graph, &particles, &fixed);
        moving.extend(rods.iter().flatten().flatten());
        let loops = model.closures.iter();
        moving.extend(loops.flat_map(|(left, right)| left.iter().chain(right)));
        let known =
            |entry: &Edge| graph.class(entry.node()) & !(class::PARAM | class::CONFIGURATION) == 0;
        moving.extend(match model.gravity.iter().all(known) {
            true => model.gravity,
            false => zero3(graph),
        });
        Points {
            masses,
            moving,
            attached,
            turns,
            particles: fixed,
            lines,
            rods: rods.len(),
        }
    }
}

/// Lists springs, dampers and forces between two points.
fn along(model: &Model) -> impl Iterator<Item = (LineKind, Vec3, Vec3)> {
    let elements = &model.elements;
    let springs = elements
        .springs
        .iter()
        .map(|one| (LineKind::Spring, &one.along));
    let dampers = elements
        .dampers
        .iter()
        .map(|one| (LineKind::Damper, &one.along));
    let forces = elements
        .pushes
        .iter()
        .map(|one| (LineKind::Force, &one.along));
    let all = springs.chain(dampers).chain(forces);
    all.filter_map(|(acts, along)| match along {
        Along::Line { from, to, .. } => Some((acts, *from, *to)),
        Along::Scalar(_) => None,
    })
}

/// Lists rods between particles, and from particles to the origin of the world, unless a frame holds both ends.
fn rods(
    model: &Model,
    graph: &mut Graph,
    particles: &[Vec3],
    fixed: &[Option<usize>],
) -> Vec<[Vec3; 2]> {
    let origin = zero3(graph);
    let mut rods = Vec::new();
    for (last, &end) in particles.iter().enumerate() {
        let others =
            (0..last).filter(|&other| fixed[other].is_none() || fixed[other] != fixed[last]);
        let others = others.map(|other| particles[other]);
        let others: Vec<Vec3> = others
            .chain(fixed[last].is_none().then_some(origin))
            .collect();
        for other in others {
            let difference = sub3(graph, end, other);
            let square = graph.dot(&difference, &difference);
            if is_constant(model, graph, &[square]) && !is_constant(model, graph, &difference) {
                rods.push([other, end]);
            }
        }
    }
    rods
}

/// Returns the first frame that a point is fixed to.
fn carrier(model: &Model, graph: &mut Graph, point: Vec3) -> Option<usize> {
    if is_constant(model, graph, &point) {
        return None;
    }
    model.frames.iter().position(|frame| {
        let arm = sub3(graph, point, frame.position);
        let arm = apply_transposed(graph, &frame.rotation, arm);
        is_constant(model, graph, &arm)
    })
}

/// Returns whether the entries are constant along every motion.
fn is_constant(model: &Model, graph: &mut Graph, entries: &[Edge]) -> bool {
    let moves = |entry: &Edge| graph.class(entry.node()) & class::CONFIGURATION != 0;
    if !entries.iter().any(moves) {
        return true;
    }
    let rates = model
        .x
        .iter()
        .map(|x| x.node())
        .zip(model.rate.iter().copied());
    let slopes = Derivation::new(rates).all(graph, entries);
    slopes.iter().all(|slope| *slope == graph.zero())
}
