//! Euler's implicit step in the chart, solved by Newton's method.
//!
//! The step of [`BackwardEuler`](crate::methods::BackwardEuler): u = h w(x ⊕ u, ξ₁), ξ₁ = ξ + h f(x ⊕ u, ξ₁), x₁ = x ⊕ u.
//! The first of these equations is not stiff. It is solved by itself, in as many turns as coordinates move one another, and
//! makes u a function of ξ₁; what is left are as many unknowns as there are velocities and states,
//!
//! g(ξ₁) = ξ₁ − ξ − h f(x ⊕ u(ξ₁), ξ₁) = 0,  ∂g/∂ξ₁ = I − h ∂f/∂ξ − h ∂f/∂x ∂u/∂ξ₁.
//!
//! Where coordinates are plain and ẋ = ξ, ∂g/∂ξ₁ is I − h (T_ξ + h T_x) with the linearisation T = [A B], else it comes from
//! the same sums in dual numbers: both are exact. Factors are kept as long as corrections shrink, and corrected by the steps
//! (Broyden); where a step does not bring a point nearer, measured by the corrections that follow, it is halved. Sources: P.
//! Deuflhard, *Newton Methods for Nonlinear Problems* (2011), 3.3; C. T. Kelley, *Iterative Methods for Linear and Nonlinear
//! Equations* (1995), 7.3.

use core::array::from_fn;

use crate::error::StepError;
use crate::integrate::acceleration;
use crate::manifold;
use crate::methods::backward_euler::{ENOUGH, MEMORY, Progress, Unknowns, ratio};
use crate::methods::factors::Factors;
use crate::methods::{Method, arrive};
use crate::scalar::Scalar;
use crate::slopes::{Directions, Nearby, Tangent, values};
use crate::state::State;
use crate::store::{Table, add_scaled, is_finite, largest, scale};
use crate::system::System;

/// Order 1: the step of [`BackwardEuler`](crate::methods::BackwardEuler) of systems with a linearisation
/// ([`Tangent`], `generate all, linearize;`), solved by Newton's method, however many directions are stiff.
///
/// A step takes one evaluation of [A B] and one of ξ̇ where the equations are linear, and some more of either where they are
/// not. Each unknown is found to rounding by itself; the length of the step may have either sign. Steps have slopes
/// ([`step_slopes`](crate::step_slopes)): those of the implicit function.
///
/// Inputs are a function whose slopes are not known. Those that depend on the time alone cost nothing. Of a controller,
/// u(t, x, ξ), the iteration learns from its own steps how the inputs follow the state: it takes more of them, and as many
/// stiff loops as [`BackwardEuler`](crate::methods::BackwardEuler) can close are closed. A stiff spring or damper is better a
/// load of the description.
///
/// # Errors
/// [`StepError::NotConverged`] where no solution is found in 64 evaluations: there is none, or the step is so long
/// that the rates of the coordinates themselves turn by more than about 1 rad in it, in coordinates whose rates depend on
/// where they are (Euler's angles; not rotation matrices, quaternions, or plain coordinates with ẋ = ξ).
/// [`StepError::Singular`] and [`StepError::NonFinite`] where ξ̇ has no value at the start, or wherever the iteration turns.
///
/// ```
/// use hamel::methods::StiffEuler;
/// use hamel::{State, step};
///
/// hamel::rigid_eom! {
///     /// Two masses on springs of 10⁸ N/m.
///     system Masses {
///         param k = 100000000;
///         coord a, b;
///         velocity v, w;
///         rate a = v;
///         rate b = w;
///         kinetic (v^2 + w^2) / 2;
///         potential k * (a^2 + (b - a)^2) / 2;
///         start a = 0.001, b = 0.002;
///         generate all, linearize;
///     }
/// }
///
/// let system = Masses::<f64>::default();
/// let mut state = State::start(&system);
/// // 160 periods of the slower oscillation, which is damped at once.
/// step(&system, StiffEuler, &mut state, 0.1, &|_, _, _| [])?;
/// assert!(state.x.iter().all(|q| q.abs() < 1e-8));
/// # Ok::<(), hamel::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StiffEuler;

