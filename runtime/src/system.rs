//! The trait of a mechanical system, which generated code implements.

use crate::error::Singular;
use crate::manifold;
use crate::scalar::Scalar;
use crate::store::Store;

/// Kind of a block of consecutive coordinates in x; it decides how x moves along its manifold.
///
/// Each kind has a *chart*: local coordinates u in which an integrator computes one step. A step starts at u = 0 and
/// ends with a retraction, which moves x along u; see [`manifold`](crate::manifold).
///
/// ```
/// use hamel::Block;
///
/// // A free body with a wheel: position, attitude, and the angle of the wheel.
/// let blocks = [Block::Flat(3), Block::Rotation, Block::Circle];
/// let entries: usize = blocks.iter().map(|block| block.coordinates()).sum();
/// let directions: usize = blocks.iter().map(|block| block.chart()).sum();
/// assert_eq!((entries, directions), (14, 7));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Block {
    /// That many plain coordinates; the chart holds their changes.
    Flat(usize),
    /// A point (c, s) = (cos θ, sin θ) of the unit circle; the chart is the change of θ in rad.
    Circle,
    /// A unit quaternion (w, x, y, z), scalar first, body to world; the chart is a rotation vector
    /// in rad, body axes, applied on the right.
    Quaternion,
    /// A rotation matrix, nine entries row by row, body to world; the chart is the same as for the quaternion.
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

/// Motion of a mechanical system: ẋ = A(x) ξ, M(x) ξ̇ + c(x, ξ) = f(x, ξ, u).
///
/// x holds ν coordinates, possibly redundant (φ(x) = 0), in the order of [`blocks`](Self::blocks); ξ holds n
/// quasi-velocities; u holds the inputs. First-order states z, if there are any, follow the quasi-velocities in the
/// same list, and integrators treat both alike. Notation and equation numbers: M. Konz, J. Rudolph, *Redundant
/// configuration coordinates and nonholonomic velocity coordinates in analytical mechanics*, IFAC-PapersOnLine 51-2
/// (2018) 409-414 (KR18). Units are those of the description.
///
/// A system by hand implements [`blocks`](Self::blocks), [`chart_rate`](Self::chart_rate) and
/// [`forward_dynamics`](Self::forward_dynamics). The other methods have defaults:
///
/// | methods | their defaults hold if |
/// |---|---|
/// | [`start`](Self::start), [`clock`](Self::clock) | runs start at rest at the origin, and time is not a coordinate |
/// | [`rate`](Self::rate) | always |
/// | [`correction`](Self::correction), [`constraint_norm`](Self::constraint_norm), [`project_coordinates`](Self::project_coordinates), [`project_position`](Self::project_position), [`project_velocity`](Self::project_velocity) | the only constraints are those of the blocks: unit length, orthogonality |
/// | [`zero_coordinates`](Self::zero_coordinates), [`zero_velocities`](Self::zero_velocities), [`zero_chart`](Self::zero_chart), [`zero_inputs`](Self::zero_inputs) | storage is an array; for others, if there are as many velocities as chart entries, and no inputs |
///
/// [`Energies`] adds T and V, which [`Monitor`](crate::Monitor) and implicit methods need.
///
/// Implementations are pure functions: equal arguments give equal results, and no argument causes a panic. Time is not
/// an argument. A description that declares time has it as a coordinate of x with the rate 1, so that every method
/// evaluates each stage at the time of that stage. Anything else that depends on time enters through u.
///
/// ```
/// use hamel::{Block, Singular, State, System, methods::Rkmk4, step};
///
/// /// A mass on a spring, q̈ = −ω² q + u.
/// struct Oscillator {
///     omega: f64,
/// }
///
/// impl System for Oscillator {
///     type Scalar = f64;
///     type Coordinates = [f64; 1];
///     type Velocities = [f64; 1];
///     type Chart = [f64; 1];
///     type Inputs = [f64; 1];
///
///     fn blocks(&self) -> &[Block] {
///         &[Block::Flat(1)]
///     }
///     fn chart_rate(&self, _: &[f64; 1], xi: &[f64; 1]) -> [f64; 1] {
///         *xi
///     }
///     fn forward_dynamics(
///         &self,
///         x: &[f64; 1],
///         _: &[f64; 1],
///         u: &[f64; 1],
///     ) -> Result<[f64; 1], Singular> {
///         Ok([u[0] - self.omega * self.omega * x[0]])
///     }
/// }
///
/// # fn main() -> Result<(), hamel::StepError> {
/// let system = Oscillator { omega: 2.0 };
/// let mut state: State<Oscillator> = State { t: 0.0, x: [1.0], xi: [0.0] };
/// step(&system, Rkmk4, &mut state, 0.01, &|_, _, _| [0.0])?;
/// assert!((state.x[0] - 0.02_f64.cos()).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
pub trait System {
    /// Type of all numbers.
    type Scalar: Scalar;
    /// Storage of x, ν entries.
    type Coordinates: Store<Self::Scalar>;
    /// Storage of ξ: n entries, followed by those of z.
    type Velocities: Store<Self::Scalar>;
    /// Storage of a chart vector, with as many entries as the charts of all blocks together.
    type Chart: Store<Self::Scalar>;
    /// Storage of u.
    type Inputs: Store<Self::Scalar>;

    /// Returns the kinds of coordinates, in their order in x. Their [lengths](Block::coordinates) add up to ν.
    fn blocks(&self) -> &[Block];

