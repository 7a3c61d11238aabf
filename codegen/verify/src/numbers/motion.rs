//! Motion of frames and points at one point of X, modulo p: ṙ, r̈, and for every i ∂ᵢr, d/dt ∂ᵢr, ∂ᵢṙ.
//!
//! The poses are differentiated by hyper-dual numbers along ẋ = A ξ and along the columns of A. In d/dt ∂ᵢr the column
//! Aᵢ changes with x, in ∂ᵢṙ it is ẋ that changes; the difference of the two is what the coefficients γ express.

use super::space::{Mat3, Vec3, add, angular_velocity, apply};
use hamel_algebra::graph::Edge;
use hamel_algebra::jets::Jet;
use hamel_algebra::residue_pair::ResiduePair;

/// A quantity q at a point modulo p with its derivatives in time and along the columns of A.
#[derive(Clone, Debug)]
pub struct MotionJet<T> {
    /// Value q.
    pub value: T,
    /// Rate q̇.
    pub rate: T,
    /// Second derivative q̈.
    pub second: T,
    /// Derivatives ∂ᵢq along the columns of A.
    pub by: Vec<T>,
    /// Their rates, d/dt ∂ᵢq.
    pub rate_by: Vec<T>,
    /// Derivatives of the rate, ∂ᵢq̇ at constant ξ.
    pub by_rate: Vec<T>,
}

impl<T: Copy> MotionJet<T> {
    /// Collects derivatives from jets with the columns Aᵢ with Ȧᵢ, Aᵢ with ∂ᵢẋ, ẋ with ẍ.
    fn assemble(n: usize, entry: impl Fn(&dyn Fn(&Jet) -> ResiduePair) -> T) -> Self {
        let across =
            |i: usize| entry(&|jet| jet.across.get(i).copied().unwrap_or(ResiduePair::ZERO));
        let mixed = |i: usize| entry(&|jet| jet.mixed.get(i).copied().unwrap_or(ResiduePair::ZERO));
        MotionJet {
            value: entry(&|jet| jet.value),
            rate: entry(&|jet| jet.along),
            second: mixed(2 * n),
            by: (0..n).map(across).collect(),
            rate_by: (0..n).map(mixed).collect(),
            by_rate: (n..2 * n).map(mixed).collect(),
        }
    }

    /// Applies a linear function to the quantity and its derivatives.
    pub fn map<U: Copy>(&self, f: impl Fn(T) -> U) -> MotionJet<U> {
        let all = |list: &[T]| list.iter().map(|&entry| f(entry)).collect();
        MotionJet {
            value: f(self.value),
            rate: f(self.rate),
            second: f(self.second),
            by: all(&self.by),
            rate_by: all(&self.rate_by),
            by_rate: all(&self.by_rate),
        }
    }
}

impl MotionJet<Vec3> {
    /// Returns the sum of two vectors, with the sums of their derivatives.
    pub fn plus(&self, other: &Self) -> Self {
        let all = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(&a, &b)| add(a, b)).collect();
        MotionJet {
            value: add(self.value, other.value),
            rate: add(self.rate, other.rate),
            second: add(self.second, other.second),
            by: all(&self.by, &other.by),
            rate_by: all(&self.rate_by, &other.rate_by),
            by_rate: all(&self.by_rate, &other.by_rate),
        }
    }
}

/// Axes and origin of a frame in the world, with their derivatives.
#[derive(Clone, Debug)]
pub struct MovingFrame {
    /// Axes of the frame.
    pub rotation: MotionJet<Mat3>,
    /// Origin of the frame.
    pub position: MotionJet<Vec3>,
}

/// Angular velocity of a frame in its own axes, and its derivatives.
#[derive(Clone, Debug)]
pub struct AngularMotion {
    /// Angular velocity ω.
    pub omega: Vec3,
    /// Angular acceleration dω/dt.
    pub alpha: Vec3,
    /// Partial angular velocities ωᵢ = ∂ω/∂ξⁱ.
    pub by: Vec<Vec3>,
    /// Their rates, d/dt ωᵢ.
    pub rate_by: Vec<Vec3>,
    /// Derivatives ∂ᵢω along the columns of A at constant ξ.
    pub by_omega: Vec<Vec3>,
}

impl MovingFrame {
    /// Creates a frame from the jets of the nine entries of its axes and the three of its origin; `None` if their
    /// number is another.
    pub fn new(n: usize, jets: &[Jet]) -> Option<Self> {
        let (axes, origin) = jets.split_at_checked(9)?;
        let origin: &[Jet; 3] = origin.try_into().ok()?;
        let axes: &[Jet; 9] = axes.try_into().ok()?;
        Some(MovingFrame {
            rotation: MotionJet::assemble(n, |of| {
                std::array::from_fn(|i| std::array::from_fn(|j| of(&axes[3 * i + j])))
            }),
            position: point(n, origin),
        })
    }

    /// Returns the point with constant components `at` in the frame's axes, in world coordinates, with its derivatives.
    pub fn fixed_point(&self, at: Vec3) -> MotionJet<Vec3> {
        self.position
            .plus(&self.rotation.map(|axes| apply(&axes, at)))
    }

    /// Returns the angular velocity ω in the frame's axes and its derivatives, by the product rule on Rᵀ Ṙ.
    pub fn angular_motion(&self) -> AngularMotion {
        let r = &self.rotation;
        let n = r.by.len();
        let each = |f: &dyn Fn(usize) -> Vec3| (0..n).map(f).collect::<Vec<_>>();
        AngularMotion {
            omega: angular_velocity(&r.value, &r.rate),
            alpha: add(
                angular_velocity(&r.rate, &r.rate),
                angular_velocity(&r.value, &r.second),
            ),
            by: each(&|i| angular_velocity(&r.value, &r.by[i])),
            rate_by: each(&|i| {
                add(
                    angular_velocity(&r.rate, &r.by[i]),
                    angular_velocity(&r.value, &r.rate_by[i]),
                )
            }),
            by_omega: each(&|i| {
                add(
                    angular_velocity(&r.by[i], &r.rate),
                    angular_velocity(&r.value, &r.by_rate[i]),
                )
            }),
        }
    }
}

/// Creates a point of the world from the jets of its three entries.
pub fn point(n: usize, jets: &[Jet; 3]) -> MotionJet<Vec3> {
    MotionJet::assemble(n, |of| std::array::from_fn(|i| of(&jets[i])))
}

/// Lists the entries of a pose in the order in which [`MovingFrame::new`] reads them.
pub fn pose_entries(rotation: &[[Edge; 3]; 3], position: &[Edge; 3]) -> Vec<Edge> {
    rotation.iter().flatten().chain(position).copied().collect()
}