/// Evaluations after which the iteration has failed.
const MOST: u32 = 64;
/// Turns after which the coordinates of a step have not been found.
const TURNS: u32 = 64;
/// Corrections that are longer than this part of the ones before ask for new factors.
const SLOW: f64 = 0.1;
/// The least part of a step that is tried.
const LEAST: f64 = 1e-4;
/// Units of rounding to which the coordinates of a step are found.
const ULPS: f64 = 4.0;

/// x ⊕ u
fn moved<Sys: System + ?Sized>(
    system: &Sys,
    x: &Sys::Coordinates,
    u: &Sys::Chart,
) -> Sys::Coordinates {
    let mut x = x.clone();
    manifold::retract(system.blocks(), x.as_mut(), u.as_ref());
    x
}

/// x ⊕ u with u = h w(x ⊕ u, ξ₁), by turns that begin at `u`, which is left at the solution; nothing where turns find none.
fn reach<Sys: System + ?Sized>(
    system: &Sys,
    x: &Sys::Coordinates,
    h: f64,
    xi: &Sys::Velocities,
    u: &mut Sys::Chart,
) -> Option<Sys::Coordinates> {
    let (zero, one) = (Sys::Scalar::default(), Sys::Scalar::from_f64(1.0));
    let rounding = Sys::Scalar::from_f64(ULPS * Sys::Scalar::EPSILON);
    let mut nearest = one;
    for _ in 0..TURNS {
        let place = moved(system, x, u);
        let mut next = system.chart_rate(&place, xi);
        scale(next.as_mut(), h);
        let (mut own, mut change) = (zero, zero);
        for (old, new) in u.as_ref().iter().zip(next.as_ref()) {
            own = Scalar::max(own, (*new - *old).beside(*new, *old));
            change = Scalar::max(change, (*new - *old).size());
        }
        *u = next;
        if own.largest_lane() == 0.0 {
            return Some(place);
        }
        // Small beside all of u, and no longer shrinking: rounding.
        let whole = change.beside(largest(u.as_ref()), zero);
        let unsettled = rounding.select_lt(whole, one, zero);
        let shrinks = own.select_lt(Sys::Scalar::from_f64(0.5) * nearest, one, unsettled);
        let moves = rounding.select_lt(own, shrinks, zero);
        if moves.largest_lane() == 0.0 {
            return Some(moved(system, x, u));
        }
        nearest = own.select_lt(nearest, own, nearest);
    }
    None
}

/// What is found at values of the unknowns.
struct Point<Sys: System + ?Sized> {
    x: Sys::Coordinates,
    inputs: Sys::Inputs,
    /// g
    defect: Sys::Velocities,
}

/// Where ξ₁ leads to, with u from a guess of it.
fn place<Sys, U>(
    system: &Sys,
    state: &State<Sys>,
    h: f64,
    inputs: &U,
    z: &mut Unknowns<Sys>,
) -> Result<Point<Sys>, StepError>
where
    Sys: System + ?Sized,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    let x = reach(system, &state.x, h, &z.xi, &mut z.u).ok_or(StepError::NotConverged {
        time: state.t,
        iterations: TURNS,
    })?;
    let inputs = inputs(state.t + h, &x, &z.xi);
    let defect = z.xi.clone();
    Ok(Point { x, inputs, defect })
}

/// ξ₁ − ξ − h f, in the place of ξ₁.
fn lag<Sys: System + ?Sized>(
    state: &State<Sys>,
    h: f64,
    f: &Sys::Velocities,
    xi: &mut Sys::Velocities,
) {
    for (own, start) in xi.as_mut().iter_mut().zip(state.xi.as_ref()) {
        *own -= *start;
    }
    add_scaled(xi.as_mut(), -h, f.as_ref());
}

