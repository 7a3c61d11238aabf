//! The integration methods, one per file, with their purpose, order and cost.
//!
//! All of them are types that implement [`Method`]: a step from one [`State`] to the next. Whatever a method needs
//! beyond [`System`] is a trait bound, so that applying it to an unsuitable system is a compile-time error.
//!
//! | method | order | for |
//! |---|---|---|
//! | [`Rkmk4`], [`Cf4`] | 4 | any system; x stays on the manifold |
//! | [`Rkmk54`] | 5 | any system; errors of 1e-4 to 1e-8 |
//! | [`Rkmk8`] | 8 | any system; errors below 1e-6 |
//! | [`tableau::Rkmk`] | any | other explicit tableaux, on the manifold |
//! | [`Splitting`] | 2, 4, 6 | bodies in potentials ([`Split`](crate::Split)): the most accurate per evaluation |
//! | [`Free`] | exact | bodies without forces; gives the state at any time |
//! | [`Lgvi`] | 2 | bodies in potentials; the variational reference |
//! | [`Gauss4`], [`Gauss6`] | 4, 6 | long runs of systems whose M depends on x ([`Canonical`](crate::Canonical)); implicit |
//! | [`Rk4`] | 4 | initial states off the manifold, which a stabilising term leads back to it; steps the coordinates x |
//! | [`BackwardEuler`] | 1 | implicit; damps fast motions, and slow ones as well |
//! | [`StiffEuler`] | 1 | the same step by Newton's method, with a linearisation ([`Tangent`]); many stiff directions |
//! | [`SemiImplicitEuler`] | 1 | short steps, such as those of controllers; one evaluation |
//!
//! [`Adaptive`](crate::adaptive::Adaptive) runs [`Rkmk54`] and [`Rkmk8`] with step-size control.
//!
//! ```
//! # #[cfg(feature = "macros")] {
//! # hamel::rigid_eom! {
//! #     system Pendulum {
//! #         coord q;
//! #         velocity w;
//! #         rate q = w;
//! #         kinetic w^2 / 2;
//! #         potential -cos(q);
//! #         input tau;
//! #         generalized force w = tau;
//! #         start q = 1;
//! #     }
//! # }
//!
//! use hamel::methods::{BackwardEuler, Gauss4, Rkmk4, Rkmk8, SemiImplicitEuler};
//! use hamel::{Method, Run, StepError};
//!
//! let pendulum = Pendulum::<f64>::default();
//! fn end<M: Method<Pendulum<f64>>>(system: &Pendulum<f64>, method: M) -> Result<f64, StepError> {
//!     Ok(Run::new(system).method(method).step(0.01).until(1.0)?.x[0])
//! }
//!
//! let exact = end(&pendulum, Rkmk8)?;
//! assert!((end(&pendulum, Rkmk4)? - exact).abs() < 1e-9);
//! assert!((end(&pendulum, Gauss4)? - exact).abs() < 1e-9);
//! assert!((end(&pendulum, SemiImplicitEuler)? - exact).abs() < 1e-2);
//! assert!((end(&pendulum, BackwardEuler)? - exact).abs() < 1e-2);
//! # }
//! # Ok::<(), hamel::StepError>(())
//! ```

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
    /// Returns the order p: the error at a fixed time is O(hᵖ).
    fn order(&self) -> u32;

    /// Returns whether the method itself keeps x near φ(x) = 0 over long runs.
    ///
    /// Symmetric methods do, but lose this property if x is corrected after each step. For all other methods, x is
    /// corrected towards φ(x) = 0 after each step ([`System::project_coordinates`]).
    #[inline]
    fn preserves_constraints(&self) -> bool {
        false
    }

    /// Returns the state one step of length `h` after `state`; `h` may have either sign or be zero. `inputs(t, x, ξ)`
    /// returns u.
    ///
    /// The result is not projected onto the constraints that multipliers enforce; [`step`](crate::step) and
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

    /// Makes a [`step`](Self::step) that follows another of the same run, reusing the last evaluation of the forces.
    ///
    /// `force` holds the force at the start of this step, as the previous step left it, and receives the force at its
    /// end. A method that evaluates the force at both ends of a step thus saves one evaluation. Other methods do not
    /// touch it.
    ///
    /// `force` has to be `None` for the first step, and whenever anything else has changed the state.
    ///
    /// # Errors
    /// Those of [`step`](Self::step).
    #[inline]
    fn step_reusing_force<U>(
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

/// A method that moves x only through the chart, so that every point it evaluates lies on the manifold, and that has no
/// memory: the slopes of its steps can be computed ([`step_slopes`](crate::step_slopes)). [`Rk4`], in contrast, moves
/// the entries of x.
#[diagnostic::on_unimplemented(
    message = "steps of `{Self}` have no slopes",
    label = "it evaluates points off the manifold",
    note = "use `Rkmk4`, or another method that implements `InChart`"
)]
pub trait InChart {
    /// Makes a step and writes its slopes: by matrix products if the method and the system allow it, otherwise in dual
    /// numbers.
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
    fn preserves_constraints(&self) -> bool {
        (**self).preserves_constraints()
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
    fn step_reusing_force<U>(
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
        (**self).step_reusing_force(system, state, h, inputs, force)
    }
}

/// Returns the state at the end of a step of length `h` from `state`, given (x, ξ): normalises x, to remove the drift
/// off the manifold that rounding causes.
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
    // Tests before the state is built, since a built state would have to be moved once more.
    if t.is_finite() && is_finite(x.as_ref()) && is_finite(xi.as_ref()) {
        Ok(State { t, x, xi })
    } else {
        Err(StepError::NonFinite { time: state.t })
    }
}
