//! What a mechanical system offers: the traits that generated code implements.

use crate::error::Singular;
use crate::scalar::Scalar;
use crate::store::Store;

/// The kind of one run of coordinates in x, which decides how x is moved along its manifold.
///
/// The *chart* of a kind are the coordinates u in which one step of an integrator is computed; the
/// step starts at u = 0 and ends by moving x along u, see [`manifold`](crate::manifold).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Block {
    /// This many bare coordinates; the chart is the change of them.
    Flat(usize),
    /// A point (c, s) = (cos θ, sin θ) of the circle; the chart is the change of θ in rad.
    Circle,
    /// A unit quaternion (w, x, y, z), scalar first, body to world; the chart is a rotation vector
    /// in rad, body axes, applied on the right.
    Quaternion,
    /// A rotation matrix, nine entries row by row, body to world; chart as for the quaternion.
    Rotation,
}

impl Block {
    /// Number of entries in x: n, 2, 4 or 9.
    #[inline]
    pub const fn coordinates(self) -> usize {
        match self {
            Self::Flat(count) => count,
            Self::Circle => 2,
            Self::Quaternion => 4,
            Self::Rotation => 9,
        }
    }

    /// Number of entries in a chart vector: n, 1, 3 or 3.
    #[inline]
    pub const fn chart(self) -> usize {
        match self {
            Self::Flat(count) => count,
            Self::Circle => 1,
            Self::Quaternion | Self::Rotation => 3,
        }
    }
}

/// Equations of motion ẋ = A(x) ξ, M(x) ξ̇ + c(x, ξ) = f(x, ξ, u) of a mechanical system.
///
/// x holds ν coordinates, possibly redundant (φ(x) = 0), in the order of [`blocks`](Self::blocks);
/// ξ holds n velocity coordinates, u the inputs. Behind the velocities stand states of first order z, where there are
/// any: methods of integration move both alike. Notation and equation numbers: M. Konz, J. Rudolph,
/// *Redundant configuration coordinates and nonholonomic velocity coordinates in analytical
/// mechanics*, IFAC-PapersOnLine 51-2 (2018) 409-414 (KR18). Units are those of the description.
///
/// An implementation is pure: equal arguments give equal results, and no argument makes it panic.
/// Time is no argument: where a description declares it, it is a coordinate of x whose rate is 1, so that every method
/// evaluates its stages at their own times; what else depends on time enters through u.
pub trait System {
    /// The numbers computed with.
    type Scalar: Scalar;
    /// Storage of x, ν entries.
    type Coordinates: Store<Self::Scalar>;
    /// Storage of ξ, n entries, and behind them those of z.
    type Velocities: Store<Self::Scalar>;
    /// Storage of a chart vector, as many entries as the blocks' charts have.
    type Chart: Store<Self::Scalar>;
    /// Storage of u.
    type Inputs: Store<Self::Scalar>;

    /// The kinds of coordinates, in the order in which they stand in x. Their
    /// [lengths](Block::coordinates) add up to ν.
    fn blocks(&self) -> &[Block];

    /// ν zeros.
    fn zero_coordinates(&self) -> Self::Coordinates;

    /// n zeros.
    fn zero_velocities(&self) -> Self::Velocities;

    /// A chart vector of zeros.
    fn zero_chart(&self) -> Self::Chart;

    /// No input: zeros.
    fn zero_inputs(&self) -> Self::Inputs;

    /// The initial (x, ξ) of the description, with φ(x) = 0.
    fn start(&self) -> (Self::Coordinates, Self::Velocities);

    /// ẋ = A(x) ξ, KR18 (5); with the time among the coordinates ẋ = A(x) ξ + a(x).
    fn rate(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Coordinates;

    /// The same motion in the chart, per block: ẋ (flat), θ̇ (circle), angular velocity in body axes
    /// (quaternion, rotation).
    fn chart_rate(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Chart;

    /// ξ̇ = M⁻¹ (f − c), KR18 (30), and behind it ż.
    ///
    /// # Errors
    /// [`Singular`] when M is not positive definite, or the kinematics are singular, at x.
    fn accel(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
        u: &Self::Inputs,
    ) -> Result<Self::Velocities, Singular>;

    /// −Ψ(x) φ(x): leads back to φ = 0 and vanishes there. ẋ = A ξ + λ · correction is KR18 (8)
    /// with Λ = λ I, along which φ decays like exp(−λ t).
    fn correction(&self, x: &Self::Coordinates) -> Self::Coordinates;

    /// The step along A, in velocities times time, that closes the loops which multipliers keep, to
    /// first order; `None` where there are none.
    ///
    /// # Errors
    /// [`Singular`] where the loops' rows depend on one another.
    #[inline]
    fn project_position(
        &self,
        x: &Self::Coordinates,
    ) -> Result<Option<Self::Velocities>, Singular> {
        let _ = x;
        Ok(None)
    }

    /// The velocities nearest to ξ in kinetic energy that satisfy B(x) ξ = 0 for the constraints that
    /// multipliers keep; `None` where there are none.
    ///
    /// # Errors
    /// [`Singular`] where the rows of B depend on one another.
    #[inline]
    fn project_velocity(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
    ) -> Result<Option<Self::Velocities>, Singular> {
        let _ = (x, xi);
        Ok(None)
    }

    /// max |φ(x)| over the constraints.
    fn constraint_norm(&self, x: &Self::Coordinates) -> Self::Scalar;

    /// T = ½ ξᵀ M(x) ξ, and T₂ + T₁ + T₀ where ẋ has terms without ξ.
    fn kinetic_energy(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Scalar;

    /// V(x), up to a constant.
    fn potential_energy(&self, x: &Self::Coordinates) -> Self::Scalar;
}
