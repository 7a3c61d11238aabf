//! Slopes of steps: the derivative, on the manifold, of the map from one state to the next that a method defines.
//!
//! A step Φ of length h takes (x, ξ, z) to (x⁺, ξ⁺, z⁺) with inputs u held over the step. Displacements of the start
//! are expressed by η, δx = A(x) η, and those of the end by η⁺ = Y(x⁺) δx⁺, where Y A = I, so that
//!
//! (η⁺, δξ⁺, δz⁺) = A_d (η, δξ, δz) + B_d δu
//!
//! has no redundant direction, whichever coordinates x are used. A_d and B_d are the derivatives of the discrete map
//! itself, not of a truncated variational equation. The step is made in dual numbers, in which the slopes of ξ̇ come
//! from the generated linearisation; its code is several times shorter than that of ξ̇ in dual numbers. Explicit
//! methods multiply matrices instead if the coordinates are plain and ẋ = ξ, and so does the semi-implicit Euler method
//! if there are no multipliers ([`TangentStep`]).

mod matrices;

pub use matrices::TangentStep;

use crate::dual::Dual;
use crate::error::{Singular, StepError};
use crate::methods::{InChart, Method};
use crate::scalar::Scalar;
use crate::split::Split;
use crate::state::State;
use crate::store::Table;
use crate::system::{Block, Energies, System};

/// Dual numbers with any number of directions.
#[doc(hidden)]
pub trait Directions: Scalar {
    /// Type of the value and of each slope.
    type Value: Scalar;

    /// Sets the number to a value and to slopes along the first directions; all other slopes are zero.
    fn vary(&mut self, value: Self::Value, slopes: &[Self::Value]);

    /// Creates a number with slope 1 along one direction and 0 along all others.
    fn along(value: Self::Value, direction: usize) -> Self;

    /// Returns the value.
    fn value(&self) -> Self::Value;

    /// Returns the slopes.
    fn slopes(&self) -> &[Self::Value];

    /// Adds `factor` times the slopes of another number; the value is unchanged.
    fn add_slopes(&mut self, factor: Self::Value, other: &Self);

    /// Adds to the slope along one direction; the value is unchanged.
    fn add_slope(&mut self, by: Self::Value, direction: usize);

    /// Returns whether the slopes are 1 along one direction and 0 along all others.
    fn is_along(&self, direction: usize) -> bool;
}

/// Returns whether all lanes are 0.
#[inline]
fn is_zero<S: Scalar>(a: S) -> bool {
    a.abs().largest_lane() == 0.0
}

impl<S: Scalar, const N: usize> Directions for Dual<S, N> {
    type Value = S;

    #[inline]
    fn vary(&mut self, value: S, slopes: &[S]) {
        self.value = value;
        let (first, rest) = self.slopes.split_at_mut(slopes.len().min(N));
        for (own, slope) in first.iter_mut().zip(slopes) {
            *own = *slope;
        }
        rest.fill(S::default());
    }

    #[inline]
    fn along(value: S, direction: usize) -> Self {
        Dual::along(value, direction)
    }

    #[inline]
    fn value(&self) -> S {
        self.value
    }

    #[inline]
    fn slopes(&self) -> &[S] {
        &self.slopes
    }

    #[inline]
    fn add_slopes(&mut self, factor: S, other: &Self) {
        for (own, slope) in self.slopes.iter_mut().zip(&other.slopes) {
            *own = factor.mul_add(*slope, *own);
        }
    }

    #[inline]
    fn add_slope(&mut self, by: S, direction: usize) {
        if let Some(slope) = self.slopes.get_mut(direction) {
            *slope += by;
        }
    }

    #[inline]
    fn is_along(&self, direction: usize) -> bool {
        let one = S::from_f64(1.0);
        let mut slopes = self.slopes.iter().enumerate();
        slopes.all(|(i, &slope)| is_zero(if i == direction { slope - one } else { slope }))
    }
}

