//! Rotations applied to an attitude, whether it is stored as a matrix or as a quaternion.

use core::array::from_fn;

use crate::scalar::Scalar;
use crate::so3::{self, Matrix, Vector, by_series};
use crate::{s3, so3::SINE_RATIO, so3::VERSINE_RATIO};

/// A rotation, body to world, that can be turned in its own (body) axes.
pub trait Attitude<S: Scalar>: Copy {
    /// Returns the identity.
    fn identity() -> Self;

    /// Returns the attitude turned by |u| about u.
    fn turned(self, u: Vector<S>) -> Self;

    /// Returns the attitude turned by a unit quaternion.
    fn turned_by(self, f: s3::Quaternion<S>) -> Self;

    /// Returns the attitude turned by a rotation matrix. Of the two quaternions of the matrix, the one closer to `near`
    /// is used; `near` need not be exact.
    fn turned_by_matrix(self, f: Matrix<S>, near: impl FnOnce() -> s3::Quaternion<S>) -> Self;

    /// Returns the attitude turned by cay(f), that is, by 2 atan|f| about f.
    fn turned_by_cayley(self, f: Vector<S>) -> Self;

    /// Returns the attitude turned about body axis `axis` by an angle in rad, and the sine and cosine of the angle.
    fn turned_about(self, axis: usize, angle: S) -> (Self, SineCosine<S>);
}

/// Sine and cosine of an angle.
#[derive(Clone, Copy, Debug)]
pub struct SineCosine<S> {
    /// The sine.
    pub sine: S,
    /// The cosine.
    pub cosine: S,
}

impl<S: Scalar> SineCosine<S> {
    /// Computes sine and cosine of an angle in rad, by series below half a radian.
    #[inline(always)]
    pub fn of(angle: S) -> Self {
        let t2 = angle * angle;
        let one = S::from_f64(1.0);
        let [a, b] = by_series(t2, [SINE_RATIO, VERSINE_RATIO], || {
            let (sine, cosine) = angle.sin_cos();
            [sine / angle, (one - cosine) / t2]
        });
        Self {
            sine: a * angle,
            cosine: one - b * t2,
        }
    }

    /// Returns sine and cosine of twice the angle.
    #[inline(always)]
    pub fn doubled(self) -> Self {
        let twice = S::from_f64(2.0) * self.sine;
        Self {
            sine: twice * self.cosine,
            cosine: S::from_f64(1.0) - twice * self.sine,
        }
    }

    /// Updates the components p, in body axes, of a vector at rest in the world after the body has turned by this angle
    /// about `axis`.
    #[inline(always)]
    pub fn turn_back(self, axis: usize, p: &mut Vector<S>) {
        let (b, c) = others(axis);
        let (along, across) = (p[b], p[c]);
        p[b] = self.cosine.mul_add(along, self.sine * across);
        p[c] = self.cosine.mul_add(across, -(self.sine * along));
    }
}

/// Returns the two axes that follow `axis` in cyclic order.
#[inline(always)]
pub(crate) const fn others(axis: usize) -> (usize, usize) {
    match axis {
        0 => (1, 2),
        1 => (2, 0),
        _ => (0, 1),
    }
}

impl<S: Scalar> Attitude<S> for Matrix<S> {
    #[inline(always)]
    fn identity() -> Self {
        so3::identity()
    }

    #[inline(always)]
    fn turned(self, u: Vector<S>) -> Self {
        so3::retract(self, u)
    }

    #[inline(always)]
    fn turned_by(self, f: s3::Quaternion<S>) -> Self {
        so3::product(self, s3::to_matrix(f))
    }

    #[inline(always)]
    fn turned_by_matrix(self, f: Matrix<S>, _: impl FnOnce() -> s3::Quaternion<S>) -> Self {
        so3::product(self, f)
    }

    #[inline(always)]
    fn turned_by_cayley(self, f: Vector<S>) -> Self {
        so3::product(self, so3::cayley(f))
    }

    #[inline(always)]
    fn turned_about(self, axis: usize, angle: S) -> (Self, SineCosine<S>) {
        let angle = SineCosine::of(angle);
        let mut r = self;
        for row in 0..3 {
            let mut entries: Vector<S> = from_fn(|column| r[3 * row + column]);
            angle.turn_back(axis, &mut entries);
            for column in 0..3 {
                r[3 * row + column] = entries[column];
            }
        }
        (r, angle)
    }
}

impl<S: Scalar> Attitude<S> for s3::Quaternion<S> {
    #[inline(always)]
    fn identity() -> Self {
        let zero = S::default();
        [S::from_f64(1.0), zero, zero, zero]
    }

    #[inline(always)]
    fn turned(self, u: Vector<S>) -> Self {
        s3::retract(self, u)
    }

    #[inline(always)]
    fn turned_by(self, f: s3::Quaternion<S>) -> Self {
        s3::product(self, f)
    }

    #[inline(always)]
    fn turned_by_matrix(self, f: Matrix<S>, near: impl FnOnce() -> s3::Quaternion<S>) -> Self {
        let (zero, f) = (S::default(), s3::from_matrix(f));
        let along = f.iter().zip(near());
        let along = along.fold(zero, |sum, (&a, b)| a.mul_add(b, sum));
        let f = f.map(|entry| along.select_lt(zero, -entry, entry));
        s3::product(self, f)
    }

    #[inline(always)]
    fn turned_by_cayley(self, f: Vector<S>) -> Self {
        let one = S::from_f64(1.0);
        let norm = (one + so3::dot(f, f)).sqrt();
        s3::product(self, [one, f[0], f[1], f[2]]).map(|entry| entry / norm)
    }

    #[inline(always)]
    fn turned_about(self, axis: usize, angle: S) -> (Self, SineCosine<S>) {
        let half = SineCosine::of(S::from_f64(0.5) * angle);
        let (b, c) = others(axis);
        let (along, beside, across) = (1 + axis, 1 + b, 1 + c);
        let mut q = self;
        q[0] = half.cosine * self[0] - half.sine * self[along];
        q[along] = half.cosine * self[along] + half.sine * self[0];
        q[beside] = half.cosine * self[beside] + half.sine * self[across];
        q[across] = half.cosine * self[across] - half.sine * self[beside];
        (q, half.doubled())
    }
}
