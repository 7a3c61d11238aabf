//! Velocity coordinates in which ξ̇ is computed: the user's, or the body's own twist.
//!
//! If the twist η = B ξ of the only body has as many entries as ξ and B is orthogonal on X (for example, a body
//! whose velocities are given in world axes), then M is constant in η, and ξ̇ = Bᵀ η̇ + (dBᵀ/dt) η.

use crate::calculus::{Calculus, into_frame};
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::Edge;
use hamel_algebra::linear::{multiply, transpose};
use hamel_language::model::Model;

/// Model in the velocity coordinates in which ξ̇ is derived, with the derivatives along them.
#[derive(Clone, Debug)]
pub struct DerivationContext {
    /// The model; its A and generalised forces belong to the internal velocities.
    pub model: Model,
    /// Derivatives ∂ᵢ along the internal frame, and d/dt at constant internal velocities.
    pub calculus: Calculus,
    /// Transformation back to ξ̇, if the internal velocities differ from ξ.
    pub back: Option<VelocityTransform>,
}

/// Transformation ξ̇ = Bᵀ η̇ + drift from accelerations η̇ of internal velocities to those of the description.
#[derive(Clone, Debug)]
pub struct VelocityTransform {
    /// Orthogonal matrix B, n rows of n entries.
    pub b: Vec<Vec<Edge>>,
    /// Drift term (dBᵀ/dt) η.
    pub drift: Vec<Edge>,
}

impl DerivationContext {
    /// Creates the context in the velocities of the description.
    pub fn in_given_velocities(model: &Model) -> Self {
        DerivationContext {
            model: model.clone(),
            calculus: Calculus::new(model),
            back: None,
        }
    }

    /// Creates the context in the twist of the only body, in the body's axes.
    ///
    /// Returns `None` unless the whole kinetic energy is that of a single body and B is square, orthogonal and not
    /// the identity.
    pub fn in_body_twist(model: &Model) -> Option<Self> {
        let [body] = model.bodies.as_slice() else {
            return None;
        };
        let mut model = model.clone();
        let mut calculus = Calculus::new(&model);
        let zero = model.graph.zero();
        if model.kinetic != zero || !model.particles.is_empty() {
            return None;
        }
        let frame = model.frames[body.frame].clone();
        let graph = &mut model.graph;
        let spins = calculus.spin_jacobian(graph, &frame.rotation);
        let columns: Vec<Vec<Edge>> = calculus
            .point_jacobian(graph, frame.position)
            .into_iter()
            .zip(spins)
            .map(|(v, w)| {
                into_frame(graph, &frame.rotation, v)
                    .into_iter()
                    .chain(w)
                    .collect()
            })
            .collect();
        let mut b = transpose(&columns);
        b.retain(|row| row.iter().any(|&entry| entry != zero));
        let n = model.xi.len();
        let identity = |product: &[Vec<Edge>], one: Edge| {
            (0..n).all(|i| (0..n).all(|j| product[i][j] == if i == j { one } else { zero }))
        };
        if b.len() != n || identity(&b, graph.one()) {
            return None;
        }
        let back = transpose(&b);
        if !identity(&multiply(graph, &b, &back), graph.one()) {
            return None;
        }
        let eta: Vec<Edge> = b.iter().map(|row| graph.dot(row, &model.xi)).collect();
        // B depends on x alone, so its rate along the motion is ∂B/∂x ẋ.
        let mut along = Derivation::new(
            model
                .x
                .iter()
                .zip(&model.rate)
                .map(|(x, &rate)| (x.node(), rate)),
        );
        let drift: Vec<Edge> = back
            .iter()
            .map(|row| {
                let change = along.all(graph, row);
                graph.dot(&change, &eta)
            })
            .collect();
        model.a = multiply(graph, &model.a, &back);
        model.generalized = b
            .iter()
            .map(|row| graph.dot(row, &model.generalized))
            .collect();
        let calculus = Calculus::with_drift(&model, &drift);
        Some(DerivationContext {
            model,
            calculus,
            back: Some(VelocityTransform { b, drift }),
        })
    }

    /// Transforms η̇ back to ξ̇.
    pub fn to_given_velocities(
        &self,
        graph: &mut hamel_algebra::graph::Graph,
        eta_dot: Vec<Edge>,
    ) -> Vec<Edge> {
        let Some(back) = &self.back else {
            return eta_dot;
        };
        (0..eta_dot.len())
            .map(|j| {
                let column: Vec<Edge> = back.b.iter().map(|row| row[j]).collect();
                let turned = graph.dot(&column, &eta_dot);
                graph.add(turned, back.drift[j])
            })
            .collect()
    }
}
