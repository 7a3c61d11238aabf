//! Rotations as unit quaternions q = (w, x, y, z), scalar first, body to world.
//!
//! q̇ = ½ q ⊗ (0, ω) with ω in body axes; q and −q are the same rotation. A chart vector is the
//! rotation vector of [`so3`](crate::so3), in rad, so that [`so3::dexpinv`](crate::so3::dexpinv)
//! serves here too.
//!
//! ```
//! use hamel::{s3, so3};
//!
//! let u = [0.1, -0.2, 0.3];
//! let q = s3::exp(u);
//! // The same rotation as a matrix.
//! let (a, b): ([f64; 9], _) = (s3::to_matrix(q), so3::exp(u));
//! assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15));
//! assert!(s3::defect(s3::product(q, q)) < 1e-15);
//! ```

use core::array::from_fn;

use crate::scalar::{Scalar, series};
use crate::so3::{Matrix, Vector, by_series};

/// Coefficients of cos(t/2) in powers of t²: (−1)ᵏ / (4ᵏ (2k)!)
const HALF_COSINE: [f64; 7] = [
    1.0,
    -1.0 / 8.0,
    1.0 / 384.0,
    -1.0 / 46_080.0,
    1.0 / 10_321_920.0,
    -1.0 / 3_715_891_200.0,
    1.0 / 1_961_990_553_600.0,
];

/// Coefficients of sin(t/2) / t in powers of t²: (−1)ᵏ / (2 · 4ᵏ (2k+1)!)
const HALF_SINE_RATIO: [f64; 7] = [
    0.5,
    -1.0 / 48.0,
    1.0 / 3840.0,
    -1.0 / 645_120.0,
    1.0 / 185_794_560.0,
    -1.0 / 81_749_606_400.0,
    1.0 / 51_011_754_393_600.0,
];

/// Coefficients of 2 atan(z) / z in powers of z²: 2 (−1)ᵏ / (2k+1)
const TWICE_ARCTANGENT_RATIO: [f64; 7] = [
    2.0,
    -2.0 / 3.0,
    2.0 / 5.0,
    -2.0 / 7.0,
    2.0 / 9.0,
    -2.0 / 11.0,
    2.0 / 13.0,
];

/// A quaternion of four components, scalar first.
pub type Quaternion<S> = [S; 4];

/// Returns the Hamilton product p ⊗ q.
#[inline(always)]
pub fn product<S: Scalar>(p: Quaternion<S>, q: Quaternion<S>) -> Quaternion<S> {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]
}

/// Returns q̇ = ½ q ⊗ (0, ω), ω in body axes, rad per time.
#[inline]
pub fn rate<S: Scalar>(q: Quaternion<S>, w: Vector<S>) -> Quaternion<S> {
    let half = S::from_f64(0.5);
    product(q, [S::default(), half * w[0], half * w[1], half * w[2]])
}

/// Returns the rotation by t = |u| about u: (cos(t/2), sin(t/2)/t u).
#[inline(always)]
pub fn exp<S: Scalar>(u: Vector<S>) -> Quaternion<S> {
    let t2 = u[0].mul_add(u[0], u[1].mul_add(u[1], u[2] * u[2]));
    let [cosine, a] = by_series(t2, [HALF_COSINE, HALF_SINE_RATIO], || {
        let t = t2.sqrt();
        let (sine, cosine) = (t * S::from_f64(0.5)).sin_cos();
        [cosine, sine / t]
    });
    [cosine, a * u[0], a * u[1], a * u[2]]
}