/// Sparsity of the matrices of a system, known when code is generated: the nonzero entries of each row, and a colouring
/// of the directions for compressed dual numbers.
///
/// Source: A. R. Curtis, M. J. D. Powell, J. K. Reid, *On the estimation of sparse Jacobian matrices*, J. Inst. Maths
/// Applics 13 (1974).
#[derive(Clone, Copy, Debug)]
#[doc(hidden)]
pub struct Sparsity {
    /// Nonzero entries of each row of the frame A(x).
    pub frame: &'static [&'static [usize]],
    /// Nonzero entries of each row of the coframe Y(x).
    pub coframe: &'static [&'static [usize]],
    /// For each displacement at the end of a motion along the chart rate, the entries of (η, ξ, z) on which it depends.
    pub motion: &'static [&'static [usize]],
    /// For each entry of (η, ξ, z), its direction in compressed numbers: entries that do not occur together in any row
    /// of `motion` may share a direction.
    pub seeds: &'static [usize],
}

/// A system whose steps have slopes; generated code implements it if the description asks for `linearize`.
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
/// #         generate all, linearize;
/// #     }
/// # }
///
/// use hamel::{State, Tangent};
///
/// let pendulum = Pendulum::<f64>::default();
/// let State { x, xi, .. } = State::start(&pendulum);
/// let mut slopes = [[0.0; 3]; 2];
/// let accel = pendulum.slopes(&x, &xi, &[0.0], &mut slopes)?;
/// assert_eq!(accel, [-1.0_f64.sin()]);
/// // d(δw)/dt = −cos(q) δq + δτ.
/// assert_eq!(slopes[1], [-1.0_f64.cos(), 0.0, 1.0]);
/// # }
/// # Ok::<(), hamel::Singular>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no linearisation",
    label = "slopes and `StiffEuler` need it",
    note = "add it to the description: `generate all, linearize;`"
)]
pub trait Tangent: Energies + Clone {
    /// Whether the kinds of coordinates alone keep φ(x) = 0: then all points that a method reaches in the chart lie on
    /// the manifold, where the linearisation is valid.
    const CHARTED: bool;
    /// Whether a step ends with a projection onto constraints that multipliers enforce.
    const PROJECTED: bool;
    /// Whether all coordinates are plain numbers with ẋ = ξ, and nothing is projected: explicit methods then use
    /// matrices instead of dual numbers.
    const PLAIN: bool;

    /// Nonzero entries of A, of Y and of the slopes of a motion along the chart rate.
    const SPARSITY: Sparsity;

    /// Dual numbers with a slope for each entry of η, ξ, z and u, in this order.
    type Number: Directions<Value = Self::Scalar>;
    /// The same system in these dual numbers.
    type Dual: Energies<Scalar = Self::Number>;
    /// Compressed dual numbers, with a slope for each direction that occurs in [`Sparsity::seeds`].
    type CompressedNumber: Directions<Value = Self::Scalar>;
    /// The same system in compressed numbers.
    type Compressed: System<Scalar = Self::CompressedNumber>;
    /// Storage of A(x), ν rows.
    type Frame: Table<Self::Scalar>;
    /// Storage of Y(x), a row for each entry of η.
    type Coframe: Table<Self::Scalar>;
    /// Storage of `[A B]` and `[A_d B_d]`: rows of η, ξ and z, columns of η, ξ, z and u.
    type Slopes: Table<Self::Scalar>;

    /// Returns the system in dual numbers, with constant parameters.
    fn dual(&self) -> Self::Dual;

    /// Returns the system in compressed dual numbers, with constant parameters.
    fn compressed(&self) -> Self::Compressed;

    /// Returns A(x), by rows: δx = A η.
    fn frame(&self, x: &Self::Coordinates) -> Self::Frame;

    /// Returns Y(x), by rows: η = Y δx.
    fn coframe(&self, x: &Self::Coordinates) -> Self::Coframe;

