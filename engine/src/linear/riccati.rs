//! Linear-quadratic regulators: Riccati's equations by structure-preserving doubling, refined by Newton's method.

use super::subspace::{Matrix, balance};

/// Doublings of the horizon: 2⁶⁰ steps.
const MAX_DOUBLINGS: usize = 60;
/// Newton steps, of which one or two suffice unless the start lies far away.
const MAX_REFINEMENTS: usize = 50;
/// Residual relative to the terms of the equation at which a solution is accepted.
const MAX_RESIDUAL: f64 = 1e-8;

/// An equation for the symmetric cost matrix X.
#[derive(Clone, Debug)]
pub struct Riccati {
    pub a: Matrix,
    pub b: Matrix,
    pub q: Matrix,
    pub r: Matrix,
    /// Whether the system moves in steps: X = Q + Aᵀ X A − Aᵀ X B (R + Bᵀ X B)⁻¹ Bᵀ X A instead of
    /// 0 = Q + Aᵀ X + X A − X B R⁻¹ Bᵀ X.
    pub stepped: bool,
}

impl Riccati {
    /// Returns X and the gain K of u = −K x for which A − B K is stable, from a `start` of Q with which every unstable
    /// mode has a cost; `None` if the method does not converge.
    pub fn solve(&self, start: &Matrix) -> Option<(Matrix, Matrix)> {
        let root = self.r.clone().cholesky()?.l();
        let inputs = root
            .solve_lower_triangular(&self.b.transpose())?
            .transpose();
        let g = &inputs * inputs.transpose();
        let diagonal = |m: &Matrix| Matrix::from_diagonal(&m.diagonal().map(f64::sqrt));
        let factors = balance(&self.a, &diagonal(&g), &diagonal(start));
        let t = Matrix::from_diagonal(&factors.clone().into());
        let inverse = Matrix::from_diagonal(&t.diagonal().map(|factor| 1.0 / factor));
        let scaled = Riccati {
            a: &inverse * &self.a * &t,
            b: &inverse * &self.b,
            q: &t * &self.q * &t,
            r: self.r.clone(),
            stepped: self.stepped,
        };
        let g = &inverse * g * &inverse;
        let mut x = scaled.linear(&scaled.a, &g, &(&t * start * &t))?;
        let (mut residual, mut size) = scaled.residual(&x)?;
        for _ in 0..MAX_REFINEMENTS {
            let closed = &scaled.a - &scaled.b * scaled.gain(&x)?;
            let zero = Matrix::zeros(x.nrows(), x.nrows());
            let Some(change) = scaled.linear(&closed, &zero, &residual) else {
                break;
            };
            let next = symmetric(&x + change);
            let (next_residual, next_size) = scaled.residual(&next)?;
            let better = next_residual.norm() / next_size < 0.5 * residual.norm() / size;
            // The first step from a distant start may increase the residual.
            if !better && residual.norm() <= MAX_RESIDUAL * size {
                break;
            }
            (x, residual, size) = (next, next_residual, next_size);
        }
        let converged = residual.norm() <= MAX_RESIDUAL * size;
        let gain = scaled.gain(&x)? * &inverse;
        converged.then(|| (symmetric(&inverse * x * &inverse), gain))
    }

    fn gain(&self, x: &Matrix) -> Option<Matrix> {
        let force = self.b.tr_mul(x);
        match self.stepped {
            true => (&self.r + &force * &self.b)
                .cholesky()
                .map(|m| m.solve(&(force * &self.a))),
            false => self.r.clone().cholesky().map(|m| m.solve(&force)),
        }
    }

    /// Returns the difference of both sides, and the size of its terms.
    fn residual(&self, x: &Matrix) -> Option<(Matrix, f64)> {
        let gain = self.gain(x)?;
        let moved = self.a.tr_mul(x);
        let parts = match self.stepped {
            true => [
                self.q.clone(),
                &moved * &self.a,
                -x,
                -(&moved * &self.b * gain),
            ],
            false => [
                self.q.clone(),
                moved.transpose(),
                moved,
                -(x * &self.b * gain),
            ],
        };
        let size = parts.iter().map(|part| part.norm()).sum::<f64>();
        let [first, second, third, fourth] = parts;
        let residual = symmetric(first + second + third + fourth);
        size.is_finite()
            .then_some((residual, size.max(f64::MIN_POSITIVE)))
    }

    /// Solves the equation with these matrices and G = B R⁻¹ Bᵀ by doubling (Chu, Fan and Lin 2005); with G = 0 it is
    /// Lyapunov's or Stein's. A system in continuous time becomes one in steps by Cayley's transform.
    fn linear(&self, a: &Matrix, g: &Matrix, q: &Matrix) -> Option<Matrix> {
        if self.stepped {
            return doubled(a.clone(), g.clone(), q.clone());
        }
        let n = a.nrows();
        let size = (a.norm() + g.norm().sqrt() * q.norm().sqrt()) / (n as f64).sqrt();
        [1.0, 3.1, 0.29, 11.0, 0.083].into_iter().find_map(|part| {
            let shift = part * size.max(f64::MIN_POSITIVE);
            let shifted = (a - Matrix::identity(n, n) * shift).lu();
            let pulled = shifted.solve(g)?;
            let w = (a.transpose() - Matrix::identity(n, n) * shift + q * &pulled).lu();
            let e = w.solve(&Matrix::identity(n, n))?;
            let h = shifted.solve(&Matrix::identity(n, n))?;
            let h = symmetric(&e * q * h) * (2.0 * shift);
            let g = symmetric(pulled * &e) * (2.0 * shift);
            doubled(Matrix::identity(n, n) + e.transpose() * (2.0 * shift), g, h)
        })
    }
}

/// Returns the limit of H in the doubling of a symplectic pencil.
fn doubled(mut e: Matrix, mut g: Matrix, mut h: Matrix) -> Option<Matrix> {
    let n = e.nrows();
    for _ in 0..MAX_DOUBLINGS {
        let w = (Matrix::identity(n, n) + &g * &h).lu();
        let moved = w.solve(&e)?;
        let more = symmetric(e.tr_mul(&(&h * &moved)));
        g += symmetric(&e * w.solve(&g)? * e.transpose());
        e *= moved;
        h += &more;
        if !h.iter().chain(e.iter()).all(|entry| entry.is_finite()) {
            return None;
        }
        if more.norm() <= f64::EPSILON * h.norm() {
            return Some(h);
        }
    }
    None
}

fn symmetric(m: Matrix) -> Matrix {
    (&m + m.transpose()) * 0.5
}
