//! Mechanisms over other number types: their functions are tapes, which a [`TapeEvaluator`] evaluates.

use super::singular;
use hamel::{Block, Energies, Scalar, Singular, System};
use hamel_codegen::program::Cause;

/// Indices of functions among the tapes, and the shapes of their arguments.
#[derive(Clone, Debug)]
pub struct TapeIndices {
    pub blocks: Vec<Block>,
    pub chart: usize,
    /// Numbers of entries of x, of ξ with z, and of u.
    pub lengths: [usize; 3],
    pub rate: usize,
    pub chart_rate: usize,
    pub accel: usize,
    pub correction: usize,
    pub constraint: usize,
    pub kinetic: usize,
    pub potential: usize,
    /// Whether the correction restores constraints that no chart satisfies.
    pub embedded: bool,
    pub project_position: Option<usize>,
    pub project_velocity: Option<usize>,
}

/// Evaluates the functions of a mechanism, given as tapes, in a number type.
pub trait TapeEvaluator {
    /// The number type.
    type Number: Scalar;

    /// Returns the indices of the functions among the tapes.
    fn indices(&self) -> &TapeIndices;

    /// Evaluates a function for x, ξ and u.
    fn call(
        &self,
        function: usize,
        arguments: [&[Self::Number]; 3],
    ) -> Result<Vec<Self::Number>, Cause>;
}

/// System whose functions are tapes, so that methods can step it in any number type.
pub struct TapeSystem<T>(pub T);

impl<T: TapeEvaluator> TapeSystem<T> {
    /// Evaluates a function with `length` entries; NaN if it has no value.
    fn value(
        &self,
        function: usize,
        length: usize,
        x: &[T::Number],
        xi: &[T::Number],
    ) -> Vec<T::Number> {
        let value = self.0.call(function, [x, xi, &[]]);
        value.unwrap_or_else(|_| vec![T::Number::from_f64(f64::NAN); length])
    }

    fn number(&self, function: usize, x: &[T::Number], xi: &[T::Number]) -> T::Number {
        let value = self.value(function, 1, x, xi).first().copied();
        value.unwrap_or(T::Number::from_f64(f64::NAN))
    }

    fn zeros(length: usize) -> Vec<T::Number> {
        vec![T::Number::default(); length]
    }
}

impl<T: TapeEvaluator> System for TapeSystem<T> {
    type Scalar = T::Number;
    type Coordinates = Vec<T::Number>;
    type Velocities = Vec<T::Number>;
    type Chart = Vec<T::Number>;
    type Inputs = Vec<T::Number>;

    fn blocks(&self) -> &[Block] {
        &self.0.indices().blocks
    }

    fn zero_velocities(&self) -> Self::Velocities {
        Self::zeros(self.0.indices().lengths[1])
    }

    fn zero_inputs(&self) -> Self::Inputs {
        Self::zeros(self.0.indices().lengths[2])
    }

    fn rate(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Coordinates {
        let indices = self.0.indices();
        self.value(indices.rate, indices.lengths[0], x, xi)
    }

    fn chart_rate(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Chart {
        let indices = self.0.indices();
        self.value(indices.chart_rate, indices.chart, x, xi)
    }

    fn forward_dynamics(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
        u: &Self::Inputs,
    ) -> Result<Self::Velocities, Singular> {
        let accel = self.0.indices().accel;
        self.0.call(accel, [x, xi, u]).map_err(singular)
    }

    fn correction(&self, x: &Self::Coordinates) -> Self::Coordinates {
        let indices = self.0.indices();
        self.value(indices.correction, indices.lengths[0], x, &[])
    }

    fn project_coordinates(&self, x: &Self::Coordinates) -> Option<Self::Coordinates> {
        self.0.indices().embedded.then(|| self.correction(x))
    }

    fn project_position(
        &self,
        x: &Self::Coordinates,
    ) -> Result<Option<Self::Velocities>, Singular> {
        let step = self.0.indices().project_position;
        let step = step.map(|function| self.0.call(function, [x, &[], &[]]));
        step.transpose().map_err(singular)
    }

    fn project_velocity(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
    ) -> Result<Option<Self::Velocities>, Singular> {
        let projected = self.0.indices().project_velocity;
        let projected = projected.map(|function| self.0.call(function, [x, xi, &[]]));
        projected.transpose().map_err(singular)
    }

    fn constraint_norm(&self, x: &Self::Coordinates) -> T::Number {
        let residuals = self.value(self.0.indices().constraint, 1, x, &[]);
        let sizes = residuals.into_iter().map(Scalar::abs);
        sizes.fold(T::Number::default(), Scalar::max)
    }
}

impl<T: TapeEvaluator> Energies for TapeSystem<T> {
    fn kinetic_energy(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> T::Number {
        self.number(self.0.indices().kinetic, x, xi)
    }

    fn potential_energy(&self, x: &Self::Coordinates) -> T::Number {
        self.number(self.0.indices().potential, x, &[])
    }
}
