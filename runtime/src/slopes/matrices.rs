//! Slopes of steps by matrix products, instead of a step in dual numbers.
//!
//! W is the derivative of (x, ξ, z) at a point of the step with respect to those at its start and to u, G that of their
//! rates at this point. With the linearisation T = `[A B]` at the point, if coordinates are plain and ẋ = ξ
//! ([`Tangent::PLAIN`]),
//!
//! G = [W_ξ; T W + T_u],  Wᵢ = I + h Σⱼ aᵢⱼ Gⱼ
//!
//! and an explicit step ends with the weights b instead of a. For the semi-implicit Euler method, the rows of ξ are
//! I + h T for coordinates of all kinds; those of x follow from the slopes of a motion along the chart rate, which are
//! sparse.

use core::array::from_fn;
use core::fmt;

use crate::error::StepError;
use crate::integrate::{project, project_coordinates};
use crate::manifold;
use crate::methods::tableau::{Row, Stages, Weights};
use crate::methods::{InChart, Method, arrive};
use crate::scalar::Scalar;
use crate::slopes::{Directions, Tangent, TangentSystem, displacement, values, varying};
use crate::state::State;
use crate::store::{Table, add_scaled, is_finite, scale};
use crate::system::System;

/// A step of length h from a state, with inputs held over it, whose slopes are to be computed.
#[derive(Clone, Copy)]
#[doc(hidden)]
pub struct TangentStep<'a, Sys: Tangent> {
    pub(crate) system: &'a Sys,
    /// The system in dual numbers; if it is `None` and needed, it is created.
    pub(crate) tangent: Option<&'a TangentSystem<Sys>>,
    pub(crate) state: &'a State<Sys>,
    pub(crate) u: &'a Sys::Inputs,
    pub(crate) h: f64,
}

impl<Sys: Tangent> fmt::Debug for TangentStep<'_, Sys> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TangentStep")
            .field("state", self.state)
            .field("u", self.u)
            .field("h", &self.h)
            .finish_non_exhaustive()
    }
}

