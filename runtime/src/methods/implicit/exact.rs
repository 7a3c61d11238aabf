//! Exact ∂g/∂ξ₁, from the linearisation of a system.

use crate::error::StepError;
use crate::methods::factors::{Factors, Part};
use crate::methods::implicit::Derivative;
use crate::methods::implicit::equations::{ImplicitStep, Point};
use crate::methods::implicit::unknowns::Unknowns;
use crate::scalar::Scalar;
use crate::slopes::{Directions, Tangent, TangentSystem, values};
use crate::state::State;
use crate::store::{Table, add_scaled, is_finite, scale};
use crate::system::System;

/// LU factors of ∂g/∂ξ₁ of a system.
pub(in crate::methods) type FactorsOf<Sys> =
    Factors<<Sys as System>::Scalar, Part<<Sys as Tangent>::Slopes>, <Sys as System>::Velocities>;

/// Factorises ∂g/∂ξ₁, given g in dual numbers with slopes along the directions of ξ.
pub(in crate::methods) fn factored<Sys: Tangent>(
    system: &Sys,
    defect: &[Sys::Number],
) -> FactorsOf<Sys> {
    let mut table = Sys::Slopes::zero();
    let first = table.rows() - defect.len();
    for (i, number) in defect.iter().enumerate() {
        for (entry, slope) in table.row_mut(first + i).iter_mut().zip(number.slopes()) {
            *entry = *slope;
        }
    }
    Factors::new(Part { table, first }, system.zero_velocities())
}

/// Returns ξ₁ in dual numbers, each entry with slope 1 along its own direction.
pub(in crate::methods) fn varied<Sys: Tangent>(
    tangent: &TangentSystem<Sys>,
    xi: &Sys::Velocities,
) -> <TangentSystem<Sys> as System>::Velocities {
    let first = Sys::Slopes::zero().rows() - xi.as_ref().len();
    let mut varied = tangent.zero_velocities();
    for (i, (number, value)) in varied.as_mut().iter_mut().zip(xi.as_ref()).enumerate() {
        *number = Sys::Number::along(*value, first + i);
    }
    varied
}

/// Sets dual numbers to values with zero slopes.
pub(in crate::methods) fn still<N: Directions>(numbers: &mut [N], values: &[N::Value]) {
    for (number, value) in numbers.iter_mut().zip(values) {
        number.vary(*value, &[]);
    }
}

/// Exact derivatives of a system with a linearisation, for inputs held constant.
pub(in crate::methods) struct Exact<'a, Sys: Tangent> {
    /// The system in dual numbers, if they are needed.
    pub(in crate::methods) tangent: Option<&'a TangentSystem<Sys>>,
}

impl<Sys: Tangent> Derivative<Sys> for Exact<'_, Sys> {
    type Factors = FactorsOf<Sys>;

    const KNOWS_INPUTS: bool = false;

    fn linear(
        &self,
        equations: &ImplicitStep<'_, Sys>,
        z: &mut Unknowns<Sys>,
        iterations: &mut u32,
    ) -> Result<(Point<Sys>, Self::Factors), StepError> {
        *iterations += 1;
        let (system, state, h) = (equations.system, equations.state, equations.h);
        let time = state.t;
        let mut here = equations.place(z)?;
        let made =
            (equations.weighed && self.tangent.is_none()).then(|| TangentSystem::new(system));
        let Some(tangent) = self.tangent.or(made.as_ref()) else {
            let mut table = Sys::Slopes::zero();
            let found = system.slopes(&here.x, &z.xi, &here.inputs, &mut table);
            let f = found.map_err(|cause| {
                match is_finite(here.x.as_ref()) && is_finite(z.xi.as_ref()) {
                    true => StepError::Singular { cause, time },
                    false => StepError::NonFinite { time },
                }
            })?;
            equations.lag(&f, &mut here.defect);
            let first = table.rows() - f.as_ref().len();
            for i in first..table.rows() {
                let row = table.row_mut(i);
                // The displacement of each plain coordinate is h times its velocity; velocities precede the states z in
                // ξ₁.
                let (by_x, by_xi) = row.split_at_mut(first.min(row.len()));
                add_scaled(by_xi.get_mut(..first).unwrap_or(&mut []), h, by_x);
                scale(row, -h);
                if let Some(entry) = row.get_mut(i) {
                    *entry += Sys::Scalar::from_f64(1.0);
                }
            }
            let factors = Factors::new(Part { table, first }, system.zero_velocities());
            return Ok((here, factors));
        };
        let mut begin = State::<TangentSystem<Sys>> {
            t: time,
            x: tangent.zero_coordinates(),
            xi: tangent.zero_velocities(),
        };
        still(begin.x.as_mut(), state.x.as_ref());
        still(begin.xi.as_mut(), state.xi.as_ref());
        let mut held = tangent.zero_inputs();
        still(held.as_mut(), here.inputs.as_ref());
        let mut near = Unknowns::<TangentSystem<Sys>> {
            u: tangent.zero_chart(),
            xi: varied(tangent, &z.xi),
        };
        still(near.u.as_mut(), z.u.as_ref());
        let varying = ImplicitStep {
            system: tangent,
            state: &begin,
            h,
            inputs: &|_, _: &_, _: &_| held.clone(),
            weighed: equations.weighed,
        };
        let found = varying.point(&mut near)?;
        values(here.defect.as_mut(), found.defect.as_ref());
        Ok((here, factored(system, found.defect.as_ref())))
    }

    fn solve(factors: &Self::Factors, defect: &mut Sys::Velocities) {
        factors.solve(defect.as_mut());
    }
}
