//! Derivatives along the motion: ∂ᵢ f = Aᵢ^α ∂f/∂x^α (KR18 (9)), d/dt along ẋ = A ξ at ξ̇ = 0, and
//! the Jacobians of frames.

use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Mat3, Vec3, apply_transposed};
use hamel_language::model::Model;

/// The derivations of a model, with their memories.
#[derive(Clone, Debug)]
pub struct Calculus {
    directions: Vec<Derivation>,
    time: Derivation,
}

impl Calculus {
    /// The derivations ∂₁ … ∂ₙ and d/dt.
    pub fn new(model: &Model) -> Self {
        let direction = |i: usize| {
            Derivation::new(
                model
                    .x
                    .iter()
                    .zip(&model.a)
                    .map(|(x, row)| (x.node(), row[i])),
            )
        };
        Calculus {
            directions: (0..model.n()).map(direction).collect(),
            time: Derivation::new(
                model
                    .x
                    .iter()
                    .zip(&model.rate)
                    .map(|(x, &rate)| (x.node(), rate)),
            ),
        }
    }

    /// The same where ξ changes at rates of its own while inner velocities are held constant.
    pub fn with_drift(model: &Model, drift: &[Edge]) -> Self {
        let x = model.x.iter().zip(&model.rate);
        let seeds = x.chain(model.xi.iter().zip(drift));
        Calculus {
            time: Derivation::new(seeds.map(|(symbol, &rate)| (symbol.node(), rate))),
            ..Calculus::new(model)
        }
    }

    /// n.
    pub fn n(&self) -> usize {
        self.directions.len()
    }

    /// ∂ᵢ f.
    pub fn along(&mut self, graph: &mut Graph, i: usize, f: Edge) -> Edge {
        self.directions[i].of(graph, f)
    }

    /// df/dt at ξ̇ = 0.
    pub fn rate(&mut self, graph: &mut Graph, f: Edge) -> Edge {
        self.time.of(graph, f)
    }

    /// dv/dt at ξ̇ = 0.
    pub fn rate3(&mut self, graph: &mut Graph, v: Vec3) -> Vec3 {
        v.map(|entry| self.time.of(graph, entry))
    }

    /// ∂ᵢ p for all i, world axes.
    pub fn point_jacobian(&mut self, graph: &mut Graph, point: Vec3) -> Vec<Vec3> {
        (0..self.n())
            .map(|i| point.map(|entry| self.along(graph, i, entry)))
            .collect()
    }

    /// The columns of the body angular velocity, vee(Rᵀ ∂ᵢR), for all i.
    pub fn spin_jacobian(&mut self, graph: &mut Graph, rotation: &Mat3) -> Vec<Vec3> {
        (0..self.n())
            .map(|i| self.spin_along(graph, i, rotation))
            .collect()
    }

    /// vee(Rᵀ ∂ᵢR).
    pub fn spin_along(&mut self, graph: &mut Graph, i: usize, rotation: &Mat3) -> Vec3 {
        let change = rotation.map(|row| row.map(|entry| self.along(graph, i, entry)));
        spin(graph, rotation, &change)
    }

    /// The body angular velocity vee(Rᵀ Ṙ).
    pub fn spin(&mut self, graph: &mut Graph, rotation: &Mat3) -> Vec3 {
        let change = rotation.map(|row| row.map(|entry| self.time.of(graph, entry)));
        spin(graph, rotation, &change)
    }
}

/// ω with ω̂ = Rᵀ Ṙ: ω₁ = R₃ · Ṙ₂ and cyclic, columns of R.
fn spin(graph: &mut Graph, rotation: &Mat3, change: &Mat3) -> Vec3 {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let column: Vec3 = std::array::from_fn(|row| rotation[row][k]);
        let moved: Vec3 = std::array::from_fn(|row| change[row][j]);
        graph.dot(&column, &moved)
    })
}

/// A vector of the world in the axes of a frame, Rᵀ a.
pub fn into_frame(graph: &mut Graph, rotation: &Mat3, a: Vec3) -> Vec3 {
    apply_transposed(graph, rotation, a)
}