impl<Sys: Tangent> TangentStep<'_, Sys> {
    /// Makes the step of a method, and writes its slopes.
    #[inline]
    pub(crate) fn of<M: Method<TangentSystem<Sys>> + InChart>(
        &self,
        method: &M,
        slopes: &mut Sys::Slopes,
    ) -> Result<State<Sys>, StepError> {
        let in_dual_numbers = |slopes: &mut Sys::Slopes| self.in_dual_numbers(method, slopes);
        method.step_slopes(self, slopes, in_dual_numbers)
    }

    #[inline]
    fn in_dual_numbers<M: Method<TangentSystem<Sys>>>(
        &self,
        method: &M,
        slopes: &mut Sys::Slopes,
    ) -> Result<State<Sys>, StepError> {
        match self.tangent {
            Some(tangent) => self.varied(method, tangent, slopes),
            None => self.varied(method, &TangentSystem::new(self.system), slopes),
        }
    }

    #[inline]
    fn varied<M: Method<TangentSystem<Sys>>>(
        &self,
        method: &M,
        tangent: &TangentSystem<Sys>,
        slopes: &mut Sys::Slopes,
    ) -> Result<State<Sys>, StepError> {
        let (system, state) = (self.system, self.state);
        state.check_shape(system)?;
        let displacements = slopes.rows() - state.xi.as_ref().len();
        let mut begin = State::<TangentSystem<Sys>> {
            t: state.t,
            x: varying(tangent, &system.frame(&state.x), &state.x),
            xi: tangent.zero_velocities(),
        };
        let xi = begin.xi.as_mut().iter_mut().zip(state.xi.as_ref());
        for (i, (varied, value)) in xi.enumerate() {
            *varied = Sys::Number::along(*value, displacements + i);
        }
        let mut held = tangent.zero_inputs();
        let first = slopes.rows();
        for (i, (varied, value)) in held.as_mut().iter_mut().zip(self.u.as_ref()).enumerate() {
            *varied = Sys::Number::along(*value, first + i);
        }
        let mut varied = method.step(tangent, &begin, self.h, &|_, _, _| held.clone())?;
        if !method.preserves_constraints() {
            project_coordinates(tangent, &mut varied);
        }
        project(tangent, &mut varied)?;
        let mut end = State::<Sys> {
            t: varied.t,
            x: system.zero_coordinates(),
            xi: system.zero_velocities(),
        };
        values(end.x.as_mut(), varied.x.as_ref());
        values(end.xi.as_mut(), varied.xi.as_ref());
        let coframe = system.coframe(&end.x);
        for i in 0..displacements {
            let moved = displacement::<Sys, _>(&coframe, i, varied.x.as_ref());
            slopes.row_mut(i).copy_from_slice(moved.slopes());
        }
        for (i, number) in varied.xi.as_ref().iter().enumerate() {
            slopes
                .row_mut(displacements + i)
                .copy_from_slice(number.slopes());
        }
        Ok(end)
    }

    /// Makes the step of an explicit method of N stages, given its tableau, for plain coordinates ([`Tangent::PLAIN`]).
    #[inline]
    pub(crate) fn explicit<const N: usize>(
        &self,
        rows: &[Row],
        closing: Weights,
        slopes: &mut Sys::Slopes,
    ) -> Result<State<Sys>, StepError> {
        let (system, state, h) = (self.system, self.state, self.h);
        state.check_shape(system)?;
        let f = self.linear(&state.x, &state.xi, slopes)?;
        let first = slopes.clone();
        let n = state.x.as_ref().len();
        let mut stages: Stages<Sys, N> = Stages::empty(system);
        stages.set(0, system.chart_rate(&state.x, &state.xi), f);
        let mut g: [Sys::Slopes; N] = from_fn(|_| first.clone());
        for (index, row) in rows.iter().enumerate().take(N).skip(1) {
            let (x, xi) = stages.sums(system, h, row.weights).point(system, state);
            let f = self.linear(&x, &xi, slopes)?;
            stages.set(index, system.chart_rate(&x, &xi), f);
            let rates = match row.weights {
                [(0, weight)] => second(slopes, &first, n, h * weight),
                weights => later(slopes, &moved(&g, weights, h), n),
            };
            if let Some(slot) = g.get_mut(index) {
                *slot = rates;
            }
        }
        let end = stages.sums(system, h, closing).end(system, state, h)?;
        *slopes = moved(&g, closing, h);
        checked(end, slopes, state.t)
    }

    /// Makes the step of the semi-implicit Euler method, for systems without projection.
    ///
    /// The rows of W for ξ⁺ = ξ + h ξ̇ are I + h T. The rows for x are I plus h times these if coordinates are plain;
    /// otherwise they follow from the motion along the chart rate.
    #[inline]
    pub(crate) fn semi_implicit(&self, w: &mut Sys::Slopes) -> Result<State<Sys>, StepError> {
        let (system, state, h) = (self.system, self.state, self.h);
        state.check_shape(system)?;
        let f = self.linear(&state.x, &state.xi, w)?;
        let mut xi = state.xi.clone();
        add_scaled(xi.as_mut(), h, f.as_ref());
        let displacements = w.rows() - xi.as_ref().len();
        for i in displacements..w.rows() {
            scale(w.row_mut(i), h);
            lean(w, i);
        }
        let end = if Sys::PLAIN {
            for i in 0..displacements {
                w.repeat(i, Sys::Scalar::from_f64(h), displacements + i);
                lean(w, i);
            }
            let mut x = state.x.clone();
            let rate = system.chart_rate(&state.x, &xi);
            add_scaled(x.as_mut(), h, rate.as_ref());
            arrive(system, state, h, x, xi)?
        } else {
            match self.tangent {
                Some(tangent) => self.along(&tangent.compressed, xi, w)?,
                None => self.along(&system.compressed(), xi, w)?,
            }
        };
        checked(end, w, state.t)
    }

    /// Moves x along the chart rate for the length of the step, and computes its rows of W; the rows of ξ are known.
    ///
    /// Let P and Q be the derivatives of the displacements at the end with respect to η and ξ; they are sparse and
    /// computed in compressed dual numbers. The rows of x are [P 0] + Q W_ξ.
    #[inline]
    fn along(
        &self,
        compressed: &Sys::Compressed,
        xi: Sys::Velocities,
        w: &mut Sys::Slopes,
    ) -> Result<State<Sys>, StepError> {
        let (system, state) = (self.system, self.state);
        let displacements = w.rows() - xi.as_ref().len();
        let sparsity = Sys::SPARSITY;
        let frame = system.frame(&state.x);
        let mut x = compressed.zero_coordinates();
        for (i, (number, value)) in x.as_mut().iter_mut().zip(state.x.as_ref()).enumerate() {
            number.vary(*value, &[]);
            for &entry in sparsity.frame.get(i).copied().unwrap_or_default() {
                if let Some(factor) = frame.row(i).get(entry)
                    && let Some(seed) = sparsity.seeds.get(entry)
                {
                    number.add_slope(*factor, *seed);
                }
            }
        }
        let mut velocities = compressed.zero_velocities();
        let numbers = velocities.as_mut().iter_mut().zip(xi.as_ref());
        let seeds = sparsity.seeds.iter().skip(displacements);
        for ((number, value), seed) in numbers.zip(seeds) {
            *number = Sys::CompressedNumber::along(*value, *seed);
        }
        let mut u = compressed.chart_rate(&x, &velocities);
        scale(u.as_mut(), self.h);
        manifold::retract(compressed.blocks(), x.as_mut(), u.as_ref());
        let mut place = system.zero_coordinates();
        values(place.as_mut(), x.as_ref());
        let end = arrive(system, state, self.h, place, xi)?;
        let coframe = system.coframe(&end.x);
        for (i, entries) in sparsity.motion.iter().enumerate() {
            let moved = displacement::<Sys, _>(&coframe, i, x.as_ref());
            let slope = |entry: usize| {
                let seed = sparsity.seeds.get(entry);
                let slope = seed.and_then(|&seed| moved.slopes().get(seed));
                slope.copied().unwrap_or_default()
            };
            let (by_eta, by_xi) =
                entries.split_at(entries.partition_point(|&entry| entry < displacements));
            match by_xi.split_first() {
                Some((&first, others)) => {
                    w.repeat(i, slope(first), first);
                    for &entry in others {
                        w.add_scaled(i, slope(entry), entry);
                    }
                }
                None => w.row_mut(i).fill(Sys::Scalar::default()),
            }
            for &entry in by_eta {
                if let Some(own) = w.row_mut(i).get_mut(entry) {
                    *own += slope(entry);
                }
            }
        }
        Ok(end)
    }

    /// Returns ξ̇ at a point, and writes T = `[A B]`.
    #[inline]
    fn linear(
        &self,
        x: &Sys::Coordinates,
        xi: &Sys::Velocities,
        table: &mut Sys::Slopes,
    ) -> Result<Sys::Velocities, StepError> {
        let time = self.state.t;
        let found = self.system.slopes(x, xi, self.u, table);
        found.map_err(
            |cause| match is_finite(x.as_ref()) && is_finite(xi.as_ref()) {
                true => StepError::Singular { cause, time },
                false => StepError::NonFinite { time },
            },
        )
    }
}

