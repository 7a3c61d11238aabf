//! The unknowns (u, ξ₁) of an implicit step, and the convergence tests of the iterations that solve for them.

use crate::scalar::Scalar;
use crate::state::State;
use crate::store::{is_finite, largest};
use crate::system::{Block, System};

/// Number of steps that Broyden's method remembers before it starts anew.
pub(in crate::methods) const MAX_REMEMBERED_STEPS: usize = 16;
/// Correction at which an iteration ends, in rounding units; the remaining error is smaller by the rate of convergence.
pub(in crate::methods) const CONVERGED_ULPS: f64 = 256.0;
/// Factor by which a residual may exceed the correction times the largest growth seen.
const GROWTH_MARGIN: f64 = 10.0;
/// Growth of residuals above which a system counts as stiff.
const STIFF_GROWTH: f64 = 100.0;
/// Number of successive corrections that bring no entry nearer, after which the remaining changes count as rounding.
const MAX_IDLE_CORRECTIONS: u32 = 4;

/// The unknowns (u, ξ₁), or a change or residual of them.
pub(in crate::methods) struct Unknowns<Sys: System + ?Sized> {
    pub(in crate::methods) u: Sys::Chart,
    pub(in crate::methods) xi: Sys::Velocities,
}

impl<Sys: System + ?Sized> Unknowns<Sys> {
    pub(in crate::methods) fn zero(system: &Sys) -> Self {
        Self {
            u: system.zero_chart(),
            xi: system.zero_velocities(),
        }
    }

    pub(in crate::methods) fn entries(&mut self) -> impl Iterator<Item = &mut Sys::Scalar> {
        self.u.as_mut().iter_mut().chain(self.xi.as_mut())
    }

    pub(in crate::methods) fn add_multiple(&mut self, a: Sys::Scalar, other: &Self) {
        let others = other.u.as_ref().iter().chain(other.xi.as_ref());
        for (own, other) in self.entries().zip(others) {
            *own = a.mul_add(*other, *own);
        }
    }

    /// Returns Σ aᵢ bᵢ, where `add(a, b, sum)` adds one product.
    pub(in crate::methods) fn dot(
        &self,
        other: &Self,
        add: impl Fn(Sys::Scalar, Sys::Scalar, Sys::Scalar) -> Sys::Scalar,
    ) -> Sys::Scalar {
        let u = self.u.as_ref().iter().zip(other.u.as_ref());
        let xi = self.xi.as_ref().iter().zip(other.xi.as_ref());
        u.chain(xi)
            .fold(Sys::Scalar::default(), |sum, (a, b)| add(*a, *b, sum))
    }

    /// Returns the coefficient of the projection of `other` onto this step. If the square of the step is not above
    /// `rest`, the values are rounding, and the slopes of dual numbers (if any) are used as well.
    pub(in crate::methods) fn along(&self, other: &Self, rest: Sys::Scalar) -> Sys::Scalar {
        let (product, inner) = (Scalar::mul_add, Scalar::inner_plus);
        let square = self.dot(self, product);
        let by_value = ratio(self.dot(other, product), square);
        let by_slopes = ratio(self.dot(other, inner), self.dot(self, inner));
        rest.select_lt(square, by_value, by_slopes)
    }

    /// Returns max(|u|, h |ξ|).
    pub(in crate::methods) fn length(&self, h: f64) -> Sys::Scalar {
        let of_xi = Sys::Scalar::from_f64(h.abs()) * largest(self.xi.as_ref());
        Scalar::max(largest(self.u.as_ref()), of_xi)
    }

    pub(in crate::methods) fn is_finite(&self) -> bool {
        is_finite(self.u.as_ref()) && is_finite(self.xi.as_ref())
    }
}

impl<Sys: System + ?Sized> Clone for Unknowns<Sys> {
    fn clone(&self) -> Self {
        Self {
            u: self.u.clone(),
            xi: self.xi.clone(),
        }
    }
}

/// Returns a / b, and 0 in the lanes where b is zero, which have converged.
pub(in crate::methods) fn ratio<S: Scalar>(a: S, b: S) -> S {
    S::default().select_lt(b.abs(), a / b, S::default())
}

/// Progress and convergence tests of an iteration.
pub(in crate::methods) struct Progress<Sys: System + ?Sized> {
    /// Reference sizes of the unknowns: x (flat) or 1 rad (angles), and ξ at the start of the step.
    start: Unknowns<Sys>,
    /// Smallest correction of each unknown so far, relative to the size of the unknown; 0 before the first.
    least: Unknowns<Sys>,
    /// Largest |x| at the start of the step.
    reach: Sys::Scalar,
    /// Number of successive corrections that brought no unknown nearer.
    pub(in crate::methods) idle: u32,
    /// Lengths of the last residual and correction.
    last: (Sys::Scalar, Sys::Scalar),
    /// Largest growth of the residual per length of correction, at least 1: about 1 + h L, with L the stiffest rate.
    growth: Sys::Scalar,
}

