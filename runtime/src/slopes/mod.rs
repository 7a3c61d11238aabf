//! Steps with slopes: the derivative of the map that a method makes of states, on the manifold.
//!
//! A step Φ of length h takes (x, ξ, z) to (x⁺, ξ⁺, z⁺) at inputs u held over the step. Displacements are measured
//! by δx = A(x) η and read by η⁺ = Y(x⁺) δx⁺, Y A = I, so that
//!
//! (η⁺, δξ⁺, δz⁺) = A_d (η, δξ, δz) + B_d δu
//!
//! has no redundant direction, whatever coordinates x are. A_d and B_d are those of the discrete map itself, not of
//! a truncated variational equation: the step is made in dual numbers, with the emitted linearisation for the slopes
//! of ξ̇, which is several times shorter than ξ̇ in such numbers. Explicit methods multiply matrices instead where
//! coordinates are plain and ẋ = ξ, and so does the semi-implicit Euler method wherever no multiplier is
//! ([`TangentStep`]).

mod matrices;

pub use matrices::TangentStep;

use crate::dual::Dual;
use crate::error::{Singular, StepError};
use crate::methods::{InChart, Method};
use crate::scalar::Scalar;
use crate::split::Split;
use crate::state::State;
use crate::store::Table;
use crate::system::{Block, System};

/// Dual numbers of any number of directions.
pub trait Directions: Scalar {
    /// Values and slopes.
    type Value: Scalar;

    /// Makes it a number that varies with these slopes along the first directions, in place.
    fn vary(&mut self, value: Self::Value, slopes: &[Self::Value]);

    /// A number that varies with slope 1 along one direction.
    fn along(value: Self::Value, direction: usize) -> Self;

    /// Its value.
    fn value(&self) -> Self::Value;

    /// Its slopes.
    fn slopes(&self) -> &[Self::Value];

    /// Adds a multiple of the slopes of another number.
    fn follow(&mut self, factor: Self::Value, other: &Self);

    /// Adds to the slope along one direction.
    fn lean(&mut self, by: Self::Value, direction: usize);

    /// Whether the slopes are 1 along one direction and 0 along all others.
    fn is_along(&self, direction: usize) -> bool;
}

/// Whether all lanes are 0.
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
    fn follow(&mut self, factor: S, other: &Self) {
        for (own, slope) in self.slopes.iter_mut().zip(&other.slopes) {
            *own = factor.mul_add(*slope, *own);
        }
    }

    #[inline]
    fn lean(&mut self, by: S, direction: usize) {
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

/// What is known of matrices when code is generated: for each row the entries that are not 0, and which of them can be
/// told apart along one direction.
///
/// Source: A. R. Curtis, M. J. D. Powell, J. K. Reid, *On the estimation of sparse Jacobian matrices*, J. Inst. Maths
/// Applics 13 (1974).
#[derive(Clone, Copy, Debug)]
pub struct Sparsity {
    /// Of the rows of the frame A(x).
    pub frame: &'static [&'static [usize]],
    /// Of the rows of the coframe Y(x).
    pub coframe: &'static [&'static [usize]],
    /// The entries of (η, ξ, z) that each displacement depends on at the end of a motion along the chart rate.
    pub motion: &'static [&'static [usize]],
    /// The direction along which each entry of (η, ξ, z) varies in compressed numbers: entries that no row of `motion`
    /// contains together may share one.
    pub seeds: &'static [usize],
}

/// A system whose steps have slopes; generated code implements it where `linearize` is asked for.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no linearisation",
    label = "slopes and `StiffEuler` need it",
    note = "ask for it in the description: `generate all, linearize;`"
)]
pub trait Tangent: System + Clone {
    /// Whether the coordinate kinds alone keep φ(x) = 0: all that a method moves in the chart then lies on the
    /// manifold, where the linearisation holds.
    const CHARTED: bool;
    /// Whether a step ends with a projection, on constraints that multipliers keep.
    const PROJECTED: bool;
    /// Whether all coordinates are plain numbers with ẋ = ξ, and nothing is projected: explicit methods then take
    /// matrices in the place of dual numbers.
    const PLAIN: bool;

    /// Which entries of A, of Y and of the slopes of a motion along the chart rate are not 0.
    const SPARSITY: Sparsity;

