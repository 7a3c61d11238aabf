//! Baselines: methods that are measured to show their defects, not meant for use.
//!
//! | method | order | choice |
//! |---|---|---|
//! | [`ForwardEuler`] | 1 | Euler's explicit steps |
//! | [`Rk4Projected`] | 4 | coordinates x treated as free, projected after each step |
//! | [`Rk4Added`] | 2 | rotations without dexpinv |
//! | [`Slide`], [`Buss`] | 1, 2, 4 | rotations that conserve R P, but not the energy |
//!
//! They implement [`Method`] like the methods of the runtime, through its public interface only.

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

/// Methods for any [`System`] that are kept to show a defect: Euler's method, which gains energy, and Runge-Kutta methods
/// that project rotations, or add angular velocities in different axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BaselineMethod {
    /// [`ForwardEuler`]
    ForwardEuler,
    /// [`Rk4Projected`]
    Rk4Projected,
    /// [`Rk4Added`]
    Rk4Added,
}

impl BaselineMethod {
    /// All integration methods for any system that are kept only to show a defect, without [`Slide`] and [`Buss`], which
    /// step rotations only.
    pub const ALL: &[Self] = &[Self::ForwardEuler, Self::Rk4Projected, Self::Rk4Added];
}

impl<Sys: System + ?Sized> Method<Sys> for BaselineMethod {
    fn order(&self) -> u32 {
        match self {
            Self::ForwardEuler => Method::<Sys>::order(&ForwardEuler),
            Self::Rk4Projected => Method::<Sys>::order(&Rk4Projected),
            Self::Rk4Added => Method::<Sys>::order(&Rk4Added),
        }
    }

    /// Returns true, so that no run stabilises them: baselines show their drift, or project by themselves.
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
