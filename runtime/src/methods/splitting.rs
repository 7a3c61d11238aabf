//! Bodies in potentials: kicks of the forces between free motions in closed form.
//!
//! T(p) + V(x) is split into its two terms, whose flows are known, and the flows are composed. The
//! methods are symplectic and symmetric: energy errors do not grow, vertical momentum is kept to
//! rounding, a step of −h returns. One evaluation of forces, no linear algebra and no iteration a
//! kick. On tops near a steady spin the free flow does most of the work, and steps of several radians
//! are usual.

use crate::error::StepError;
use crate::flows::Flow;
use crate::methods::Method;
use crate::methods::phase::Phase;
use crate::methods::scheme::Scheme;
use crate::split::Split;
use crate::state::State;

/// Order 2, 4 or 6; for systems that implement [`Split`].
///
/// A step evaluates the forces [`Scheme::drifts`] + 1 times, the last of them at the point where the
/// next step starts; [`run`](Self::run) uses that one again. Torques that depend on velocities are not of
/// this form: u is taken at the momenta of the moment of each kick, so that inputs depending on ξ lower
/// the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Splitting {
    /// The composition.
    pub scheme: Scheme,
    /// The free flow. One of order 2 keeps the order of compositions of Strang steps only.
    pub flow: Flow,
    /// Whether that flow is exact for all rotors of the system.
    exact: bool,
}

impl Splitting {
    /// The composition with the free flow that suits it: closed forms for the Nyström schemes; for
    /// compositions of Strang steps turns about axes where a rotor has no symmetry.
    pub fn new<Sys: Split + ?Sized>(system: &Sys, scheme: Scheme) -> Self {
        let flow = if scheme.composes_steps() {
            Flow::Turns
        } else {
            Flow::Exact
        };
        Self::with_flow(system, scheme, flow)
    }

    /// The composition with a given free flow.
    pub fn with_flow<Sys: Split + ?Sized>(system: &Sys, scheme: Scheme, flow: Flow) -> Self {
        let rotors = system.rotors();
        Self {
            scheme,
            flow,
            exact: rotors.as_ref().iter().all(|rotor| flow.is_exact(rotor)),
        }
    }

    /// Moves `state` by `count` steps of length `h` and calls `observe` after each; the force at the end of
    /// one is that at the start of the next, [`Scheme::drifts`] evaluations a step and one more.
    ///
    /// # Errors
    /// [`StepError::NonFinite`], [`StepError::Shape`]; `state` is then the last valid one.
    pub fn run<Sys, U, O>(
        &self,
        system: &Sys,
        state: &mut State<Sys>,
        h: f64,
        count: u64,
        inputs: &U,
        mut observe: O,
    ) -> Result<(), StepError>
    where
        Sys: Split + ?Sized,
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
        O: FnMut(&State<Sys>),
    {
        let start = state.t;
        let mut force = None;
        for index in 1..=count {
            let (mut next, last) = self.advance(system, state, h, force, inputs)?;
            next.t = start + h * index as f64;
            *state = next;
            force = Some(last);
            observe(state);
        }
        Ok(())
    }

    /// One step, with the force at its start where that is known; and the force at its end.
    #[inline]
    fn advance<Sys, U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        force: Option<Sys::Chart>,
        inputs: &U,
    ) -> Result<(State<Sys>, Sys::Chart), StepError>
    where
        Sys: Split + ?Sized,
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        let mut phase = Phase::new(system, state)?;
        let mut force = force.unwrap_or_else(|| phase.force(inputs));
        phase.push(self.scheme.kick(0) * h, &force);
        for index in 0..self.scheme.drifts() {
            phase.drift(self.scheme.drift(index) * h, &self.flow);
            force = phase.force(inputs);
            phase.push(self.scheme.kick(index + 1) * h, &force);
        }
        Ok((phase.state(h)?, force))
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
        self.advance(system, state, h, None, inputs)
            .map(|(next, _)| next)
    }
}
