//! The methods, one per file: what each is good for, its order, its cost.
//!
//! All of them are types that implement [`Method`]: a step from one
//! [`State`] to the next. What a method needs beyond
//! [`System`] it names as a bound, so that a system that cannot be run by it is an
//! error of the compiler.
//!
//! | method | order | for |
//! |---|---|---|
//! | [`Rkmk4`], [`Cf4`] | 4 | any system; stay on the manifold |
//! | [`Rkmk54`] | 5 | any system; errors of 1e-4 to 1e-8 |
//! | [`Rkmk8`] | 8 | any system; errors below 1e-6 |
//! | [`tableau::Rkmk`] | any | other explicit tableaux, on the manifold |
//! | [`Splitting`] | 2, 4, 6 | bodies in potentials ([`Split`](crate::Split)): the most accurate per evaluation |
//! | [`Free`] | exact | bodies without forces, at any time |
//! | [`Lgvi`] | 2 | bodies in potentials; the variational reference |
//! | [`Gauss4`], [`Gauss6`] | 4, 6 | long runs of systems with M(x) ([`Canonical`](crate::Canonical)); implicit |
//! | [`Rk4`] | 4 | starts off the manifold, which the stabilising term leads back; on the coordinates x |
//! | [`BackwardEuler`] | 1 | implicit: damps whatever is fast, and all else as well |
//! | [`StiffEuler`] | 1 | the same step of systems with a linearisation ([`Tangent`]), by Newton's method: of many stiff directions |
//! | [`SemiImplicitEuler`] | 1 | short steps of controllers; one evaluation |
//!
//! [`Adaptive`](crate::adaptive::Adaptive) chooses the steps of [`Rkmk54`] and [`Rkmk8`] itself.

mod backward_euler;
mod cf4;
mod factors;
pub mod free;
mod gauss;
mod general;
mod implicit;
mod lgvi;
mod phase;
mod rk4;
mod rkmk4;
pub mod rkmk54;
pub mod rkmk8;
mod scheme;
mod semi_implicit_euler;
mod splitting;
mod stiff_euler;
pub mod tableau;

pub use backward_euler::BackwardEuler;
pub use cf4::Cf4;
pub use free::Free;
pub use gauss::{Gauss4, Gauss6};
pub use general::General;
pub use lgvi::Lgvi;
pub use rk4::Rk4;
pub use rkmk4::Rkmk4;
pub use rkmk8::Rkmk8;
pub use rkmk54::Rkmk54;
pub use scheme::Scheme;
pub use semi_implicit_euler::SemiImplicitEuler;
pub use splitting::Splitting;
pub use stiff_euler::StiffEuler;

use crate::error::StepError;
use crate::manifold;
use crate::slopes::{Tangent, TangentStep};
use crate::state::State;
use crate::store::is_finite;
use crate::system::System;

/// A one-step method for systems of the type `Sys`.
pub trait Method<Sys: System + ?Sized> {
    /// The order p: the error at a fixed time is O(hᵖ).
    fn order(&self) -> u32;

    /// Whether x stays near φ(x) = 0 over long runs by the method itself. Symmetric methods do that, and lose it where x is
    /// moved after each step; x is led back after the steps of all others ([`System::project_coordinates`]).
    #[inline]
    fn stays_near(&self) -> bool {
        false
    }

    /// The state one step of length `h` after `state`, with `h` of either sign or zero.
    /// `inputs(t, x, ξ)` gives u.
    ///
    /// Constraints kept by multipliers are not projected on; [`step`](crate::step) and
    /// [`integrate`](crate::integrate()) do that.
    ///
    /// # Errors
    /// See [`StepError`].
    fn step<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs;

    /// A [`step`](Self::step) that follows another of the same run. `force` is the force at its start, where
    /// the step before has left it, and takes the one at its end: a method that evaluates both does so once
    /// for two steps. Others leave it alone.
    ///
    /// `force` has to be `None` for the first step, and after the state was moved by anything else.
    ///
    /// # Errors
    /// Those of [`step`](Self::step).
    #[inline]
    fn follow<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
        force: &mut Option<Sys::Chart>,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        let _ = force;
        self.step(system, state, h, inputs)
    }
}

/// A method that moves x in the chart alone, so that all that it evaluates lies on the manifold, and that has no
/// memory: its steps have slopes ([`step_slopes`](crate::step_slopes)). [`Rk4`] moves the entries of x.
#[diagnostic::on_unimplemented(
    message = "steps of `{Self}` have no slopes",
    label = "it evaluates points off the manifold",
    note = "take `Rkmk4`, or another method that implements `InChart`"
)]
pub trait InChart {
    /// A step whose slopes are written: by matrices, where the method can and the system allows it, else in dual numbers.
    ///
    /// # Errors
    /// Those of [`step`](crate::step()).
    #[inline]
    fn step_slopes<Sys: Tangent>(
        &self,
        step: &TangentStep<'_, Sys>,
        slopes: &mut Sys::Slopes,
        in_dual_numbers: impl FnOnce(&mut Sys::Slopes) -> Result<State<Sys>, StepError>,
    ) -> Result<State<Sys>, StepError> {
        let _ = step;
        in_dual_numbers(slopes)
    }
}

impl InChart for BackwardEuler {}
impl InChart for Cf4 {}
impl InChart for Free {}
impl InChart for Lgvi {}
impl InChart for Splitting {}
impl InChart for StiffEuler {}

impl<M: InChart + ?Sized> InChart for &M {
    #[inline]
    fn step_slopes<Sys: Tangent>(
        &self,
        step: &TangentStep<'_, Sys>,
        slopes: &mut Sys::Slopes,
        in_dual_numbers: impl FnOnce(&mut Sys::Slopes) -> Result<State<Sys>, StepError>,
    ) -> Result<State<Sys>, StepError> {
        (**self).step_slopes(step, slopes, in_dual_numbers)
    }
}

impl<Sys: System + ?Sized, M: Method<Sys> + ?Sized> Method<Sys> for &M {
    fn order(&self) -> u32 {
        (**self).order()
    }

    #[inline]
    fn stays_near(&self) -> bool {
        (**self).stays_near()
    }

    #[inline]
    fn step<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        (**self).step(system, state, h, inputs)
    }

    #[inline]
    fn follow<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
        force: &mut Option<Sys::Chart>,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        (**self).follow(system, state, h, inputs, force)
    }
}

/// The end of a step of length `h` from `state`: (x, ξ), with x brought back onto its manifold from
/// what rounding did.
#[inline]
pub(crate) fn arrive<Sys: System + ?Sized>(
    system: &Sys,
    state: &State<Sys>,
    h: f64,
    mut x: Sys::Coordinates,
    xi: Sys::Velocities,
) -> Result<State<Sys>, StepError> {
    manifold::normalise(system.blocks(), x.as_mut());
    let t = state.t + h;
    // Before the state is there, which would be moved once more.
    if t.is_finite() && is_finite(x.as_ref()) && is_finite(xi.as_ref()) {
        Ok(State { t, x, xi })
    } else {
        Err(StepError::NonFinite { time: state.t })
    }
}