/// g at values of ξ₁.
fn point<Sys, U>(
    system: &Sys,
    state: &State<Sys>,
    h: f64,
    inputs: &U,
    z: &mut Unknowns<Sys>,
) -> Result<Point<Sys>, StepError>
where
    Sys: System + ?Sized,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    let mut point = place(system, state, h, inputs, z)?;
    let held = |_: f64, _: &_, _: &_| point.inputs.clone();
    let f = acceleration(system, state.t, h, &point.x, &z.xi, &held)?;
    lag(state, h, &f, &mut point.defect);
    Ok(point)
}

/// ∂g/∂ξ₁ of a system.
type FactorsOf<Sys> =
    Factors<<Sys as System>::Scalar, <Sys as Tangent>::Slopes, <Sys as System>::Velocities>;

/// The factors of ∂g/∂ξ₁ from numbers that vary with ξ₁ along the directions of ξ.
fn factored<Sys: Tangent>(system: &Sys, defect: &[Sys::Number]) -> FactorsOf<Sys> {
    let mut table = Sys::Slopes::zero();
    let first = table.rows() - defect.len();
    for (i, number) in defect.iter().enumerate() {
        for (entry, slope) in table.row_mut(first + i).iter_mut().zip(number.slopes()) {
            *entry = *slope;
        }
    }
    Factors::new(table, first, system.zero_velocities())
}

/// ξ₁ that varies along its own directions.
fn varied<Sys: Tangent>(
    nearby: &Nearby<Sys>,
    xi: &Sys::Velocities,
) -> <Nearby<Sys> as System>::Velocities {
    let first = Sys::Slopes::zero().rows() - xi.as_ref().len();
    let mut varied = nearby.zero_velocities();
    for (i, (number, value)) in varied.as_mut().iter_mut().zip(xi.as_ref()).enumerate() {
        *number = Sys::Number::along(*value, first + i);
    }
    varied
}

/// Numbers that do not vary.
fn still<N: Directions>(numbers: &mut [N], values: &[N::Value]) {
    for (number, value) in numbers.iter_mut().zip(values) {
        number.vary(*value, &[]);
    }
}

/// The equations of a step.
struct Equations<'a, Sys: Tangent, U> {
    system: &'a Sys,
    /// The system in dual numbers, where they are needed.
    nearby: Option<&'a Nearby<Sys>>,
    state: &'a State<Sys>,
    h: f64,
    inputs: &'a U,
}

