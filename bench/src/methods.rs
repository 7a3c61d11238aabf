//! The table of methods: one line each, in tables by what they need of a system.

use hamel::System;
use hamel::methods::{Rk4, Rk4Projected, Rkmk4};
use hamel_report::data::Kind;
use hamel_report::problem::{Entry, Problem};

/// Lines `name kind method` as entries of a problem.
macro_rules! table {
    ($problem:expr; $($name:literal $kind:ident $method:expr;)*) => {
        vec![$($problem.by($name, Kind::$kind, $method)),*]
    };
}

/// Methods for any system.
pub fn general<'p, 'a, Sys, U>(problem: &'p Problem<'a, Sys, U>) -> Vec<Entry<'p>>
where
    Sys: System<Scalar = f64>,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    table! { problem;
        "rkmk4" Method Rkmk4;
        "rk4" Baseline Rk4 { lambda: 0.0 };
        "rk4, λ = 10/s" Baseline Rk4 { lambda: 10.0 };
        "rk4-projected" Baseline Rk4Projected;
    }
}
