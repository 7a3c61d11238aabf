//! ∂g/∂ξ₁ by finite differences of g: for any system, including inputs that depend on the state.

use std::vec;
use std::vec::Vec;

use crate::error::StepError;
use crate::methods::factors::{Factors, Square};
use crate::methods::implicit::Derivative;
use crate::methods::implicit::equations::{ImplicitStep, Point};
use crate::methods::implicit::unknowns::Unknowns;
use crate::scalar::Scalar;
use crate::store::{Store, largest};
use crate::system::Energies;

/// A square matrix with a row for each velocity.
pub(in crate::methods) struct SquareMatrix<V>(Vec<V>);

impl<S: Scalar, V: Store<S>> Square<S> for SquareMatrix<V> {
    fn row(&self, i: usize) -> &[S] {
        self.0.get(i).map_or(&[], |row| row.as_ref())
    }

    fn row_mut(&mut self, i: usize) -> &mut [S] {
        self.0.get_mut(i).map_or(&mut [], |row| row.as_mut())
    }
}

/// Finite-difference derivatives, at one evaluation per velocity.
pub(in crate::methods) struct Differences;

impl<Sys: Energies + ?Sized> Derivative<Sys> for Differences {
    type Factors = Factors<Sys::Scalar, SquareMatrix<Sys::Velocities>, Sys::Velocities>;

    const KNOWS_INPUTS: bool = true;

    fn linear(
        &self,
        equations: &ImplicitStep<'_, Sys>,
        z: &mut Unknowns<Sys>,
        iterations: &mut u32,
    ) -> Result<(Point<Sys>, Self::Factors), StepError> {
        *iterations += 1;
        let here = equations.point(z)?;
        let zeros = equations.system.zero_velocities();
        let mut grid = SquareMatrix(vec![zeros.clone(); zeros.as_ref().len()]);
        let of = Sys::Scalar::from_f64;
        // The perturbation uses half of the digits: of ξ, or of x/h if that is larger.
        let half = of(Sys::Scalar::EPSILON.sqrt());
        let reach = largest(equations.state.x.as_ref()).magnitude() / of(equations.h.abs());
        for j in 0..zeros.as_ref().len() {
            *iterations += 1;
            let mut near = z.clone();
            let Some(entry) = near.xi.as_mut().get_mut(j) else {
                continue;
            };
            let before = *entry;
            let by = half * Scalar::max(reach, entry.magnitude());
            *entry += of(0.0).select_lt(by, by, half);
            let by = *entry - before;
            let there = equations.point(&mut near)?;
            let pairs = there.defect.as_ref().iter().zip(here.defect.as_ref());
            for (i, (there, here)) in pairs.enumerate() {
                if let Some(entry) = grid.row_mut(i).get_mut(j) {
                    *entry = (*there - *here) / by;
                }
            }
        }
        Ok((here, Factors::new(grid, zeros)))
    }

    fn solve(factors: &Self::Factors, defect: &mut Sys::Velocities) {
        factors.solve(defect.as_mut());
    }
}