    /// Numbers with a slope for each entry of η, ξ, z and u, in this order.
    type Number: Directions<Value = Self::Scalar>;
    /// The same system in such numbers.
    type Dual: System<Scalar = Self::Number>;
    /// Numbers with a slope for each direction of the seeds.
    type CompressedNumber: Directions<Value = Self::Scalar>;
    /// The same system in compressed numbers.
    type Compressed: System<Scalar = Self::CompressedNumber>;
    /// A(x), ν rows.
    type Frame: Table<Self::Scalar>;
    /// Y(x), a row for each entry of η.
    type Coframe: Table<Self::Scalar>;
    /// [A B] and [A_d B_d]: rows of η, ξ and z, columns of η, ξ, z and u.
    type Slopes: Table<Self::Scalar>;

    /// The system in dual numbers, its parameters constant.
    fn dual(&self) -> Self::Dual;

    /// The system in compressed numbers, its parameters constant.
    fn compressed(&self) -> Self::Compressed;

    /// A(x), by rows: δx = A η.
    fn frame(&self, x: &Self::Coordinates) -> Self::Frame;

    /// Y(x), by rows: η = Y δx.
    fn coframe(&self, x: &Self::Coordinates) -> Self::Coframe;

    /// ξ̇, and [A B] of the motion, d/dt (η, δξ, δz) = A (η, δξ, δz) + B δu, which is written to `slopes`.
    ///
    /// # Errors
    /// Those of [`accel`](System::accel).
    fn slopes(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
        u: &Self::Inputs,
        slopes: &mut Self::Slopes,
    ) -> Result<Self::Velocities, Singular>;
}

/// The state at the end of a step, and the slopes [A_d B_d] of the step.
pub type Stepped<Sys> = Result<(State<Sys>, <Sys as Tangent>::Slopes), StepError>;

/// A system in dual numbers, with the slopes of ξ̇ from its linearisation.
#[derive(Clone, Debug)]
pub struct TangentSystem<Sys: Tangent> {
    system: Sys,
    dual: Sys::Dual,
    compressed: Sys::Compressed,
}

impl<Sys: Tangent> TangentSystem<Sys> {
    /// Of a system at its parameters.
    pub fn new(system: &Sys) -> Self {
        TangentSystem {
            system: system.clone(),
            dual: system.dual(),
            compressed: system.compressed(),
        }
    }

    /// The system, in numbers without slopes.
    pub(crate) fn plain(&self) -> &Sys {
        &self.system
    }
}

/// The values of numbers.
pub(crate) fn values<N: Directions>(values: &mut [N::Value], numbers: &[N]) {
    for (value, number) in values.iter_mut().zip(numbers) {
        *value = number.value();
    }
}

/// Entry i of η = Y δx, without a value, of coordinates that vary.
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
            sum.follow(*factor, moved);
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

    /// ξ̇ + ∂ξ̇/∂(η, ξ, z, u) of the displacements Y δx and of what ξ, z and u vary by; where coordinates may be off the
    /// manifold, ξ̇ in dual numbers.
    fn accel(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
        u: &Self::Inputs,
    ) -> Result<Self::Velocities, Singular> {
        if !Sys::CHARTED {
            return self.dual.accel(x, xi, u);
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
            // At the start of a step all vary by themselves, and inputs always do.
            let alone = by.is_along(column);
            for (i, number) in result.as_mut().iter_mut().enumerate() {
                match table.row(displacements + i).get(column) {
                    Some(slope) if alone => number.lean(*slope, column),
                    Some(slope) if !is_zero(*slope) => number.follow(*slope, by),
                    _ => {}
                }
            }
        };
        // Many forces depend on no place.
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

/// A step of length `h` from a state at inputs that are held, and its slopes [A_d B_d].
///
/// Works with every method that moves coordinates in the chart, and allocates nothing, except in
/// [`BackwardEuler`](crate::methods::BackwardEuler) where a system is stiff. Constraints that multipliers keep are
/// projected on as in [`step`](crate::step()), slopes with them. Implicit methods end where slopes have converged, too.
/// A run of many steps makes [`TangentSystem`] once and calls [`step_slopes_into`].
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
    // What methods make by matrices needs no dual numbers there.
    match Sys::PLAIN {
        true => step(None),
        false => step(Some(&TangentSystem::new(system))),
    }
}

/// Coordinates that vary along the frame of displacements.
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

/// The same of a system that is in dual numbers already; [A_d B_d] is written to `slopes`, whatever it was.
///
/// # Errors
/// Those of [`step`](crate::step()); `slopes` then has no meaning.
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
