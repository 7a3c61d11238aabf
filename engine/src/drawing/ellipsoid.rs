//! The solid ellipsoid that has a given mass and inertia.
//!
//! A solid ellipsoid with the radii a, b, c along its principal axes has the moments m/5 (b² + c²), m/5 (c² + a²) and
//! m/5 (a² + b²). Hence a² = 5/(2 m) (I₂ + I₃ − I₁), and likewise for b and c: the ellipsoid is real if no moment
//! exceeds the sum of the other two, which holds for every rigid body.

use super::scene::Vector;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// Principal axes and radii, in the axes of the inertia tensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Three right-handed unit vectors.
    pub axes: [Vector; 3],
    /// The radii along them.
    pub radii: Vector,
}

impl Ellipsoid {
    /// Creates the ellipsoid of a mass and an inertia about the centre of mass. If the inertia is not that of a body, a
    /// radius whose square would be negative is 0.
    pub fn new(mass: f64, inertia: [Vector; 3]) -> Self {
        let matrix = Matrix3::from_fn(|i, j| inertia[i][j]);
        let eigen = SymmetricEigen::new(matrix);
        // Sort by moment, so that the result does not depend on the eigenvalue solver.
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
        let [first, second, _] = order.map(|k| upright(eigen.eigenvectors.column(k).into()));
        let axes = [first, second, first.cross(&second)];
        let moments = order.map(|k| eigen.eigenvalues[k]);
        let sum: f64 = moments.iter().sum();
        let radii = moments.map(|moment| {
            let square = 2.5 * (sum - 2.0 * moment) / mass;
            // Rounding must not give a plate or a rod a thickness.
            let least = 1e-12 * 2.5 * sum / mass;
            if square > least { square.sqrt() } else { 0.0 }
        });
        Ellipsoid {
            axes: axes.map(Into::into),
            radii,
        }
    }
}

/// Returns the one of two opposite directions whose largest entry is positive.
fn upright(axis: Vector3<f64>) -> Vector3<f64> {
    if axis[axis.iamax()] < 0.0 {
        -axis
    } else {
        axis
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σ over the principal axes of m/5 (tr(r²) − r²) e eᵀ.
    fn inertia(mass: f64, of: &Ellipsoid) -> Matrix3<f64> {
        let total: f64 = of.radii.iter().map(|r| r * r).sum();
        let terms = of.axes.iter().zip(of.radii).map(|(axis, radius)| {
            let axis = Vector3::from(*axis);
            axis * axis.transpose() * (mass / 5.0 * (total - radius * radius))
        });
        terms.sum()
    }

    #[test]
    fn an_ellipsoid_has_the_inertia_that_it_was_made_of() {
        let inertias = [
            [[2.1, 0.1, -0.2], [0.1, 1.7, 0.15], [-0.2, 0.15, 1.2]],
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            // A rod and a plate, which have radii of 0.
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]],
            [[1.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 2.0]],
            [[0.0; 3]; 3],
        ];
        for (index, given) in inertias.into_iter().enumerate() {
            let mass = 0.5 + index as f64;
            let ellipsoid = Ellipsoid::new(mass, given);
            let expected = Matrix3::from_fn(|i, j| given[i][j]);
            let difference = (inertia(mass, &ellipsoid) - expected).amax();
            assert!(difference < 1e-12, "{given:?}: {difference:e}");
            let axes = Matrix3::from_fn(|i, j| ellipsoid.axes[j][i]);
            assert!((axes.determinant() - 1.0).abs() < 1e-12, "{given:?}");
        }
        let flat = |index: usize| Ellipsoid::new(1.0, inertias[index]).radii;
        assert_eq!(flat(2).iter().filter(|radius| **radius == 0.0).count(), 2);
        assert_eq!(flat(3).iter().filter(|radius| **radius == 0.0).count(), 1);
    }
}
