//! Monitoring of energy and constraints along a run.

use crate::scalar::Scalar;
use crate::state::State;
use crate::system::Energies;

/// Records the largest deviation of the energy T + V and the largest violation of the constraints, over all observed
/// states.
///
/// T + V is conserved only if there is no dissipation and neither inputs nor other loads do work. Once a value is NaN
/// it remains NaN, so that a run that failed cannot look good.
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
/// use hamel::{Monitor, Run, State, methods::Rkmk8};
///
/// let pendulum = Pendulum::<f64>::default();
/// let mut monitor = Monitor::new(&pendulum, &State::start(&pendulum));
/// let run = Run::new(&pendulum).method(Rkmk8).step(0.01);
/// run.observe(|state| monitor.observe(&pendulum, state)).until(10.0)?;
/// assert!(monitor.relative_energy_deviation() < 1e-12);
/// assert_eq!(monitor.constraint(), 0.0);
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Monitor<S> {
    initial: S,
    deviation: S,
    scale: S,
    constraint: S,
}

impl<S: Scalar> Monitor<S> {
    /// Creates a monitor whose reference is the energy at `state`.
    pub fn new<Sys>(system: &Sys, state: &State<Sys>) -> Self
    where
        Sys: Energies<Scalar = S> + ?Sized,
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

    /// Records one more state.
    #[inline]
    pub fn observe<Sys>(&mut self, system: &Sys, state: &State<Sys>)
    where
        Sys: Energies<Scalar = S> + ?Sized,
    {
        let kinetic = system.kinetic_energy(&state.x, &state.xi);
        let potential = system.potential_energy(&state.x);
        self.note(kinetic, potential, system.constraint_norm(&state.x));
    }

    /// Records one more state, given its T, V and largest |φ|.
    #[inline]
    pub fn note(&mut self, kinetic: S, potential: S, constraint: S) {
        let energy = kinetic + potential;
        let gained = energy - self.initial;
        self.deviation = Scalar::max(self.deviation, gained.abs());
        // Energy that the run gained must not enlarge the scale by which this very gain is judged.
        self.scale = Scalar::max(self.scale, kinetic - gained.max(S::default()));
        self.constraint = Scalar::max(self.constraint, constraint);
    }

    /// Returns E₀, the energy T + V of the first state.
    pub fn initial_energy(&self) -> S {
        self.initial
    }

    /// Returns max |T + V − E₀|, in units of energy.
    pub fn energy_deviation(&self) -> S {
        self.deviation
    }

    /// Returns max |T + V − E₀| divided by an energy scale.
    ///
    /// The scale is the largest of |E₀| and, over all observed states, the kinetic energy less any increase of T + V up
    /// to then. E₀ alone is not suitable as a scale, since V is defined up to a constant and E₀ may be zero. The result
    /// is zero for a system that never moves, and infinite if all energy of a run has come from outside, since then
    /// there is no energy to compare with.
    pub fn relative_energy_deviation(&self) -> S {
        let (zero, infinity) = (S::default(), S::from_f64(f64::INFINITY));
        let ratio = self.deviation / self.scale;
        // Without a deviation the result is the deviation itself, zero or NaN. A scale of NaN also gives NaN, not zero.
        let still = self.scale.select_lt(infinity, self.deviation, ratio);
        zero.select_lt(self.deviation, ratio, still)
    }

    /// Returns max |φ(x)| over all constraints and states.
    pub fn constraint(&self) -> S {
        self.constraint
    }
}
