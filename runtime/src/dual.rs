//! Dual numbers: a number with its slopes (derivatives) along N directions, which all functions of this crate and all
//! generated functions propagate exactly.
//!
//! a + Σ aᵢ εᵢ with εᵢ εⱼ = 0: f(a + Σ aᵢ εᵢ) = f(a) + f′(a) Σ aᵢ εᵢ. A system in dual numbers yields the slopes of
//! everything computed with it: of a step ([`step_slopes`](crate::step_slopes)), of a run with respect to parameters,
//! of an output. Sources: W. K. Clifford, *Preliminary sketch of biquaternions*, Proc. London Math. Soc. 4 (1873); A.
//! Griewank, A. Walther, *Evaluating Derivatives*, SIAM (2008), chapter 3.

use core::array::from_fn;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::scalar::Scalar;
use crate::{s3, so3};

/// A number and its slopes along N directions.
///
/// Branches are decided by the value: at a jump or a corner the slope is that of the side taken. |a| has the slope 0 at
/// 0, and so has a length √(a·a) at a = 0, as in generated code; √a of a number that grows from 0 has a large slope.
/// Convergence tests ([`size`](Scalar::magnitude), [`beside`](Scalar::relative_to), [`largest_lane`](Scalar::largest_lane)) take
/// slopes and value into account alike.
///
/// ```
/// use hamel::{Dual, Scalar};
///
/// // d/dx (x² sin x) at 2, and the same by another parameter that is not there.
/// let x = Dual::<f64, 2>::along(2.0, 0);
/// let y = x * x * x.sin_cos().0;
/// let slope = 4.0 * 2.0_f64.sin() + 4.0 * 2.0_f64.cos();
/// assert!((y.slopes[0] - slope).abs() < 1e-15 && y.slopes[1] == 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<S, const N: usize> {
    /// Value a.
    pub value: S,
    /// Slopes a₁, …, a_N.
    pub slopes: [S; N],
}

impl<S: Scalar, const N: usize> Dual<S, N> {
    /// Creates a constant, whose slopes are zero.
    #[inline]
    pub fn constant(value: S) -> Self {
        Dual {
            value,
            slopes: [S::default(); N],
        }
    }

    /// Creates a number with slope 1 along one direction; a direction of N or more gives a constant.
    #[inline]
    pub fn along(value: S, direction: usize) -> Self {
        let (zero, one) = (S::default(), S::from_f64(1.0));
        Dual {
            value,
            slopes: from_fn(|i| if i == direction { one } else { zero }),
        }
    }

    /// Returns f(a), given the value and the derivative of f at a (chain rule).
    #[inline]
    fn chain(self, value: S, slope: S) -> Self {
        Dual {
            value,
            slopes: self.slopes.map(|own| slope * own),
        }
    }

    /// Returns the largest |slope|.
    #[inline]
    fn steepest(self) -> S {
        let slopes = self.slopes.into_iter();
        slopes.fold(S::default(), |largest, slope| {
            largest.max(slope.magnitude())
        })
    }

    /// Selects value and slopes from two numbers by `choose`.
    #[inline]
    fn chosen(choose: impl Fn(S, S) -> S, one: Self, other: Self) -> Self {
        Dual {
            value: choose(one.value, other.value),
            slopes: from_fn(|i| choose(one.slopes[i], other.slopes[i])),
        }
    }
}

/// Returns the slopes of θ = dexp(u) δu.
#[inline(always)]
fn turns<S: Scalar, const N: usize>(by: so3::Vector<S>, u: so3::Vector<Dual<S, N>>) -> [[S; N]; 3] {
    let dexp = so3::dexp(by);
    let [x, y, z] = u.map(|entry| entry.slopes);
    from_fn(|i| {
        from_fn(|d| {
            dexp[3 * i].mul_add(x[d], dexp[3 * i + 1].mul_add(y[d], dexp[3 * i + 2] * z[d]))
        })
    })
}

impl<S: Scalar, const N: usize> Default for Dual<S, N> {
    fn default() -> Self {
        Dual::constant(S::default())
    }
}

impl<S: Scalar, const N: usize> Add for Dual<S, N> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Dual {
            value: self.value + other.value,
            slopes: from_fn(|i| self.slopes[i] + other.slopes[i]),
        }
    }
}

impl<S: Scalar, const N: usize> Sub for Dual<S, N> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Dual {
            value: self.value - other.value,
            slopes: from_fn(|i| self.slopes[i] - other.slopes[i]),
        }
    }
}

impl<S: Scalar, const N: usize> Mul for Dual<S, N> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Dual {
            value: self.value * other.value,
            slopes: from_fn(|i| {
                self.value
                    .mul_add(other.slopes[i], self.slopes[i] * other.value)
            }),
        }
    }
}

impl<S: Scalar, const N: usize> Div for Dual<S, N> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let inverse = S::from_f64(1.0) / other.value;
        Dual {
            value,
            slopes: from_fn(|i| inverse * (-value).mul_add(other.slopes[i], self.slopes[i])),
        }
    }
}

