//! Subspaces that the inputs of a linear system reach, and its transmission zeros, by rank-revealing factorisations.

use nalgebra::DMatrix;

/// A real matrix.
pub type Matrix = DMatrix<f64>;

/// Pivots below this, relative to the largest entry of the balanced system, count as zero: a pivot of 1e-5 multiplies
/// the rounding errors of later ones by 1e5.
const RANK_TOLERANCE: f64 = 1e-10;
/// Largest 1-norm at which Padé's approximant of order 13 is exact to rounding.
const PADE_RADIUS: f64 = 5.37;
/// Passes of balancing, of which a few suffice.
const MAX_BALANCING_PASSES: usize = 40;

/// Returns factors t of the states, powers of two, such that with x = T z rows and columns of
/// [T⁻¹ A T, T⁻¹ B; C T, 0] have similar sums (Osborne 1960). Rows or columns of zeros stay.
pub fn balance(a: &Matrix, b: &Matrix, c: &Matrix) -> Vec<f64> {
    let n = a.nrows();
    let (mut a, mut b, mut c) = (a.abs(), b.abs(), c.abs());
    a.fill_diagonal(0.0);
    let mut factors = vec![1.0; n];
    for _ in 0..MAX_BALANCING_PASSES {
        let mut settled = true;
        for i in 0..n {
            let row = a.row(i).sum() + b.row(i).sum();
            let column = a.column(i).sum() + c.column(i).sum();
            let exponent = (0.5 * (row.log2() - column.log2())).round();
            if row == 0.0 || column == 0.0 || exponent == 0.0 {
                continue;
            }
            let factor = exponent.exp2();
            if row / factor + column * factor < 0.95 * (row + column) {
                a.row_mut(i).scale_mut(1.0 / factor);
                b.row_mut(i).scale_mut(1.0 / factor);
                a.column_mut(i).scale_mut(factor);
                c.column_mut(i).scale_mut(factor);
                factors[i] *= factor;
                settled = false;
            }
        }
        if settled {
            break;
        }
    }
    factors
}

/// Matrices of a system, x' = A x + B u, y = C x + D u.
#[derive(Clone, Debug)]
pub struct Quadruple {
    /// A, n × n.
    pub a: Matrix,
    /// B, n × m.
    pub b: Matrix,
    /// C, p × n.
    pub c: Matrix,
    /// D, p × m.
    pub d: Matrix,
}

impl Quadruple {
    /// Returns the system in the states z, x = T z.
    pub fn scaled(&self, factors: &[f64]) -> Self {
        let mut found = self.clone();
        for (i, &factor) in factors.iter().enumerate() {
            found.a.row_mut(i).scale_mut(1.0 / factor);
            found.b.row_mut(i).scale_mut(1.0 / factor);
            found.a.column_mut(i).scale_mut(factor);
            found.c.column_mut(i).scale_mut(factor);
        }
        found
    }

    /// Returns the system scaled for rank tests, with the factors t of its states, x = T z: states by powers of two
    /// (Osborne's balancing, not by Gramians), then each column [B; D] and each row [C, D] so that its largest entry is
    /// that of A, which changes the transfer function.
    pub fn scale_for_rank_tests(&self) -> (Self, Vec<f64>) {
        let factors = balance(&self.a, &self.b, &self.c);
        let mut found = self.scaled(&factors);
        let size = Some(found.a.amax())
            .filter(|&size| size > 0.0)
            .unwrap_or(1.0);
        for j in 0..found.b.ncols() {
            let most = found.b.column(j).amax().max(found.d.column(j).amax());
            if most > 0.0 {
                found.b.column_mut(j).scale_mut(size / most);
                found.d.column_mut(j).scale_mut(size / most);
            }
        }
        for i in 0..found.c.nrows() {
            let most = found.c.row(i).amax().max(found.d.row(i).amax());
            if most > 0.0 {
                found.c.row_mut(i).scale_mut(size / most);
                found.d.row_mut(i).scale_mut(size / most);
            }
        }
        (found, factors)
    }

    /// Returns the dual system, in which reachable and observable states change places.
    pub fn dual(&self) -> Self {
        Quadruple {
            a: self.a.transpose(),
            b: self.c.transpose(),
            c: self.b.transpose(),
            d: self.d.transpose(),
        }
    }

    /// Returns the pivots that count as zero.
    fn tolerance(&self) -> f64 {
        let parts = [&self.a, &self.b, &self.c, &self.d].map(|part| part.amax());
        RANK_TOLERANCE * parts.into_iter().fold(0.0, f64::max)
    }

    /// Returns an orthonormal basis N of the unreachable directions: the largest subspace with Nᵀ B = 0 that Aᵀ maps
    /// into itself, so that Nᵀ x moves by itself, with the matrix Nᵀ A N. The system has to be balanced.
    pub fn unreachable(&self) -> Matrix {
        let n = self.a.nrows();
        // A multiple of I changes no such subspace; without it, short steps do not hide what couples states.
        let shifted = &self.a - Matrix::identity(n, n) * (self.a.trace() / n.max(1) as f64);
        let tolerance = RANK_TOLERANCE * shifted.amax();
        let (_, mut basis) = split(&self.b.transpose(), RANK_TOLERANCE * self.b.amax());
        loop {
            let moved = shifted.tr_mul(&basis);
            let leaving = &moved - &basis * basis.tr_mul(&moved);
            let (lost, kept) = split(&leaving, tolerance);
            if lost.ncols() == 0 {
                return basis;
            }
            basis *= kept;
        }
    }

