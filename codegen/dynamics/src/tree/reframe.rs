//! Frames of links on hinges after Denavit and Hartenberg.
//!
//! The third axis is along the hinge and the first one along the common normal to the hinge of the
//! next link, so that two plane rotations and two distances lead from link to link.
//!
//! If α is the angle between two axes, the foot of their common normal is at p·z / sin² α along the
//! axis. Rounding at a distance d costs (d / L)² units of roundoff if L is the size of the
//! description. Therefore an origin is moved only as far as `limits` allows, and a direction is used
//! only if its numbers keep their digits; axes that are almost parallel are treated as parallel
//! ones, and the small tilt between them is a rotation Rx(a) Ry(b).

use super::draft::{JointMotion, LinkDraft};
use super::rounding_limits::RoundingLimits;
use super::turn::RotationFactor;
use hamel_algebra::graph::{Edge, Function, Graph};
use hamel_algebra::linear::{Vec3, add3, scale3};

/// Moves and rotates the frames of all links on hinges.
pub fn reframe(graph: &mut Graph, links: &mut [LinkDraft], limits: &RoundingLimits) {
    let weights = weights(links);
    for i in 0..=links.len() {
        // The world first, then every link.
        let parent = i.checked_sub(1);
        let children: Vec<usize> = (0..links.len())
            .filter(|&j| links[j].parent == parent && is_hinge(&links[j]))
            .collect();
        let hinged = parent.is_some_and(|link| is_hinge(&links[link]));
        for &j in &children {
            if let Some(distance) = foot(graph, &links[j], hinged, limits) {
                slide(graph, links, j, distance);
            }
        }
        if let (Some(link), true) = (parent, hinged) {
            let mut children = children.clone();
            children.sort_by_key(|&j| std::cmp::Reverse(weights[j]));
            if let Some(angle) = normal(graph, links, &children, limits) {
                spin(graph, links, link, angle);
            }
        }
        for j in children {
            factor(graph, &mut links[j], limits);
        }
    }
}

/// Keeps the frames of the description, except that hinges rotate about third axes.
pub fn keep_frames(graph: &mut Graph, links: &mut [LinkDraft], limits: &RoundingLimits) {
    for link in links.iter_mut().filter(|link| is_hinge(link)) {
        factor(graph, link, limits);
    }
}

/// As [`keep_frames`], but with origins moved along their hinges; returns for each link how far.
pub fn keep_frames_shifted(
    graph: &mut Graph,
    links: &mut [LinkDraft],
    limits: &RoundingLimits,
) -> Vec<Edge> {
    let mut distances = vec![graph.zero(); links.len()];
    // In order from the root, since the position of a link depends on the frame of its parent.
    for j in 0..links.len() {
        if !is_hinge(&links[j]) {
            continue;
        }
        let hinged = links[j].parent.is_some_and(|link| is_hinge(&links[link]));
        if let Some(distance) = foot(graph, &links[j], hinged, limits) {
            slide(graph, links, j, distance);
            distances[j] = distance;
        }
    }
    keep_frames(graph, links, limits);
    distances
}

fn is_hinge(link: &LinkDraft) -> bool {
    matches!(link.motion, JointMotion::Hinge { .. })
}

/// Returns for each link the number of links in its subtree, including the link itself.
fn weights(links: &[LinkDraft]) -> Vec<usize> {
    let mut weights = vec![1; links.len()];
    for j in (0..links.len()).rev() {
        if let Some(parent) = links[j].parent {
            weights[parent] += weights[j];
        }
    }
    weights
}

/// Returns the hinge axis of a link in the axes of its parent.
fn axis(link: &LinkDraft) -> Vec3 {
    std::array::from_fn(|row| link.base[row][2])
}

/// Returns whether all entries are numbers, not parameters, so that decisions based on them hold
/// for all parameters.
fn numeric(graph: &Graph, edges: &[Edge]) -> bool {
    edges.iter().all(|edge| graph.class(edge.node()) == 0)
}

