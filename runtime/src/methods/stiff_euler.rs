//! Implicit Euler method in the chart, by Newton's method with exact derivatives; the iteration is in
//! [`implicit`](crate::methods::implicit).

use crate::error::StepError;
use crate::methods::implicit::equations::{ImplicitStep, MAX_FIXED_POINT_ITERATIONS, reach};
use crate::methods::implicit::exact::{Exact, factored, still, varied};
use crate::methods::implicit::unknowns::Unknowns;
use crate::methods::{Method, arrive};
use crate::slopes::{Directions, Tangent, TangentSystem, values};
use crate::state::State;
use crate::system::System;

/// Implicit Euler method for stiff systems with a linearisation ([`Tangent`], `generate all, linearize;`): order 1, the
/// same step as [`BackwardEuler`](crate::methods::BackwardEuler), solved by Newton's method with exact derivatives.
///
/// A step takes one evaluation of the linearisation `[A B]` and one of ξ̇ if the equations are linear, a few more of
/// each if they are not, and up to hundreds if the step is so long that it is approached through shorter ones. Each
/// unknown is solved to rounding relative to its own size; the length of the step may have either sign. The slopes of a
/// step ([`step_slopes`](crate::step_slopes)) are those of the implicit function.
///
/// Inputs are a function whose derivatives are not known. Inputs that depend on time alone cost nothing extra. For a
/// controller u(t, x, ξ), the iteration learns from its own steps how the inputs depend on the state: it takes more of
/// them, and may not converge if many loops of the controller are stiff. In this case use
/// [`BackwardEuler`](crate::methods::BackwardEuler), which takes finite differences of everything, or describe a stiff
/// spring or damper as a load of the system instead of an input.
///
/// The equations of a long step may have several solutions. Springs of 10⁶ N/m that start half a metre from equilibrium
/// can turn a mechanism by many radians in one step, to a solution that is not the limit of the solutions of shorter
/// steps.
///
/// # Errors
/// [`StepError::NotConverged`] if no solution is found on the way from h = 0. Either there is none; or the rates of the
/// coordinates themselves turn by more than about 1 rad in the step, in coordinates whose rates depend on their values
/// (Euler angles; not rotation matrices, quaternions, or plain coordinates with ẋ = ξ); or the mechanism moves far in
/// directions that very stiff springs or loops leave free. Shorter steps help. [`StepError::Singular`] and
/// [`StepError::NonFinite`] if ξ̇ cannot be computed at the start, or at an iterate.
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
        let tangent = (!Sys::PLAIN).then(|| TangentSystem::new(system));
        let equations = ImplicitStep {
            system,
            state,
            h,
            inputs,
            weighed: false,
        };
        let (x, xi) = equations.solve(&Exact {
            tangent: tangent.as_ref(),
        })?;
        arrive(system, state, h, x, xi)
    }
}

/// Makes the step in plain numbers, then computes its slopes by the implicit function theorem: δξ₁ = −(∂g/∂ξ₁)⁻¹ δg,
/// where δg is the variation of g at fixed ξ₁. Inputs are evaluated in dual numbers here, so that the slopes of a
/// controller count.
impl<Sys: Tangent> Method<TangentSystem<Sys>> for StiffEuler {
    fn order(&self) -> u32 {
        1
    }

    fn step<U>(
        &self,
        tangent: &TangentSystem<Sys>,
        state: &State<TangentSystem<Sys>>,
        h: f64,
        inputs: &U,
    ) -> Result<State<TangentSystem<Sys>>, StepError>
    where
        U: Fn(
            f64,
            &<TangentSystem<Sys> as System>::Coordinates,
            &<TangentSystem<Sys> as System>::Velocities,
        ) -> <TangentSystem<Sys> as System>::Inputs,
    {
        state.check_shape(tangent)?;
        let system = tangent.plain();
        let mut begin = State::<Sys> {
            t: state.t,
            x: system.zero_coordinates(),
            xi: system.zero_velocities(),
        };
        values(begin.x.as_mut(), state.x.as_ref());
        values(begin.xi.as_mut(), state.xi.as_ref());
        let plain_inputs = |t: f64, x: &Sys::Coordinates, xi: &Sys::Velocities| {
            let (mut x_near, mut xi_near) = (tangent.zero_coordinates(), tangent.zero_velocities());
            still(x_near.as_mut(), x.as_ref());
            still(xi_near.as_mut(), xi.as_ref());
            let mut u = system.zero_inputs();
            values(u.as_mut(), inputs(t, &x_near, &xi_near).as_ref());
            u
        };
        let equations = ImplicitStep {
            system,
            state: &begin,
            h,
            inputs: &plain_inputs,
            weighed: false,
        };
        let (_, xi) = equations.solve(&Exact {
            tangent: (!Sys::PLAIN).then_some(tangent),
        })?;

        let mut fixed = state.clone();
        still(fixed.x.as_mut(), begin.x.as_ref());
        still(fixed.xi.as_mut(), begin.xi.as_ref());
        let mut z = Unknowns::<TangentSystem<Sys>> {
            u: tangent.zero_chart(),
            xi: varied(tangent, &xi),
        };
        let at = |state| ImplicitStep {
            system: tangent,
            state,
            h,
            inputs,
            weighed: false,
        };
        let along = at(&fixed).point(&mut z)?;
        let factors = factored(system, along.defect.as_ref());

        still(z.xi.as_mut(), xi.as_ref());
        let by_start = at(state).point(&mut z)?;
        let directions = by_start.defect.as_ref().first();
        for direction in 0..directions.map_or(0, |number| number.slopes().len()) {
            let mut by = system.zero_velocities();
            for (by, number) in by.as_mut().iter_mut().zip(by_start.defect.as_ref()) {
                *by = number.slopes().get(direction).copied().unwrap_or_default();
            }
            factors.solve(by.as_mut());
            for (number, by) in z.xi.as_mut().iter_mut().zip(by.as_ref()) {
                number.add_slope(-*by, direction);
            }
        }
        let x = reach(tangent, &state.x, h, &z.xi, &mut z.u).ok_or(StepError::NotConverged {
            time: state.t,
            iterations: MAX_FIXED_POINT_ITERATIONS,
        })?;
        arrive(tangent, state, h, x, z.xi)
    }
}
