//! How far a run strays from what is conserved.

use crate::scalar::Scalar;
use crate::state::State;
use crate::system::System;

/// Largest drift of the energy T + V and largest constraint defect over the states observed.
///
/// T + V is conserved only without dissipation, inputs and other loads that do work. A NaN stays.
#[derive(Clone, Copy, Debug)]
pub struct Monitor<S> {
    initial: S,
    deviation: S,
    scale: S,
    constraint: S,
}

impl<S: Scalar> Monitor<S> {
    /// Starts at `state`.
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

    /// Takes a further state into account.
    #[inline]
    pub fn observe<Sys>(&mut self, system: &Sys, state: &State<Sys>)
    where
        Sys: System<Scalar = S> + ?Sized,
    {
        let kinetic = system.kinetic_energy(&state.x, &state.xi);
        let energy = kinetic + system.potential_energy(&state.x);
        let gained = energy - self.initial;
        self.deviation = Scalar::max(self.deviation, gained.abs());
        // Energy that the run has made of nothing is no measure of what it should be.
        self.scale = Scalar::max(self.scale, kinetic - gained.max(S::default()));
        self.constraint = Scalar::max(self.constraint, system.constraint_norm(&state.x));
    }

    /// T + V of the first state.
    pub fn initial_energy(&self) -> S {
        self.initial
    }

    /// max |T + V − E₀|
    pub fn energy_deviation(&self) -> S {
        self.deviation
    }

    /// max |T + V − E₀| over the larger of |E₀| and the largest kinetic energy seen, without what T + V
    /// has gained by then: V has a free constant, so that E₀ alone may be zero. Zero for a system that
    /// never moves.
    pub fn relative_energy_deviation(&self) -> S {
        let zero = S::default();
        // The second selection is for a scale of NaN, which must not become zero.
        let ratio = self.deviation / self.scale;
        zero.select_lt(
            self.scale,
            ratio,
            self.scale.select_lt(S::from_f64(1.0), zero, ratio),
        )
    }

    /// max |φ(x)|
    pub fn constraint(&self) -> S {
        self.constraint
    }
}
