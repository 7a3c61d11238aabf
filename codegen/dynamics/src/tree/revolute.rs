//! Whether a rotation is one about a constant axis, and what the cosine and sine of its angle are.

use hamel_algebra::graph::{Edge, Function, Graph, Node};
use hamel_algebra::linear::{Mat3, Vec3, apply3, cross, scale3, sub3, transpose3};
use hamel_language::model::Model;
use hamel_language::model::layout::Block;

/// E = base · Rz(angle) · axesᵀ.
pub struct Hinge {
    /// Constant axes before the turn.
    pub base: Mat3,
    /// Axes of the link in those of the frame that it moves.
    pub axes: Mat3,
    /// Cosine and sine.
    pub angle: (Edge, Edge),
    /// Its rate Σ k ξⁱ.
    pub rate: Vec<(usize, Edge)>,
}

/// The hinge that a rotation with these constant columns of angular velocity is.
pub fn hinge(model: &mut Model, turn: &Mat3, columns: &[(usize, Vec3, Vec3)]) -> Option<Hinge> {
    let pairs = angles(model, turn);
    let graph = &mut model.graph;
    let (_, first, _) = columns.first()?;
    let axes = axes(graph, *first)?;
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
    // Turned back, the second axis of the plane follows the first.
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

/// An orthonormal frame, by columns, whose third axis is a constant vector's direction.
pub fn axes(graph: &mut Graph, v: Vec3) -> Option<Mat3> {
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
            let third = normalized(graph, v)?;
            // Across the plane of two entries that are not zero.
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
            [third, normalized(graph, across)?]
        }
    };
    let second = cross(graph, third, first);
    let clean = |v: Vec3| v.map(|e| if e == -zero { zero } else { e });
    Some(transpose3(&[clean(first), clean(second), clean(third)]))
}

/// Whether a constant is a negative number.
fn sign(graph: &Graph, edge: Edge) -> bool {
    use num_traits::Signed;
    graph
        .as_rational(edge)
        .is_some_and(|number| number.is_negative())
}

/// v / |v|.
pub fn normalized(graph: &mut Graph, v: Vec3) -> Option<Vec3> {
    let square = graph.dot(&v, &v);
    let length = graph.apply(Function::Sqrt, square);
    let scale = graph.div(graph.one(), length)?;
    Some(scale3(graph, scale, v))
}

/// Cosine and sine, in both senses, of the angles that a rotation is written in.
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
