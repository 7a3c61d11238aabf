//! Euler's implicit step in the chart, of order 1.
//!
//! u = h w(x ⊕ u, ξ₁), ξ₁ = ξ + h f(x ⊕ u, ξ₁), x₁ = x ⊕ u, solved for z = (u, ξ₁) by Broyden's method:
//! it starts as the fixed-point iteration, learns the stiff directions from its own steps, and needs no
//! derivatives. In numbers with slopes it learns from the values, and from the slopes once the values rest. Source: C. T.
//! Kelley, *Iterative Methods for Linear and Nonlinear Equations* (1995), 7.3.

use core::array::from_fn;

use crate::error::StepError;
use crate::integrate::acceleration;
use crate::manifold;
use crate::methods::{Method, arrive};
use crate::scalar::Scalar;
use crate::state::State;
use crate::store::{add_scaled, is_finite, largest, scale};
use crate::system::{Block, System};

/// Order 1, some six evaluations of ξ̇ a step and more where the system is stiff.
///
/// Damps every oscillation; stable at any step that it can solve, and [`StepError::NotConverged`] where it cannot, as of
/// several very stiff directions at once, which [`StiffEuler`](crate::methods::StiffEuler) solves. Each unknown is found to
/// rounding by itself, and in numbers with slopes so are the slopes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BackwardEuler;

/// Steps that the iteration remembers before it starts anew.
pub(super) const MEMORY: usize = 16;
/// Evaluations after which the iteration has failed.
const MOST: u32 = 64;
/// The correction at which it ends, in units of the last place; the error that it leaves is smaller by the rate of
/// convergence.
pub(super) const ENOUGH: f64 = 256.0;
/// How much longer a defect may be than the correction times the largest growth seen.
const MARGIN: f64 = 10.0;
/// Corrections in a row that bring no entry nearer, after which what is left is rounding.
const PATIENCE: u32 = 4;

/// (u, ξ₁), or a change or a residual of it.
pub(super) struct Unknowns<Sys: System + ?Sized> {
    pub(super) u: Sys::Chart,
    pub(super) xi: Sys::Velocities,
}

impl<Sys: System + ?Sized> Unknowns<Sys> {
    pub(super) fn zero(system: &Sys) -> Self {
        Self {
            u: system.zero_chart(),
            xi: system.zero_velocities(),
        }
    }

    fn entries(&mut self) -> impl Iterator<Item = &mut Sys::Scalar> {
        self.u.as_mut().iter_mut().chain(self.xi.as_mut())
    }

    pub(super) fn add_multiple(&mut self, a: Sys::Scalar, other: &Self) {
        let others = other.u.as_ref().iter().chain(other.xi.as_ref());
        for (own, other) in self.entries().zip(others) {
            *own = a.mul_add(*other, *own);
        }
    }

    /// Σ aᵢ bᵢ by the function that adds one such product.
    fn dot(
        &self,
        other: &Self,
        add: impl Fn(Sys::Scalar, Sys::Scalar, Sys::Scalar) -> Sys::Scalar,
    ) -> Sys::Scalar {
        let u = self.u.as_ref().iter().zip(other.u.as_ref());
        let xi = self.xi.as_ref().iter().zip(other.xi.as_ref());
        u.chain(xi)
            .fold(Sys::Scalar::default(), |sum, (a, b)| add(*a, *b, sum))
    }

    /// The part of another along this step. A step whose square is not above `rest` has only slopes to go by, if any.
    fn along(&self, other: &Self, rest: Sys::Scalar) -> Sys::Scalar {
        let (product, inner) = (Scalar::mul_add, Scalar::inner_plus);
        let square = self.dot(self, product);
        let by_value = ratio(self.dot(other, product), square);
        let by_slopes = ratio(self.dot(other, inner), self.dot(self, inner));
        rest.select_lt(square, by_value, by_slopes)
    }

    /// max(|u|, h |ξ|)
    fn length(&self, h: f64) -> Sys::Scalar {
        let of_xi = Sys::Scalar::from_f64(h.abs()) * largest(self.xi.as_ref());
        Scalar::max(largest(self.u.as_ref()), of_xi)
    }

