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
//! (Broyden).
//!
//! Where a point turns out to be no nearer, measured by the correction that follows, there are two remedies. First, M(x) g = 0
//! is solved instead. Far from the solution f = M⁻¹ τ is larger by h² k/m than it will be, and ∂(M⁻¹)/∂x τ passes for
//! stiffness; M g contains τ itself, which is nearly linear, and M only beside ξ₁ − ξ. Where that does not do, as where a
//! spring between two points is so stiff that it guides a mechanism like a rod, the step is approached by way of shorter
//! ones, each of which begins where the last two point (continuation in h).
//!
//! Sources: P. Deuflhard, *Newton Methods for Nonlinear Problems* (2011), 3.3 and 5.1; C. T. Kelley, *Iterative Methods for
//! Linear and Nonlinear Equations* (1995), 7.3.

mod equations;
mod newton;

use crate::error::StepError;
use crate::methods::backward_euler::Unknowns;
use crate::methods::{Method, arrive};
use crate::slopes::{Directions, Nearby, Tangent, values};
use crate::state::State;
use crate::system::System;
use equations::{Equations, TURNS, factored, point, reach, still, varied};

/// Order 1: the step of [`BackwardEuler`](crate::methods::BackwardEuler) of systems with a linearisation
/// ([`Tangent`], `generate all, linearize;`), solved by Newton's method, however many directions are stiff.
///
/// A step takes one evaluation of [A B] and one of ξ̇ where the equations are linear, some more of either where they are not,
/// and up to hundreds where the step is so long that it is approached by way of shorter ones. Each unknown is found to rounding by itself; the length of the step may have either sign. Steps have slopes
/// ([`step_slopes`](crate::step_slopes)): those of the implicit function.
///
/// Inputs are a function whose slopes are not known. Those that depend on the time alone cost nothing. Of a controller,
/// u(t, x, ξ), the iteration learns from its own steps how the inputs follow the state, as
/// [`BackwardEuler`](crate::methods::BackwardEuler) learns everything: it takes more of them, and may not converge where many
/// loops of a controller are stiff. It is better to describe a stiff spring or damper as a load of the system.
///
/// # Errors
/// [`StepError::NotConverged`] where no solution is found on the way from h = 0: there is none, or the step is so long
/// that the rates of the coordinates themselves turn by more than about 1 rad in it, in coordinates whose rates depend on
/// where they are (Euler's angles; not rotation matrices, quaternions, or plain coordinates with ẋ = ξ), or that a mechanism
/// goes far along what very stiff springs between its parts, or loops, leave free. Shorter steps help.
///
/// Equations of a long step may have several solutions. Springs of 10⁶ N/m that begin half a metre from rest can turn a
/// mechanism by many radians in one step, to a solution that no shorter step leads to.
/// [`StepError::Singular`] and [`StepError::NonFinite`] where ξ̇ has no value at the start, or wherever the iteration turns.
///
/// ```
/// # #[cfg(feature = "macros")]
/// # fn main() -> Result<(), hamel::StepError> {
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
/// # Ok(())
/// # }
/// # #[cfg(not(feature = "macros"))]
/// # fn main() {}
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StiffEuler;

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
            weighed: false,
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
            weighed: false,
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
