//! Building blocks of the steps of baselines.

use hamel::{Scalar, State, StepError, System, manifold};

/// y ← y + a x, element by element.
#[inline]
pub(super) fn add_scaled<S: Scalar>(y: &mut [S], a: S, x: &[S]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y = a.mul_add(*x, *y);
    }
}

/// y ← a y, element by element.
#[inline]
pub(super) fn scale<S: Scalar>(y: &mut [S], a: S) {
    for y in y {
        *y *= a;
    }
}

/// Evaluates ξ̇ at a point of the step that starts at `time`, with the inputs at `time + offset`.
///
/// A pivot that is NaN because the state is NaN is reported as a NaN state.
#[inline]
pub(super) fn acceleration<Sys, U>(
    system: &Sys,
    time: f64,
    offset: f64,
    x: &Sys::Coordinates,
    xi: &Sys::Velocities,
    inputs: &U,
) -> Result<Sys::Velocities, StepError>
where
    Sys: System + ?Sized,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    let u = inputs(time + offset, x, xi);
    system.forward_dynamics(x, xi, &u).map_err(|cause| {
        let mut entries = x.as_ref().iter().chain(xi.as_ref());
        if entries.all(|entry| entry.is_finite()) {
            StepError::Singular { cause, time }
        } else {
            StepError::NonFinite { time }
        }
    })
}

/// Returns the state (x, ξ) after a step of length `h` from `state`, with rounding errors of x removed by projection
/// onto its manifold.
#[inline]
pub(super) fn arrive<Sys: System + ?Sized>(
    system: &Sys,
    state: &State<Sys>,
    h: f64,
    mut x: Sys::Coordinates,
    xi: Sys::Velocities,
) -> Result<State<Sys>, StepError> {
    manifold::normalise(system.blocks(), x.as_mut());
    let t = state.t + h;
    let next = State { t, x, xi };
    if next.is_finite() {
        Ok(next)
    } else {
        Err(StepError::NonFinite { time: state.t })
    }
}
