//! Jacobi's elliptic functions sn, cn, dn of (u | m), as far as the torque-free rotor needs them.
//!
//! Both m and 1 − m are given, since near a separatrix only 1 − m carries all significant digits. Sources: M.
//! Abramowitz, I. Stegun, *Handbook of Mathematical Functions* (1964), 16.4, 16.17, 16.22; R. Bulirsch, Numer. Math. 7
//! (1965) 78.

use core::array::from_fn;
use core::f64::consts::FRAC_PI_2;

use crate::scalar::{Scalar, epsilon};

/// Values of sn, cn, dn at one argument.
#[derive(Clone, Copy, Debug)]
pub struct Jacobi<S> {
    /// sn u
    pub sn: S,
    /// cn u
    pub cn: S,
    /// dn u
    pub dn: S,
}

/// Coefficients of the palindromic polynomials cₖ in sn u = Σ (−1)ᵏ cₖ(m) u²ᵏ⁺¹ / (2k+1)!
const SERIES: [[f64; 7]; 7] = [
    [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 14.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 135.0, 135.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 1228.0, 5478.0, 1228.0, 1.0, 0.0, 0.0],
    [1.0, 11_069.0, 165_826.0, 165_826.0, 11_069.0, 1.0, 0.0],
    [
        1.0,
        99_642.0,
        4_494_351.0,
        13_180_268.0,
        4_494_351.0,
        99_642.0,
        1.0,
    ],
];

/// Factors (−1)ᵏ / (2k+1)!
const FACTORS: [f64; 7] = [
    1.0,
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
];

/// Bound of |u| below which the series of [`Series`] is exact to rounding for every m in [0, 1].
pub const SERIES_BELOW: f64 = 0.12;

/// The Maclaurin series in u for one m.
#[derive(Clone, Copy, Debug)]
pub struct Series<S> {
    m: S,
    coefficients: [S; 7],
}

impl<S: Scalar> Series<S> {
    /// Creates the series for the parameter m.
    #[inline]
    pub fn new(m: S) -> Self {
        let coefficients = from_fn(|k| {
            let mut sum = S::default();
            for power in (0..=k).rev() {
                sum = sum.mul_add(m, S::from_f64(SERIES[k][power]));
            }
            sum * S::from_f64(FACTORS[k])
        });
        Self { m, coefficients }
    }

    /// Returns sn, cn, dn for |u| < [`SERIES_BELOW`].
    #[inline]
    pub fn at(&self, u: S) -> Jacobi<S> {
        let u2 = u * u;
        let mut sum = S::default();
        for coefficient in self.coefficients.iter().rev() {
            sum = sum.mul_add(u2, *coefficient);
        }
        let sn = u * sum;
        let one = S::from_f64(1.0);
        let sn2 = sn * sn;
        Jacobi {
            sn,
            cn: (one - sn2).sqrt(),
            dn: (one - self.m * sn2).sqrt(),
        }
    }
}

impl<S: Scalar> Jacobi<S> {
    /// Returns the functions at the sum of two arguments, by the addition theorem.
    ///
    /// Its denominator 1 − m sn² sn² is computed as cn² + sn² dn², a sum of positive terms.
    #[inline]
    pub fn plus(self, other: Self, m: S) -> Self {
        let (a, b) = (self, other);
        let (sb, cb, db) = (b.sn, b.cn, b.dn);
        let below = a.cn * a.cn + (a.sn * db) * (a.sn * db);
        Self {
            sn: (a.sn * cb * db + sb * a.cn * a.dn) / below,
            cn: (a.cn * cb - a.sn * a.dn * sb * db) / below,
            dn: (a.dn * db - m * a.sn * a.cn * sb * cb) / below,
        }
    }

    /// Returns the functions at this argument plus 2K j, where `sign` is (−1)ʲ.
    #[inline]
    pub fn shifted(self, sign: S) -> Self {
        Self {
            sn: sign * self.sn,
            cn: sign * self.cn,
            dn: self.dn,
        }
    }
}

/// Largest number of steps of the arithmetic-geometric mean; sufficient for every 1 − m ≥ 1e-300.
const MEANS: usize = 16;

/// Arithmetic-geometric mean of 1 and √(1 − m), with its descending sequence.
#[derive(Clone, Copy, Debug)]
pub struct Mean<S> {
    pairs: [(S, S); MEANS],
    steps: usize,
    limit: S,
}

impl<S: Scalar> Mean<S> {
    /// Computes the mean for 1 − m > 0.
    pub fn new(complement: S) -> Self {
        let half = S::from_f64(0.5);
        // The next mean has the square of this relative gap.
        let close = epsilon::<S>().sqrt() * S::from_f64(0.25);
        let mut pairs = [(S::default(), S::default()); MEANS];
        let (mut a, mut b) = (S::from_f64(1.0), complement.sqrt());
        let mut steps = 0;
        for pair in &mut pairs {
            *pair = (a, b);
            steps += 1;
            let done = (close * a - (a - b).abs()).is_positive();
            (a, b) = (half * (a + b), (a * b).sqrt());
            if done {
                break;
            }
        }
        Self {
            pairs,
            steps,
            limit: a,
        }
    }

    /// Returns K(m), a quarter of the period of sn.
    #[inline]
    pub fn quarter_period(&self) -> S {
        S::from_f64(FRAC_PI_2) / self.limit
    }

    /// Returns sn, cn, dn for |u| ≤ K.
    pub fn at(&self, u: S) -> Jacobi<S> {
        let (zero, one) = (S::default(), S::from_f64(1.0));
        // Below this |u|, sn u = u and cn u = dn u = 1 to rounding; the ratio cn/sn stays finite.
        let small = S::from_f64(1e-9);
        let size = u.abs();
        let kept = size.select_lt(small, small, size);
        let (sine, cosine) = (kept * self.limit).sin_cos();
        let mut a = cosine / sine;
        let mut c = a * self.limit;
        let mut dn = one;
        for (mean, root) in self.pairs.iter().take(self.steps).rev() {
            a *= c;
            c *= dn;
            dn = (*root + a) / (*mean + a);
            a = c / *mean;
        }
        let sn = one / (one + c * c).sqrt();
        let sign = u.select_lt(zero, -one, one);
        Jacobi {
            sn: size.select_lt(small, u, sign * sn),
            cn: size.select_lt(small, one, c * sn),
            dn: size.select_lt(small, one, dn),
        }
    }
}
