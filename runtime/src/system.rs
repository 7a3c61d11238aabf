//! The interface of a mechanical system, which generated code implements.

use crate::error::Singular;
use crate::scalar::Scalar;
use crate::store::Store;

/// The kind of a block of consecutive coordinates in x, which decides how x moves along its manifold.
///
/// Each kind has a *chart*: local coordinates u in which an integrator computes one step. A step starts at u = 0 and
/// ends with a retraction, which moves x along u; see [`manifold`](crate::manifold).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Block {
    /// This many plain coordinates; the chart is their change.
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
/// x holds ν coordinates, possibly redundant (φ(x) = 0), in the order of [`blocks`](Self::blocks); ξ holds n
/// quasi-velocities, and u the inputs. First-order states z, if there are any, follow the velocities in ξ, and
/// integrators treat both alike. Notation and equation numbers: M. Konz, J. Rudolph,
/// *Redundant configuration coordinates and nonholonomic velocity coordinates in analytical
/// mechanics*, IFAC-PapersOnLine 51-2 (2018) 409-414 (KR18). Units are those of the description.
///
/// Implementations are pure functions: equal arguments give equal results, and no argument causes a panic. Time is not
/// an argument. A description that declares it has it as a coordinate of x with the rate 1, so that every method
/// evaluates each stage at its own time; anything else that depends on time enters through u.
pub trait System {
    /// The type of all numbers.
    type Scalar: Scalar;
    /// Storage of x, ν entries.
    type Coordinates: Store<Self::Scalar>;
    /// Storage of ξ: n entries, followed by those of z.
    type Velocities: Store<Self::Scalar>;
    /// Storage of a chart vector, with as many entries as the charts of all blocks together.
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

    /// Inputs that are all zero.
    fn zero_inputs(&self) -> Self::Inputs;

    /// The initial (x, ξ) of the description, with φ(x) = 0.
    fn start(&self) -> (Self::Coordinates, Self::Velocities);

    /// The place in x of the time, where the description declares it. Runs set this entry to the time that has passed since
    /// their start ([`Clock`](crate::Clock)).
    #[inline]
    fn clock(&self) -> Option<usize> {
        None
    }

    /// ẋ = A(x) ξ, KR18 (5), ν entries; ẋ = A(x) ξ + a(x) if time is among the coordinates.
    fn rate(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Coordinates;

    /// The same motion in the chart, block by block: ẋ for plain coordinates, θ̇ for a circle, the angular velocity in
    /// body axes for a quaternion or a rotation matrix.
    fn chart_rate(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Chart;

    /// ξ̇ = M⁻¹ (f − c), KR18 (30), n entries, followed by ż.
    ///
    /// # Errors
    /// [`Singular`] if M is not positive definite at x, or the kinematics are singular there.
    fn accel(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
        u: &Self::Inputs,
    ) -> Result<Self::Velocities, Singular>;

    /// −Ψ(x) φ(x), ν entries, which points back to φ = 0 and vanishes there. Along ẋ = A ξ + λ · correction, which is
    /// KR18 (8) with Λ = λ I, φ decays like exp(−λ t).
    fn correction(&self, x: &Self::Coordinates) -> Self::Coordinates;

    /// −Ψ(x) φ(x) as [`correction`](System::correction) has it, by which integrators lead x back to φ = 0 after every
    /// step; `None` where charts keep all of φ.
    #[inline]
    fn project_coordinates(&self, x: &Self::Coordinates) -> Option<Self::Coordinates> {
        let _ = x;
        None
    }

    /// The displacement along A, in units of velocity times time, that closes to first order the loops which multipliers
    /// enforce; `None` if there are no such loops.
    ///
    /// # Errors
    /// [`Singular`] if the rows of the loops are linearly dependent.
    #[inline]
    fn project_position(
        &self,
        x: &Self::Coordinates,
    ) -> Result<Option<Self::Velocities>, Singular> {
        let _ = x;
        Ok(None)
    }

    /// The velocities with B(x) ξ = 0 that are nearest to ξ in the metric of kinetic energy, for the constraints that
    /// multipliers enforce; `None` if there are no such constraints.
    ///
    /// # Errors
    /// [`Singular`] if the rows of B are linearly dependent.
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

    /// The kinetic energy T = ½ ξᵀ M(x) ξ, or T₂ + T₁ + T₀ if ẋ has terms without ξ.
    fn kinetic_energy(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Scalar;

    /// The potential energy V(x), up to a constant.
    fn potential_energy(&self, x: &Self::Coordinates) -> Self::Scalar;
}
