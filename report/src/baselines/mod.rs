//! Baselines: methods that are measured to show what they lose, and are not for use.
//!
//! | method | order | what it shows |
//! |---|---|---|
//! | [`ForwardEuler`] | 1 | Euler's explicit steps |
//! | [`Rk4Projected`] | 4 | the coordinates x as if they were free, projected after each step |
//! | [`Rk4Added`] | 2 | rotations without dexpinv |
//! | [`Slide`], [`Buss`] | 1, 2, 4 | rotations that keep R P, but not the energy |
//!
//! They implement [`Method`] as those of the runtime do, by its public interface alone.

mod angular_momentum;
mod euler;
mod phase;
mod rk4_added;
mod rk4_projected;
mod step;

pub use angular_momentum::{Buss, Slide};
pub use euler::ForwardEuler;
pub use rk4_added::Rk4Added;
pub use rk4_projected::Rk4Projected;

use hamel::{Method, State, StepError, System};

/// The baselines that need nothing but [`System`], as one type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Baseline {
    /// [`ForwardEuler`]
    ForwardEuler,
    /// [`Rk4Projected`]
    Rk4Projected,
    /// [`Rk4Added`]
    Rk4Added,
}

impl Baseline {
    /// All of them.
    pub const ALL: &[Self] = &[Self::ForwardEuler, Self::Rk4Projected, Self::Rk4Added];
}

impl<Sys: System + ?Sized> Method<Sys> for Baseline {
    fn order(&self) -> u32 {
        match self {
            Self::ForwardEuler => Method::<Sys>::order(&ForwardEuler),
            Self::Rk4Projected => Method::<Sys>::order(&Rk4Projected),
            Self::Rk4Added => Method::<Sys>::order(&Rk4Added),
        }
    }

    /// They are here to show what is not led back, or is in other ways.
    #[inline]
    fn preserves_constraints(&self) -> bool {
        true
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
        match self {
            Self::ForwardEuler => ForwardEuler.step(system, state, h, inputs),
            Self::Rk4Projected => Rk4Projected.step(system, state, h, inputs),
            Self::Rk4Added => Rk4Added.step(system, state, h, inputs),
        }
    }
}
