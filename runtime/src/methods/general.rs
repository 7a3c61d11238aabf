//! A method for any system, chosen at run time.

use crate::error::StepError;
use crate::methods::{Method, Rk4, Rk4Projected, Rkmk4};
use crate::state::State;
use crate::system::System;

/// The methods that need nothing but [`System`], as one type.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum General {
    /// [`Rkmk4`]
    Rkmk4,
    /// [`Rk4`]
    Rk4 {
        /// λ ≥ 0 in 1/time.
        lambda: f64,
    },
    /// [`Rk4Projected`]
    Rk4Projected,
}

/// Calls the same function of the method that is meant.
macro_rules! each {
    ($general:expr, $method:ident => $call:expr) => {
        match $general {
            General::Rkmk4 => {
                let $method = Rkmk4;
                $call
            }
            General::Rk4 { lambda } => {
                let $method = Rk4 { lambda: *lambda };
                $call
            }
            General::Rk4Projected => {
                let $method = Rk4Projected;
                $call
            }
        }
    };
}

impl<Sys: System + ?Sized> Method<Sys> for General {
    fn order(&self) -> u32 {
        each!(self, method => Method::<Sys>::order(&method))
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
        each!(self, method => method.step(system, state, h, inputs))
    }
}
