//! Steps with slopes: the derivative of the map that a method makes of states, on the manifold.
//!
//! A step Φ of length h takes (x, ξ, z) to (x⁺, ξ⁺, z⁺) at inputs u held over the step. Displacements are measured
//! by δx = A(x) η and read by η⁺ = Y(x⁺) δx⁺, Y A = I, so that
//!
//! (η⁺, δξ⁺, δz⁺) = A_d (η, δξ, δz) + B_d δu
//!
//! has no redundant direction, whatever coordinates x are. A_d and B_d are those of the discrete map itself, not of
//! a truncated variational equation: the step is made in dual numbers. A system without displacements of its own has
//! none: where x has ν entries and A has n columns, η has n.

use crate::dual::Dual;
use crate::error::StepError;
use crate::integrate::step;
use crate::methods::Method;
use crate::scalar::Scalar;
use crate::state::State;
use crate::store::Table;
use crate::system::System;

/// Dual numbers of any number of directions.
pub trait Directions: Scalar {
    /// Values and slopes.
    type Value: Scalar;

    /// A number that varies with these slopes along the first directions.
    fn varying(value: Self::Value, slopes: &[Self::Value]) -> Self;

    /// A number that varies with slope 1 along one direction.
    fn along(value: Self::Value, direction: usize) -> Self;

    /// Its value.
    fn value(&self) -> Self::Value;

    /// Its slopes.
    fn slopes(&self) -> &[Self::Value];
}

impl<S: Scalar, const N: usize> Directions for Dual<S, N> {
    type Value = S;

    #[inline]
    fn varying(value: S, slopes: &[S]) -> Self {
        let mut dual = Dual::constant(value);
        for (own, slope) in dual.slopes.iter_mut().zip(slopes) {
            *own = *slope;
        }
        dual
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
}

/// A system whose steps have slopes; generated code implements it where `linearize` is asked for.
pub trait Tangent: System {
    /// Numbers with a slope for each entry of η, ξ, z and u, in this order.
    type Number: Directions<Value = Self::Scalar>;
    /// The same system in such numbers.
    type Dual: System<Scalar = Self::Number>;
    /// A(x), ν rows.
    type Frame: Table<Self::Scalar>;
    /// Y(x), a row for each entry of η.
    type Coframe: Table<Self::Scalar>;
    /// [A_d B_d]: rows of η⁺, ξ⁺ and z⁺, columns of η, ξ, z and u.
    type Slopes: Table<Self::Scalar>;

    /// The system in dual numbers, its parameters constant.
    fn dual(&self) -> Self::Dual;

    /// A(x), by rows: δx = A η.
    fn frame(&self, x: &Self::Coordinates) -> Self::Frame;

    /// Y(x), by rows: η = Y δx.
    fn coframe(&self, x: &Self::Coordinates) -> Self::Coframe;
}

/// A step of length `h` from a state at inputs that are held, and its slopes [A_d B_d].
///
/// Every method that runs the system in dual numbers will do; nothing is allocated. Constraints that multipliers keep
/// are projected on as in [`step`], slopes with them. Implicit methods end where value and slopes have converged as
/// they do, quadratically. Cost: that of a step in dual numbers of n_η + n + n_z + m directions.
///
/// # Errors
/// Those of [`step`].
pub fn step_slopes<Sys, M>(
    method: &M,
    system: &Sys,
    state: &State<Sys>,
    u: &Sys::Inputs,
    h: f64,
) -> Result<(State<Sys>, Sys::Slopes), StepError>
where
    Sys: Tangent,
    M: Method<Sys::Dual>,
{
    state.check_shape(system)?;
    let mut slopes = Sys::Slopes::zero();
    let dual = system.dual();
    let frame = system.frame(&state.x);
    let displacements = slopes.rows() - state.xi.as_ref().len();
    let mut varied = State::<Sys::Dual> {
        t: state.t,
        x: dual.zero_coordinates(),
        xi: dual.zero_velocities(),
    };
    let x = varied.x.as_mut().iter_mut().zip(state.x.as_ref());
    for (i, (varied, value)) in x.enumerate() {
        *varied = Sys::Number::varying(*value, frame.row(i));
    }
    let xi = varied.xi.as_mut().iter_mut().zip(state.xi.as_ref());
    for (i, (varied, value)) in xi.enumerate() {
        *varied = Sys::Number::along(*value, displacements + i);
    }
    let mut held = dual.zero_inputs();
    let first = slopes.rows();
    for (i, (varied, value)) in held.as_mut().iter_mut().zip(u.as_ref()).enumerate() {
        *varied = Sys::Number::along(*value, first + i);
    }
    step(&dual, method, &mut varied, h, &|_, _, _| held.clone())?;
    let next = varied;
    let mut end = State::<Sys> {
        t: next.t,
        x: system.zero_coordinates(),
        xi: system.zero_velocities(),
    };
    for (value, number) in end.x.as_mut().iter_mut().zip(next.x.as_ref()) {
        *value = number.value();
    }
    for (value, number) in end.xi.as_mut().iter_mut().zip(next.xi.as_ref()) {
        *value = number.value();
    }
    let coframe = system.coframe(&end.x);
    for i in 0..displacements {
        let row = slopes.row_mut(i);
        for (factor, number) in coframe.row(i).iter().zip(next.x.as_ref()) {
            for (sum, slope) in row.iter_mut().zip(number.slopes()) {
                *sum = factor.mul_add(*slope, *sum);
            }
        }
    }
    for (i, number) in next.xi.as_ref().iter().enumerate() {
        let row = slopes.row_mut(displacements + i);
        row.iter_mut()
            .zip(number.slopes())
            .for_each(|(entry, slope)| *entry = *slope);
    }
    Ok((end, slopes))
}
