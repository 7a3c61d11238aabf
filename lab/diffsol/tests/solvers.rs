//! Integrates generated systems by the solvers of diffsol: a heavy top compared with `Rkmk8`, and a stiff system.

use diffsol::{DenseMatrix, MatrixCommon, NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod};
use hamel::adapter::OdeEquations;
use hamel::adaptive::Adaptive;
use hamel::{State, StepError, System};

hamel::rigid_eom! {
    /// A top on a fixed point, its centre of mass on its axis.
    pub system Top {
        param m = 1, g = 9.81, l = 0.1, J1 = 0.03, J3 = 0.02;
        coord R: SO3;
        velocity w: vec3;
        rate R = R * hat(w);
        frame top = pose(R, [0, 0, 0]);
        body on top { mass m; com [0, 0, l]; inertia diag(J1, J1, J3) about origin; }
        gravity [0, 0, -g];
        start w = [2, 1, 20];
    }
}

hamel::rigid_eom! {
    /// A pendulum in honey: its velocity is forgotten in a microsecond.
    pub system Honey {
        param m = 1, l = 1, g = 9.81, d = 1e6;
        coord a: S1;
        velocity w;
        rate a = w;
        particle mass m at [l * a.s, 0, -l * a.c];
        gravity [0, 0, -g];
        generalized force w = -d * w;
        start a = 1;
    }
}

/// Returns the final state of a run by diffsol's BDF of variable order, and the number of its steps.
fn bdf<Sys>(
    system: &Sys,
    lambda: f64,
    until: f64,
    tolerance: f64,
) -> Result<(State<Sys>, usize), Box<dyn std::error::Error>>
where
    Sys: System<Scalar = f64>,
{
    let none = |_, _: &_, _: &_| system.zero_inputs();
    let equations = OdeEquations::new(system, none, lambda);
    let start = State::start(system);
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .t0(start.t)
        .rtol(tolerance)
        .atol([tolerance])
        .rhs_implicit(
            |y, _, t, rates| equations.rates(t, y, rates),
            |y, _, t, v, product| equations.jacobian_product(t, y, v, product),
        )
        .init(|_, _, y| equations.write(&start, y), equations.unknowns())
        .build()?;
    let mut solver = problem.bdf::<NalgebraLU<f64>>()?;
    let (path, times, _) = solver.solve(until)?;
    let last = path.ncols() - 1;
    let y: Vec<f64> = (0..path.nrows())
        .map(|row| path.get_index(row, last))
        .collect();
    Ok((equations.state(until, &y)?, times.len()))
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    square.sqrt()
}

#[test]
fn a_heavy_top_agrees_with_rkmk8() -> Result<(), Box<dyn std::error::Error>> {
    const TOLERANCE: f64 = 1e-9;
    let system = Top::default();
    let mut exact = State::start(&system);
    Adaptive::rkmk8(1e-12).run(&system, &mut exact, 2.0, |_, _, _| system.zero_inputs())?;
    let (end, steps) = bdf(&system, 10.0, 2.0, TOLERANCE)?;
    let error = distance(&end.x, &exact.x);
    println!("{error:e} in {steps} steps");
    // The errors of a multistep method accumulate in an oscillating motion: ten thousand tolerances.
    assert!(error < 1e4 * TOLERANCE);
    assert!(system.constraint_norm(&end.x) < 1e-14);
    Ok(())
}

#[test]
fn a_stiff_system_takes_few_steps() -> Result<(), Box<dyn std::error::Error>> {
    let system = Honey::default();
    let (end, steps) = bdf(&system, 10.0, 100.0, 1e-8)?;
    // θ̇ = −(g/l)/(c/(m l²)) sin θ: tan(θ/2) decays at 9.81e-6/s.
    let expected = 2.0 * (0.5_f64.tan() * (-9.81e-4_f64).exp()).atan();
    let angle = hamel::s1::log([end.x[0], end.x[1]]);
    println!("{:e} in {steps} steps", angle - expected);
    assert!((angle - expected).abs() < 1e-6);
    // An explicit method would need 1e6 steps a second.
    assert!(steps < 1000);
    Ok(())
}

#[test]
fn the_last_state_is_refused_when_it_is_none() {
    let system = Honey::default();
    let equations = OdeEquations::new(&system, |_, _: &_, _: &_| system.zero_inputs(), 0.0);
    let end = equations.state(1.0, &[f64::NAN; 3]).map(|state| state.t);
    assert_eq!(end, Err(StepError::NonFinite { time: 1.0 }));
}