impl<S: Scalar, const N: usize> Neg for Dual<S, N> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Dual {
            value: -self.value,
            slopes: self.slopes.map(|slope| -slope),
        }
    }
}

macro_rules! assign {
    ($($trait:ident $function:ident $operation:ident,)*) => {$(
        impl<S: Scalar, const N: usize> $trait for Dual<S, N> {
            #[inline]
            fn $function(&mut self, other: Self) {
                *self = self.$operation(other);
            }
        }
    )*};
}
assign!(AddAssign add_assign add, SubAssign sub_assign sub, MulAssign mul_assign mul, DivAssign div_assign div,);

impl<S: Scalar, const N: usize> Scalar for Dual<S, N> {
    const EPSILON: f64 = S::EPSILON;

    #[inline]
    fn from_f64(value: f64) -> Self {
        Dual::constant(S::from_f64(value))
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    #[inline]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, S::from_f64(0.5) * root.inverse_of_length())
    }

    #[inline]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }

    #[inline]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), S::from_f64(1.0) / self.value)
    }

    #[inline]
    fn ln_1p(self) -> Self {
        let one = S::from_f64(1.0);
        self.chain(self.value.ln_1p(), one / (one + self.value))
    }

    #[inline]
    fn exp_m1(self) -> Self {
        self.chain(self.value.exp_m1(), self.value.exp())
    }

    #[inline]
    fn sinh(self) -> Self {
        self.chain(self.value.sinh(), self.value.cosh())
    }

    #[inline]
    fn cosh(self) -> Self {
        self.chain(self.value.cosh(), self.value.sinh())
    }

    #[inline]
    fn tanh(self) -> Self {
        let value = self.value.tanh();
        self.chain(value, (-value).mul_add(value, S::from_f64(1.0)))
    }

    /// Uses d atan2(y, x) = (x dy − y dx)/(x² + y²), 0 at the origin.
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let length = (self.value * self.value + x.value * x.value).sqrt();
        let inverse = length.inverse_of_length();
        let (along, across) = (x.value * inverse, self.value * inverse);
        Dual {
            value: self.value.atan2(x.value),
            slopes: from_fn(|i| inverse * (along * self.slopes[i] - across * x.slopes[i])),
        }
    }

    #[inline]
    fn abs(self) -> Self {
        self.chain(self.value.abs(), self.value.sign())
    }

    #[inline]
    fn magnitude(self) -> Self {
        Dual::constant(self.value.magnitude().max(self.steepest()))
    }

    #[inline]
    fn relative_to(self, a: Self, b: Self) -> Self {
        let of_value = self.value.relative_to(a.value, b.value);
        let of_slopes = self.steepest().relative_to(a.steepest(), b.steepest());
        Dual::constant(of_value.max(of_slopes))
    }

    #[inline]
    fn inner_plus(self, a: Self, b: Self) -> Self {
        let sum = self.value.inner_plus(a.value, b.value);
        let slopes = self.slopes.into_iter().zip(a.slopes);
        Dual::constant(slopes.fold(sum, |sum, (one, other)| one.inner_plus(other, sum)))
    }

    #[inline]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Dual {
            value: self.value.mul_add(a.value, b.value),
            slopes: from_fn(|i| {
                self.value
                    .mul_add(a.slopes[i], self.slopes[i].mul_add(a.value, b.slopes[i]))
            }),
        }
    }

    #[inline]
    fn scale(&mut self, a: f64) {
        self.value.scale(a);
        for slope in &mut self.slopes {
            slope.scale(a);
        }
    }

    #[inline]
    fn times_plus(self, a: f64, b: Self) -> Self {
        let a = S::from_f64(a);
        Dual {
            value: a.mul_add(self.value, b.value),
            slopes: from_fn(|i| a.mul_add(self.slopes[i], b.slopes[i])),
        }
    }

    #[inline]
    fn max(self, other: Self) -> Self {
        let larger = |one, two| other.value.select_lt(self.value, one, two);
        Dual {
            value: self.value.max(other.value),
            ..Dual::chosen(larger, self, other)
        }
    }

    #[inline]
    fn select_lt(self, limit: Self, then: Self, otherwise: Self) -> Self {
        Dual::chosen(
            |one, two| self.value.select_lt(limit.value, one, two),
            then,
            otherwise,
        )
    }

    /// Uses δ(R E) = δR E + R E θ̂ for E = exp(û), θ = dexp(u) δu.
    #[inline]
    fn turned_matrix(r: so3::Matrix<Self>, u: so3::Vector<Self>) -> so3::Matrix<Self> {
        let (values, by) = (r.map(|entry| entry.value), u.map(|entry| entry.value));
        let e = so3::exp(by);
        let turned = so3::product(values, e);
        let theta = turns(by, u);
        from_fn(|k| {
            let (i, j) = (k / 3, k % 3);
            let (next, last) = ((j + 1) % 3, (j + 2) % 3);
            let slopes = from_fn(|d| {
                let moved = r[3 * i].slopes[d].mul_add(
                    e[j],
                    r[3 * i + 1].slopes[d].mul_add(e[3 + j], r[3 * i + 2].slopes[d] * e[6 + j]),
                );
                // Column j of θ̂ has θ_last in row next, −θ_next in row last.
                turned[3 * i + next].mul_add(
                    theta[last][d],
                    (-turned[3 * i + last]).mul_add(theta[next][d], moved),
                )
            });
            Dual {
                value: turned[k],
                slopes,
            }
        })
    }

    /// Uses δ(q ⊗ e) = δq ⊗ e + ½ q ⊗ e ⊗ (0, θ) for e = exp(u), θ = dexp(u) δu.
    #[inline]
    fn turned_quaternion(q: s3::Quaternion<Self>, u: so3::Vector<Self>) -> s3::Quaternion<Self> {
        let (values, by) = (q.map(|entry| entry.value), u.map(|entry| entry.value));
        let e = s3::exp(by);
        let turned = s3::product(values, e);
        let theta = turns(by, u);
        let mut result = turned.map(Dual::constant);
        for d in 0..N {
            let moved = s3::product(q.map(|entry| entry.slopes[d]), e);
            let along = s3::rate(turned, theta.map(|slopes| slopes[d]));
            for (number, (moved, along)) in result.iter_mut().zip(moved.into_iter().zip(along)) {
                number.slopes[d] = moved + along;
            }
        }
        result
    }

    #[inline]
    fn chart_velocity(u: so3::Vector<Self>, w: so3::Vector<Self>) -> so3::Vector<Self> {
        if N <= 6 {
            return so3::chart_velocity(u, w);
        }
        let along = |number: Self, direction| Dual::<S, 6>::along(number.value, direction);
        let of_u = from_fn(|k| along(u[k], k));
        let of_w = from_fn(|k| along(w[k], 3 + k));
        so3::chart_velocity(of_u, of_w).map(|entry| Dual {
            value: entry.value,
            slopes: from_fn(|d| {
                let [a, b, c, x, y, z] = entry.slopes;
                let by_w = x.mul_add(
                    w[0].slopes[d],
                    y.mul_add(w[1].slopes[d], z * w[2].slopes[d]),
                );
                let by_u = b.mul_add(u[1].slopes[d], c.mul_add(u[2].slopes[d], by_w));
                a.mul_add(u[0].slopes[d], by_u)
            }),
        })
    }

    #[inline]
    fn nearest_whole(self) -> Self {
        Dual::constant(self.value.nearest_whole())
    }

    #[inline]
    fn is_positive(self) -> bool {
        self.value.is_positive()
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.value.is_finite() && self.slopes.iter().all(|slope| slope.is_finite())
    }

    #[inline]
    fn largest_lane(self) -> f64 {
        self.magnitude().value.largest_lane()
    }
}