    /// Returns the part that the inputs reach and the outputs show, which has the same transfer function.
    pub fn minimal(&self) -> Self {
        let mut found = self.clone();
        for _ in 0..2 {
            let (scaled, factors) = found.scale_for_rank_tests();
            let (_, basis) = split(&scaled.unreachable().transpose(), 0.5);
            let scaled = found.scaled(&factors);
            let mut c = &scaled.c * &basis;
            for (mut row, whole) in c.row_iter_mut().zip(scaled.c.row_iter()) {
                // What is left of a row that vanishes on the part is rounding.
                if row.norm() <= RANK_TOLERANCE * whole.norm() {
                    row.fill(0.0);
                }
            }
            found = Quadruple {
                a: basis.tr_mul(&(&scaled.a * &basis)),
                b: basis.tr_mul(&scaled.b),
                c,
                d: scaled.d,
            }
            .dual();
        }
        found
    }

    /// Returns the matrix whose eigenvalues are the invariant zeros, where [A − s I, B; C, D] has less than its usual
    /// rank, by the reduction of Emami-Naeini and Van Dooren (1982).
    pub fn zero_dynamics(&self) -> Option<Matrix> {
        let (scaled, _) = self.scale_for_rank_tests();
        let tolerance = scaled.tolerance();
        let reduced = scaled.reduced(tolerance).dual().reduced(tolerance);
        if reduced.d.is_empty() {
            return Some(reduced.a);
        }
        Some(reduced.a - reduced.b * reduced.d.lu().solve(&reduced.c)?)
    }

    /// Removes rows of outputs without direct term: where they vanish, so do the states that they show, whose
    /// equations take their place. In the result D has independent rows.
    fn reduced(mut self, tolerance: f64) -> Self {
        loop {
            let (direct, indirect) = split(&self.d.transpose(), tolerance);
            let (vanishing, kept) = split(&indirect.tr_mul(&self.c), tolerance);
            let (c, d) = (direct.tr_mul(&self.c), direct.tr_mul(&self.d));
            if vanishing.ncols() == 0 {
                return Quadruple { c, d, ..self };
            }
            let slow = &self.a * &kept;
            self = Quadruple {
                c: stacked(&(c * &kept), &vanishing.tr_mul(&slow)),
                d: stacked(&d, &vanishing.tr_mul(&self.b)),
                a: kept.tr_mul(&slow),
                b: kept.tr_mul(&self.b),
            };
        }
    }
}

/// Returns the exponential of a matrix, by scaling, Padé's approximant of order 13 and squaring (Higham 2005); `None` if
/// it is too large.
pub fn exponential(m: &Matrix) -> Option<Matrix> {
    let (n, order) = (m.nrows(), 13);
    let size = m
        .column_iter()
        .map(|column| column.lp_norm(1))
        .fold(0.0, f64::max);
    let squarings = (size / PADE_RADIUS).log2().ceil().clamp(0.0, 1100.0) as i32;
    let m = m * 0.5_f64.powi(squarings / 2) * 0.5_f64.powi(squarings - squarings / 2);
    // Even and odd terms Σ c_k Mᵏ, c_k / c_(k−1) = (q − k + 1) / (k (2 q − k + 1)).
    let (mut power, mut factor) = (Matrix::identity(n, n), 1.0);
    let mut parts = [power.clone(), Matrix::zeros(n, n)];
    for k in 1..=order {
        factor *= f64::from(order - k + 1) / f64::from(k * (2 * order - k + 1));
        power *= &m;
        parts[k as usize % 2] += &power * factor;
    }
    let [even, odd] = parts;
    let mut grown = (&even - &odd).lu().solve(&(even + odd))?;
    for _ in 0..squarings {
        grown = &grown * &grown;
    }
    grown.iter().all(|entry| entry.is_finite()).then_some(grown)
}

/// Returns the rows of two matrices.
pub fn stacked(upper: &Matrix, lower: &Matrix) -> Matrix {
    let mut both = upper
        .clone()
        .resize_vertically(upper.nrows() + lower.nrows(), 0.0);
    both.rows_mut(upper.nrows(), lower.nrows()).copy_from(lower);
    both
}

/// Returns orthonormal bases of the row space and of the null space of a matrix.
pub fn split(rows: &Matrix, tolerance: f64) -> (Matrix, Matrix) {
    let n = rows.ncols();
    if n == 0 {
        return (Matrix::zeros(0, 0), Matrix::zeros(0, 0));
    }
    let wide = rows
        .transpose()
        .resize_horizontally(n.max(rows.nrows()), 0.0);
    let factored = wide.col_piv_qr();
    let pivots = factored.r();
    let rank = (0..n)
        .take_while(|&i| pivots[(i, i)].abs() > tolerance)
        .count();
    let q = factored.q();
    (
        q.columns(0, rank).into_owned(),
        q.columns(rank, n - rank).into_owned(),
    )
}
