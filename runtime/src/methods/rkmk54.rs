//! The method of Dormand and Prince of order 5(4) in the chart.
//!
//! Coefficients: J. R. Dormand, P. J. Prince, *A family of embedded Runge-Kutta formulae*, J. Comput. Appl. Math. 6
//! (1980) 19; dense output of order 4: E. Hairer, S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I*
//! (1993), II.6. Row 6 holds the weights b, so its stage is the first of the next step.

use crate::adaptive::pair::Pair;
use crate::error::StepError;
use crate::methods::tableau::{Row, Stages};
use crate::methods::{InChart, Method};
use crate::slopes::{Tangent, TangentStep};
use crate::state::State;
use crate::system::System;

/// Dormand-Prince method in the chart: order 5, six evaluations of ξ̇ per step; for any system.
///
/// Local error O(h⁶). x stays on its manifold to rounding. [`Adaptive::rkmk54`] is the version with step-size control.
///
/// [`Adaptive::rkmk54`]: crate::adaptive::Adaptive::rkmk54
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rkmk54;

impl<Sys: System + ?Sized> Method<Sys> for Rkmk54 {
    fn order(&self) -> u32 {
        PAIR.order
    }

    #[inline]
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
        let mut stages: Stages<Sys, 6> = Stages::start(system, state, inputs)?;
        for (index, row) in PAIR.rows.iter().enumerate().take(6).skip(1) {
            stages.evaluate(system, state, h, inputs, index, row)?;
        }
        stages.sums(system, h, CLOSING).end(system, state, h)
    }
}

impl InChart for Rkmk54 {
    #[inline]
    fn step_slopes<Sys: Tangent>(
        &self,
        step: &TangentStep<'_, Sys>,
        slopes: &mut Sys::Slopes,
        in_dual_numbers: impl FnOnce(&mut Sys::Slopes) -> Result<State<Sys>, StepError>,
    ) -> Result<State<Sys>, StepError> {
        match Sys::PLAIN {
            true => step.explicit::<6>(&PAIR.rows, CLOSING, slopes),
            false => in_dual_numbers(slopes),
        }
    }
}

const CLOSING: &[(usize, f64)] = &[
    (0, 35.0 / 384.0),
    (2, 500.0 / 1113.0),
    (3, 125.0 / 192.0),
    (4, -2187.0 / 6784.0),
    (5, 11.0 / 84.0),
];

/// Coefficients of the method, with its error estimate and dense output.
pub static PAIR: Pair<7, 1> = Pair {
    order: 5,
    end: 6,
    stability: 3.25,
    rows: [
        Row {
            node: 0.0,
            weights: &[],
        },
        Row {
            node: 0.2,
            weights: &[(0, 0.2)],
        },
        Row {
            node: 0.3,
            weights: &[(0, 3.0 / 40.0), (1, 9.0 / 40.0)],
        },
        Row {
            node: 0.8,
            weights: &[(0, 44.0 / 45.0), (1, -56.0 / 15.0), (2, 32.0 / 9.0)],
        },
        Row {
            node: 8.0 / 9.0,
            weights: &[
                (0, 19372.0 / 6561.0),
                (1, -25360.0 / 2187.0),
                (2, 64448.0 / 6561.0),
                (3, -212.0 / 729.0),
            ],
        },
        Row {
            node: 1.0,
            weights: &[
                (0, 9017.0 / 3168.0),
                (1, -355.0 / 33.0),
                (2, 46732.0 / 5247.0),
                (3, 49.0 / 176.0),
                (4, -5103.0 / 18656.0),
            ],
        },
        Row {
            node: 1.0,
            weights: CLOSING,
        },
    ],
    errors: &[&[
        (0, 71.0 / 57600.0),
        (2, -71.0 / 16695.0),
        (3, 71.0 / 1920.0),
        (4, -17253.0 / 339_200.0),
        (5, 22.0 / 525.0),
        (6, -1.0 / 40.0),
    ]],
    dense: [&[
        (0, -12_715_105_075.0 / 11_282_082_432.0),
        (2, 87_487_479_700.0 / 32_700_410_799.0),
        (3, -10_690_763_975.0 / 1_880_347_072.0),
        (4, 701_980_252_875.0 / 199_316_789_632.0),
        (5, -1_453_857_185.0 / 822_651_844.0),
        (6, 69_997_945.0 / 29_380_423.0),
    ]],
};