#[cfg(test)]
mod tests {
    use super::Dual;
    use crate::scalar::Scalar;
    use crate::{s3, so3};

    type Number = Dual<f64, 7>;

    /// Returns numbers whose slopes are about 1, from a linear congruential generator.
    fn numbers<const N: usize>(seed: &mut u64, size: f64) -> [Number; N] {
        let mut next = || {
            *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        core::array::from_fn(|_| Dual {
            value: size * next(),
            slopes: core::array::from_fn(|_| next()),
        })
    }

    fn agree(found: &[Number], wanted: &[Number], close: f64) {
        for (found, wanted) in found.iter().zip(wanted) {
            let pairs = found.slopes.iter().zip(&wanted.slopes);
            for (a, b) in pairs.chain([(&found.value, &wanted.value)]) {
                assert!((a - b).abs() < close, "{a} {b}");
            }
        }
    }

    /// Retractions by the derivative of exp agree with exp evaluated in dual numbers, for small and large angles, and
    /// whatever the slopes of the retracted rotation are.
    #[test]
    fn derivatives_of_turns_are_those_of_their_formulas() {
        let seed = &mut 7;
        for size in [1e-12, 1e-7, 1e-3, 0.2, 0.29, 0.4, 1.0, 2.0, 3.4] {
            for _ in 0..50 {
                let u: [Number; 3] = numbers(seed, size);
                let (r, q, w) = (numbers(seed, 1.0), numbers(seed, 1.0), numbers(seed, 1.0));
                agree(&so3::retract(r, u), &so3::product(r, so3::exp(u)), 2e-14);
                agree(&s3::retract(q, u), &s3::product(q, s3::exp(u)), 2e-14);
                // dexpinv is singular at a whole turn.
                if size < 3.0 {
                    agree(&so3::dexpinv(u, w), &so3::chart_velocity(u, w), 2e-13);
                }
            }
        }
    }

    #[test]
    fn factors_that_do_not_vary_multiply_value_and_slopes() {
        let [a, b]: [Number; 2] = numbers(&mut 3, 1.0);
        let mut scaled = a;
        scaled.scale(-1.7);
        agree(&[scaled], &[Number::from_f64(-1.7) * a], 1e-15);
        agree(
            &[a.times_plus(0.3, b)],
            &[Number::from_f64(0.3) * a + b],
            1e-15,
        );
    }
}
