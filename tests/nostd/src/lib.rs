//! Generated systems without the standard library: this crate must pass `cargo check` on any target.

#![no_std]
#![deny(warnings)]
#![deny(missing_docs)]
#![forbid(unsafe_code)]

use hamel::methods::Rkmk4;
use hamel::{Run, State, StepError};

hamel::rigid_eom! {
    /// A top on a fixed point, its centre of mass on its axis.
    pub system Top {
        param m = 1, g = 9.81, l = 0.5, J1 = 0.3, J3 = 0.02;
        coord R: SO3;
        velocity w: vec3;
        rate R = R * hat(w);
        frame top = pose(R, [0, 0, 0]);
        body on top { mass m; com [0, 0, l]; inertia diag(J1, J1, J3) about origin; }
        gravity [0, 0, -g];
        start w = [1, 0, 50];
    }
}

hamel::rigid_eom! {
    /// A pole on a cart with a force on the cart.
    pub system Cart {
        param mc = 1, mp = 0.1, l = 0.5, g = 9.81;
        coord p, a: S1;
        velocity v, w;
        rate p = v;
        rate a = w;
        particle mass mc at [p, 0, 0];
        particle mass mp at [p + l * a.s, 0, l * a.c];
        gravity [0, 0, -g];
        input F;
        generalized force v = F;
        start a = 0.1;
    }
}

/// Integrates a spinning top, in single precision.
///
/// # Errors
/// If the integrator fails.
pub fn spin(until: f64) -> Result<State<Top<f32>>, StepError> {
    let top = Top::<f32>::default();
    Run::new(&top).method(Rkmk4).step(1e-3).until(until)
}

/// Takes one step of the cart with a controller as its inputs.
///
/// # Errors
/// If the integrator fails.
pub fn balance(cart: &Cart<f64>, state: &mut State<Cart<f64>>) -> Result<(), StepError> {
    hamel::step(cart, Rkmk4, state, 1e-3, &|_, x: &[f64; 3], xi: &[f64; 2]| {
        [20.0 * x[2] + 3.0 * xi[1]]
    })
}
