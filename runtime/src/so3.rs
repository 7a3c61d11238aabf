//! Rotations as matrices R (body to world), Ṙ = R ω̂ with ω in body axes.
//!
//! Rotation vectors u are in rad. Below half a radian the functions of t = |u| are evaluated by series in t²: the
//! closed forms divide by zero or cancel there. A step of an integrator rarely turns further, so it usually needs
//! neither a square root nor a sine. The truncation error of the series is below 5e-17. Sources: H. Munthe-Kaas, *High
//! order Runge-Kutta methods on manifolds*, Appl. Numer. Math. 29 (1999) 115; E. Hairer, C. Lubich, G. Wanner,
//! *Geometric Numerical Integration* (2006), IV.7-8.
//!
//! ```
//! use hamel::so3;
//!
//! // A quarter turn about the z axis takes x to y.
//! let r = so3::exp([0.0, 0.0, std::f64::consts::FRAC_PI_2]);
//! let y = so3::apply(r, [1.0, 0.0, 0.0]);
//! assert!(y[0].abs() < 1e-15 && (y[1] - 1.0).abs() < 1e-15);
//! assert!((so3::log(r)[2] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
//! assert!(so3::defect(so3::product(r, r)) < 1e-15);
//! ```

use core::array::from_fn;

use crate::s3;
use crate::scalar::{Scalar, series};

/// A vector of three components.
pub type Vector<S> = [S; 3];

/// A 3 × 3 matrix, nine entries row by row.
pub type Matrix<S> = [S; 9];

/// Value of t² from which on the closed forms are used.
const SERIES_BELOW: f64 = 0.25;

/// Coefficients of sin t / t in powers of t²: (−1)ᵏ / (2k+1)!
pub(crate) const SINE_RATIO: [f64; 7] = [
    1.0,
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
];

/// Coefficients of (1 − cos t) / t² in powers of t²: (−1)ᵏ / (2k+2)!
pub(crate) const VERSINE_RATIO: [f64; 7] = [
    0.5,
    -1.0 / 24.0,
    1.0 / 720.0,
    -1.0 / 40_320.0,
    1.0 / 3_628_800.0,
    -1.0 / 479_001_600.0,
    1.0 / 87_178_291_200.0,
];

/// Coefficients of (t − sin t) / t³ in powers of t²: (−1)ᵏ / (2k+3)!
const SINE_DEFECT: [f64; 7] = [
    1.0 / 6.0,
    -1.0 / 120.0,
    1.0 / 5040.0,
    -1.0 / 362_880.0,
    1.0 / 39_916_800.0,
    -1.0 / 6_227_020_800.0,
    1.0 / 1_307_674_368_000.0,
];

/// Coefficients of (1 − (t/2) cot(t/2)) / t² in powers of t²: |B₂ₖ₊₂| / (2k+2)!, Bernoulli numbers.
const COTANGENT_RATIO: [f64; 7] = [
    1.0 / 12.0,
    1.0 / 720.0,
    1.0 / 30_240.0,
    1.0 / 1_209_600.0,
    1.0 / 47_900_160.0,
    691.0 / 1_307_674_368_000.0,
    1.0 / 74_724_249_600.0,
];

/// Evaluates functions of t² by their series if all lanes allow it; otherwise by `closed`, whose value is replaced by
/// the series in the lanes with small t².
#[inline(always)]
pub(crate) fn by_series<S: Scalar, const N: usize>(
    t2: S,
    coefficients: [[f64; 7]; N],
    closed: impl FnOnce() -> [S; N],
) -> [S; N] {
    let limit = S::from_f64(SERIES_BELOW);
    let expanded = coefficients.map(|coefficients| series(t2, coefficients));
    if (limit - t2).is_positive() {
        expanded
    } else {
        let closed = closed();
        from_fn(|i| t2.select_lt(limit, expanded[i], closed[i]))
    }
}

/// Returns the identity matrix, a rotation by zero.
#[inline]
pub fn identity<S: Scalar>() -> Matrix<S> {
    let mut r = [S::default(); 9];
    for i in 0..3 {
        r[4 * i] = S::from_f64(1.0);
    }
    r
}

/// Returns the scalar product a · b.
#[inline(always)]
pub fn dot<S: Scalar>(a: Vector<S>, b: Vector<S>) -> S {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

/// Returns the vector product a × b = â b.
#[inline(always)]
pub fn cross<S: Scalar>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [
        a[1].mul_add(b[2], -(a[2] * b[1])),
        a[2].mul_add(b[0], -(a[0] * b[2])),
        a[0].mul_add(b[1], -(a[1] * b[0])),
    ]
}