    /// Returns ξ̇, and writes the linearisation `[A B]` of the motion, d/dt (η, δξ, δz) = A (η, δξ, δz) + B δu, to
    /// `slopes`.
    ///
    /// # Errors
    /// Those of [`forward_dynamics`](System::forward_dynamics).
    fn slopes(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
        u: &Self::Inputs,
        slopes: &mut Self::Slopes,
    ) -> Result<Self::Velocities, Singular>;
}

/// State at the end of a step, and the slopes `[A_d B_d]` of the step.
pub type Stepped<Sys> = Result<(State<Sys>, <Sys as Tangent>::Slopes), StepError>;

/// A system in dual numbers, with the slopes of ξ̇ from its linearisation.
#[derive(Clone, Debug)]
pub struct TangentSystem<Sys: Tangent> {
    system: Sys,
    dual: Sys::Dual,
    compressed: Sys::Compressed,
}

impl<Sys: Tangent> TangentSystem<Sys> {
    /// Creates the dual system of a system with its current parameters.
    pub fn new(system: &Sys) -> Self {
        TangentSystem {
            system: system.clone(),
            dual: system.dual(),
            compressed: system.compressed(),
        }
    }

    /// Returns the system in numbers without slopes.
    pub(crate) fn plain(&self) -> &Sys {
        &self.system
    }
}

/// Copies the values of dual numbers.
pub(crate) fn values<N: Directions>(values: &mut [N::Value], numbers: &[N]) {
    for (value, number) in values.iter_mut().zip(numbers) {
        *value = number.value();
    }
}

/// Returns entry i of η = Y δx, where δx are the slopes of the coordinates; the value of the result is zero.
#[inline]
fn displacement<Sys, N>(coframe: &Sys::Coframe, i: usize, x: &[N]) -> N
where
    Sys: Tangent,
    N: Directions<Value = Sys::Scalar>,
{
    let mut sum = N::default();
    for &entry in Sys::SPARSITY.coframe.get(i).copied().unwrap_or_default() {
        if let Some(factor) = coframe.row(i).get(entry)
            && let Some(moved) = x.get(entry)
        {
            sum.add_slopes(*factor, moved);
        }
    }
    sum
}

impl<Sys: Tangent> System for TangentSystem<Sys> {
    type Scalar = Sys::Number;
    type Coordinates = <Sys::Dual as System>::Coordinates;
    type Velocities = <Sys::Dual as System>::Velocities;
    type Chart = <Sys::Dual as System>::Chart;
    type Inputs = <Sys::Dual as System>::Inputs;

    fn blocks(&self) -> &[Block] {
        self.dual.blocks()
    }

    fn zero_coordinates(&self) -> Self::Coordinates {
        self.dual.zero_coordinates()
    }

    fn zero_velocities(&self) -> Self::Velocities {
        self.dual.zero_velocities()
    }

    fn zero_chart(&self) -> Self::Chart {
        self.dual.zero_chart()
    }

    fn zero_inputs(&self) -> Self::Inputs {
        self.dual.zero_inputs()
    }

    fn start(&self) -> (Self::Coordinates, Self::Velocities) {
        self.dual.start()
    }

    fn clock(&self) -> Option<usize> {
        self.dual.clock()
    }

