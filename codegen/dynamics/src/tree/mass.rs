//! Mass, first moment and second moment of a link about the origin of its frame.
//!
//! m, h = ∫ r dm and S = ∫ r rᵀ dm, from which the inertia matrix is Θ = tr(S) I − S.

use super::link::Link;
use super::turn::RotationFactor;
use hamel_algebra::graph::{Edge, Graph, Label};
use hamel_algebra::linear::{Mat3, Vec3, add3, cross, scale3, zero3};
use hamel_language::model::Body;

/// Inertia of a link as mass m, first moment h = m s and second moment S = ∫ r rᵀ dm, about its origin and in its axes.
#[derive(Clone, Copy, Debug)]
pub struct LinkInertia {
    /// Mass (kg).
    pub mass: Edge,
    /// First moment (kg m).
    pub first: Vec3,
    /// Second moment (kg m²).
    pub second: Mat3,
}

impl LinkInertia {
    /// Returns the inertia of a massless link.
    pub fn zero(graph: &Graph) -> Self {
        LinkInertia {
            mass: graph.zero(),
            first: zero3(graph),
            second: [zero3(graph); 3],
        }
    }

    /// Records in the graph which quantity mass and moments are entries of.
    pub fn label(&self, graph: &mut Graph, label: Option<Label>) {
        graph.label(&[self.mass], label);
        graph.label(&self.first, label);
        graph.label(&self.second.concat(), label);
    }

    /// Returns the inertia of a particle at the origin.
    pub fn of_particle(graph: &Graph, mass: Edge) -> Self {
        LinkInertia {
            mass,
            ..LinkInertia::zero(graph)
        }
    }

    /// Returns the inertia of a body in its frame: S = ½ tr(Θ) I − Θ about the centre of mass,
    /// shifted to the origin.
    pub fn of_body(graph: &mut Graph, body: &Body) -> Self {
        let theta = &body.inertia_com;
        let trace = graph.sum(&[theta[0][0], theta[1][1], theta[2][2]]);
        let half = graph.ratio(1, 2);
        let half = graph.mul(half, trace);
        let second = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                if i == j {
                    graph.sub(half, theta[i][j])
                } else {
                    -theta[i][j]
                }
            })
        });
        let central = LinkInertia {
            mass: body.mass,
            first: zero3(graph),
            second,
        };
        central.shift_origin(graph, body.com)
    }

    /// Returns the inertia about another origin, where a point at r has the position r + `by`.
    ///
    /// h' = h + m by, S' = S + by hᵀ + h' byᵀ.
    pub fn shift_origin(&self, graph: &mut Graph, by: Vec3) -> Self {
        let far = scale3(graph, self.mass, by);
        let first = add3(graph, self.first, far);
        let mut second = self.second;
        for i in 0..3 {
            for j in 0..=i {
                let (a, b) = (graph.mul(by[i], self.first[j]), graph.mul(first[i], by[j]));
                second[i][j] = graph.sum(&[second[i][j], a, b]);
                second[j][i] = second[i][j];
            }
        }
        LinkInertia {
            mass: self.mass,
            first,
            second,
        }
    }

    /// Returns the inertia in rotated axes, where a point at r has the position R r.
    pub fn rotate_axes(&self, graph: &mut Graph, turn: &RotationFactor) -> Self {
        LinkInertia {
            mass: self.mass,
            first: turn.rotate(graph, self.first),
            second: turn.rotate_symmetric(graph, &self.second),
        }
    }

    /// Returns the inertia of a link about the origin and in the axes of its parent.
    pub fn to_parent(&self, graph: &mut Graph, link: &Link) -> Self {
        let turns = link.turns.iter().rev();
        let turned = turns.fold(*self, |mass, turn| mass.rotate_axes(graph, turn));
        turned.shift_origin(graph, link.position)
    }

    /// Returns the inertia of two bodies that are fixed to each other.
    pub fn plus(&self, graph: &mut Graph, other: &LinkInertia) -> Self {
        LinkInertia {
            mass: graph.add(self.mass, other.mass),
            first: add3(graph, self.first, other.first),
            second: std::array::from_fn(|i| {
                let (i, row) = (i, other.second[i]);
                add3(graph, self.second[i], row)
            }),
        }
    }

    /// Returns the force m a + α × h and the torque Θ α + h × a about the origin for a spatial
    /// acceleration at zero velocity.
    pub fn wrench(&self, graph: &mut Graph, alpha: Vec3, a: Vec3) -> (Vec3, Vec3) {
        let push = scale3(graph, self.mass, a);
        let tangential = cross(graph, alpha, self.first);
        let lever = cross(graph, self.first, a);
        let spin = self.times_vector(graph, alpha);
        (add3(graph, push, tangential), add3(graph, spin, lever))
    }

    /// Returns the moment of inertia about the third axis, Θ_zz = S_xx + S_yy.
    pub fn polar_moment(&self, graph: &mut Graph) -> Edge {
        graph.add(self.second[0][0], self.second[1][1])
    }

    /// Returns the inertia matrix Θ = tr(S) I − S.
    pub fn inertia_matrix(&self, graph: &mut Graph) -> Mat3 {
        let s = &self.second;
        std::array::from_fn(|i| {
            std::array::from_fn(|k| {
                if i == k {
                    graph.add(s[(i + 1) % 3][(i + 1) % 3], s[(i + 2) % 3][(i + 2) % 3])
                } else {
                    -s[i][k]
                }
            })
        })
    }

    /// Returns the product Θ α = tr(S) α − S α of the inertia matrix and a vector.
    pub fn times_vector(&self, graph: &mut Graph, alpha: Vec3) -> Vec3 {
        let s = &self.second;
        std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let polar = graph.add(s[j][j], s[k][k]);
            let axial = graph.mul(polar, alpha[i]);
            let (a, b) = (graph.mul(s[i][j], alpha[j]), graph.mul(s[i][k], alpha[k]));
            let other = graph.add(a, b);
            graph.sub(axial, other)
        })
    }
}
