//! Adapter that presents a system as plain ordinary differential equations, for the solvers of other crates.
//!
//! This crate does not contain general stiff solvers of its own. The unknowns are y = (x, ξ), a slice of ν + n numbers;
//! [`OdeEquations`] provides their rates, the product of the Jacobian with a vector, and the conversion of y back to a
//! state. It depends on no solver. The recommended one is `diffsol` (MIT; BDF of variable order, ESDIRK and TR-BDF2
//! with dense output and events, released every few weeks, described in J. Open Source Softw. 11 (2026) 9384):
//! `lab/diffsol` of the repository runs a heavy top and a stiff system with it.
//!
//! A solver does not know the manifold of x. The stabilising term of KR18 (8), ẋ = A ξ − λ Ψ φ, leads back to it, and
//! [`OdeEquations::state`] projects each state onto it. If λ is far above the rates of the motion, the equations are
//! stiff, which stiff solvers handle.
//!
//! ```
//! # #[cfg(feature = "macros")] {
//! # hamel::rigid_eom! {
//! #     system Pendulum {
//! #         coord q;
//! #         velocity w;
//! #         rate q = w;
//! #         kinetic w^2 / 2;
//! #         potential -cos(q);
//! #         input tau;
//! #         generalized force w = tau;
//! #         start q = 1;
//! #     }
//! # }
//!
//! use hamel::{State, adapter::OdeEquations};
//!
//! let pendulum = Pendulum::<f64>::default();
//! let equations = OdeEquations::new(&pendulum, |_, _, _| [0.0], 0.0);
//! let mut y = vec![0.0; equations.unknowns()];
//! equations.write(&State::start(&pendulum), &mut y);
//! // Euler's method, in the place of a solver.
//! let mut y_dot = y.clone();
//! for step in 0..100 {
//!     equations.rates(1e-3 * f64::from(step), &y, &mut y_dot);
//!     y.iter_mut().zip(&y_dot).for_each(|(y, rate)| *y += 1e-3 * rate);
//! }
//! let end = equations.state(0.1, &y)?;
//! assert!(end.x[0] < 1.0);
//! # }
//! # Ok::<(), hamel::StepError>(())
//! ```

use core::cell::Cell;

use crate::adaptive::control::power;
use crate::error::StepError;
use crate::integrate::{acceleration, project, project_coordinates};
use crate::manifold;
use crate::scalar::Scalar;
use crate::state::State;
use crate::store::add_scaled;
use crate::system::System;

/// ẏ = f(t, y): ẋ = A(x) ξ − λ Ψ φ, ξ̇ = M⁻¹ (f − c), for y = (x, ξ).
///
/// At a point where ξ̇ does not exist the rates are NaN: the solver shortens its step or gives up, and
/// [`failure`](Self::failure) returns the cause.
#[derive(Debug)]
pub struct OdeEquations<'s, Sys: ?Sized, U> {
    system: &'s Sys,
    inputs: U,
    lambda: f64,
    failure: Cell<Option<StepError>>,
}

