//! Angles as points (c, s) = (cos θ, sin θ) of the unit circle; d/dt (c, s) = θ̇ (−s, c).
//!
//! ```
//! use hamel::s1;
//!
//! let p = s1::retract(s1::exp(0.5_f64), 0.25);
//! assert!((s1::log(p) - 0.75).abs() < 1e-15);
//! ```

use crate::scalar::Scalar;

/// A point (cos θ, sin θ) of the unit circle.
pub type Circle<S> = [S; 2];

/// Returns d/dt (c, s) = θ̇ (−s, c), θ̇ in rad per time.
#[inline]
pub fn rate<S: Scalar>(p: Circle<S>, theta_dot: S) -> Circle<S> {
    [-(theta_dot * p[1]), theta_dot * p[0]]
}

/// Returns (cos u, sin u), u in rad.
#[inline(always)]
pub fn exp<S: Scalar>(u: S) -> Circle<S> {
    let (sine, cosine) = u.sin_cos();
    [cosine, sine]
}

/// Returns the angle in rad, between −π and π.
#[inline]
pub fn log<S: Scalar>(p: Circle<S>) -> S {
    p[1].atan2(p[0])
}

/// Returns the point turned by u, in rad.
#[inline(always)]
pub fn retract<S: Scalar>(p: Circle<S>, u: S) -> Circle<S> {
    let [c, s] = exp(u);
    [p[0] * c - p[1] * s, p[1] * c + p[0] * s]
}

/// Returns p / |p|; NaN for p = 0.
#[inline(always)]
pub fn normalise<S: Scalar>(p: Circle<S>) -> Circle<S> {
    let norm = squared_norm(p).sqrt();
    p.map(|component| component / norm)
}

/// Returns −½ p (p·p − 1), the term −Ψ φ of KR18 (8) for c² + s² = 1.
#[inline]
pub fn correction<S: Scalar>(p: Circle<S>) -> Circle<S> {
    let factor = S::from_f64(0.5) * (S::from_f64(1.0) - squared_norm(p));
    p.map(|component| factor * component)
}

/// Returns |c² + s² − 1|.
#[inline]
pub fn defect<S: Scalar>(p: Circle<S>) -> S {
    (squared_norm(p) - S::from_f64(1.0)).abs()
}

#[inline(always)]
fn squared_norm<S: Scalar>(p: Circle<S>) -> S {
    p[0].mul_add(p[0], p[1] * p[1])
}