/// Returns the skew-symmetric matrix â with â b = a × b.
#[inline]
pub fn hat<S: Scalar>(a: Vector<S>) -> Matrix<S> {
    let zero = S::default();
    [zero, -a[2], a[1], a[2], zero, -a[0], -a[1], a[0], zero]
}

/// Evaluates the entries of a matrix product, row by row, in a loop: with vector registers this is the fastest form for
/// dual numbers.
#[cfg(feature = "std")]
macro_rules! entries {
    ($entry:ident) => {
        from_fn(|k| {
            let (i, j) = (k / 3, k % 3);
            $entry!(i, j)
        })
    };
}
/// The same, written out: no index remains to be checked, which could panic, and on microcontrollers a step in dual
/// numbers takes a seventh fewer instructions, since less is copied.
#[cfg(not(feature = "std"))]
macro_rules! entries {
    ($entry:ident: $([$i:literal $j:literal])+) => { [$($entry!($i, $j)),+] };
    ($entry:ident) => { entries!($entry: [0 0] [0 1] [0 2] [1 0] [1 1] [1 2] [2 0] [2 1] [2 2]) };
}

/// Returns the product A B.
#[inline(always)]
pub fn product<S: Scalar>(a: Matrix<S>, b: Matrix<S>) -> Matrix<S> {
    macro_rules! entry {
        ($i:expr, $j:expr) => {
            a[3 * $i].mul_add(
                b[$j],
                a[3 * $i + 1].mul_add(b[3 + $j], a[3 * $i + 2] * b[6 + $j]),
            )
        };
    }
    entries!(entry)
}

/// Returns the product Aᵀ B.
#[inline(always)]
pub fn transpose_product<S: Scalar>(a: Matrix<S>, b: Matrix<S>) -> Matrix<S> {
    macro_rules! entry {
        ($i:expr, $j:expr) => {
            a[$i].mul_add(b[$j], a[3 + $i].mul_add(b[3 + $j], a[6 + $i] * b[6 + $j]))
        };
    }
    entries!(entry)
}

/// Returns A b; for a rotation, this transforms a vector from body axes to world axes.
#[inline(always)]
pub fn apply<S: Scalar>(a: Matrix<S>, b: Vector<S>) -> Vector<S> {
    from_fn(|i| dot([a[3 * i], a[3 * i + 1], a[3 * i + 2]], b))
}

/// Returns Aᵀ b; for a rotation, this transforms a vector from world axes to body axes.
#[inline(always)]
pub fn apply_transpose<S: Scalar>(a: Matrix<S>, b: Vector<S>) -> Vector<S> {
    from_fn(|i| dot([a[i], a[3 + i], a[6 + i]], b))
}

/// Returns Ṙ = R ω̂ (KR18 (38)), ω in body axes, rad per time.
#[inline]
pub fn rate<S: Scalar>(r: Matrix<S>, w: Vector<S>) -> Matrix<S> {
    product(r, hat(w))
}

/// Returns the rotation by |u| about u: exp(û) = I + a û + b û², a = sin t / t, b = 2 sin²(t/2) / t².
///
/// b is not computed as (1 − cos t) / t², which suffers from cancellation.
#[inline(always)]
pub fn exp<S: Scalar>(u: Vector<S>) -> Matrix<S> {
    let t2 = dot(u, u);
    let [a, b] = by_series(t2, [SINE_RATIO, VERSINE_RATIO], || {
        let t = t2.sqrt();
        let (sine, cosine) = (t * S::from_f64(0.5)).sin_cos();
        let twice_ratio = S::from_f64(2.0) * sine / t;
        [twice_ratio * cosine, twice_ratio * sine / t]
    });
    of_parts(a, b, u)
}

/// Returns cay(f) = I + 2/(1 + f·f) (f̂ + f̂²), the rotation by 2 atan|f| about f.
#[inline(always)]
pub fn cayley<S: Scalar>(f: Vector<S>) -> Matrix<S> {
    let factor = S::from_f64(2.0) / (S::from_f64(1.0) + dot(f, f));
    of_parts(factor, factor, f)
}

/// Returns I + a û + b û².
///
/// û² = u uᵀ − t² I, with the diagonal written out, so that there is no difference of nearly equal squares.
#[inline(always)]
fn of_parts<S: Scalar>(a: S, b: S, [x, y, z]: Vector<S>) -> Matrix<S> {
    let one = S::from_f64(1.0);
    let (bx, by) = (b * x, b * y);
    let (ax, ay, az) = (a * x, a * y, a * z);
    let (xx, yy, zz) = (x * x, y * y, z * z);
    [
        (-b).mul_add(yy + zz, one),
        bx.mul_add(y, -az),
        bx.mul_add(z, ay),
        bx.mul_add(y, az),
        (-b).mul_add(zz + xx, one),
        by.mul_add(z, -ax),
        bx.mul_add(z, -ay),
        by.mul_add(z, ax),
        (-b).mul_add(xx + yy, one),
    ]
}