/// Returns the end of a step if its slopes are finite.
#[inline]
fn checked<Sys: Tangent>(
    end: State<Sys>,
    slopes: &Sys::Slopes,
    time: f64,
) -> Result<State<Sys>, StepError> {
    match slopes.is_finite() {
        true => Ok(end),
        false => Err(StepError::NonFinite { time }),
    }
}

/// Adds 1 to the diagonal entry of row `i`.
#[inline]
fn lean<S: Scalar, T: Table<S>>(table: &mut T, i: usize) {
    if let Some(entry) = table.row_mut(i).get_mut(i) {
        *entry += S::from_f64(1.0);
    }
}

/// Returns W = I + h Σⱼ aⱼ Gⱼ.
#[inline]
fn moved<S: Scalar, T: Table<S>>(g: &[T], weights: Weights, h: f64) -> T {
    let mut w = T::zero();
    for (place, (j, weight)) in weights.iter().enumerate() {
        let Some(rates) = g.get(*j) else { continue };
        for i in 0..w.rows() {
            if place == 0 {
                w.row_mut(i).copy_from_slice(rates.row(i));
                scale(w.row_mut(i), h * weight);
            } else {
                w.add_combination(i, &[S::from_f64(h * weight)], rates, i);
            }
        }
    }
    for i in 0..w.rows() {
        lean(&mut w, i);
    }
    w
}

/// Returns G of a stage, given T and W at its point: the rows of x are those of ξ in W. Inputs are held.
#[inline]
fn later<S: Scalar, T: Table<S>>(table: &T, w: &T, n: usize) -> T {
    let mut g = T::zero();
    for i in 0..n {
        g.row_mut(i).copy_from_slice(w.row(n + i));
    }
    let size = table.rows();
    for i in n..size {
        let entries = table.row(i);
        let inputs = g.row_mut(i).iter_mut().zip(entries).skip(size);
        inputs.for_each(|(g, entry)| *g = *entry);
        g.add_combination(i, entries, w, 0);
    }
    g
}

/// Returns G of a stage with W = I + a G₁, which is T + a T G₁, where the rows of x in G₁ are those of ξ in I.
#[inline]
fn second<S: Scalar, T: Table<S>>(table: &T, first: &T, n: usize, a: f64) -> T {
    let mut g = table.clone();
    for i in 0..n {
        g.add_combination(i, &[S::from_f64(a)], first, n + i);
    }
    let mut scaled = table.clone();
    for i in n..table.rows() {
        scale(scaled.row_mut(i), a);
        let own = g.row_mut(i).iter_mut().skip(n);
        let of_xi = own.zip(scaled.row(i).iter().take(n));
        of_xi.for_each(|(own, entry)| *own += *entry);
        g.add_combination(i, scaled.row(i).get(n..).unwrap_or(&[]), first, n);
    }
    g
}
