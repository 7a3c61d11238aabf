//! Rotation matrices and the hat map.

use super::value::Value;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Mat3, Vec3, identity3, multiply3};

/// Returns ŵ, with ŵ a = w × a.
pub fn hat(graph: &Graph, w: Vec3) -> Mat3 {
    let o = graph.zero();
    [[o, -w[2], w[1]], [w[2], o, -w[0]], [-w[1], w[0], o]]
}

/// Returns the rotation about a coordinate axis by the angle with cosine c and sine s.
pub fn turn(graph: &Graph, axis: usize, c: Edge, s: Edge) -> Mat3 {
    let mut m = identity3(graph);
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    m[j][j] = c;
    m[k][k] = c;
    m[j][k] = -s;
    m[k][j] = s;
    m
}

/// Returns the rotation I + s n̂ + (1 − c) n̂² about a unit vector n, where c and s are cosine and sine of the angle.
pub fn axis_angle(graph: &mut Graph, axis: Vec3, c: Edge, s: Edge) -> Value {
    let versine = graph.sub(graph.one(), c);
    let n = hat(graph, axis);
    let square = multiply3(graph, &n, &n);
    let mut m = identity3(graph);
    for i in 0..3 {
        for j in 0..3 {
            let (a, b) = (graph.mul(s, n[i][j]), graph.mul(versine, square[i][j]));
            let sum = graph.add(m[i][j], a);
            m[i][j] = graph.add(sum, b);
        }
    }
    Value::from_mat3(&m)
}

/// Returns the rotation matrix (w² − v·v) I + 2 v vᵀ + 2 w v̂ of a unit quaternion (w, v).
pub fn quaternion_matrix(graph: &mut Graph, q: [Edge; 4]) -> Mat3 {
    let [w, v @ ..] = q;
    let (ww, vv) = (graph.mul(w, w), graph.dot(&v, &v));
    let base = graph.sub(ww, vv);
    let two = graph.ratio(2, 1);
    let skew = hat(graph, v);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let (outer, turn) = (graph.mul(v[i], v[j]), graph.mul(w, skew[i][j]));
            let sum = graph.add(outer, turn);
            let double = graph.mul(two, sum);
            if i == j {
                graph.add(base, double)
            } else {
                double
            }
        })
    })
}
