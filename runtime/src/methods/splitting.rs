//! Splitting methods for bodies in potentials: kicks by the forces between free motions in closed form.
//!
//! T(p) + V(x) is split into its two terms, whose flows are known, and the flows are composed. The methods are
//! symplectic and symmetric: energy errors do not grow, vertical momentum is conserved to rounding, and a step of −h
//! returns to the start. A kick takes one evaluation of the forces, no linear algebra and no iteration. For tops near a
//! steady spin the free flow accounts for most of the motion, and steps of several radians are usual.

use crate::error::StepError;
use crate::flows::Flow;
use crate::methods::Method;
use crate::methods::phase::Phase;
use crate::methods::scheme::Scheme;
use crate::split::Split;
use crate::state::State;

/// Splitting method of order 2, 4 or 6; for systems that implement [`Split`].
///
/// A step evaluates the forces [`Scheme::drifts`] + 1 times, the last time at the point where the next step starts: a
/// run by [`integrate`](crate::integrate()) reuses that evaluation. Torques that depend on velocities are not of this
/// form: u is evaluated with the momenta at the kick, so that inputs depending on ξ lower the order.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// # hamel::rigid_eom! {
/// #     system Body {
/// #         param Theta: sym3 = [[2.1, 0.1, 0], [0.1, 1.7, 0], [0, 0, 1.2]];
/// #         coord R: SO3;
/// #         velocity w: vec3;
/// #         rate R = R * hat(w);
/// #         frame hull = pose(R, [0, 0, 0]);
/// #         body on hull { mass 1; inertia Theta about origin; }
/// #         start w = [0.01, 2, 0.01];
/// #     }
/// # }
///
/// use hamel::methods::{Scheme, Splitting};
/// use hamel::{Monitor, Run, State};
///
/// let body = Body::<f64>::default();
/// let mut monitor = Monitor::new(&body, &State::start(&body));
/// let run = Run::new(&body).method(Splitting::new(&body, Scheme::Nystrom4)).step(0.1);
/// run.observe(|state| monitor.observe(&body, state)).until(100.0)?;
/// assert!(monitor.relative_energy_deviation() < 1e-12);
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Splitting {
    /// Scheme by which kicks and drifts are composed.
    pub scheme: Scheme,
    /// Free flow. A flow of order 2 keeps the order of the scheme only for compositions of Strang steps.
    pub flow: Flow,
    /// Whether this flow is exact for all rotors of the system.
    exact: bool,
}

impl Splitting {
    /// Creates the method with the free flow that suits the scheme: closed forms for the Nyström schemes; for
    /// compositions of Strang steps, turns about axes if a rotor has no symmetry.
    pub fn new<Sys: Split + ?Sized>(system: &Sys, scheme: Scheme) -> Self {
        let flow = if scheme.composes_steps() {
            Flow::Turns
        } else {
            Flow::Exact
        };
        Self::with_flow(system, scheme, flow)
    }

    /// Creates the method with a given free flow.
    pub fn with_flow<Sys: Split + ?Sized>(system: &Sys, scheme: Scheme, flow: Flow) -> Self {
        let rotors = system.rotors();
        Self {
            scheme,
            flow,
            exact: rotors.as_ref().iter().all(|rotor| flow.is_exact(rotor)),
        }
    }
}

impl<Sys: Split + ?Sized> Method<Sys> for Splitting {
    fn order(&self) -> u32 {
        if self.exact || self.scheme.composes_steps() {
            self.scheme.order()
        } else {
            2
        }
    }

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
        self.step_reusing_force(system, state, h, inputs, &mut None)
    }

    #[inline]
    fn step_reusing_force<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
        force: &mut Option<Sys::Chart>,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        let mut phase = Phase::new(system, state)?;
        let mut last = force.take().unwrap_or_else(|| phase.force(inputs));
        phase.push(self.scheme.kick(0) * h, &last);
        for index in 0..self.scheme.drifts() {
            phase.drift(self.scheme.drift(index) * h, &self.flow);
            if index + 1 == self.scheme.drifts() {
                phase.arrive();
            }
            last = phase.force(inputs);
            phase.push(self.scheme.kick(index + 1) * h, &last);
        }
        let next = phase.state(h)?;
        *force = Some(last);
        Ok(next)
    }
}