/// Returns the rotation vector u, |u| ≤ π, with exp(u) = ±q: 2 atan(|v|/w)/|v| v for q = ±(w, v), w ≥ 0. The norm of q
/// does not matter.
#[inline]
pub fn log<S: Scalar>(q: Quaternion<S>) -> Vector<S> {
    let zero = S::default();
    let [w, v @ ..] = q;
    let v2 = v[0].mul_add(v[0], v[1].mul_add(v[1], v[2] * v[2]));
    let norm = v2.sqrt();
    // Unlike |w|, this has a nonzero slope at w = 0, half a turn.
    let positive = w.select_lt(zero, -w, w);
    let closed = S::from_f64(2.0) * norm.atan2(positive) / norm;
    let z2 = v2 / (w * w);
    let expanded = series(z2, TWICE_ARCTANGENT_RATIO) / positive;
    let factor = z2.select_lt(S::from_f64(1e-4), expanded, closed);
    let factor = w.select_lt(zero, -factor, factor);
    v.map(|component| factor * component)
}

/// Returns the rotation matrix of a unit quaternion.
#[inline(always)]
pub fn to_matrix<S: Scalar>(q: Quaternion<S>) -> Matrix<S> {
    let (one, two) = (S::from_f64(1.0), S::from_f64(2.0));
    let [w, x, y, z] = q;
    let (x2, y2, z2) = (two * x, two * y, two * z);
    [
        one - (y2 * y + z2 * z),
        x2 * y - z2 * w,
        x2 * z + y2 * w,
        x2 * y + z2 * w,
        one - (z2 * z + x2 * x),
        y2 * z - x2 * w,
        x2 * z - y2 * w,
        y2 * z + x2 * w,
        one - (x2 * x + y2 * y),
    ]
}

/// Returns a unit quaternion of a rotation matrix; its norm is one whether or not R is exactly orthogonal.
///
/// 4 q qᵀ is linear in R; its column with the largest diagonal entry is a multiple of q, without cancellation (S. W.
/// Shepperd, J. Guid. Control 1 (1978) 223).
#[inline]
pub fn from_matrix<S: Scalar>(r: Matrix<S>) -> Quaternion<S> {
    let one = S::from_f64(1.0);
    let columns = [
        [
            one + r[0] + r[4] + r[8],
            r[7] - r[5],
            r[2] - r[6],
            r[3] - r[1],
        ],
        [
            r[7] - r[5],
            one + r[0] - r[4] - r[8],
            r[1] + r[3],
            r[2] + r[6],
        ],
        [
            r[2] - r[6],
            r[1] + r[3],
            one - r[0] + r[4] - r[8],
            r[5] + r[7],
        ],
        [
            r[3] - r[1],
            r[2] + r[6],
            r[5] + r[7],
            one - r[0] - r[4] + r[8],
        ],
    ];
    let mut best = columns[0];
    let mut diagonal = best[0];
    for i in 1..4 {
        let candidate = columns[i][i];
        best = from_fn(|k| diagonal.select_lt(candidate, columns[i][k], best[k]));
        diagonal = diagonal.select_lt(candidate, candidate, diagonal);
    }
    normalise(best)
}

/// Returns q ⊗ exp(u): q turned by u in its own (body) axes.
#[inline(always)]
pub fn retract<S: Scalar>(q: Quaternion<S>, u: Vector<S>) -> Quaternion<S> {
    S::turned_quaternion(q, u)
}

/// Returns q / |q|; NaN for q = 0.
#[inline(always)]
pub fn normalise<S: Scalar>(q: Quaternion<S>) -> Quaternion<S> {
    let norm = squared_norm(q).sqrt();
    q.map(|component| component / norm)
}

/// Returns −½ q (q·q − 1), the term −Ψ φ of KR18 (8) for q·q = 1.
#[inline]
pub fn correction<S: Scalar>(q: Quaternion<S>) -> Quaternion<S> {
    let factor = S::from_f64(0.5) * (S::from_f64(1.0) - squared_norm(q));
    q.map(|component| factor * component)
}

/// Returns |q·q − 1|.
#[inline]
pub fn defect<S: Scalar>(q: Quaternion<S>) -> S {
    (squared_norm(q) - S::from_f64(1.0)).abs()
}

#[inline(always)]
fn squared_norm<S: Scalar>(q: Quaternion<S>) -> S {
    q[0].mul_add(q[0], q[1].mul_add(q[1], q[2].mul_add(q[2], q[3] * q[3])))
}
