//! How well a run keeps energy and constraints.

use crate::scalar::Scalar;
use crate::state::State;
use crate::system::System;

/// The largest deviation of the energy T + V and the largest violation of the constraints, over all observed states.
///
/// T + V is conserved only if there is no dissipation and neither inputs nor other loads do work. Once a value is NaN it
/// remains NaN, so that a run that went wrong cannot look well.
#[derive(Clone, Copy, Debug)]
pub struct Monitor<S> {
    initial: S,
    deviation: S,
    scale: S,
    constraint: S,
}

impl<S: Scalar> Monitor<S> {
    /// Starts with the energy at `state`.
    pub fn new<Sys>(system: &Sys, state: &State<Sys>) -> Self
    where
        Sys: System<Scalar = S> + ?Sized,
    {
        let kinetic = system.kinetic_energy(&state.x, &state.xi);
        let initial = kinetic + system.potential_energy(&state.x);
        Self {
            initial,
            deviation: S::default(),
            scale: Scalar::max(initial.abs(), kinetic),
            constraint: system.constraint_norm(&state.x),
        }
    }

    /// Takes one more state into account.
    #[inline]
    pub fn observe<Sys>(&mut self, system: &Sys, state: &State<Sys>)
    where
        Sys: System<Scalar = S> + ?Sized,
    {
        let kinetic = system.kinetic_energy(&state.x, &state.xi);
        let potential = system.potential_energy(&state.x);
        self.note(kinetic, potential, system.constraint_norm(&state.x));
    }

    /// The same for T, V and the largest |φ| of a state.
    #[inline]
    pub fn note(&mut self, kinetic: S, potential: S, constraint: S) {
        let energy = kinetic + potential;
        let gained = energy - self.initial;
        self.deviation = Scalar::max(self.deviation, gained.abs());
        // Energy that the run has made of nothing is no measure of what it should be.
        self.scale = Scalar::max(self.scale, kinetic - gained.max(S::default()));
        self.constraint = Scalar::max(self.constraint, constraint);
    }

    /// E₀, the energy T + V of the first state.
    pub fn initial_energy(&self) -> S {
        self.initial
    }

    /// max |T + V − E₀|, in units of energy.
    pub fn energy_deviation(&self) -> S {
        self.deviation
    }

    /// max |T + V − E₀| divided by the larger of |E₀| and the largest kinetic energy seen, minus the increase of T + V
    /// up to then. E₀ alone would not do as a scale, since V has a free constant and E₀ may be zero. Zero for a system
    /// that never moves, and infinite where all energy of a run has come from outside: there is nothing that it could
    /// be compared with.
    pub fn relative_energy_deviation(&self) -> S {
        let (zero, infinity) = (S::default(), S::from_f64(f64::INFINITY));
        let ratio = self.deviation / self.scale;
        // Without a change it is the change itself, which may be NaN: so may the scale, which must not become zero.
        let still = self.scale.select_lt(infinity, self.deviation, ratio);
        zero.select_lt(self.deviation, ratio, still)
    }

    /// max |φ(x)| over all constraints and states.
    pub fn constraint(&self) -> S {
        self.constraint
    }
}