impl<Sys, U> Equations<'_, Sys, U>
where
    Sys: Tangent,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    fn point(&self, z: &mut Unknowns<Sys>) -> Result<Point<Sys>, StepError> {
        point(self.system, self.state, self.h, self.inputs, z)
    }

    /// g with the factors of its slopes, where inputs stay.
    fn linear(&self, z: &mut Unknowns<Sys>) -> Result<(Point<Sys>, FactorsOf<Sys>), StepError> {
        let (state, h, time) = (self.state, self.h, self.state.t);
        let mut here = place(self.system, state, h, self.inputs, z)?;
        let Some(nearby) = self.nearby else {
            let mut table = Sys::Slopes::zero();
            let found = self.system.slopes(&here.x, &z.xi, &here.inputs, &mut table);
            let f = found.map_err(|cause| {
                match is_finite(here.x.as_ref()) && is_finite(z.xi.as_ref()) {
                    true => StepError::Singular { cause, time },
                    false => StepError::NonFinite { time },
                }
            })?;
            lag(state, h, &f, &mut here.defect);
            let first = table.rows() - f.as_ref().len();
            for i in first..table.rows() {
                let row = table.row_mut(i);
                // Displacements are h times the velocities in front of the states.
                let (by_x, by_xi) = row.split_at_mut(first.min(row.len()));
                add_scaled(by_xi.get_mut(..first).unwrap_or(&mut []), h, by_x);
                scale(row, -h);
                if let Some(entry) = row.get_mut(i) {
                    *entry += Sys::Scalar::from_f64(1.0);
                }
            }
            let factors = Factors::new(table, first, self.system.zero_velocities());
            return Ok((here, factors));
        };
        let mut begin = State::<Nearby<Sys>> {
            t: time,
            x: nearby.zero_coordinates(),
            xi: nearby.zero_velocities(),
        };
        still(begin.x.as_mut(), state.x.as_ref());
        still(begin.xi.as_mut(), state.xi.as_ref());
        let mut held = nearby.zero_inputs();
        still(held.as_mut(), here.inputs.as_ref());
        let mut near = Unknowns::<Nearby<Sys>> {
            u: nearby.zero_chart(),
            xi: varied(nearby, &z.xi),
        };
        still(near.u.as_mut(), z.u.as_ref());
        let found = point(
            nearby,
            &begin,
            h,
            &|_, _: &_, _: &_| held.clone(),
            &mut near,
        )?;
        values(here.defect.as_mut(), found.defect.as_ref());
        Ok((here, factored(self.system, found.defect.as_ref())))
    }

    /// (x₁, ξ₁)
    fn solve(&self) -> Result<(Sys::Coordinates, Sys::Velocities), StepError> {
        let (system, state, h, time) = (self.system, self.state, self.h, self.state.t);
        let of = Sys::Scalar::from_f64;
        let (zero, one) = (Sys::Scalar::default(), of(1.0));
        let mut iterations = 1;
        let mut z = Unknowns::<Sys> {
            u: system.zero_chart(),
            xi: state.xi.clone(),
        };
        let (mut here, mut factors) = self.linear(&mut z)?;
        if !is_finite(here.defect.as_ref()) {
            return Err(StepError::NonFinite { time });
        }
        let mut progress = Progress::new(system, state);
        let mut steps: [Sys::Velocities; MEMORY] = from_fn(|_| system.zero_velocities());
        let mut known = 0;
        // The factors are those of this point.
        let mut fresh = true;
        let mut step = correction::<Sys>(&factors, &here.defect);
        'nearer: loop {
            let mut part = one;
            let (next, raw, fed, rounding) = loop {
                iterations += 1;
                if iterations > MOST || !is_finite(step.as_ref()) || least(part) < LEAST {
                    return Err(StepError::NotConverged { time, iterations });
                }
                let mut next = z.clone();
                for (xi, step) in next.xi.as_mut().iter_mut().zip(step.as_ref()) {
                    *xi = part.mul_add(*step, *xi);
                }
                let found = self.point(&mut next);
                let found = found.map(|there| (correction::<Sys>(&factors, &there.defect), there));
                match found {
                    Ok((raw, there)) if is_finite(raw.as_ref()) => {
                        let fed = differ(here.inputs.as_ref(), there.inputs.as_ref());
                        let small = Unknowns {
                            u: system.zero_chart(),
                            xi: step.clone(),
                        };
                        let whole = progress.whole(&next, &small, h);
                        let moves = of(ENOUGH * Sys::Scalar::EPSILON).select_lt(whole, one, zero);
                        let limit = of(-0.25).mul_add(part, one) * largest(step.as_ref());
                        let farther = largest(raw.as_ref()).select_lt(limit, zero, moves);
                        if fed || farther.largest_lane() == 0.0 {
                            here = there;
                            break (next, raw, fed, moves.largest_lane() == 0.0);
                        }
                        part = zero.select_lt(farther, of(0.5) * part, part);
                    }
                    Err(error) if fresh && least(part) < 2.0 * LEAST => {
                        return Err(error);
                    }
                    _ => part *= of(0.5),
                }
                if !fresh {
                    (here, factors) = self.linear(&mut z)?;
                    (fresh, known) = (true, 0);
                    step = correction::<Sys>(&factors, &here.defect);
                    continue 'nearer;
                }
            };
            let exact = core::mem::take(&mut fresh) && !fed;
            let whole_step = least(part) == 1.0;
            let length = of(h.abs()) * largest(raw.as_ref());
            let mut after = raw;
            // Rounding teaches nothing.
            if whole_step && !rounding {
                if let Some(slot) = steps.get_mut(known) {
                    *slot = step.clone();
                    known += 1;
                }
                learnt::<Sys>(steps.get(..known).unwrap_or(&[]), &mut after);
            }
            let mut end = next.clone();
            for (xi, step) in end.xi.as_mut().iter_mut().zip(after.as_ref()) {
                *xi += *step;
            }
            if let Some(x) = reach(system, &state.x, h, &end.xi, &mut end.u) {
                let mut by = Unknowns::<Sys> {
                    u: end.u.clone(),
                    xi: after.clone(),
                };
                for (by, before) in by.u.as_mut().iter_mut().zip(next.u.as_ref()) {
                    *by -= *before;
                }
                let over = progress.is_over(&end, &by, length, h);
                // What exact factors do not make shorter is rounding.
                if over || rounding && exact && progress.idle > 1 {
                    return Ok((x, end.xi));
                }
            }
            z = next;
            let shrinks = progress.idle == 0 && !slow::<Sys>(&after, &step, &state.xi, &z.xi);
            step = after;
            if known == MEMORY || !whole_step || !(fed || shrinks || progress.idle > 1) {
                iterations += 1;
                (here, factors) = self.linear(&mut z)?;
                (fresh, known) = (true, 0);
                step = correction::<Sys>(&factors, &here.defect);
            }
        }
    }
}

