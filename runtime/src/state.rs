//! The state of a run.

use core::fmt;

use crate::error::StepError;
use crate::manifold;
use crate::store::is_finite;
use crate::system::System;

/// State of a system: time, coordinates and velocities.
///
/// Time is an `f64` whatever the scalar type: it is common to all lanes, and an `f32` clock would stop advancing in
/// steps of 1 ms after some hours.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// # hamel::rigid_eom! {
/// #     system Pendulum {
/// #         coord q;
/// #         velocity w;
/// #         rate q = w;
/// #         kinetic w^2 / 2;
/// #         potential -cos(q);
/// #         input tau;
/// #         generalized force w = tau;
/// #         start q = 1;
/// #     }
/// # }
///
/// use hamel::State;
///
/// let pendulum = Pendulum::<f64>::default();
/// let mut state = State::start(&pendulum);
/// assert_eq!((state.t, state.x, state.xi), (0.0, [1.0], [0.0]));
/// // Fields may be set, by name or by place.
/// state.xi[0] = 2.0;
/// let same = State { t: 0.0, ..State::from(PendulumState { w: 2.0, ..Default::default() }) };
/// assert_eq!(state.xi, same.xi);
/// # let _: State<Pendulum<f64>> = same;
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
pub struct State<Sys: System + ?Sized> {
    /// Time, in the unit of the description (s in SI).
    pub t: f64,
    /// Configuration coordinates x, ν entries.
    pub x: Sys::Coordinates,
    /// Velocity coordinates ξ, n entries.
    pub xi: Sys::Velocities,
}

impl<Sys: System + ?Sized> State<Sys> {
    /// Returns the initial state of the description, at t = 0.
    pub fn start(system: &Sys) -> Self {
        let (x, xi) = system.start();
        Self { t: 0.0, x, xi }
    }

    /// Returns whether time and every entry of x and ξ are finite.
    #[inline]
    pub fn is_finite(&self) -> bool {
        self.t.is_finite() && is_finite(self.x.as_ref()) && is_finite(self.xi.as_ref())
    }

    /// Checks that x, ξ and chart vectors have the lengths that the system expects, as every [`Method`](crate::Method)
    /// does before a step.
    ///
    /// # Errors
    /// [`StepError::Shape`] for the first list of a wrong length.
    #[inline]
    pub fn check_shape(&self, system: &Sys) -> Result<(), StepError> {
        let blocks = system.blocks();
        let checks = [
            (
                "coordinates",
                manifold::coordinates(blocks),
                self.x.as_ref().len(),
            ),
            (
                "velocities",
                system.zero_velocities().as_ref().len(),
                self.xi.as_ref().len(),
            ),
            (
                "chart",
                manifold::chart(blocks),
                system.zero_chart().as_ref().len(),
            ),
        ];
        for (part, expected, found) in checks {
            if expected != found {
                return Err(StepError::Shape {
                    part,
                    expected,
                    found,
                });
            }
        }
        Ok(())
    }
}

impl<Sys: System + ?Sized> Clone for State<Sys> {
    fn clone(&self) -> Self {
        Self {
            t: self.t,
            x: self.x.clone(),
            xi: self.xi.clone(),
        }
    }
}

impl<Sys: System + ?Sized> fmt::Debug for State<Sys> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("State")
            .field("t", &self.t)
            .field("x", &self.x)
            .field("xi", &self.xi)
            .finish()
    }
}
