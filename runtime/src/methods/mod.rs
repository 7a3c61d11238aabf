//! The methods, one per file: what each is good for, its order, its cost.
//!
//! All of them are types that implement [`Method`]: a step from one
//! [`State`] to the next. What a method needs beyond
//! [`System`] it names as a bound, so that a system that cannot be run by it is an
//! error of the compiler.
//!
//! | method | order | for |
//! |---|---|---|
//! | [`Rkmk4`] | 4 | any system; stays on the manifold |
//! | [`Splitting`] | 2, 4, 6 | bodies in potentials ([`Split`](crate::Split)): the most accurate per evaluation |
//! | [`Free`] | exact | bodies without forces, at any time |
//! | [`Lgvi`] | 2 | bodies in potentials; the variational reference |
//! | [`Gauss4`], [`Gauss6`] | 4, 6 | long runs of systems with M(x) ([`Canonical`](crate::Canonical)); implicit |
//! | [`Rk4`], [`Rk4Projected`] | 4 | baselines on the coordinates x |
//! | [`Slide`], [`Buss`] | 1, 2, 4 | baselines that keep R P |

pub mod free;
pub mod gauss;
pub mod general;
pub mod lgvi;
mod phase;
pub mod rk4;
pub mod rkmk4;
pub mod scheme;
pub mod splitting;
pub mod world;

pub use free::Free;
pub use gauss::{Gauss4, Gauss6};
pub use general::General;
pub use lgvi::Lgvi;
pub use rk4::{Rk4, Rk4Projected};
pub use rkmk4::Rkmk4;
pub use scheme::Scheme;
pub use splitting::Splitting;
pub use world::{Buss, Slide};

use crate::error::StepError;
use crate::state::State;
use crate::system::System;

/// A one-step method for systems of the type `Sys`.
pub trait Method<Sys: System + ?Sized> {
    /// The order p: the error at a fixed time is O(hᵖ).
    fn order(&self) -> u32;

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
}

impl<Sys: System + ?Sized, M: Method<Sys> + ?Sized> Method<Sys> for &M {
    fn order(&self) -> u32 {
        (**self).order()
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
}