/// Returns by how much the origin of a link is best moved along its hinge: to the foot of the
/// common normal with the hinge of the parent, or to where a coordinate vanishes.
fn foot(
    graph: &mut Graph,
    link: &LinkDraft,
    hinged: bool,
    limits: &RoundingLimits,
) -> Option<Edge> {
    let (z, p) = (axis(link), link.position);
    let zero = graph.zero();
    if !numeric(graph, &z) {
        return None;
    }
    let along: Vec<usize> = (0..3).filter(|&k| z[k] != zero).collect();
    if let [k] = along[..] {
        return (!hinged || k == 2 || p[k] != zero).then(|| -graph.mul(p[k], z[k]));
    }
    if !hinged {
        return None;
    }
    let (x, y) = (graph.mul(z[0], z[0]), graph.mul(z[1], z[1]));
    let square = graph.add(x, y);
    let forward = graph.dot(&p[..2], &z[..2]);
    let distance = -graph.div(forward, square)?;
    if limits.allows_shift(graph, distance) {
        return Some(distance);
    }
    // The hinges are almost parallel: move to the height of the parent's origin, as for parallel
    // axes.
    let level = -graph.div(p[2], z[2])?;
    limits.allows_shift(graph, level).then_some(level)
}

/// Returns cosine and sine of the angle by which the axes of a link are best rotated about its
/// hinge.
fn normal(
    graph: &mut Graph,
    links: &[LinkDraft],
    children: &[usize],
    limits: &RoundingLimits,
) -> Option<(Edge, Edge)> {
    let zero = graph.zero();
    let directions: Vec<(Edge, Edge)> = children
        .iter()
        .map(|&j| axis(&links[j]))
        .filter(|z| numeric(graph, z) && limits.has_direction(graph, &z[..2]))
        .map(|z| (-z[1], z[0]))
        .collect();
    let oblique = |&(x, y): &(Edge, Edge)| x.abs() != zero || y.abs() != zero;
    for (x, y) in directions.into_iter().filter(oblique) {
        let (c, s) = direction(graph, x, y)?;
        if limits.is_accurate(graph, &[c, s]) {
            return Some((c, s));
        }
    }
    let arms = children.iter().map(|&j| links[j].position);
    for p in arms.filter(|p| p[0] != zero && p[1] != zero) {
        if numeric(graph, &p[..2]) && limits.has_direction(graph, &p[..2]) {
            let (c, s) = direction(graph, p[0], p[1])?;
            if limits.is_accurate(graph, &[c, s]) {
                return Some((c, s));
            }
        }
    }
    None
}

/// Returns (x, y) / √(x² + y²); `None` if this is no rotation at all.
fn direction(graph: &mut Graph, x: Edge, y: Edge) -> Option<(Edge, Edge)> {
    let zero = graph.zero();
    if y.abs() == zero {
        return None;
    }
    if x.abs() == zero {
        return Some((zero, graph.one()));
    }
    let length = hypotenuse(graph, x, y);
    Some((graph.div(x, length)?, graph.div(y, length)?))
}

/// Moves the origin of a link along its hinge.
fn slide(graph: &mut Graph, links: &mut [LinkDraft], j: usize, distance: Edge) {
    if distance.abs() == graph.zero() {
        return;
    }
    let step = scale3(graph, distance, axis(&links[j]));
    links[j].position = add3(graph, links[j].position, step);
    let zero = graph.zero();
    let back = [zero, zero, -distance];
    links[j].mass = links[j].mass.shift_origin(graph, back);
    for link in links.iter_mut().filter(|link| link.parent == Some(j)) {
        link.position = add3(graph, link.position, back);
    }
}

