//! Modes of linear systems: their states, and whether inputs reach them and outputs show them.

use super::subspace::split;
use super::{LinearError, LinearSystem, Matrix, Quadruple};
use crate::linearize::eigenvalues::eigenvalues;
use hamel_files::number::short;
use nalgebra::{Complex, ComplexField};
use std::cmp::Ordering;
use std::fmt;

/// Eigenvalues below this, relative to the largest entry of A, count as zero, since a rounding error ε moves a double
/// zero by √ε; so do the distances of eigenvalues of steps from 1.
pub(super) const ZERO_TOLERANCE: f64 = 1e-7;
/// Real parts below this, relative to the largest entry of A, are rounding errors of zero.
const REAL_TOLERANCE: f64 = 1e-13;
/// Modes with less damping, as a ratio, do not decay.
const DAMPING_TOLERANCE: f64 = 1e-9;
/// Parts of a mode below this, relative to its largest part in scaled states, are not named.
const NAMED_PART: f64 = 0.3;
/// Pivots that count as zero in the search for the vectors of a mode, tried in this order.
const VECTOR_TOLERANCES: [f64; 4] = [1e-13, 1e-10, 1e-7, 1e-4];

/// A mode: an eigenvalue with the states that move in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// The eigenvalue; the imaginary part is not negative, and a positive one stands for a pair.
    pub value: Complex<f64>,
    /// Names of the states with the largest parts.
    pub states: Vec<String>,
    /// Whether the inputs reach it.
    pub reachable: bool,
    /// Whether the outputs show it.
    pub observable: bool,
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {}", pair(self.value), self.states.join(", "))
    }
}

/// Formats an eigenvalue, or a pair if its imaginary part is positive.
pub fn pair(value: Complex<f64>) -> String {
    match (value.im > 0.0, value.re == 0.0) {
        (false, _) => short(value.re),
        (true, true) => format!("± {} i", short(value.im)),
        (true, false) => format!("{} ± {} i", short(value.re), short(value.im)),
    }
}

/// Returns the eigenvalues of a matrix, the fastest growing first.
pub fn spectrum(a: &Matrix) -> Result<Vec<Complex<f64>>, LinearError> {
    let rows: Vec<Vec<f64>> = a
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect();
    let finite = a.iter().all(|entry| entry.is_finite());
    let values = finite.then(|| eigenvalues(&rows)).flatten();
    let values = values.ok_or(LinearError::NoEigenvalues)?;
    Ok(values
        .into_iter()
        .map(|(re, im)| Complex::new(re, im))
        .collect())
}

impl LinearSystem {
    /// Returns all modes, the fastest growing first, conjugate pairs once.
    ///
    /// # Errors
    /// The QR algorithm does not converge.
    pub fn modes(&self) -> Result<Vec<Mode>, LinearError> {
        let (scaled, _) = self.matrices.scale_for_rank_tests();
        let unreachable = scaled.unreachable();
        let (_, reachable) = split(&unreachable.transpose(), 0.5);
        let mut modes = self.modes_within(&scaled.a, &unreachable)?;
        modes.iter_mut().for_each(|mode| mode.reachable = false);
        modes.extend(self.modes_within(&scaled.a.transpose(), &reachable)?);
        let key = |mode: &Mode| (mode.value.re, mode.value.im);
        modes.sort_by(|a, b| key(b).partial_cmp(&key(a)).unwrap_or(Ordering::Equal));
        let size = scaled.a.amax();
        for off in self.modes_off(&self.matrices.dual())? {
            // Among equal eigenvalues, the mode with the same states.
            let distance = |mode: &Mode| {
                let others = off.states.iter().filter(|name| !mode.states.contains(name));
                (mode.value - off.value).modulus() + ZERO_TOLERANCE * size * others.count() as f64
            };
            let open = modes.iter_mut().filter(|mode| mode.observable);
            if let Some(mode) = open.min_by(|a, b| distance(a).total_cmp(&distance(b))) {
                mode.observable = false;
            }
        }
        Ok(modes)
    }

    /// Returns the modes that the inputs of a system with these states do not reach.
    pub(super) fn modes_off(&self, system: &Quadruple) -> Result<Vec<Mode>, LinearError> {
        let (scaled, _) = system.scale_for_rank_tests();
        self.modes_within(&scaled.a, &scaled.unreachable())
    }

    /// Returns the modes of Aᵀ in a subspace that it maps into itself, with an orthonormal basis.
    fn modes_within(&self, a: &Matrix, basis: &Matrix) -> Result<Vec<Mode>, LinearError> {
        let inner = basis.tr_mul(&a.tr_mul(basis));
        let (n, size) = (inner.nrows(), a.amax());
        let mut modes = Vec::new();
        for mut value in spectrum(&inner)? {
            let distance = if self.step.is_some() {
                value - 1.0
            } else {
                value
            };
            if distance.modulus() <= ZERO_TOLERANCE * size {
                value -= distance;
            }
            if value.re.abs() <= REAL_TOLERANCE * size {
                value.re = 0.0;
            }
            if value.im < 0.0 {
                continue;
            }
            // Vanishes on the vectors of the pair, and on those of a double eigenvalue.
            let square = &inner * &inner - &inner * (2.0 * value.re)
                + Matrix::identity(n, n) * value.modulus_squared();
            let found = VECTOR_TOLERANCES
                .iter()
                .map(|part| split(&square, part * size * size).1);
            let vectors = found.into_iter().find(|vectors| vectors.ncols() > 0);
            let parts = basis * vectors.unwrap_or_else(|| Matrix::identity(n, n));
            let part = |i: usize| parts.row(i).norm();
            let most = (0..parts.nrows()).map(part).fold(0.0, f64::max);
            let named = (0..parts.nrows()).filter(|&i| part(i) >= NAMED_PART * most);
            modes.push(Mode {
                value,
                states: named.map(|i| self.states[i].clone()).collect(),
                reachable: true,
                observable: true,
            });
        }
        Ok(modes)
    }

    /// Returns whether a mode with this eigenvalue does not decay.
    pub(super) fn persists(&self, value: Complex<f64>) -> bool {
        match self.step {
            Some(_) => value.modulus() >= 1.0 - ZERO_TOLERANCE,
            None => value.re >= -DAMPING_TOLERANCE * value.modulus(),
        }
    }

    /// Returns whether a mode with this eigenvalue grows.
    pub(super) fn grows(&self, value: Complex<f64>) -> bool {
        match self.step {
            Some(_) => value.modulus() > 1.0 + ZERO_TOLERANCE,
            None => value.re > DAMPING_TOLERANCE * value.modulus(),
        }
    }
}
