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
//! | [`Rk4`], [`Rk4Projected`] | 4 | baselines on the coordinates x |

pub mod general;
pub mod rk4;
pub mod rkmk4;

pub use general::General;
pub use rk4::{Rk4, Rk4Projected};
pub use rkmk4::Rkmk4;

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
