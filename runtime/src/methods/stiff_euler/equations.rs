//! The equations g(ξ₁) = 0 of a step, and ∂g/∂ξ₁.

use crate::error::StepError;
use crate::integrate::acceleration;
use crate::manifold;
use crate::methods::backward_euler::Unknowns;
use crate::methods::factors::Factors;
use crate::scalar::Scalar;
use crate::slopes::{Directions, Nearby, Tangent, values};
use crate::state::State;
use crate::store::{Table, add_scaled, is_finite, largest, scale};
use crate::system::System;

/// Turns after which the coordinates of a step have not been found.
pub(super) const TURNS: u32 = 64;
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
pub(super) fn reach<Sys: System + ?Sized>(
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

/// W = M(x) g of velocities g, in their place: Wᵢ = T(g + s eᵢ) − T(g) − T(s eᵢ) + T(0), over s.
///
/// The energy is a quadratic polynomial of velocities, so that this is exact; s makes both parts about equally large.
fn weigh<Sys: System + ?Sized>(
    system: &Sys,
    x: &Sys::Coordinates,
    n: usize,
    g: &mut Sys::Velocities,
) {
    let (zero, one) = (Sys::Scalar::default(), Sys::Scalar::from_f64(1.0));
    let none = system.zero_velocities();
    let at_rest = system.kinetic_energy(x, &none);
    let whole = system.kinetic_energy(x, g) - at_rest;
    let before = g.clone();
    for (i, entry) in g.as_mut().iter_mut().enumerate().take(n) {
        let along = |of: &Sys::Velocities, s: Sys::Scalar| {
            let mut of = of.clone();
            if let Some(entry) = of.as_mut().get_mut(i) {
                *entry += s;
            }
            system.kinetic_energy(x, &of) - at_rest
        };
        let inertia = along(&none, one) + along(&none, -one);
        let square = whole.size() / inertia.size();
        let s = zero.select_lt(square, square, one).sqrt();
        *entry = (along(&before, s) - whole - along(&none, s)) / s;
    }
}

/// What is found at values of the unknowns.
pub(super) struct Point<Sys: System + ?Sized> {
    x: Sys::Coordinates,
    pub(super) inputs: Sys::Inputs,
    /// g
    pub(super) defect: Sys::Velocities,
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
pub(super) fn point<Sys, U>(
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
pub(super) type FactorsOf<Sys> =
    Factors<<Sys as System>::Scalar, <Sys as Tangent>::Slopes, <Sys as System>::Velocities>;

/// How many of the unknowns are velocities; states follow them.
fn displacements<Sys: Tangent>(xi: &Sys::Velocities) -> usize {
    Sys::Slopes::zero().rows() - xi.as_ref().len()
}

/// The factors of ∂g/∂ξ₁ from numbers that vary with ξ₁ along the directions of ξ.
pub(super) fn factored<Sys: Tangent>(system: &Sys, defect: &[Sys::Number]) -> FactorsOf<Sys> {
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
pub(super) fn varied<Sys: Tangent>(
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
pub(super) fn still<N: Directions>(numbers: &mut [N], values: &[N::Value]) {
    for (number, value) in numbers.iter_mut().zip(values) {
        number.vary(*value, &[]);
    }
}

/// The equations of a step.
pub(super) struct Equations<'a, Sys: Tangent, U> {
    pub(super) system: &'a Sys,
    /// The system in dual numbers, where they are needed.
    pub(super) nearby: Option<&'a Nearby<Sys>>,
    pub(super) state: &'a State<Sys>,
    pub(super) h: f64,
    pub(super) inputs: &'a U,
    /// Whether equations are M g = 0.
    pub(super) weighed: bool,
}

impl<Sys, U> Equations<'_, Sys, U>
where
    Sys: Tangent,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    pub(super) fn point(&self, z: &mut Unknowns<Sys>) -> Result<Point<Sys>, StepError> {
        let mut here = point(self.system, self.state, self.h, self.inputs, z)?;
        if self.weighed {
            weigh(
                self.system,
                &here.x,
                displacements::<Sys>(&z.xi),
                &mut here.defect,
            );
        }
        Ok(here)
    }

    /// g with the factors of its slopes, where inputs stay.
    pub(super) fn linear(
        &self,
        z: &mut Unknowns<Sys>,
    ) -> Result<(Point<Sys>, FactorsOf<Sys>), StepError> {
        let (state, h, time) = (self.state, self.h, self.state.t);
        let mut here = place(self.system, state, h, self.inputs, z)?;
        let made = (self.weighed && self.nearby.is_none()).then(|| Nearby::new(self.system));
        let Some(nearby) = self.nearby.or(made.as_ref()) else {
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
        let mut found = point(
            nearby,
            &begin,
            h,
            &|_, _: &_, _: &_| held.clone(),
            &mut near,
        )?;
        if self.weighed {
            weigh(
                nearby,
                &found.x,
                displacements::<Sys>(&z.xi),
                &mut found.defect,
            );
        }
        values(here.defect.as_mut(), found.defect.as_ref());
        Ok((here, factored(self.system, found.defect.as_ref())))
    }
}