impl<'s, Sys, U> OdeEquations<'s, Sys, U>
where
    Sys: System + ?Sized,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    /// Creates the equations of a system with u = `inputs(t, x, ξ)` and the stabilising rate λ in 1/time: about 10/s,
    /// or 0; negative for runs backwards in time.
    pub fn new(system: &'s Sys, inputs: U, lambda: f64) -> Self {
        Self {
            system,
            inputs,
            lambda,
            failure: Cell::new(None),
        }
    }

    /// Returns the length ν + n of y = (x, ξ), with all entries of x: four of a quaternion, nine of a rotation.
    pub fn unknowns(&self) -> usize {
        let x = self.system.zero_coordinates();
        let xi = self.system.zero_velocities();
        x.as_ref().len() + xi.as_ref().len()
    }

    /// Writes (x, ξ) to y, up to the length of y.
    pub fn write(&self, state: &State<Sys>, y: &mut [Sys::Scalar]) {
        put(y, state.x.as_ref().iter().chain(state.xi.as_ref()).copied());
    }

    /// Converts y to a state, with x on its manifold and on the constraints that multipliers enforce.
    ///
    /// # Errors
    /// [`StepError::Shape`] for a list of the wrong length, [`StepError::NonFinite`] for one that is not finite,
    /// [`StepError::Singular`] if the state cannot be projected onto the constraints.
    pub fn state(&self, t: f64, y: &[Sys::Scalar]) -> Result<State<Sys>, StepError> {
        let (mut x, xi) = self.read(y.iter().copied())?;
        manifold::normalise(self.system.blocks(), x.as_mut());
        let mut state = State { t, x, xi };
        if state.is_finite() {
            project_coordinates(self.system, &mut state);
            project(self.system, &mut state)?;
            Ok(state)
        } else {
            Err(StepError::NonFinite { time: t })
        }
    }

    /// Writes ẏ = f(t, y).
    pub fn rates(&self, t: f64, y: &[Sys::Scalar], y_dot: &mut [Sys::Scalar]) {
        let rates = self
            .read(y.iter().copied())
            .and_then(|(x, xi)| self.evaluate(t, &x, &xi));
        match rates {
            Ok((x, xi)) => put(y_dot, x.as_ref().iter().chain(xi.as_ref()).copied()),
            Err(cause) => self.fail(cause, y_dot),
        }
    }

    /// Writes the product ∂f/∂y v of the Jacobian and a vector, for y = (x, ξ) with all entries of x, by a central
    /// difference.
    ///
    /// The difference is (f(t, y + δ v) − f(t, y − δ v)) / 2δ, with the largest δ that moves no entry by more than
    /// ∛ε (1 + |yᵢ|): accurate to about 1e-10 of the rates, at two evaluations. Entries of y that v does not move may
    /// be arbitrarily large.
    pub fn jacobian_product(
        &self,
        t: f64,
        y: &[Sys::Scalar],
        v: &[Sys::Scalar],
        product: &mut [Sys::Scalar],
    ) {
        let number = Sys::Scalar::from_f64;
        let reach = number(power(Sys::Scalar::EPSILON, 1.0 / 3.0));
        // The entry that moves most relative to its own size determines δ. For v = 0, δ does not matter.
        let zero = Sys::Scalar::default();
        let fastest = y.iter().zip(v).fold(zero, |most, (y, v)| {
            Scalar::max(most, v.magnitude() / (number(1.0) + y.magnitude()))
        });
        let delta = reach / zero.select_lt(fastest, fastest, number(1.0));
        let side = |delta: Sys::Scalar| {
            let entries = y.iter().zip(v).map(|(y, v)| delta.mul_add(*v, *y));
            let (x, xi) = self.read(entries)?;
            self.evaluate(t, &x, &xi)
        };
        match (side(delta), side(-delta)) {
            (Ok((x, xi)), Ok((x_below, xi_below))) => {
                let above = x.as_ref().iter().chain(xi.as_ref());
                let below = x_below.as_ref().iter().chain(xi_below.as_ref());
                let twice = number(2.0) * delta;
                put(product, above.zip(below).map(|(a, b)| (*a - *b) / twice));
            }
            (Err(cause), _) | (_, Err(cause)) => self.fail(cause, product),
        }
    }

    /// Returns the cause of the last failed evaluation; once one was singular, the last singular one.
    pub fn failure(&self) -> Option<StepError> {
        self.failure.get()
    }

    /// Writes NaN for the solver and records the cause. Errors that follow from these NaN do not hide a singular
    /// evaluation.
    fn fail(&self, cause: StepError, rates: &mut [Sys::Scalar]) {
        let known = matches!(self.failure.get(), Some(StepError::Singular { .. }));
        if !known || matches!(cause, StepError::Singular { .. }) {
            self.failure.set(Some(cause));
        }
        rates.fill(Sys::Scalar::from_f64(f64::NAN));
    }

    /// Splits y into (x, ξ).
    fn read(
        &self,
        mut y: impl ExactSizeIterator<Item = Sys::Scalar>,
    ) -> Result<(Sys::Coordinates, Sys::Velocities), StepError> {
        let (found, expected) = (y.len(), self.unknowns());
        if found != expected {
            return Err(StepError::Shape {
                part: "coordinates and velocities",
                expected,
                found,
            });
        }
        let mut x = self.system.zero_coordinates();
        let mut xi = self.system.zero_velocities();
        put(x.as_mut(), y.by_ref());
        put(xi.as_mut(), y);
        Ok((x, xi))
    }

    /// Returns (ẋ, ξ̇).
    fn evaluate(
        &self,
        t: f64,
        x: &Sys::Coordinates,
        xi: &Sys::Velocities,
    ) -> Result<(Sys::Coordinates, Sys::Velocities), StepError> {
        let mut rate = self.system.rate(x, xi);
        if self.lambda != 0.0 {
            add_scaled(
                rate.as_mut(),
                self.lambda,
                self.system.correction(x).as_ref(),
            );
        }
        let accel = acceleration(self.system, t, 0.0, x, xi, &self.inputs)?;
        Ok((rate, accel))
    }
}

/// Writes as many entries as there is room for.
fn put<S>(list: &mut [S], entries: impl Iterator<Item = S>) {
    for (slot, entry) in list.iter_mut().zip(entries) {
        *slot = entry;
    }
}
