//! Detection of rotations about a constant axis, with the cosine and sine of their angle.

use hamel_algebra::graph::{Edge, Function, Graph, Node};
use hamel_algebra::linear::{Mat3, Vec3, apply3, cross, scale3, sub3, transpose3};
use hamel_language::model::Model;
use hamel_language::model::layout::Block;

/// A rotation about a constant axis, E = base · Rz(angle) · axesᵀ.
pub struct Hinge {
    /// Constant axes before the rotation by the angle.
    pub base: Mat3,
    /// Axes of the link in those of the frame that the hinge moves.
    pub axes: Mat3,
    /// Cosine and sine of the angle.
    pub angle: (Edge, Edge),
    /// Rate of the angle, Σ k ξⁱ, as pairs (i, k).
    pub rate: Vec<(usize, Edge)>,
}

/// Returns the axis and angle of a rotation E as a hinge; `None` if its axis is not constant.
///
/// `columns` are (i, angular velocity, velocity) per unit of each ξⁱ; the angular velocities have
/// to be constant.
pub fn find_hinge(
    model: &mut Model,
    turn: &Mat3,
    columns: &[(usize, Vec3, Vec3)],
) -> Option<Hinge> {
    let pairs = angles(model, turn);
    let graph = &mut model.graph;
    let (_, first, _) = columns.first()?;
    let axes = axes_along(graph, *first)?;
    let axis: Vec3 = std::array::from_fn(|row| axes[row][2]);
    let zero = graph.zero();
    let mut rate = Vec::new();
    for &(i, angular, _) in columns {
        if cross(graph, angular, axis)
            .iter()
            .any(|&entry| entry != zero)
        {
            return None;
        }
        rate.push((i, graph.dot(&angular, &axis)));
    }
    let across = std::array::from_fn(|row| axes[row][0]);
    let (axis, across) = (apply3(graph, turn, axis), apply3(graph, turn, across));
    if !axis.iter().all(|entry| graph.is_free(entry.node())) {
        return None;
    }
    // Rotated back by the angle, the first axis has to be constant; the second one follows from it.
    let along = cross(graph, axis, across);
    for (cos, sin) in pairs {
        let (c, s) = (scale3(graph, cos, across), scale3(graph, sin, along));
        let start = sub3(graph, c, s);
        if start.iter().all(|entry| graph.is_free(entry.node())) {
            let second = cross(graph, axis, start);
            return Some(Hinge {
                base: transpose3(&[start, second, axis]),
                axes,
                angle: (cos, sin),
                rate,
            });
        }
    }
    None
}

/// Returns an orthonormal frame, by columns, whose third axis has the direction of a constant
/// vector.
pub fn axes_along(graph: &mut Graph, v: Vec3) -> Option<Mat3> {
    let zero = graph.zero();
    let [third, first] = match std::array::from_fn::<bool, 3, _>(|i| v[i] != zero) {
        [false, false, false] => return None,
        place if place.iter().filter(|&&other| other).count() == 1 => {
            let i = place.iter().position(|&other| other)?;
            let unit = |graph: &Graph, i: usize| {
                std::array::from_fn(|j| if i == j { graph.one() } else { graph.zero() })
            };
            let negative = sign(graph, v[i]);
            let third: Vec3 = unit(graph, i);
            [
                third.map(|e| if negative { -e } else { e }),
                unit(graph, (i + 1) % 3),
            ]
        }
        place => {
            let third = normalize(graph, v)?;
            // The first axis is perpendicular to the third, in the plane of two of its non-zero
            // entries.
            let (i, j) = if place[0] && place[1] {
                (0, 1)
            } else if place[1] {
                (1, 2)
            } else {
                (2, 0)
            };
            let mut across = [zero; 3];
            across[i] = -third[j];
            across[j] = third[i];
            [third, normalize(graph, across)?]
        }
    };
    let second = cross(graph, third, first);
    let clean = |v: Vec3| v.map(|e| if e == -zero { zero } else { e });
    Some(transpose3(&[clean(first), clean(second), clean(third)]))
}

/// Returns whether a constant is a negative number.
fn sign(graph: &Graph, edge: Edge) -> bool {
    use num_traits::Signed;
    graph
        .as_rational(edge)
        .is_some_and(|number| number.is_negative())
}

/// Returns v / |v|.
pub fn normalize(graph: &mut Graph, v: Vec3) -> Option<Vec3> {
    let square = graph.dot(&v, &v);
    let length = graph.apply(Function::Sqrt, square);
    let scale = graph.div(graph.one(), length)?;
    Some(scale3(graph, scale, v))
}

/// Returns (cos, sin) and (cos, −sin) of all angles that a rotation matrix is written in.
fn angles(model: &mut Model, turn: &Mat3) -> Vec<(Edge, Edge)> {
    let graph = &mut model.graph;
    let nodes = graph.reachable(&turn.concat());
    let mut pairs = Vec::new();
    let mut arguments = Vec::new();
    for &id in &nodes {
        if let Node::Apply(Function::Cos | Function::Sin, angle) = graph.node(id)
            && !graph.is_free(id)
        {
            arguments.push(angle.abs());
        }
    }
    arguments.sort_unstable();
    arguments.dedup();
    for angle in arguments {
        let (cos, sin) = (
            graph.apply(Function::Cos, angle),
            graph.apply(Function::Sin, angle),
        );
        pairs.extend([(cos, sin), (cos, -sin)]);
    }
    let mut place = 0;
    for block in &model.blocks {
        if let (Block::Circle, &[cos, sin]) = (block, &model.x[place..place + block.len()])
            && nodes.binary_search(&cos.node()).is_ok()
        {
            pairs.extend([(cos, sin), (cos, -sin)]);
        }
        place += block.len();
    }
    pairs
}
