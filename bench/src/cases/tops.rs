//! Tops on a fixed point, each by the leanest model that fits it.

use super::{ATTITUDE, RELATIVE};
use crate::models::heavy_top_axis::AxisTop;
use crate::models::heavy_top_world::WorldTop;
use crate::models::kovalevskaya_top::KovalevskayaTop;
use crate::models::lagrange_top::LagrangeTop;
use crate::peers;
use crate::runner::{BenchError, Runner, rows};
use hamel::{System, so3};
use hamel_report::counted::Counted;
use hamel_report::problem::Problem;
use hamel_report::solution::{distance, relative};

/// Steps of long runs: 0.075 rad each on the benchmark, as much as on Kovalevskaya's top.
const BENCHMARK: f64 = 5e-4;
const KOVALEVSKAYA: f64 = 0.02;

/// A top with x = R, ξ = ω in body axes.
fn top<Sys>(runner: &mut Runner, system: &Sys, long: Option<f64>) -> Result<(), BenchError>
where
    Sys: System<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3], Inputs = [f64; 0]>,
{
    runner.case.error = ATTITUDE.into();
    let inertia: [f64; 9] = runner.parameter("J")?;
    let end: [f64; 9] = runner.end("R")?;
    let problem = Problem {
        system: Counted::new(system),
        x: runner.initial("R")?,
        xi: runner.initial("omega")?,
        until: runner.case.until,
        inputs: |_, _: &_, _: &_| [],
        error: Box::new(move |x, _| distance(x, &end)),
        momenta: Box::new(move |x, xi| vertical(x, &inertia, xi)),
        conservative: true,
    };
    let peers = peers::tops(runner, &problem)?;
    runner.measure(&problem, peers, long);
    Ok(())
}

/// (R J ω)₃.
fn vertical(x: &[f64], inertia: &[f64; 9], xi: &[f64]) -> Vec<f64> {
    match (x.first_chunk(), xi.first_chunk()) {
        (Some(r), Some(w)) => vec![so3::apply(*r, so3::apply(*inertia, *w))[2]],
        _ => vec![f64::NAN],
    }
}

pub fn benchmark(runner: &mut Runner) -> Result<(), BenchError> {
    let [j1, _, _, _, j2, _, _, _, j3] = runner.parameter("J")?;
    let ([m], [_, l, _]) = (runner.parameter("m")?, runner.parameter("s")?);
    let system = AxisTop::new(m, runner.gravity()?, l, j1, j2, j3);
    top(runner, &body(system)?, Some(BENCHMARK))
}

pub fn kovalevskaya(runner: &mut Runner) -> Result<(), BenchError> {
    let [.., c] = runner.parameter::<9>("J")?;
    let ([m], [a, _, _]) = (runner.parameter("m")?, runner.parameter("s")?);
    let system = KovalevskayaTop::new(m, runner.gravity()?, a, c);
    top(runner, &body(system)?, Some(KOVALEVSKAYA))
}

pub fn lagrange(runner: &mut Runner) -> Result<(), BenchError> {
    let [a, .., c] = runner.parameter::<9>("J")?;
    let ([m], [_, _, l]) = (runner.parameter("m")?, runner.parameter("s")?);
    let system = LagrangeTop::new(m, runner.gravity()?, l, a, c);
    top(runner, &body(system)?, None)
}

/// A bob whose inertia is made isotropic about the joint moves as a spherical pendulum, without poles.
pub fn pendulum(runner: &mut Runner) -> Result<(), BenchError> {
    runner.case.error = RELATIVE.into();
    let ([m], [l]) = (runner.parameter("m")?, runner.parameter("l")?);
    let j = m * l * l;
    let isotropic = rows([j, 0.0, 0.0, 0.0, j, 0.0, 0.0, 0.0, j]);
    let system = WorldTop::new(m, runner.gravity()?, [0.0, 0.0, l], isotropic);
    let system = body(system)?;
    let n0 = runner.initial::<3>("x")?.map(|x| x / l);
    let v0: [f64; 3] = runner.initial("xdot")?;
    let tilt = so3::cross([0.0, 0.0, 1.0], n0);
    let (sin, cos) = (so3::dot(tilt, tilt).sqrt(), n0[2]);
    let turn = |t: f64| t / sin * sin.atan2(cos);
    let (end, rate): ([f64; 3], [f64; 3]) = (runner.end("x")?, runner.end("xdot")?);
    let problem = Problem {
        system: Counted::new(&system),
        x: so3::exp(tilt.map(turn)),
        xi: so3::cross(n0, v0).map(|w| w / l),
        until: runner.case.until,
        inputs: |_, _: &_, _: &_| [],
        error: Box::new(move |x, xi| match (x.first_chunk(), xi.first_chunk()) {
            (Some(r), Some(w)) => {
                let x = so3::apply(*r, [0.0, 0.0, l]);
                relative(&x, &end).max(relative(&so3::cross(*w, x), &rate))
            }
            _ => f64::NAN,
        }),
        momenta: Box::new(|_, xi| xi.get(2).copied().into_iter().collect()),
        conservative: true,
    };
    runner.measure(&problem, Vec::new(), None);
    Ok(())
}

/// A generated system, where its parameters are possible.
pub fn body<Sys, E: std::fmt::Display>(system: Result<Sys, E>) -> Result<Sys, BenchError> {
    system.map_err(|error| BenchError(error.to_string()))
}
