//! States and inputs at which systems are timed.

use hamel::{Scalar, System, manifold};

/// The arguments of forward dynamics.
pub struct Input<S: System> {
    pub x: S::Coordinates,
    pub xi: S::Velocities,
    pub u: S::Inputs,
}

/// The start displaced along its manifold, with different velocities and loads for every k.
pub fn input<S: System>(system: &S, k: usize) -> Input<S> {
    let fill = |list: &mut [S::Scalar], first: usize| {
        for (i, entry) in list.iter_mut().enumerate() {
            *entry = S::Scalar::from_f64(((k * 37 + (first + i) * 11) as f64 * 0.618).sin());
        }
    };
    let (mut x, mut xi) = system.start();
    let (mut chart, mut u) = (system.zero_chart(), system.zero_inputs());
    fill(chart.as_mut(), 0);
    fill(xi.as_mut(), 100);
    fill(u.as_mut(), 200);
    manifold::retract(system.blocks(), x.as_mut(), chart.as_ref());
    Input { x, xi, u }
}
