//! Steps with slopes where coordinates are plain and ẋ = ξ ([`Tangent::PLAIN`]): matrices in the place of dual numbers.
//!
//! W holds the slopes of (x, ξ, z) at a point of the step by those of its start and by u, G those of their rates there.
//! With the linearisation T = [A B] at the point,
//!
//! G = [W_ξ; T W + T_u],  Wᵢ = I + h Σⱼ aᵢⱼ Gⱼ
//!
//! and the step is closed by the weights b in the place of a.

use core::array::from_fn;
use core::cell::{Cell, RefCell};

use crate::error::StepError;
use crate::methods::Method;
use crate::methods::tableau::{Row, Weights};
use crate::scalar::Scalar;
use crate::slopes::{Stepped, Tangent};
use crate::state::State;
use crate::store::{Table, is_finite, scale};

/// A step of length h from a state, at inputs that are held over it, of a system with plain coordinates.
#[derive(Clone, Copy, Debug)]
pub struct PlainStep<'a, Sys: Tangent> {
    pub(crate) system: &'a Sys,
    pub(crate) state: &'a State<Sys>,
    pub(crate) u: &'a Sys::Inputs,
    pub(crate) h: f64,
}

impl<Sys: Tangent> PlainStep<'_, Sys> {
    /// The step of an explicit method of N stages, whose tableau is given.
    #[inline]
    pub(crate) fn explicit<M: Method<Sys>, const N: usize>(
        &self,
        method: &M,
        rows: &[Row],
        closing: Weights,
    ) -> Stepped<Sys> {
        let (state, u, h) = (self.state, self.u, self.h);
        // The method asks for the inputs at every stage, in their order.
        let points: [(Sys::Coordinates, Sys::Velocities); N] =
            from_fn(|_| (state.x.clone(), state.xi.clone()));
        let (points, stage) = (RefCell::new(points), Cell::new(0));
        let held = |_: f64, x: &Sys::Coordinates, xi: &Sys::Velocities| {
            if let Ok(mut points) = points.try_borrow_mut()
                && let Some(point) = points.get_mut(stage.get())
            {
                *point = (x.clone(), xi.clone());
            }
            stage.set(stage.get() + 1);
            u.clone()
        };
        let end = method.step(self.system, state, h, &held)?;
        let first = self.linear(&state.x, &state.xi)?;
        let n = state.x.as_ref().len();
        let mut g: [Sys::Slopes; N] = from_fn(|_| first.clone());
        let stages = rows.iter().zip(points.into_inner()).enumerate();
        for (index, (row, (x, xi))) in stages.take(N).skip(1) {
            let table = self.linear(&x, &xi)?;
            let rates = match row.weights {
                [(0, weight)] => second(&table, &first, n, h * weight),
                weights => later(&table, &moved(&g, weights, h), n),
            };
            if let Some(slot) = g.get_mut(index) {
                *slot = rates;
            }
        }
        self.end(end, moved(&g, closing, h))
    }

    /// The step of the semi-implicit Euler method: the rows of ξ are I + h T, those of x move by h times these.
    #[inline]
    pub(crate) fn semi_implicit<M: Method<Sys>>(&self, method: &M) -> Stepped<Sys> {
        let (state, h) = (self.state, self.h);
        let end = method.step(self.system, state, h, &|_, _, _| self.u.clone())?;
        let mut w = self.linear(&state.x, &state.xi)?;
        let length = Sys::Scalar::from_f64(h);
        let n = state.x.as_ref().len();
        for i in n..w.rows() {
            scale(w.row_mut(i), length);
            lean(&mut w, i);
        }
        for i in 0..n {
            w.repeat(i, length, n + i);
            lean(&mut w, i);
        }
        self.end(end, w)
    }

    /// T = [A B] at a point.
    #[inline]
    fn linear(&self, x: &Sys::Coordinates, xi: &Sys::Velocities) -> Result<Sys::Slopes, StepError> {
        let table = self.system.slopes(x, xi, self.u);
        let time = self.state.t;
        table.map_err(|cause| StepError::Singular { cause, time })
    }

    /// What the step gives, where its slopes have values.
    #[inline]
    fn end(&self, end: State<Sys>, slopes: Sys::Slopes) -> Stepped<Sys> {
        match (0..slopes.rows()).all(|i| is_finite(slopes.row(i))) {
            true => Ok((end, slopes)),
            false => Err(StepError::NonFinite { time: self.state.t }),
        }
    }
}

/// Adds 1 to an entry on the diagonal.
#[inline]
fn lean<S: Scalar, T: Table<S>>(table: &mut T, i: usize) {
    if let Some(entry) = table.row_mut(i).get_mut(i) {
        *entry += S::from_f64(1.0);
    }
}

/// W = I + h Σⱼ aⱼ Gⱼ
#[inline]
fn moved<S: Scalar, T: Table<S>>(g: &[T], weights: Weights, h: f64) -> T {
    let mut w = T::zero();
    for (place, (j, weight)) in weights.iter().enumerate() {
        let Some(rates) = g.get(*j) else { continue };
        let a = S::from_f64(h * weight);
        for i in 0..w.rows() {
            if place == 0 {
                w.row_mut(i).copy_from_slice(rates.row(i));
                scale(w.row_mut(i), a);
            } else {
                w.follow(i, &[a], rates, i);
            }
        }
    }
    for i in 0..w.rows() {
        lean(&mut w, i);
    }
    w
}

/// G of a stage whose point has slopes W: the rows of x are those of ξ in W. Inputs are held.
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
        g.follow(i, entries, w, 0);
    }
    g
}

/// G of a stage at W = I + a G₁: T + a T G₁, where the rows of x in G₁ are those of ξ in I.
#[inline]
fn second<S: Scalar, T: Table<S>>(table: &T, first: &T, n: usize, a: f64) -> T {
    let mut g = table.clone();
    let a = S::from_f64(a);
    for i in 0..n {
        g.follow(i, &[a], first, n + i);
    }
    let mut scaled = table.clone();
    for i in n..table.rows() {
        scale(scaled.row_mut(i), a);
        let own = g.row_mut(i).iter_mut().skip(n);
        let of_xi = own.zip(scaled.row(i).iter().take(n));
        of_xi.for_each(|(own, entry)| *own += *entry);
        g.follow(i, scaled.row(i).get(n..).unwrap_or(&[]), first, n);
    }
    g
}