/// Rotates the axes of a link about its hinge.
fn spin(graph: &mut Graph, links: &mut [LinkDraft], i: usize, (c, s): (Edge, Edge)) {
    let back = RotationFactor::About {
        axis: 2,
        cos: c,
        sin: -s,
    };
    links[i].mass = links[i].mass.rotate_axes(graph, &back);
    advance(graph, &mut links[i], (c, s));
    for link in links.iter_mut().filter(|link| link.parent == Some(i)) {
        link.position = back.rotate(graph, link.position);
        turn_base(graph, link, &back);
    }
}

/// base := R base.
fn turn_base(graph: &mut Graph, link: &mut LinkDraft, turn: &RotationFactor) {
    for column in 0..3 {
        let v = turn.rotate(graph, std::array::from_fn(|row| link.base[row][column]));
        for (row, entry) in link.base.iter_mut().zip(v) {
            row[column] = entry;
        }
    }
}

/// Adds a constant to the angle of a link's hinge, given by its cosine and sine.
fn advance(graph: &mut Graph, link: &mut LinkDraft, (c, s): (Edge, Edge)) {
    if let JointMotion::Hinge { phase, .. } = &mut link.motion {
        let (cc, ss) = (graph.mul(phase.0, c), graph.mul(phase.1, s));
        let (sc, cs) = (graph.mul(phase.1, c), graph.mul(phase.0, s));
        *phase = (graph.sub(cc, ss), graph.add(sc, cs));
    }
}

/// Factors base = Rz(β) Rx(α) Rz(γ), or Rx(a) Ry(b) Rz(γ) if the tilt is too small for β to be
/// accurate.
///
/// The first two factors are stored as turns, the last is added to the joint angle.
fn factor(graph: &mut Graph, link: &mut LinkDraft, limits: &RoundingLimits) {
    let Some(first) = tilt(graph, axis(link), limits) else {
        return;
    };
    let mut rest = link.base;
    for turn in &first {
        for column in 0..3 {
            let v = turn.rotate_back(graph, std::array::from_fn(|row| rest[row][column]));
            for (row, entry) in rest.iter_mut().zip(v) {
                row[column] = entry;
            }
        }
    }
    advance(graph, link, (rest[0][0], rest[1][0]));
    if let JointMotion::Hinge { turns, .. } = &mut link.motion {
        turns.extend(first);
    }
}

/// Returns two plane rotations that take the third axis to z = (x, y, w).
///
/// They are Rz(β) Rx(α) with (sin β, −cos β) = (x, y) / sin α, or Rx(a) Ry(b) with sin b = x and
/// (−sin a, cos a) = (y, w) / cos b.
fn tilt(graph: &mut Graph, z: Vec3, limits: &RoundingLimits) -> Option<[RotationFactor; 2]> {
    let zero = graph.zero();
    let [x, y, w] = z;
    let about = |axis, cos, sin| RotationFactor::About { axis, cos, sin };
    if x.abs() == zero {
        return Some([about(2, graph.one(), zero), about(0, w, -y)]);
    }
    if y.abs() == zero {
        return Some([about(2, zero, graph.one()), about(0, w, x)]);
    }
    if limits.has_direction(graph, &[x, y]) {
        let length = hypotenuse(graph, x, y);
        let (c, s) = (-graph.div(y, length)?, graph.div(x, length)?);
        if limits.is_accurate(graph, &[c, s]) {
            return Some([about(2, c, s), about(0, w, length)]);
        }
    }
    let length = hypotenuse(graph, y, w);
    let (c, s) = (graph.div(w, length)?, -graph.div(y, length)?);
    Some([about(0, c, s), about(1, length, x)])
}

/// Returns √(x² + y²), which is a number if the sum is the square of one.
fn hypotenuse(graph: &mut Graph, x: Edge, y: Edge) -> Edge {
    let (a, b) = (graph.mul(x, x), graph.mul(y, y));
    let square = graph.add(a, b);
    graph.apply(Function::Sqrt, square)
}
