//! The classical Runge-Kutta method of the crate `ode_solvers` on the entries of (R, ω), with the
//! generated ẋ and ξ̇.

use hamel::Energies;
use hamel_report::data::Kind;
use hamel_report::entry::{Deviation, Entry, Outcome};
use hamel_report::problem::Problem;
use ode_solvers::{Rk4, SVector};
use std::hint::black_box;
use std::time::Instant;

type Entries = SVector<f64, 12>;

/// Adapts a system to the crate.
struct Raw<'p, 'a, Sys: Energies<Scalar = f64>, U>(&'p Problem<'a, Sys, U>);

impl<Sys, U> ode_solvers::System<f64, Entries> for Raw<'_, '_, Sys, U>
where
    Sys: Energies<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3], Inputs = [f64; 0]>,
{
    fn system(&self, _: f64, y: &Entries, dy: &mut Entries) {
        let (x, xi) = split(y);
        let rate = self.0.system.rate(&x, &xi);
        let accel = self
            .0
            .system
            .forward_dynamics(&x, &xi, &[])
            .unwrap_or([f64::NAN; 3]);
        for (entry, value) in dy.iter_mut().zip(rate.into_iter().chain(accel)) {
            *entry = value;
        }
    }
}

fn split(y: &Entries) -> ([f64; 9], [f64; 3]) {
    let y = y.as_slice();
    (
        y.first_chunk().copied().unwrap_or([f64::NAN; 9]),
        y.last_chunk().copied().unwrap_or([f64::NAN; 3]),
    )
}

fn solve<Sys, U>(
    problem: &Problem<'_, Sys, U>,
    steps: u64,
    until: f64,
) -> Result<Vec<Entries>, String>
where
    Sys: Energies<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3], Inputs = [f64; 0]>,
{
    let start = Entries::from_iterator(problem.x.into_iter().chain(problem.xi));
    // Subtracts half a step, since the crate rounds the number of steps up.
    let step = until / steps as f64;
    let mut solver = Rk4::new(Raw(problem), 0.0, start, until - 0.5 * step, step);
    solver.integrate().map_err(|error| error.to_string())?;
    Ok(solver.y_out().clone())
}

/// The entry of this method for a problem.
pub fn rk4<'p, Sys, U>(problem: &'p Problem<'_, Sys, U>) -> Entry<'p>
where
    Sys: Energies<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3], Inputs = [f64; 0]>,
    U: Fn(f64, &[f64; 9], &[f64; 3]) -> [f64; 0],
{
    Entry::new(
        "ode_solvers rk4",
        Kind::Peer,
        Some(4),
        move |steps, until, watch: &mut dyn FnMut(Deviation)| {
            let before = (problem.evaluations)();
            let result = solve(problem, steps, until);
            let evaluations = Some((problem.evaluations)() - before);
            let deviation = problem.deviation();
            let end = result
                .as_ref()
                .ok()
                .and_then(|track| track.last().map(split));
            for y in result.iter().flatten() {
                let (x, xi) = split(y);
                watch(deviation(&x, &xi));
            }
            Outcome {
                evaluations,
                error: end.map_or(f64::NAN, |(x, xi)| (problem.error)(&x, &xi)),
                failure: result.err(),
                statistics: None,
            }
        },
        move |steps, part| {
            let until = problem.until * (part as f64 / steps as f64);
            let begin = Instant::now();
            black_box(solve(problem, part, until).ok()?);
            Some(begin.elapsed().as_secs_f64())
        },
    )
}
