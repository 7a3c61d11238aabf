//! Linear systems, in continuous time or in steps: discretisation, modes, zeros, regulators, responses.

mod error;
mod modes;
mod response;
mod riccati;
mod subspace;

pub use error::LinearError;
pub use modes::{Mode, pair};
pub use response::{Channel, Crossing, FrequencyResponse, StepResponse};
pub use subspace::{Matrix, Quadruple};

use crate::linearize::Linearization;
use modes::spectrum;
use nalgebra::{Complex, ComplexField};
use riccati::Riccati;
use subspace::{balance, exponential, stacked};

/// Negative eigenvalues of a cost matrix below this, relative to its entries, are rounding errors.
const COST_TOLERANCE: f64 = 1e-12;

/// A linear system with names: x' = A x + B u, y = C x + D u, where x' is the rate of x or, in steps, its next value.
#[derive(Clone, Debug)]
pub struct LinearSystem {
    /// Names of the states x.
    pub states: Vec<String>,
    /// Names of the inputs u.
    pub inputs: Vec<String>,
    /// Names of the outputs y.
    pub outputs: Vec<String>,
    /// A, B, C, D.
    pub matrices: Quadruple,
    /// Length of a step (s); `None` in continuous time.
    pub step: Option<f64>,
}

/// A linear-quadratic regulator u = −K x.
#[derive(Clone, Debug)]
pub struct Regulator {
    /// K, m × n.
    pub gain: Matrix,
    /// X, symmetric: xᵀ X x is the least cost from x.
    pub cost: Matrix,
    /// Eigenvalues of A − B K.
    pub poles: Vec<Complex<f64>>,
}

impl From<&Linearization> for LinearSystem {
    fn from(linear: &Linearization) -> Self {
        let [n, m, p] = [&linear.states, &linear.inputs, &linear.outputs].map(Vec::len);
        let matrix = |rows: &[Vec<f64>], height: usize, width: usize| {
            Matrix::from_fn(height, width, |i, j| rows[i][j])
        };
        LinearSystem {
            states: linear.states.clone(),
            inputs: linear.inputs.clone(),
            outputs: linear.outputs.clone(),
            matrices: Quadruple {
                a: matrix(&linear.a, n, n),
                b: matrix(&linear.b, n, m),
                c: matrix(&linear.c, p, n),
                d: matrix(&linear.d, p, m),
            },
            step: None,
        }
    }
}

impl LinearSystem {
    /// Returns the system at multiples of h > 0, exact for inputs that are held between them:
    /// [A_d B_d; 0 I] = exp([A B; 0 0] h) (Van Loan 1978).
    ///
    /// # Errors
    /// The motion grows beyond all numbers within h.
    pub fn discretized(&self, h: f64) -> Result<Self, LinearError> {
        let Quadruple { a, b, .. } = &self.matrices;
        let (n, m) = b.shape();
        let factors = balance(a, b, &Matrix::zeros(0, n));
        let scaled = self.matrices.scaled(&factors);
        let mut whole = stacked(&scaled.a, &Matrix::zeros(m, n)).resize_horizontally(n + m, 0.0);
        whole.view_mut((0, n), (n, m)).copy_from(&scaled.b);
        let grown = exponential(&(whole * h)).ok_or(LinearError::Overflow)?;
        let inverse: Vec<f64> = factors.iter().map(|factor| 1.0 / factor).collect();
        let moved = Quadruple {
            a: grown.view((0, 0), (n, n)).into_owned(),
            b: grown.view((0, n), (n, m)).into_owned(),
            ..scaled
        };
        Ok(LinearSystem {
            matrices: Quadruple {
                c: self.matrices.c.clone(),
                ..moved.scaled(&inverse)
            },
            step: Some(h),
            ..self.clone()
        })
    }

    /// Returns the eigenvalues of A.
    ///
    /// # Errors
    /// The QR algorithm does not converge.
    pub fn poles(&self) -> Result<Vec<Complex<f64>>, LinearError> {
        spectrum(&self.matrices.a)
    }

    /// Returns the invariant zeros, at which [A − s I, B; C, D] has less than its usual rank: transmission zeros, and
    /// modes that inputs do not reach or outputs do not show.
    ///
    /// # Errors
    /// The QR algorithm does not converge.
    pub fn zeros(&self) -> Result<Vec<Complex<f64>>, LinearError> {
        spectrum(
            &self
                .matrices
                .zero_dynamics()
                .ok_or(LinearError::NoEigenvalues)?,
        )
    }

    /// Returns the regulator with the least ∫ (xᵀ Q x + uᵀ R u) dt, or the least sum over the steps; Q is n × n, R
    /// m × m, both symmetric.
    ///
    /// # Errors
    /// Q or R has negative eigenvalues, or R a zero; a mode that does not decay is not reached by the inputs, or one
    /// that neither decays nor grows has no cost; the method does not converge.
    pub fn regulator(&self, q: &Matrix, r: &Matrix) -> Result<Regulator, LinearError> {
        let Quadruple { a, b, .. } = &self.matrices;
        let n = a.nrows();
        let least = |m: &Matrix| {
            m.clone()
                .symmetric_eigenvalues()
                .iter()
                .copied()
                .fold(f64::INFINITY, f64::min)
        };
        if r.is_empty() || r.clone().cholesky().is_none() {
            return Err(LinearError::NoInputCost);
        }
        if n > 0 && least(q) < -COST_TOLERANCE * q.amax() {
            return Err(LinearError::NegativeCost);
        }
        let unreachable = self.modes_off(&Quadruple {
            c: Matrix::zeros(0, n),
            ..self.matrices.clone()
        })?;
        let unreachable: Vec<Mode> = unreachable
            .into_iter()
            .filter(|mode| self.persists(mode.value))
            .collect();
        if !unreachable.is_empty() {
            return Err(LinearError::Unreachable(unreachable));
        }
        let costs = Quadruple {
            a: a.clone(),
            b: Matrix::zeros(n, 0),
            c: q.clone(),
            d: Matrix::zeros(n, 0),
        };
        let free = self.modes_off(&costs.dual())?;
        let (growing, neutral): (Vec<Mode>, Vec<Mode>) =
            (free.into_iter().filter(|mode| self.persists(mode.value)))
                .partition(|mode| self.grows(mode.value));
        if !neutral.is_empty() {
            return Err(LinearError::NoStateCost(neutral));
        }
        let mut start = q.clone();
        if !growing.is_empty() {
            let factors = balance(a, b, &Matrix::zeros(0, n));
            let size = q.trace().max(f64::from(u8::from(q.amax() == 0.0)));
            start += Matrix::from_diagonal(
                &factors
                    .iter()
                    .map(|t| size / (t * t))
                    .collect::<Vec<_>>()
                    .into(),
            );
        }
        let stepped = self.step.is_some();
        let equation = Riccati {
            a: a.clone(),
            b: b.clone(),
            q: q.clone(),
            r: r.clone(),
            stepped,
        };
        let (cost, gain) = equation.solve(&start).ok_or(LinearError::NoConvergence)?;
        let poles = spectrum(&(a - b * &gain))?;
        let stable = |pole: &Complex<f64>| {
            if stepped {
                pole.modulus() < 1.0
            } else {
                pole.re < 0.0
            }
        };
        match poles.iter().all(stable) {
            true => Ok(Regulator { gain, cost, poles }),
            false => Err(LinearError::NoConvergence),
        }
    }
}
