//! Error tolerances, and the controller that turns an estimated error into the length of the next step.
//!
//! Source: E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II* (1996), IV.2; K.
//! Gustafsson, *Control theoretic techniques for stepsize selection*, ACM TOMS 17 (1991) 533.

use crate::error::StepError;
use crate::scalar::Scalar;
use crate::store::{Store, largest};
use crate::system::Block;

/// Error allowed in one step.
///
/// A step is accepted if each entry of its estimated error is below the tolerance of its kind. Errors at the end of a
/// run are proportional to the tolerance.
///
/// ```
/// use hamel::adaptive::{Adaptive, Tolerance};
///
/// // Positions to a micrometre whatever their size, angles to a milliradian.
/// let mut method = Adaptive::rkmk54(1e-6);
/// method.tolerance = Tolerance { angle: 1e-3, absolute: 1e-6, relative: 0.0 };
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Tolerance of circles, quaternions and rotations, in rad; at least the rounding unit of the scalar.
    pub angle: f64,
    /// Absolute tolerance of flat blocks and ξ, in their units.
    pub absolute: f64,
    /// Relative tolerance of flat blocks and ξ, with respect to the largest |entry| of the block or of ξ; zero, or at
    /// least the rounding unit of the scalar.
    pub relative: f64,
}

impl Tolerance {
    /// Creates a tolerance with the same number for all three: rad for angles, `tolerance` · (1 + |v|) for the rest.
    pub const fn new(tolerance: f64) -> Self {
        Self {
            angle: tolerance,
            absolute: tolerance,
            relative: tolerance,
        }
    }

    /// Checks that the scalar type can resolve these tolerances.
    pub(crate) fn check<S: Scalar>(&self) -> Result<(), StepError> {
        let between = |least: f64, value: f64| value >= least && value < f64::INFINITY;
        let relative = self.relative == 0.0 || between(S::EPSILON, self.relative);
        let absolute = between(f64::MIN_POSITIVE, self.absolute);
        if !between(S::EPSILON, self.angle) || !relative {
            Err(StepError::InvalidTolerance { least: S::EPSILON })
        } else if !absolute {
            let least = f64::MIN_POSITIVE;
            Err(StepError::InvalidTolerance { least })
        } else {
            Ok(())
        }
    }

    /// Returns the largest entry of a change (u, v) divided by its tolerance, in the worst lane; (x, ξ) give the sizes
    /// for the relative tolerance. Slopes of dual numbers count as entries. NaN if an entry is NaN.
    pub(crate) fn weigh<S: Scalar>(
        &self,
        blocks: &[Block],
        (u, v): (&impl Store<S>, &impl Store<S>),
        (x, xi): (&impl Store<S>, &impl Store<S>),
    ) -> f64 {
        let allowed = |list: &[S]| {
            S::from_f64(self.relative).mul_add(largest(list), S::from_f64(self.absolute))
        };
        let mut worst = largest(v.as_ref()) / allowed(xi.as_ref());
        let (mut u, mut x) = (u.as_ref(), x.as_ref());
        for block in blocks {
            let (Some((change, u_rest)), Some((here, x_rest))) = (
                u.split_at_checked(block.chart()),
                x.split_at_checked(block.coordinates()),
            ) else {
                break;
            };
            let tolerance = match block {
                Block::Flat(_) => allowed(here),
                Block::Circle | Block::Quaternion | Block::Rotation => S::from_f64(self.angle),
            };
            worst = Scalar::max(worst, largest(change) / tolerance);
            (u, x) = (u_rest, x_rest);
        }
        worst.largest_lane()
    }
}

/// Proportional-integral controller of the step length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Controller {
    /// Order p of the method, which sets the exponents of the control law.
    order: f64,
    /// Error of the last accepted step divided by its tolerance.
    before: f64,
    /// Whether the last attempt was rejected.
    refused: bool,
}

const SAFETY: f64 = 0.9;
const MIN_FACTOR: f64 = 0.2;
const MAX_FACTOR: f64 = 5.0;

impl Controller {
    pub(crate) fn new(order: u32) -> Self {
        Self {
            order: f64::from(order),
            before: 1e-4,
            refused: false,
        }
    }

    /// Returns the factor for the next step length after an accepted step with the scaled error q ≤ 1,
    /// 0.9 q^(−0.7/p) q₋₁^(0.4/p), limited to 0.2..5, and to at most 1 right after a rejection.
    pub(crate) fn accept(&mut self, q: f64) -> f64 {
        // Below 1e-10 the factor has reached its limit anyway, and zero has no logarithm.
        let q = q.max(1e-10);
        let factor = SAFETY * power(q, -0.7 / self.order) * power(self.before, 0.4 / self.order);
        let most = if self.refused { 1.0 } else { MAX_FACTOR };
        self.before = q.max(1e-4);
        self.refused = false;
        factor.clamp(MIN_FACTOR, most)
    }

    /// Returns the factor for another attempt, after one with the scaled error q > 1, or with none (NaN).
    pub(crate) fn refuse(&mut self, q: f64) -> f64 {
        self.refused = true;
        let factor = SAFETY * power(q, -1.0 / self.order);
        if factor > MIN_FACTOR {
            factor
        } else {
            MIN_FACTOR
        }
    }
}

/// Returns base^exponent for base > 0.
pub(crate) fn power(base: f64, exponent: f64) -> f64 {
    Scalar::exp(exponent * Scalar::ln(base))
}