impl<Sys: System + ?Sized> Progress<Sys> {
    pub(in crate::methods) fn new(system: &Sys, state: &State<Sys>) -> Self {
        let mut start = Unknowns::zero(system);
        start.xi = state.xi.clone();
        let (mut u, mut x) = (start.u.as_mut(), state.x.as_ref());
        for block in system.blocks() {
            let (Some((here, u_rest)), Some((of, x_rest))) = (
                u.split_at_mut_checked(block.chart()),
                x.split_at_checked(block.coordinates()),
            ) else {
                break;
            };
            match block {
                Block::Flat(_) => here.copy_from_slice(of),
                Block::Circle | Block::Quaternion | Block::Rotation => {
                    here.fill(Sys::Scalar::from_f64(1.0));
                }
            }
            (u, x) = (u_rest, x_rest);
        }
        Self {
            start,
            least: Unknowns::zero(system),
            reach: largest(state.x.as_ref()),
            idle: 0,
            last: Default::default(),
            growth: Sys::Scalar::from_f64(1.0),
        }
    }

    /// Returns whether z, after a correction, is the solution. This holds if the correction of every unknown is small
    /// relative to the size of this unknown and its change over the step, or if the corrections no longer shrink and
    /// are of the size of rounding.
    ///
    /// A correction that is shorter than the residual by more than the observed growth of residuals is not trusted: it
    /// is small because of a wrong approximation of the Jacobian. f is rounded together with x, which changes a
    /// velocity by h k ε |x| for a spring of stiffness k, so that a velocity is no more certain than ε (|ξ| + |x|/h),
    /// however small it is.
    pub(in crate::methods) fn is_over(
        &mut self,
        z: &Unknowns<Sys>,
        correction: &Unknowns<Sys>,
        defect: Sys::Scalar,
        h: f64,
    ) -> bool {
        let (zero, one) = (Sys::Scalar::default(), Sys::Scalar::from_f64(1.0));
        let enough = Sys::Scalar::from_f64(CONVERGED_ULPS * Sys::Scalar::EPSILON);
        let (mut moving, mut nearer) = (zero, zero);
        let mut judge = |correction: Sys::Scalar, start, change, least: &mut Sys::Scalar| {
            let part = correction.relative_to(start, change);
            let moves = enough.select_lt(part, one, zero);
            let shrinks = part.select_lt(Sys::Scalar::from_f64(0.9) * *least, moves, zero);
            moving = Scalar::max(moving, moves);
            nearer = Scalar::max(nearer, zero.select_lt(*least, shrinks, moves));
            let known = zero.select_lt(*least, *least, part);
            *least = part.select_lt(known, part, known);
        };
        let of_u = correction.u.as_ref().iter().zip(z.u.as_ref());
        let from = self.start.u.as_ref().iter().zip(self.least.u.as_mut());
        for ((correction, u), (start, least)) in of_u.zip(from) {
            judge(*correction, *start, *u, least);
        }
        let of_xi = correction.xi.as_ref().iter().zip(z.xi.as_ref());
        let from = self.start.xi.as_ref().iter().zip(self.least.xi.as_mut());
        for ((correction, xi), (start, least)) in of_xi.zip(from) {
            judge(*correction, *start, *xi - *start, least);
        }
        let length = correction.length(h);
        let grown = ratio(defect - self.last.0, self.last.1);
        self.growth = Scalar::max(self.growth, grown);
        self.last = (defect, length);
        let credible = Sys::Scalar::from_f64(GROWTH_MARGIN) * self.growth * length;
        let trusted = credible.select_lt(defect, one, zero).largest_lane() == 0.0;
        if moving.largest_lane() == 0.0 {
            return trusted;
        }
        self.idle = if nearer.largest_lane() == 0.0 {
            self.idle + 1
        } else {
            0
        };
        let whole = self.whole(z, correction, h).largest_lane();
        trusted
            && self.idle >= MAX_IDLE_CORRECTIONS
            && whole <= CONVERGED_ULPS * Sys::Scalar::EPSILON
    }

    /// Returns whether residuals grew so much per correction that the system is stiff.
    pub(in crate::methods) fn is_stiff(&self) -> bool {
        self.growth.largest_lane() > STIFF_GROWTH
    }

    /// Returns whether a residual is no more than the effect of rounding in z along the stiffest direction seen.
    pub(in crate::methods) fn is_solved(
        &self,
        z: &Unknowns<Sys>,
        defect: &Unknowns<Sys>,
        h: f64,
    ) -> bool {
        let part = self.whole(z, defect, h) / self.growth;
        defect.is_finite()
            && part.largest_lane() <= STIFF_GROWTH * CONVERGED_ULPS * Sys::Scalar::EPSILON
    }

    /// Returns the size of a correction relative to all of z and the start of the step; rounding is of the size ε.
    pub(in crate::methods) fn whole(
        &self,
        z: &Unknowns<Sys>,
        correction: &Unknowns<Sys>,
        h: f64,
    ) -> Sys::Scalar {
        let h = Sys::Scalar::from_f64(h.abs());
        let reach = self.reach + largest(z.u.as_ref());
        let of_u = largest(correction.u.as_ref()) / reach;
        let of_xi = h * largest(correction.xi.as_ref()) / h.mul_add(largest(z.xi.as_ref()), reach);
        Scalar::max(of_u, of_xi)
    }
}
