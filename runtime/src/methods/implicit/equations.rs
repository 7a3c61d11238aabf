//! The equations g(ξ₁) = 0 of an implicit step.

use crate::error::StepError;
use crate::integrate::acceleration;
use crate::manifold;
use crate::methods::implicit::unknowns::Unknowns;
use crate::scalar::Scalar;
use crate::state::State;
use crate::store::{add_scaled, largest, scale};
use crate::system::{Energies, System};

/// Largest number of fixed-point iterations for the coordinates of a step.
pub(in crate::methods) const MAX_FIXED_POINT_ITERATIONS: u32 = 64;
/// Accuracy of the coordinates of a step, in rounding units.
const ULPS: f64 = 4.0;

/// Returns x ⊕ u.
fn moved<Sys: System + ?Sized>(
    system: &Sys,
    x: &Sys::Coordinates,
    u: &Sys::Chart,
) -> Sys::Coordinates {
    let mut x = x.clone();
    manifold::retract(system.blocks(), x.as_mut(), u.as_ref());
    x
}

/// Solves u = h w(x ⊕ u, ξ₁) by fixed-point iteration and returns x ⊕ u.
///
/// The iteration starts from `u`, which is left at the solution; `None` if it does not converge.
pub(in crate::methods) fn reach<Sys: System + ?Sized>(
    system: &Sys,
    x: &Sys::Coordinates,
    h: f64,
    xi: &Sys::Velocities,
    u: &mut Sys::Chart,
) -> Option<Sys::Coordinates> {
    let (zero, one) = (Sys::Scalar::default(), Sys::Scalar::from_f64(1.0));
    let rounding = Sys::Scalar::from_f64(ULPS * Sys::Scalar::EPSILON);
    let mut nearest = one;
    for _ in 0..MAX_FIXED_POINT_ITERATIONS {
        let place = moved(system, x, u);
        let mut next = system.chart_rate(&place, xi);
        scale(next.as_mut(), h);
        let (mut own, mut change) = (zero, zero);
        for (old, new) in u.as_ref().iter().zip(next.as_ref()) {
            own = Scalar::max(own, (*new - *old).relative_to(*new, *old));
            change = Scalar::max(change, (*new - *old).magnitude());
        }
        *u = next;
        if own.largest_lane() == 0.0 {
            return Some(place);
        }
        // Converged entries have changes that are small compared with all of u and no longer shrink: rounding.
        let whole = change.relative_to(largest(u.as_ref()), zero);
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

/// Replaces g by M(x) g: entry i is (T(g + s eᵢ) − T(g) − T(s eᵢ) + T(0))/s. Entries of first-order states z stay as
/// they are.
///
/// This is exact, since the kinetic energy T is a quadratic polynomial of the velocities; s makes both parts about
/// equally large.
pub(super) fn weigh<Sys: Energies + ?Sized>(
    system: &Sys,
    x: &Sys::Coordinates,
    g: &mut Sys::Velocities,
) {
    let (zero, one) = (Sys::Scalar::default(), Sys::Scalar::from_f64(1.0));
    let none = system.zero_velocities();
    let at_rest = system.kinetic_energy(x, &none);
    let whole = system.kinetic_energy(x, g) - at_rest;
    let before = g.clone();
    for (i, entry) in g.as_mut().iter_mut().enumerate() {
        let along = |of: &Sys::Velocities, s: Sys::Scalar| {
            let mut of = of.clone();
            if let Some(entry) = of.as_mut().get_mut(i) {
                *entry += s;
            }
            system.kinetic_energy(x, &of) - at_rest
        };
        let inertia = (along(&none, one) + along(&none, -one)).magnitude();
        let square = zero.select_lt(inertia, whole.magnitude() / inertia, zero);
        let s = zero.select_lt(square, square, one).sqrt();
        let momentum = (along(&before, s) - whole - along(&none, s)) / s;
        *entry = zero.select_lt(inertia, momentum, *entry);
    }
}

/// Quantities at given values of the unknowns.
pub(in crate::methods) struct Point<Sys: System + ?Sized> {
    pub(super) x: Sys::Coordinates,
    pub(super) inputs: Sys::Inputs,
    /// Residual g; holds ξ₁ until the residual has been computed.
    pub(in crate::methods) defect: Sys::Velocities,
}

/// Input function u(t, x, ξ), behind a pointer: the iteration is compiled once per system, whatever its inputs are.
pub(in crate::methods) type Follow<'a, Sys> = dyn Fn(f64, &<Sys as System>::Coordinates, &<Sys as System>::Velocities) -> <Sys as System>::Inputs
    + 'a;

/// The equations of a step of length h from a state.
pub(in crate::methods) struct ImplicitStep<'a, Sys: System + ?Sized> {
    pub(in crate::methods) system: &'a Sys,
    pub(in crate::methods) state: &'a State<Sys>,
    pub(in crate::methods) h: f64,
    pub(in crate::methods) inputs: &'a Follow<'a, Sys>,
    /// Whether the equations are M g = 0 instead of g = 0.
    pub(in crate::methods) weighed: bool,
}

impl<Sys: Energies + ?Sized> ImplicitStep<'_, Sys> {
    /// Returns the coordinates to which ξ₁ leads, and the inputs there; the iteration for u starts from the guess in z.
    pub(super) fn place(&self, z: &mut Unknowns<Sys>) -> Result<Point<Sys>, StepError> {
        let (system, state, h) = (self.system, self.state, self.h);
        let x = reach(system, &state.x, h, &z.xi, &mut z.u).ok_or(StepError::NotConverged {
            time: state.t,
            iterations: MAX_FIXED_POINT_ITERATIONS,
        })?;
        let inputs = (self.inputs)(state.t + h, &x, &z.xi);
        let defect = z.xi.clone();
        Ok(Point { x, inputs, defect })
    }

    /// Replaces ξ₁ by the residual ξ₁ − ξ − h f.
    pub(super) fn lag(&self, f: &Sys::Velocities, xi: &mut Sys::Velocities) {
        for (own, start) in xi.as_mut().iter_mut().zip(self.state.xi.as_ref()) {
            *own -= *start;
        }
        add_scaled(xi.as_mut(), -self.h, f.as_ref());
    }

    /// Evaluates g, or M g, at given ξ₁.
    pub(in crate::methods) fn point(&self, z: &mut Unknowns<Sys>) -> Result<Point<Sys>, StepError> {
        let mut here = self.place(z)?;
        let held = |_: f64, _: &_, _: &_| here.inputs.clone();
        let f = acceleration(self.system, self.state.t, self.h, &here.x, &z.xi, &held)?;
        self.lag(&f, &mut here.defect);
        if self.weighed {
            weigh(self.system, &here.x, &mut here.defect);
        }
        Ok(here)
    }
}
