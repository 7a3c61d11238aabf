//! Rotations as products of plane rotations, in which entries that are zero or one cost nothing.

use hamel_algebra::graph::{Edge, Graph, Label};
use hamel_algebra::linear::{Mat3, Vec3, apply_transposed, apply3, multiply3, transpose3};

/// Factor of a rotation: a plane rotation about a coordinate axis, or a rotation matrix.
#[derive(Clone, Copy, Debug)]
pub enum RotationFactor {
    /// Rotation about the axis `axis` (0, 1, 2) by the angle with this cosine and sine.
    About {
        /// Index of the axis.
        axis: usize,
        /// Cosine of the angle.
        cos: Edge,
        /// Sine of the angle.
        sin: Edge,
    },
    /// Any rotation matrix.
    By(Mat3),
}

impl RotationFactor {
    /// Records in the graph which quantity the entries of the rotation belong to.
    pub fn label(&self, graph: &mut Graph, label: Option<Label>) {
        match self {
            RotationFactor::By(matrix) => graph.label(&matrix.concat(), label),
            RotationFactor::About { cos, sin, .. } => graph.label(&[*cos, *sin], label),
        }
    }

    /// Returns R v for a vector v.
    pub fn rotate(&self, graph: &mut Graph, v: Vec3) -> Vec3 {
        match *self {
            RotationFactor::By(ref matrix) => apply3(graph, matrix, v),
            RotationFactor::About { axis, cos, sin } => plane(graph, axis, cos, sin, v),
        }
    }

    /// Returns Rᵀ v for a vector v.
    pub fn rotate_back(&self, graph: &mut Graph, v: Vec3) -> Vec3 {
        match *self {
            RotationFactor::By(ref matrix) => apply_transposed(graph, matrix, v),
            RotationFactor::About { axis, cos, sin } => plane(graph, axis, cos, -sin, v),
        }
    }

    /// Returns R S Rᵀ for a symmetric matrix S.
    ///
    /// With t = (a − d) sin + 2 b cos, the block `[[a, b], [b, d]]` of S in the plane of rotation
    /// becomes a − sin t, d + sin t and cos t − b.
    pub fn rotate_symmetric(&self, graph: &mut Graph, s: &Mat3) -> Mat3 {
        match *self {
            RotationFactor::By(ref matrix) => {
                let left = multiply3(graph, matrix, s);
                let turned = multiply3(graph, &left, &transpose3(matrix));
                std::array::from_fn(|i| std::array::from_fn(|j| turned[i.max(j)][i.min(j)]))
            }
            RotationFactor::About { axis, cos, sin } => {
                if sin == graph.zero() && cos == graph.one() {
                    return *s;
                }
                let (k, i, j) = (axis, (axis + 1) % 3, (axis + 2) % 3);
                let mut turned = *s;
                let (a, b, d) = (s[i][i], s[i][j], s[j][j]);
                let double = graph.add(cos, cos);
                let t = {
                    let difference = graph.sub(a, d);
                    let first = graph.mul(difference, sin);
                    let second = graph.mul(double, b);
                    graph.add(first, second)
                };
                let (along, across) = (graph.mul(sin, t), graph.mul(cos, t));
                turned[i][i] = graph.sub(a, along);
                turned[j][j] = graph.add(d, along);
                turned[i][j] = graph.sub(across, b);
                turned[j][i] = turned[i][j];
                let pair = rotate_pair(graph, cos, sin, (s[i][k], s[j][k]));
                (turned[i][k], turned[j][k]) = pair;
                (turned[k][i], turned[k][j]) = pair;
                turned
            }
        }
    }

    /// Returns R H Rᵀ for any matrix H.
    pub fn rotate_matrix(&self, graph: &mut Graph, h: &Mat3) -> Mat3 {
        match *self {
            RotationFactor::By(ref matrix) => {
                let left = multiply3(graph, matrix, h);
                multiply3(graph, &left, &transpose3(matrix))
            }
            RotationFactor::About { axis, cos, sin } => {
                if sin == graph.zero() && cos == graph.one() {
                    return *h;
                }
                let (k, i, j) = (axis, (axis + 1) % 3, (axis + 2) % 3);
                let mut turned = *h;
                let t = {
                    let (difference, sum) =
                        (graph.sub(h[i][i], h[j][j]), graph.add(h[i][j], h[j][i]));
                    let (first, second) = (graph.mul(difference, sin), graph.mul(sum, cos));
                    graph.add(first, second)
                };
                let (along, across) = (graph.mul(sin, t), graph.mul(cos, t));
                turned[i][i] = graph.sub(h[i][i], along);
                turned[j][j] = graph.add(h[j][j], along);
                turned[i][j] = graph.sub(across, h[j][i]);
                turned[j][i] = graph.sub(across, h[i][j]);
                (turned[i][k], turned[j][k]) = rotate_pair(graph, cos, sin, (h[i][k], h[j][k]));
                (turned[k][i], turned[k][j]) = rotate_pair(graph, cos, sin, (h[k][i], h[k][j]));
                turned
            }
        }
    }
}

/// Returns (c a − s b, s a + c b).
fn rotate_pair(graph: &mut Graph, cos: Edge, sin: Edge, (a, b): (Edge, Edge)) -> (Edge, Edge) {
    let (ca, sb) = (graph.mul(cos, a), graph.mul(sin, b));
    let (sa, cb) = (graph.mul(sin, a), graph.mul(cos, b));
    (graph.sub(ca, sb), graph.add(sa, cb))
}

fn plane(graph: &mut Graph, axis: usize, cos: Edge, sin: Edge, v: Vec3) -> Vec3 {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut turned = v;
    (turned[i], turned[j]) = rotate_pair(graph, cos, sin, (v[i], v[j]));
    turned
}
