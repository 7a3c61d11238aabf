//! Vectors and matrices of numbers modulo p, and the angular velocity of a frame from the rates of its axes.

use crate::kernel::dot;
use hamel_algebra::residue_pair::ResiduePair;

/// Vector of three numbers modulo p.
pub type Vec3 = [ResiduePair; 3];
/// 3×3 matrix of numbers modulo p, by rows.
pub type Mat3 = [Vec3; 3];

/// Returns a + b.
pub fn add(a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|i| a[i] + b[i])
}

/// Returns a − b.
pub fn sub(a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Returns c a.
pub fn scale(c: ResiduePair, a: Vec3) -> Vec3 {
    a.map(|entry| c * entry)
}

/// Returns a × b.
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// Returns M a.
pub fn apply(m: &Mat3, a: Vec3) -> Vec3 {
    m.map(|row| dot(&row, &a))
}

/// Returns the j-th column of a matrix, counted from 0.
pub fn column(m: &Mat3, j: usize) -> Vec3 {
    m.map(|row| row[j])
}

/// Returns Mᵀ a.
pub fn apply_transposed(m: &Mat3, a: Vec3) -> Vec3 {
    std::array::from_fn(|j| dot(&column(m, j), &a))
}

/// Returns vee(Rᵀ Ṙ) for a change Ṙ of R: the angular velocity in the axes of R.
pub fn angular_velocity(rotation: &Mat3, change: &Mat3) -> Vec3 {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        dot(&column(rotation, k), &column(change, j))
    })
}