    fn rate(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Coordinates {
        self.dual.rate(x, xi)
    }

    fn chart_rate(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Chart {
        self.dual.chart_rate(x, xi)
    }

    /// Returns ξ̇ with slopes ∂ξ̇/∂(η, ξ, z, u) times those of the displacements Y δx and of ξ, z and u; if coordinates
    /// may be off the manifold, evaluates ξ̇ in dual numbers instead.
    fn forward_dynamics(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
        u: &Self::Inputs,
    ) -> Result<Self::Velocities, Singular> {
        if !Sys::CHARTED {
            return self.dual.forward_dynamics(x, xi, u);
        }
        let system = &self.system;
        let mut here = system.zero_coordinates();
        values(here.as_mut(), x.as_ref());
        let mut velocities = system.zero_velocities();
        values(velocities.as_mut(), xi.as_ref());
        let mut inputs = system.zero_inputs();
        values(inputs.as_mut(), u.as_ref());
        let mut table = Sys::Slopes::zero();
        let rates = system.slopes(&here, &velocities, &inputs, &mut table)?;
        let coframe = system.coframe(&here);
        let displacements = table.rows() - rates.as_ref().len();
        let mut result = self.zero_velocities();
        for (number, rate) in result.as_mut().iter_mut().zip(rates.as_ref()) {
            number.vary(*rate, &[]);
        }
        let mut follow = |column: usize, by: &Sys::Number| {
            // At the start of a step each entry varies along its own direction alone, and inputs always do.
            let alone = by.is_along(column);
            for (i, number) in result.as_mut().iter_mut().enumerate() {
                match table.row(displacements + i).get(column) {
                    Some(slope) if alone => number.add_slope(*slope, column),
                    Some(slope) if !is_zero(*slope) => number.add_slopes(*slope, by),
                    _ => {}
                }
            }
        };
        // Columns of displacements are often zero: many forces do not depend on position.
        let is_felt = |column: usize| {
            let mut rows = displacements..table.rows();
            rows.any(|i| {
                table
                    .row(i)
                    .get(column)
                    .is_some_and(|slope| !is_zero(*slope))
            })
        };
        for j in (0..displacements).filter(|&j| is_felt(j)) {
            follow(j, &displacement::<Sys, _>(&coframe, j, x.as_ref()));
        }
        for (j, by) in xi.as_ref().iter().chain(u.as_ref()).enumerate() {
            follow(displacements + j, by);
        }
        Ok(result)
    }

    fn correction(&self, x: &Self::Coordinates) -> Self::Coordinates {
        self.dual.correction(x)
    }

    fn project_coordinates(&self, x: &Self::Coordinates) -> Option<Self::Coordinates> {
        self.dual.project_coordinates(x)
    }

    fn project_position(
        &self,
        x: &Self::Coordinates,
    ) -> Result<Option<Self::Velocities>, Singular> {
        self.dual.project_position(x)
    }

    fn project_velocity(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
    ) -> Result<Option<Self::Velocities>, Singular> {
        self.dual.project_velocity(x, xi)
    }

    fn constraint_norm(&self, x: &Self::Coordinates) -> Self::Scalar {
        self.dual.constraint_norm(x)
    }
}

impl<Sys: Tangent> Energies for TangentSystem<Sys> {
    fn kinetic_energy(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Scalar {
        self.dual.kinetic_energy(x, xi)
    }

    fn potential_energy(&self, x: &Self::Coordinates) -> Self::Scalar {
        self.dual.potential_energy(x)
    }
}

impl<Sys: Tangent<Dual: Split>> Split for TangentSystem<Sys> {
    type Rotors = <Sys::Dual as Split>::Rotors;

    const FREE: bool = <Sys::Dual as Split>::FREE;

    fn rotors(&self) -> Self::Rotors {
        self.dual.rotors()
    }

    fn centre(&self, x: &Self::Coordinates) -> Self::Coordinates {
        self.dual.centre(x)
    }

    fn uncentre(&self, y: &Self::Coordinates) -> Self::Coordinates {
        self.dual.uncentre(y)
    }

    fn split_momenta(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Chart {
        self.dual.split_momenta(x, xi)
    }

    fn split_velocities(&self, x: &Self::Coordinates, p: &Self::Chart) -> Self::Velocities {
        self.dual.split_velocities(x, p)
    }

    fn kick(&self, x: &Self::Coordinates, u: &Self::Inputs) -> Self::Chart {
        self.dual.kick(x, u)
    }
}

/// Makes a step of length `h` from a state with constant inputs, and returns it with its slopes `[A_d B_d]`.
///
/// Works with every method that moves coordinates in the chart, and allocates nothing, except in
/// [`BackwardEuler`](crate::methods::BackwardEuler) on a stiff system. The state and its slopes are projected onto the
/// constraints that multipliers enforce, as in [`step`](crate::step()). Implicit methods iterate until the slopes have
/// converged, too. For many steps, create [`TangentSystem`] once and call [`step_slopes_into`].
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
/// #         generate all, linearize;
/// #     }
/// # }
///
/// use hamel::{State, methods::Rkmk4, step_slopes};
///
/// let pendulum = Pendulum::<f64>::default();
/// let start = State::start(&pendulum);
/// let (end, slopes) = step_slopes(&Rkmk4, &pendulum, &start, &[0.0], 0.01)?;
/// assert_eq!(end.t, 0.01);
/// // Rows of q and w, columns of q, w and tau: ∂q⁺/∂w is nearly h.
/// assert!((slopes[0][1] - 0.01).abs() < 1e-6);
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
///
/// # Errors
/// Those of [`step`](crate::step()).
pub fn step_slopes<Sys, M>(
    method: &M,
    system: &Sys,
    state: &State<Sys>,
    u: &Sys::Inputs,
    h: f64,
) -> Stepped<Sys>
where
    Sys: Tangent,
    M: Method<TangentSystem<Sys>> + InChart,
{
    let step = |tangent| {
        let step = TangentStep {
            system,
            tangent,
            state,
            u,
            h,
        };
        let mut slopes = Sys::Slopes::zero();
        let end = step.of(method, &mut slopes)?;
        Ok((end, slopes))
    };
    // For such systems, methods that use matrices need no dual system.
    match Sys::PLAIN {
        true => step(None),
        false => step(Some(&TangentSystem::new(system))),
    }
}

/// Returns the coordinates in dual numbers whose slopes are the frame A(x).
#[inline]
fn varying<Sys: Tangent>(
    tangent: &TangentSystem<Sys>,
    frame: &Sys::Frame,
    x: &Sys::Coordinates,
) -> <TangentSystem<Sys> as System>::Coordinates {
    let mut varied = tangent.zero_coordinates();
    let entries = varied.as_mut().iter_mut().zip(x.as_ref());
    for (i, (number, value)) in entries.enumerate() {
        number.vary(*value, frame.row(i));
    }
    varied
}

/// Makes the step of [`step_slopes`] with a dual system that already exists, and overwrites `slopes` with `[A_d B_d]`.
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
/// #         generate all, linearize;
/// #     }
/// # }
///
/// use hamel::{State, Table, TangentSystem, methods::Rkmk4, step_slopes_into};
///
/// let pendulum = Pendulum::<f64>::default();
/// let tangent = TangentSystem::new(&pendulum);
/// let (mut state, mut slopes) = (State::start(&pendulum), Table::zero());
/// for _ in 0..100 {
///     state = step_slopes_into(&Rkmk4, &tangent, &state, &[0.0], 0.01, &mut slopes)?;
/// }
/// assert!((slopes[0][2] - 0.5e-4).abs() < 1e-8);
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
///
/// # Errors
/// Those of [`step`](crate::step()); the content of `slopes` is then unspecified.
pub fn step_slopes_into<Sys, M>(
    method: &M,
    tangent: &TangentSystem<Sys>,
    state: &State<Sys>,
    u: &Sys::Inputs,
    h: f64,
    slopes: &mut Sys::Slopes,
) -> Result<State<Sys>, StepError>
where
    Sys: Tangent,
    M: Method<TangentSystem<Sys>> + InChart,
{
    let step = TangentStep {
        system: &tangent.system,
        tangent: Some(tangent),
        state,
        u,
        h,
    };
    step.of(method, slopes)
}