/// The least of parts between 0 and 1.
fn least<S: Scalar>(part: S) -> f64 {
    1.0 / (S::from_f64(1.0) / part).largest_lane()
}

/// −(∂g/∂ξ₁)⁻¹ g
fn correction<Sys: Tangent>(factors: &FactorsOf<Sys>, defect: &Sys::Velocities) -> Sys::Velocities {
    let mut step = defect.clone();
    factors.solve(step.as_mut());
    for entry in step.as_mut() {
        *entry = -*entry;
    }
    step
}

/// The correction by the factors, with what the steps since then tell of them: Broyden's update as a product.
fn learnt<Sys: Tangent>(steps: &[Sys::Velocities], correction: &mut Sys::Velocities) {
    let inner = |a: &Sys::Velocities, b: &Sys::Velocities| {
        let entries = a.as_ref().iter().zip(b.as_ref());
        entries.fold(Sys::Scalar::default(), |sum, (a, b)| a.inner_plus(*b, sum))
    };
    for (index, step) in steps.iter().enumerate() {
        let along = ratio(inner(step, correction), inner(step, step));
        match steps.get(index + 1) {
            Some(following) => {
                for (entry, by) in correction.as_mut().iter_mut().zip(following.as_ref()) {
                    *entry = along.mul_add(*by, *entry);
                }
            }
            None => {
                let gain = ratio(
                    Sys::Scalar::from_f64(1.0),
                    Sys::Scalar::from_f64(1.0) - along,
                );
                for entry in correction.as_mut() {
                    *entry *= gain;
                }
            }
        }
    }
}

/// Whether an entry that has yet to settle shrinks too little.
fn slow<Sys: System>(
    new: &Sys::Velocities,
    old: &Sys::Velocities,
    start: &Sys::Velocities,
    xi: &Sys::Velocities,
) -> bool {
    let of = Sys::Scalar::from_f64;
    let (zero, one) = (of(0.0), of(1.0));
    let enough = of(ENOUGH * Sys::Scalar::EPSILON);
    let entries = new.as_ref().iter().zip(old.as_ref());
    let sizes = start.as_ref().iter().zip(xi.as_ref());
    let slow = entries
        .zip(sizes)
        .fold(zero, |slow, ((new, old), (start, xi))| {
            let moves = enough.select_lt(new.beside(*start, *xi - *start), one, zero);
            let lags = (of(SLOW) * old.size()).select_lt(new.size(), moves, zero);
            Scalar::max(slow, lags)
        });
    slow.largest_lane() != 0.0
}

