//! Carlson's symmetric elliptic integral of the third kind.
//!
//! B. C. Carlson, *Numerical computation of real or complex elliptic integrals*, Numer. Algorithms 10
//! (1995) 13.

use crate::scalar::{Scalar, series};

/// Coefficients of atan(√e)/√e in powers of e: (−1)ᵏ / (2k+1)
const ARCTANGENT_RATIO: [f64; 7] = [
    1.0,
    -1.0 / 3.0,
    1.0 / 5.0,
    -1.0 / 7.0,
    1.0 / 9.0,
    -1.0 / 11.0,
    1.0 / 13.0,
];

/// Largest number of duplications. Each divides the spread of the arguments by four, at first by much more.
const DUPLICATIONS: usize = 32;
/// Relative spread below which the series is used, whose error is of order 6 in the spread.
const SPREAD: f64 = 1e-3;

/// Returns R_J(x, y, z, p) for 0 ≤ x, y, z ≤ p, where at most one of x, y, z is zero.
pub fn third_kind<S: Scalar>(x: S, y: S, z: S, p: S) -> S {
    let [one, two, three, quarter] = [1.0, 2.0, 3.0, 0.25].map(S::from_f64);
    let mean = (x + y + z + two * p) / S::from_f64(5.0);
    let (x0, y0, z0) = (mean - x, mean - y, mean - z);
    let spread = Scalar::max(Scalar::max(x0.abs(), y0.abs()), z0.abs());
    let spread = Scalar::max(spread, (mean - p).abs());
    let mut product = (p - x) * (p - y) * (p - z);

    let (mut x, mut y, mut z, mut p, mut a) = (x, y, z, p, mean);
    let (mut power, mut sum) = (one, S::default());
    for _ in 0..DUPLICATIONS {
        let (rx, ry, rz, rp) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let lambda = rx * (ry + rz) + ry * rz;
        let d = (rp + rx) * (rp + ry) * (rp + rz);
        sum += power / d * degenerate(product / (d * d));
        (x, y, z) = (
            quarter * (x + lambda),
            quarter * (y + lambda),
            quarter * (z + lambda),
        );
        (p, a) = (quarter * (p + lambda), quarter * (a + lambda));
        power *= quarter;
        product *= quarter * quarter * quarter;
        if (S::from_f64(SPREAD) * a - power * spread).is_positive() {
            break;
        }
    }

    let scale = power / a;
    let (x, y, z) = (scale * x0, scale * y0, scale * z0);
    let p = -(x + y + z) / two;
    let xyz = x * y * z;
    let e2 = x * y + x * z + y * z - three * p * p;
    let e3 = xyz + two * e2 * p + S::from_f64(4.0) * p * p * p;
    let e4 = (two * xyz + e2 * p + three * p * p * p) * p;
    let e5 = xyz * p * p;
    let mut value = one - S::from_f64(3.0 / 14.0) * e2 + e3 / S::from_f64(6.0);
    value += S::from_f64(9.0 / 88.0) * e2 * e2 - S::from_f64(3.0 / 22.0) * e4;
    value += S::from_f64(3.0 / 26.0) * e5 - S::from_f64(9.0 / 52.0) * e2 * e3;
    power / (a * a.sqrt()) * value + S::from_f64(6.0) * sum
}

/// Returns R_C(1, 1 + e) = atan(√e)/√e for e ≥ 0.
fn degenerate<S: Scalar>(e: S) -> S {
    let root = e.sqrt();
    let closed = root.atan2(S::from_f64(1.0)) / root;
    e.select_lt(S::from_f64(2e-3), series(e, ARCTANGENT_RATIO), closed)
}