    fn is_finite(&self) -> bool {
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

/// a / b, and 0 in the lanes where b is zero: those have converged.
pub(super) fn ratio<S: Scalar>(a: S, b: S) -> S {
    S::default().select_lt(b.abs(), a / b, S::default())
}

/// How far the iteration has come.
pub(super) struct Progress<Sys: System + ?Sized> {
    /// What each unknown starts from: x (flat) or 1 rad (angles), and ξ.
    start: Unknowns<Sys>,
    /// The least corrections so far, each beside the size of its unknown; 0 before the first.
    least: Unknowns<Sys>,
    /// The largest |x|.
    reach: Sys::Scalar,
    /// Corrections in a row that brought no unknown nearer.
    pub(super) idle: u32,
    /// The lengths of the last defect and correction.
    last: (Sys::Scalar, Sys::Scalar),
    /// By how much defects grew for the corrections made, at most, or 1: 1 + h L or nearly so, L the stiffest rate.
    growth: Sys::Scalar,
}

impl<Sys: System + ?Sized> Progress<Sys> {
    pub(super) fn new(system: &Sys, state: &State<Sys>) -> Self {
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

    /// Whether z, after a correction, is the solution: the correction is small beside the size of every unknown and its
    /// change over the step, each by itself, or the corrections no longer shrink and are of the size of rounding.
    ///
    /// A correction that is shorter than the defect by more than defects were seen to grow is small by what was learnt
    /// wrong. f is rounded as x is, by h k ε |x| for a spring of stiffness k, so that a velocity is no more certain than
    /// ε (|ξ| + |x|/h) however small it is.
    pub(super) fn is_over(
        &mut self,
        z: &Unknowns<Sys>,
        correction: &Unknowns<Sys>,
        defect: Sys::Scalar,
        h: f64,
    ) -> bool {
        let (zero, one) = (Sys::Scalar::default(), Sys::Scalar::from_f64(1.0));
        let enough = Sys::Scalar::from_f64(ENOUGH * Sys::Scalar::EPSILON);
        let (mut moving, mut nearer) = (zero, zero);
        let mut judge = |correction: Sys::Scalar, start, change, least: &mut Sys::Scalar| {
            let part = correction.beside(start, change);
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
        let credible = Sys::Scalar::from_f64(MARGIN) * self.growth * length;
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
        trusted && self.idle >= PATIENCE && whole <= ENOUGH * Sys::Scalar::EPSILON
    }

    /// The part that a correction makes of the whole of z and of where the step begins: rounding is of the size ε.
    pub(super) fn whole(
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

impl<Sys: System + ?Sized> Method<Sys> for BackwardEuler {
    fn order(&self) -> u32 {
        1
    }

    fn step<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        state.check_shape(system)?;
        let one = Sys::Scalar::from_f64(1.0);
        let rounding = Sys::Scalar::from_f64(Sys::Scalar::EPSILON * Sys::Scalar::EPSILON);
        let point = |u: &Sys::Chart| {
            let mut x = state.x.clone();
            manifold::retract(system.blocks(), x.as_mut(), u.as_ref());
            x
        };
        // (h w, ξ + h f) − z
        let defect = |z: &Unknowns<Sys>| {
            let x = point(&z.u);
            let mut u = system.chart_rate(&x, &z.xi);
            scale(u.as_mut(), h);
            let mut xi = state.xi.clone();
            let f = acceleration(system, state.t, h, &x, &z.xi, inputs)?;
            add_scaled(xi.as_mut(), h, f.as_ref());
            let mut defect: Unknowns<Sys> = Unknowns { u, xi };
            defect.add_multiple(-one, z);
            Ok(defect)
        };

        let mut z = Unknowns::<Sys> {
            u: system.chart_rate(&state.x, &state.xi),
            xi: state.xi.clone(),
        };
        scale(z.u.as_mut(), h);
        let mut steps: [Unknowns<Sys>; MEMORY] = from_fn(|_| Unknowns::zero(system));
        // Steps that rounding hides have squares below these.
        let mut rests = [Sys::Scalar::default(); MEMORY];
        let mut known = 0;
        let mut progress = Progress::new(system, state);
        for iterations in 1..=MOST {
            let mut next = defect(&z)?;
            if !next.is_finite() {
                return Err(StepError::NotConverged {
                    time: state.t,
                    iterations,
                });
            }
            let length = next.length(h);
            // next ← B⁻¹ defect, with B⁻¹ as the product of the updates that the steps define.
            let mut latest = None;
            for (index, (s, rest)) in steps.iter().zip(&rests).enumerate().take(known) {
                let along = s.along(&next, *rest);
                if index + 1 == known {
                    latest = Some(along);
                } else if let Some(following) = steps.get(index + 1) {
                    next.add_multiple(along, following);
                }
            }
            if let Some(along) = latest {
                let gain = ratio(one, one - along);
                next.entries().for_each(|entry| *entry *= gain);
            }
            z.add_multiple(one, &next);
            if progress.is_over(&z, &next, length, h) {
                return arrive(system, state, h, point(&z.u), z.xi);
            }
            known = if known == MEMORY { 0 } else { known };
            if let (Some(slot), Some(rest)) = (steps.get_mut(known), rests.get_mut(known)) {
                *rest = rounding * z.dot(&z, Scalar::inner_plus);
                *slot = next;
                known += 1;
            }
        }
        Err(StepError::NotConverged {
            time: state.t,
            iterations: MOST,
        })
    }
}