/// Whether numbers differ.
fn differ<S: Scalar>(a: &[S], b: &[S]) -> bool {
    let mut pairs = a.iter().zip(b);
    pairs.any(|(a, b)| (*a - *b).size().largest_lane() != 0.0)
}

impl<Sys: Tangent> Method<Sys> for StiffEuler {
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
        let nearby = (!Sys::PLAIN).then(|| Nearby::new(system));
        let equations = Equations {
            system,
            nearby: nearby.as_ref(),
            state,
            h,
            inputs,
        };
        let (x, xi) = equations.solve()?;
        arrive(system, state, h, x, xi)
    }
}

/// The step of the values, with the slopes of the implicit function: δξ₁ = −(∂g/∂ξ₁)⁻¹ δg for what g varies by at ξ₁. Inputs
/// are in dual numbers here, so that a controller's slopes count.
impl<Sys: Tangent> Method<Nearby<Sys>> for StiffEuler {
    fn order(&self) -> u32 {
        1
    }

    fn step<U>(
        &self,
        nearby: &Nearby<Sys>,
        state: &State<Nearby<Sys>>,
        h: f64,
        inputs: &U,
    ) -> Result<State<Nearby<Sys>>, StepError>
    where
        U: Fn(
            f64,
            &<Nearby<Sys> as System>::Coordinates,
            &<Nearby<Sys> as System>::Velocities,
        ) -> <Nearby<Sys> as System>::Inputs,
    {
        state.check_shape(nearby)?;
        let system = nearby.plain();
        let mut begin = State::<Sys> {
            t: state.t,
            x: system.zero_coordinates(),
            xi: system.zero_velocities(),
        };
        values(begin.x.as_mut(), state.x.as_ref());
        values(begin.xi.as_mut(), state.xi.as_ref());
        let plain_inputs = |t: f64, x: &Sys::Coordinates, xi: &Sys::Velocities| {
            let (mut x_near, mut xi_near) = (nearby.zero_coordinates(), nearby.zero_velocities());
            still(x_near.as_mut(), x.as_ref());
            still(xi_near.as_mut(), xi.as_ref());
            let mut u = system.zero_inputs();
            values(u.as_mut(), inputs(t, &x_near, &xi_near).as_ref());
            u
        };
        let equations = Equations {
            system,
            nearby: (!Sys::PLAIN).then_some(nearby),
            state: &begin,
            h,
            inputs: &plain_inputs,
        };
        let (_, xi) = equations.solve()?;

        let mut fixed = state.clone();
        still(fixed.x.as_mut(), begin.x.as_ref());
        still(fixed.xi.as_mut(), begin.xi.as_ref());
        let mut z = Unknowns::<Nearby<Sys>> {
            u: nearby.zero_chart(),
            xi: varied(nearby, &xi),
        };
        let along = point(nearby, &fixed, h, inputs, &mut z)?;
        let factors = factored(system, along.defect.as_ref());

        still(z.xi.as_mut(), xi.as_ref());
        let by_start = point(nearby, state, h, inputs, &mut z)?;
        let directions = by_start.defect.as_ref().first();
        for direction in 0..directions.map_or(0, |number| number.slopes().len()) {
            let mut by = system.zero_velocities();
            for (by, number) in by.as_mut().iter_mut().zip(by_start.defect.as_ref()) {
                *by = number.slopes().get(direction).copied().unwrap_or_default();
            }
            factors.solve(by.as_mut());
            for (number, by) in z.xi.as_mut().iter_mut().zip(by.as_ref()) {
                number.lean(-*by, direction);
            }
        }
        let x = reach(nearby, &state.x, h, &z.xi, &mut z.u).ok_or(StepError::NotConverged {
            time: state.t,
            iterations: TURNS,
        })?;
        arrive(nearby, state, h, x, z.xi)
    }
}
