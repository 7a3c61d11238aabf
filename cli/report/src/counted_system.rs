//! A system that counts the evaluations of its forces.

use hamel::{Block, Canonical, Energies, Singular, Split, System};
use std::cell::Cell;

/// A system that counts the evaluations of ξ̇ ([`System::forward_dynamics`]), of forces ([`Split::kick`]) and of ṗ
/// ([`Canonical::momentum_rate`]), whose cost grows with the loads of a scene.
///
/// All calls are forwarded; counting costs well below a nanosecond a call.
#[derive(Debug)]
pub struct CountedSystem<'a, Sys: ?Sized> {
    system: &'a Sys,
    evaluations: Cell<u64>,
}

impl<'a, Sys: ?Sized> CountedSystem<'a, Sys> {
    /// Wraps a system, with a count of zero.
    pub fn new(system: &'a Sys) -> Self {
        Self {
            system,
            evaluations: Cell::new(0),
        }
    }

    /// Returns the evaluations since the start, or since the last [reset](Self::reset).
    pub fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    /// Sets the count to zero.
    pub fn reset(&self) {
        self.evaluations.set(0);
    }

    /// Returns the wrapped system.
    pub fn inner(&self) -> &'a Sys {
        self.system
    }

    #[inline]
    fn count(&self) {
        self.evaluations.set(self.evaluations.get() + 1);
    }
}

impl<Sys: System + ?Sized> System for CountedSystem<'_, Sys> {
    type Scalar = Sys::Scalar;
    type Coordinates = Sys::Coordinates;
    type Velocities = Sys::Velocities;
    type Chart = Sys::Chart;
    type Inputs = Sys::Inputs;

    #[inline]
    fn blocks(&self) -> &[Block] {
        self.system.blocks()
    }

    #[inline]
    fn zero_coordinates(&self) -> Self::Coordinates {
        self.system.zero_coordinates()
    }

    #[inline]
    fn zero_velocities(&self) -> Self::Velocities {
        self.system.zero_velocities()
    }

    #[inline]
    fn zero_chart(&self) -> Self::Chart {
        self.system.zero_chart()
    }

    #[inline]
    fn zero_inputs(&self) -> Self::Inputs {
        self.system.zero_inputs()
    }

    #[inline]
    fn start(&self) -> (Self::Coordinates, Self::Velocities) {
        self.system.start()
    }

    #[inline]
    fn clock(&self) -> Option<usize> {
        self.system.clock()
    }

    #[inline]
    fn rate(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Coordinates {
        self.system.rate(x, xi)
    }

    #[inline]
    fn chart_rate(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Chart {
        self.system.chart_rate(x, xi)
    }

    #[inline]
    fn forward_dynamics(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
        u: &Self::Inputs,
    ) -> Result<Self::Velocities, Singular> {
        self.count();
        self.system.forward_dynamics(x, xi, u)
    }

    #[inline]
    fn correction(&self, x: &Self::Coordinates) -> Self::Coordinates {
        self.system.correction(x)
    }

    #[inline]
    fn project_coordinates(&self, x: &Self::Coordinates) -> Option<Self::Coordinates> {
        self.system.project_coordinates(x)
    }

    #[inline]
    fn project_position(
        &self,
        x: &Self::Coordinates,
    ) -> Result<Option<Self::Velocities>, Singular> {
        self.system.project_position(x)
    }

    #[inline]
    fn project_velocity(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
    ) -> Result<Option<Self::Velocities>, Singular> {
        self.system.project_velocity(x, xi)
    }

    #[inline]
    fn constraint_norm(&self, x: &Self::Coordinates) -> Self::Scalar {
        self.system.constraint_norm(x)
    }
}

impl<Sys: Energies + ?Sized> Energies for CountedSystem<'_, Sys> {
    #[inline]
    fn kinetic_energy(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Scalar {
        self.system.kinetic_energy(x, xi)
    }

    #[inline]
    fn potential_energy(&self, x: &Self::Coordinates) -> Self::Scalar {
        self.system.potential_energy(x)
    }
}

impl<Sys: Split + ?Sized> Split for CountedSystem<'_, Sys> {
    type Rotors = Sys::Rotors;

    const FREE: bool = Sys::FREE;

    #[inline]
    fn rotors(&self) -> Self::Rotors {
        self.system.rotors()
    }

    #[inline]
    fn centre(&self, x: &Self::Coordinates) -> Self::Coordinates {
        self.system.centre(x)
    }

    #[inline]
    fn uncentre(&self, y: &Self::Coordinates) -> Self::Coordinates {
        self.system.uncentre(y)
    }

    #[inline]
    fn split_momenta(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Chart {
        self.system.split_momenta(x, xi)
    }

    #[inline]
    fn split_velocities(&self, x: &Self::Coordinates, p: &Self::Chart) -> Self::Velocities {
        self.system.split_velocities(x, p)
    }

    #[inline]
    fn kick(&self, x: &Self::Coordinates, u: &Self::Inputs) -> Self::Chart {
        self.count();
        self.system.kick(x, u)
    }
}

impl<Sys: Canonical + ?Sized> Canonical for CountedSystem<'_, Sys> {
    #[inline]
    fn momentum(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Velocities {
        self.system.momentum(x, xi)
    }

    #[inline]
    fn momentum_rate(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
        u: &Self::Inputs,
    ) -> Self::Velocities {
        self.count();
        self.system.momentum_rate(x, xi, u)
    }

    #[inline]
    fn velocity_from_momentum(
        &self,
        x: &Self::Coordinates,
        p: &Self::Velocities,
    ) -> Result<Self::Velocities, Singular> {
        self.system.velocity_from_momentum(x, p)
    }
}
