//! Bodies that roll and slide without slipping sideways.

use super::RELATIVE;
use super::bodies::{join, worst};
use super::tops::body;
use crate::models::rolling_disk::RollingDisk;
use crate::models::sleigh::Sleigh;
use crate::runner::{BenchError, Runner};
use hamel_report::counted::Counted;
use hamel_report::problem::Problem;

/// Chaplygin's sleigh; its heading is compared as (cos, sin).
pub fn sleigh(runner: &mut Runner) -> Result<(), BenchError> {
    runner.case.error = RELATIVE.into();
    let ([m], [j], [a]) = (
        runner.parameter("m")?,
        runner.parameter("I")?,
        runner.parameter("a")?,
    );
    let system = body(Sleigh::new(m, j, a))?;
    let ([x], [y], [q]) = (
        runner.initial("x")?,
        runner.initial("y")?,
        runner.initial::<1>("theta")?,
    );
    let (end_x, end_y): ([f64; 1], [f64; 1]) = (runner.end("x")?, runner.end("y")?);
    let [angle] = runner.end::<1>("theta")?;
    let fields = [
        (0, end_x.to_vec()),
        (1, end_y.to_vec()),
        (2, vec![angle.cos(), angle.sin()]),
        (4, runner.end::<1>("u")?.to_vec()),
        (5, runner.end::<1>("w")?.to_vec()),
    ];
    let problem = Problem {
        system: Counted::new(&system),
        x: [x, y, q.cos(), q.sin()],
        xi: join(&[&runner.initial::<1>("u")?, &runner.initial::<1>("w")?])?,
        until: runner.case.until,
        inputs: |_, _: &_, _: &_| [],
        error: Box::new(move |x, xi| worst(&fields, x, xi)),
        momenta: Box::new(|_, _| Vec::new()),
        conservative: true,
    };
    runner.measure(&problem, Vec::new(), None);
    Ok(())
}

/// A disk that leans, rolls and precesses.
pub fn disk(runner: &mut Runner) -> Result<(), BenchError> {
    runner.case.error = RELATIVE.into();
    let ([m], [a], [i1], [i3]) = (
        runner.parameter("m")?,
        runner.parameter("a")?,
        runner.parameter("I1")?,
        runner.parameter("I3")?,
    );
    let system = body(RollingDisk::new(m, a, runner.gravity()?, i1, i3))?;
    let fields = [
        (0, runner.end::<3>("r")?.to_vec()),
        (3, runner.end::<9>("R")?.to_vec()),
        (12, runner.end::<3>("omega")?.to_vec()),
    ];
    let problem = Problem {
        system: Counted::new(&system),
        x: join(&[&runner.initial::<3>("r")?, &runner.initial::<9>("R")?])?,
        xi: runner.initial("omega")?,
        until: runner.case.until,
        inputs: |_, _: &_, _: &_| [],
        error: Box::new(move |x, xi| worst(&fields, x, xi)),
        momenta: Box::new(|_, _| Vec::new()),
        conservative: true,
    };
    runner.measure(&problem, Vec::new(), None);
    Ok(())
}
