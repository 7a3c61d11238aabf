//! The tables of methods, one line each, grouped by the traits that they need of a system.

use hamel::adaptive::Adaptive;
use hamel::methods::{
    BackwardEuler, Cf4, Gauss4, Gauss6, Lgvi, Rk4, Rkmk4, Rkmk8, Rkmk54, Scheme, SemiImplicitEuler,
    Splitting, free,
};
use hamel::{Canonical, Energies, Split};
use hamel_engine::baselines::{Buss, ForwardEuler, Rk4Added, Rk4Projected, Slide};
use hamel_report::data::Kind;
use hamel_report::entry::{Entry, Outcome, Watch};
use hamel_report::problem::Problem;
use std::hint::black_box;
use std::time::Instant;

/// Lines `name kind method` as entries of a problem.
macro_rules! table {
    ($problem:expr; $($name:literal $kind:ident $method:expr;)*) => {
        vec![$($problem.by($name, Kind::$kind, $method)),*]
    };
}

/// Methods for any system.
pub fn general<'p, 'a, Sys, U>(problem: &'p Problem<'a, Sys, U>) -> Vec<Entry<'p>>
where
    Sys: Energies<Scalar = f64>,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    let mut entries = table! { problem;
        "rkmk4" Method Rkmk4;
        "cf4" Method Cf4;
        "rkmk54" Method Rkmk54;
        "rkmk8" Method Rkmk8;
    };
    entries.push(problem.controlled("rkmk54 adaptive", 5, Adaptive::rkmk54));
    entries.push(problem.controlled("rkmk8 adaptive", 8, Adaptive::rkmk8));
    entries.extend(table! { problem;
        "rk4" Baseline Rk4 { lambda: 0.0 };
        "rk4, λ = 10/s" Baseline Rk4 { lambda: 10.0 };
        "rk4-projected" Baseline Rk4Projected;
        "rk4-added" Baseline Rk4Added;
        "euler" Baseline ForwardEuler;
        "semi-implicit-euler" Baseline SemiImplicitEuler;
        "backward-euler" Baseline BackwardEuler;
    });
    entries
}

/// Methods that integrate momenta.
pub fn canonical<'p, 'a, Sys, U>(problem: &'p Problem<'a, Sys, U>) -> Vec<Entry<'p>>
where
    Sys: Canonical<Scalar = f64> + Energies,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    table! { problem;
        "gauss4" Method Gauss4;
        "gauss6" Method Gauss6;
    }
}

/// Methods for bodies in potentials.
pub fn split<'p, 'a, Sys, U>(problem: &'p Problem<'a, Sys, U>) -> Vec<Entry<'p>>
where
    Sys: Split<Scalar = f64> + Energies,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    let kicks = |scheme| Splitting::new(problem.system, scheme);
    let mut entries = table! { problem;
        "splitting2" Method kicks(Scheme::Strang);
        "splitting" Method kicks(Scheme::Nystrom4);
        "splitting6" Method kicks(Scheme::Nystrom6);
        "suzuki" Method kicks(Scheme::Suzuki4);
        "kahan-li" Method kicks(Scheme::KahanLi6);
        "kahan-li8" Method kicks(Scheme::KahanLi8);
    };
    if Sys::FREE {
        entries.push(closed(problem));
    }
    entries.extend(table! { problem;
        "lgvi" Method Lgvi;
        "slide" Baseline Slide;
        "buss1" Baseline Buss::First;
        "buss2" Baseline Buss::Second;
        "buss-augmented2" Baseline Buss::AugmentedSecond;
        "buss4" Baseline Buss::Fourth;
    });
    entries
}

/// The closed form, which takes one evaluation for any number of steps.
fn closed<'p, 'a, Sys, U>(problem: &'p Problem<'a, Sys, U>) -> Entry<'p>
where
    Sys: Split<Scalar = f64> + Energies,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    Entry::new(
        "free",
        Kind::Method,
        None,
        move |steps, until, watch: Watch| {
            let deviation = problem.deviation();
            let start = problem.start();
            let mut end = Ok(start.clone());
            for index in 1..=steps {
                let t = until * (index as f64 / steps as f64);
                end = free::at(problem.system, &start, t);
                if let Ok(state) = &end {
                    watch(deviation(&state.x, &state.xi));
                }
            }
            Outcome {
                evaluations: Some(0),
                error: end.as_ref().map_or(f64::NAN, |end| problem.judge(end)),
                failure: end.err().map(|error| error.to_string()),
                statistics: None,
            }
        },
        move |steps, part| {
            let begin = Instant::now();
            let start = black_box(problem.start());
            black_box(free::at(problem.system, &start, problem.until).ok()?);
            // A run takes one evaluation; the caller scales the time from a part of the steps to all.
            Some(begin.elapsed().as_secs_f64() * part as f64 / steps as f64)
        },
    )
}