/// Returns the rotation vector u, |u| ≤ π, of a rotation: exp(û) = R. At |u| = π either sign is possible.
///
/// Computed from the quaternion of R, so that it is accurate both near 0 and near π.
#[inline]
pub fn log<S: Scalar>(r: Matrix<S>) -> Vector<S> {
    s3::log(s3::from_matrix(r))
}

/// Returns u̇ for R = R₀ exp(û) when R turns with the angular velocity ω (body axes): u̇ = ω + ½ u × ω + c u × (u × ω),
/// c = (1 − (t/2) cot(t/2)) / t². Singular at t = 2π.
#[inline(always)]
pub fn dexpinv<S: Scalar>(u: Vector<S>, w: Vector<S>) -> Vector<S> {
    S::chart_velocity(u, w)
}

/// Evaluates the formula of [`dexpinv`] for scalars of any type.
#[inline(always)]
pub(crate) fn chart_velocity<S: Scalar>(u: Vector<S>, w: Vector<S>) -> Vector<S> {
    let t2 = dot(u, u);
    let half = S::from_f64(0.5);
    let [c] = by_series(t2, [COTANGENT_RATIO], || {
        let half_t = t2.sqrt() * half;
        let (sine, cosine) = half_t.sin_cos();
        [(S::from_f64(1.0) - half_t * cosine / sine) / t2]
    });
    let uw = cross(u, w);
    let uuw = cross(u, uw);
    from_fn(|i| c.mul_add(uuw[i], half.mul_add(uw[i], w[i])))
}

/// Returns R exp(û): R turned by u in its own (body) axes.
#[inline(always)]
pub fn retract<S: Scalar>(r: Matrix<S>, u: Vector<S>) -> Matrix<S> {
    S::turned_matrix(r, u)
}

/// Returns the matrix I − b û + c û², by rows, that maps δu to the rotation θ of exp(û) in body axes when u varies by
/// δu, with b = (1 − cos t) / t² and c = (t − sin t) / t³.
#[inline(always)]
pub(crate) fn dexp<S: Scalar>(u: Vector<S>) -> Matrix<S> {
    let t2 = dot(u, u);
    let [b, c] = by_series(t2, [VERSINE_RATIO, SINE_DEFECT], || {
        let t = t2.sqrt();
        let (sine, cosine) = (t * S::from_f64(0.5)).sin_cos();
        let twice_ratio = S::from_f64(2.0) * sine / t;
        [
            twice_ratio * sine / t,
            (S::from_f64(1.0) - twice_ratio * cosine) / t2,
        ]
    });
    of_parts(-b, c, u)
}

/// Returns the result of one Newton step towards the nearest rotation, R (3 I − RᵀR) / 2; it squares the defect
/// RᵀR − I.
#[inline(always)]
pub fn polar<S: Scalar>(r: Matrix<S>) -> Matrix<S> {
    let d = gram_defect(r).map(|entry| S::from_f64(-0.5) * entry);
    macro_rules! entry {
        ($i:expr, $j:expr) => {{
            let own = r[3 * $i + $j];
            let sum = r[3 * $i + 1].mul_add(d[3 + $j], r[3 * $i + 2].mul_add(d[6 + $j], own));
            r[3 * $i].mul_add(d[$j], sum)
        }};
    }
    entries!(entry)
}

/// Returns −R (RᵀR − I) / 2, the term −Ψ φ of KR18 (8) for RᵀR = I.
#[inline(always)]
pub fn correction<S: Scalar>(r: Matrix<S>) -> Matrix<S> {
    let half = S::from_f64(0.5);
    product(r, gram_defect(r)).map(|entry| -(half * entry))
}

/// Returns max |RᵀR − I| over the entries.
#[inline]
pub fn defect<S: Scalar>(r: Matrix<S>) -> S {
    let mut largest = S::default();
    for entry in gram_defect(r) {
        largest = Scalar::max(largest, entry.abs());
    }
    largest
}

/// Returns RᵀR − I.
#[inline(always)]
fn gram_defect<S: Scalar>(r: Matrix<S>) -> Matrix<S> {
    let mut gram = transpose_product(r, r);
    for i in 0..3 {
        gram[4 * i] -= S::from_f64(1.0);
    }
    gram
}
