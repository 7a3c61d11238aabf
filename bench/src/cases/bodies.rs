//! Free bodies, bodies under loads that are given, and chains.

use super::tops::body;
use super::{ATTITUDE, RELATIVE};
use crate::models::double_pendulum_angles::DoublePendulum;
use crate::models::free_body::FreeBody;
use crate::models::principal_axes::PrincipalAxes;
use crate::models::satellite::Satellite;
use crate::models::two_bodies::TwoBodies;
use crate::peers;
use crate::runner::{BenchError, Runner, rows};
use hamel::so3;
use hamel_report::counted::Counted;
use hamel_report::problem::Problem;
use hamel_report::solution::{distance, largest, relative};

/// Step of the long run: 0.1 rad.
const DZHANIBEKOV: f64 = 0.1;

/// A torque-free body.
pub fn free(runner: &mut Runner) -> Result<(), BenchError> {
    runner.case.error = ATTITUDE.into();
    let inertia: [f64; 9] = runner.parameter("J")?;
    let [j1, _, _, _, j2, _, _, _, j3] = inertia;
    let system = body(PrincipalAxes::new(j1, j2, j3))?;
    let end: [f64; 9] = runner.end("R")?;
    let problem = Problem {
        system: Counted::new(&system),
        x: runner.initial("R")?,
        xi: runner.initial("omega")?,
        until: runner.case.until,
        inputs: |_, _: &_, _: &_| [],
        error: Box::new(move |x, _| distance(x, &end)),
        momenta: Box::new(move |x, xi| match (x.first_chunk(), xi.first_chunk()) {
            (Some(r), Some(w)) => so3::apply(*r, so3::apply(inertia, *w)).to_vec(),
            _ => vec![f64::NAN],
        }),
        conservative: true,
    };
    let long = (runner.case.name == "free-dzhanibekov-1e-3").then_some(DZHANIBEKOV);
    let peers = peers::free(runner, &problem)?;
    runner.measure(&problem, peers, long);
    Ok(())
}

/// Six degrees of freedom, in gravity, with a constant wrench where there is one.
pub fn six(runner: &mut Runner) -> Result<(), BenchError> {
    runner.case.error = RELATIVE.into();
    let ([m], s) = (runner.parameter("m")?, runner.parameter("s")?);
    let theta = rows(runner.parameter("Theta")?);
    let system = body(FreeBody::new(m, runner.gravity()?, s, theta))?;
    let force = runner.parameter::<3>("F");
    let torque = runner.parameter::<3>("tau");
    let zero = [0.0; 3];
    let load: [f64; 6] = join(&[&force.unwrap_or(zero), &torque.unwrap_or(zero)])?;
    let fields = [
        (0, runner.end::<3>("r")?.to_vec()),
        (3, runner.end::<9>("R")?.to_vec()),
        (12, runner.end::<3>("v")?.to_vec()),
        (15, runner.end::<3>("omega")?.to_vec()),
    ];
    let problem = Problem {
        system: Counted::new(&system),
        x: join(&[&runner.initial::<3>("r")?, &runner.initial::<9>("R")?])?,
        xi: join(&[&runner.initial::<3>("v")?, &runner.initial::<3>("omega")?])?,
        until: runner.case.until,
        inputs: |_, _: &_, _: &_| load,
        error: Box::new(move |x, xi| worst(&fields, x, xi)),
        momenta: Box::new(|_, _| Vec::new()),
        conservative: load == [0.0; 6],
    };
    runner.measure(&problem, Vec::new(), None);
    Ok(())
}

/// A satellite whose orbit is given.
pub fn satellite(runner: &mut Runner) -> Result<(), BenchError> {
    runner.case.error = RELATIVE.into();
    let [j1, _, _, _, j2, _, _, _, j3] = runner.parameter("J")?;
    let [rate] = runner.parameter("orbit_rate_n")?;
    let system = body(Satellite::new(j1, j2, j3, rate))?;
    let fields = [
        (0, runner.end::<9>("R")?.to_vec()),
        (9, runner.end::<3>("omega")?.to_vec()),
    ];
    let problem = Problem {
        system: Counted::new(&system),
        x: runner.initial("R")?,
        xi: runner.initial("omega")?,
        until: runner.case.until,
        inputs: |t: f64, _: &_, _: &_| [(rate * t).cos(), (rate * t).sin(), 0.0],
        error: Box::new(move |x, xi| worst(&fields, x, xi)),
        momenta: Box::new(|_, _| Vec::new()),
        conservative: false,
    };
    runner.measure(&problem, Vec::new(), None);
    Ok(())
}

/// Two bodies on ball joints.
pub fn two(runner: &mut Runner) -> Result<(), BenchError> {
    runner.case.error = RELATIVE.into();
    let [m1, m2] = runner.parameter("m")?;
    let system = body(TwoBodies::new(
        m1,
        m2,
        runner.gravity()?,
        runner.parameter("s1")?,
        runner.parameter("s2")?,
        runner.parameter("d")?,
        rows(runner.parameter("Theta1")?),
        rows(runner.parameter("Theta2")?),
    ))?;
    let fields = [
        (0, runner.end::<9>("R1")?.to_vec()),
        (9, runner.end::<9>("R2")?.to_vec()),
        (18, runner.end::<3>("omega1")?.to_vec()),
        (21, runner.end::<3>("omega2")?.to_vec()),
    ];
    let problem = Problem {
        system: Counted::new(&system),
        x: join(&[&runner.initial::<9>("R1")?, &runner.initial::<9>("R2")?])?,
        xi: join(&[
            &runner.initial::<3>("omega1")?,
            &runner.initial::<3>("omega2")?,
        ])?,
        until: runner.case.until,
        inputs: |_, _: &_, _: &_| [],
        error: Box::new(move |x, xi| worst(&fields, x, xi)),
        momenta: Box::new(|_, _| Vec::new()),
        conservative: true,
    };
    runner.measure(&problem, Vec::new(), None);
    Ok(())
}

/// The chaotic double pendulum, in angles.
pub fn double_pendulum(runner: &mut Runner) -> Result<(), BenchError> {
    runner.case.error = RELATIVE.into();
    let ([m1, m2], [l1, l2]) = (runner.parameter("m")?, runner.parameter("l")?);
    let system = body(DoublePendulum::new(m1, m2, l1, l2, runner.gravity()?))?;
    let fields = [
        (0, runner.end::<2>("theta")?.to_vec()),
        (2, runner.end::<2>("thetadot")?.to_vec()),
    ];
    let problem = Problem {
        system: Counted::new(&system),
        x: runner.initial("theta")?,
        xi: runner.initial("thetadot")?,
        until: runner.case.until,
        inputs: |_, _: &_, _: &_| [],
        error: Box::new(move |x, xi| worst(&fields, x, xi)),
        momenta: Box::new(|_, _| Vec::new()),
        conservative: true,
    };
    runner.measure(&problem, Vec::new(), None);
    Ok(())
}

/// Lists in a row.
pub fn join<const N: usize>(parts: &[&[f64]]) -> Result<[f64; N], BenchError> {
    let list = parts.concat();
    list.try_into()
        .map_err(|list: Vec<f64>| BenchError(format!("{} numbers instead of {N}", list.len())))
}

/// The largest relative error of fields, each with its place in (x, ξ).
pub fn worst(fields: &[(usize, Vec<f64>)], x: &[f64], xi: &[f64]) -> f64 {
    let state = [x, xi].concat();
    largest(fields.iter().map(|(offset, end)| {
        let here = state.get(*offset..offset + end.len());
        here.map_or(f64::NAN, |here| relative(here, end))
    }))
}