    /// Returns the motion of x in the chart, block by block: ẋ for plain coordinates, θ̇ for a circle, the angular
    /// velocity in body axes for a quaternion or a rotation matrix.
    fn chart_rate(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Chart;

    /// Returns ξ̇ = M⁻¹ (f − c), KR18 (30), n entries, followed by ż.
    ///
    /// # Errors
    /// [`Singular`] if M is not positive definite at x, or the kinematics are singular there.
    fn forward_dynamics(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
        u: &Self::Inputs,
    ) -> Result<Self::Velocities, Singular>;

    /// Returns ẋ = A(x) ξ, KR18 (5), ν entries; ẋ = A(x) ξ + a(x) if time is among the coordinates. This is the motion
    /// of [`chart_rate`](Self::chart_rate) in coordinates.
    #[inline]
    fn rate(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Coordinates {
        let mut rate = x.clone();
        let along = self.chart_rate(x, xi);
        manifold::rate(self.blocks(), rate.as_mut(), along.as_ref());
        rate
    }

    /// Returns the initial (x, ξ) of the description, with φ(x) = 0; by default the origin of every block, at rest.
    fn start(&self) -> (Self::Coordinates, Self::Velocities) {
        let mut x = self.zero_coordinates();
        manifold::origin(self.blocks(), x.as_mut());
        (x, self.zero_velocities())
    }

    /// Returns the index in x of the coordinate that is the time, or `None` if the description declares none. Runs set
    /// this entry to its initial value plus the time since the start of the run ([`Clock`](crate::Clock)).
    #[inline]
    fn clock(&self) -> Option<usize> {
        None
    }

    /// Returns −Ψ(x) φ(x), ν entries, which points back to φ = 0 and vanishes there.
    ///
    /// Along ẋ = A ξ + λ · correction, which is KR18 (8) with Λ = λ I, φ decays like exp(−λ t).
    fn correction(&self, x: &Self::Coordinates) -> Self::Coordinates {
        let mut towards = x.clone();
        manifold::correction(self.blocks(), towards.as_mut());
        towards
    }

    /// Returns max |φ(x)| over the constraints.
    fn constraint_norm(&self, x: &Self::Coordinates) -> Self::Scalar {
        manifold::defect(self.blocks(), x.as_ref())
    }

    /// Returns the same −Ψ(x) φ(x) as [`correction`](System::correction), which integrators add to x after every step
    /// to return to φ = 0; `None` if the charts preserve all of φ = 0 by themselves.
    #[inline]
    fn project_coordinates(&self, x: &Self::Coordinates) -> Option<Self::Coordinates> {
        let _ = x;
        None
    }

    /// Returns the displacement along A, in units of velocity times time, that closes to first order the loops that
    /// multipliers enforce; `None` if there are no such loops.
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

    /// Returns the velocities with B(x) ξ = 0 that are nearest to ξ in the kinetic-energy metric, for the constraints
    /// that multipliers enforce; `None` if there are no such constraints.
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

    /// Returns ν zeros.
    #[inline(always)]
    fn zero_coordinates(&self) -> Self::Coordinates {
        Store::zeros(manifold::coordinates(self.blocks()))
    }

    /// Returns a zero for each entry of ξ. The default for storage of variable length has as many entries as a chart
    /// vector; a system with another number of velocities returns its own list.
    #[inline(always)]
    fn zero_velocities(&self) -> Self::Velocities {
        Store::zeros(manifold::chart(self.blocks()))
    }

    /// Returns a chart vector of zeros.
    #[inline(always)]
    fn zero_chart(&self) -> Self::Chart {
        Store::zeros(manifold::chart(self.blocks()))
    }

    /// Returns inputs that are all zero. The default for storage of variable length has no entries; a system with
    /// inputs returns its own list.
    #[inline(always)]
    fn zero_inputs(&self) -> Self::Inputs {
        Store::zeros(0)
    }
}

/// A system that also provides its kinetic and potential energy.
///
/// [`Monitor`](crate::Monitor) compares T + V along a run;
/// [`BackwardEuler`](crate::methods::BackwardEuler) and [`StiffEuler`](crate::methods::StiffEuler) take inertia from T.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// # hamel::rigid_eom! {
/// #     system Pendulum {
/// #         coord q;
/// #         velocity w;
/// #         rate q = w;
/// #         kinetic w^2 / 2;
/// #         potential -cos(q);
/// #         input tau;
/// #         generalized force w = tau;
/// #         start q = 1;
/// #     }
/// # }
///
/// use hamel::{Energies, State};
///
/// fn energy<Sys: Energies<Scalar = f64>>(system: &Sys, state: &State<Sys>) -> f64 {
///     system.kinetic_energy(&state.x, &state.xi) + system.potential_energy(&state.x)
/// }
///
/// let pendulum = Pendulum::<f64>::default();
/// assert_eq!(energy(&pendulum, &State::start(&pendulum)), -1.0_f64.cos());
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "the energies of `{Self}` are not known",
    label = "a monitor needs T and V, and implicit methods need T",
    note = "implement `hamel::Energies`; generated systems have it unless a `generate` list leaves the energies out"
)]
pub trait Energies: System {
    /// Returns the kinetic energy T = ½ ξᵀ M(x) ξ, or T₂ + T₁ + T₀ if ẋ has terms without ξ.
    fn kinetic_energy(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Scalar;

    /// Returns the potential energy V(x), up to a constant.
    fn potential_energy(&self, x: &Self::Coordinates) -> Self::Scalar;
}
