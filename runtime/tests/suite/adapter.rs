//! Systems as plain equations: rates, Jacobian, what comes back, what fails.

use crate::common::points::Points;
use crate::common::{Reference, Top, distance};
use hamel::adapter::OdeEquations;
use hamel::methods::General;
use hamel::{Singular, State, StepError, System, so3};

fn top() -> Top<f64> {
    Top(Reference::read("kovalevskaya-top").body())
}

#[test]
fn rates_are_those_of_the_system_with_the_stabilising_term() {
    let system = top();
    let mut state = State::start(&system);
    state.x = state.x.map(|r| 1.01 * r);
    let equations = OdeEquations::new(&system, |_, _, _| [], 10.0);
    assert_eq!(equations.unknowns(), 12);
    let (mut y, mut y_dot) = ([0.0; 12], [0.0; 12]);
    equations.write(&state, &mut y);
    equations.rates(0.0, &y, &mut y_dot);
    let rate = system.rate(&state.x, &state.xi);
    let correction = so3::correction(state.x);
    for k in 0..9 {
        assert!((y_dot[k] - (rate[k] + 10.0 * correction[k])).abs() < 1e-15);
    }
    let accel = system
        .forward_dynamics(&state.x, &state.xi, &[])
        .expect("a body");
    assert_eq!(y_dot[9..], accel);

    let back = equations.state(0.5, &y).expect("a state");
    assert_eq!((back.t, back.xi), (0.5, state.xi));
    // One polar step squares the defect of 2e-2.
    assert!(system.constraint_norm(&back.x) < 4e-4);
}

#[test]
fn the_jacobian_is_the_derivative() {
    // ẍ₁ = −x₁ x₂² − ẋ₂, ẍ₂ = sin x₁ + ẋ₁³
    let system = Points {
        start: ([0.3, -1.2], [0.7, 2.0]),
        accel: |x, v| Ok([-x[0] * x[1] * x[1] - v[1], x[0].sin() + v[0].powi(3)]),
    };
    let equations = OdeEquations::new(&system, |_, _, _| [], 0.0);
    let y = [0.3_f64, -1.2, 0.7, 2.0];
    let rows = [
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [-y[1] * y[1], -2.0 * y[0] * y[1], 0.0, -1.0],
        [y[0].cos(), 0.0, 3.0 * y[2] * y[2], 0.0],
    ];
    for v in [
        [1.0, 0.0, 0.0, 0.0],
        [1e-5, -2e-5, 3e-5, 1e-5],
        [40.0, 1.0, -30.0, 7.0],
        [0.0; 4],
    ] {
        let mut product = [f64::NAN; 4];
        equations.jacobian_product(0.0, &y, &v, &mut product);
        let expected = rows.map(|row| (0..4).map(|k| row[k] * v[k]).sum::<f64>());
        let size = v.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        // ∛ε² of the third derivatives, and rounding over ∛ε.
        assert!(
            distance(product, expected) <= 1e-8 * size,
            "{product:?} {expected:?}"
        );
    }
}

#[test]
fn what_fails_is_told() {
    let wall = Points {
        start: ([0.0], [1.0]),
        accel: |x, _| {
            if x[0] < 1.0 {
                Ok([0.0])
            } else {
                Err(Singular::Mass)
            }
        },
    };
    let equations = OdeEquations::new(&wall, |_, _, _| [], 0.0);
    let mut y_dot = [0.0; 2];
    equations.rates(0.25, &[0.5, 1.0], &mut y_dot);
    assert_eq!((y_dot, equations.failure()), ([1.0, 0.0], None));
    equations.rates(0.25, &[1.5, 1.0], &mut y_dot);
    assert!(y_dot.iter().all(|rate| rate.is_nan()));
    let cause = StepError::Singular {
        cause: Singular::Mass,
        time: 0.25,
    };
    assert_eq!(equations.failure(), Some(cause));
    // What a solver computes from NaN does not hide it.
    equations.rates(0.5, &[f64::NAN, 1.0], &mut y_dot);
    assert_eq!(equations.failure(), Some(cause));

    let wrong = equations.state(0.0, &[1.0]).map(|state| state.t);
    let part = "coordinates and velocities";
    assert_eq!(
        wrong,
        Err(StepError::Shape {
            part,
            expected: 2,
            found: 1
        })
    );
    let infinite = equations
        .state(0.0, &[f64::INFINITY, 0.0])
        .map(|state| state.t);
    assert_eq!(infinite, Err(StepError::NonFinite { time: 0.0 }));
}

#[test]
fn a_runge_kutta_method_on_the_unknowns_is_rk4_on_the_entries() {
    let system = top();
    let equations = OdeEquations::new(&system, |_, _, _| [], 10.0);
    let mut state = State::start(&system);
    let mut y = [0.0; 12];
    equations.write(&state, &mut y);
    let h = 0.01;
    for _ in 0..100 {
        let method = General::Rk4 { lambda: 10.0 };
        hamel::step(&system, method, &mut state, h, &|_, _, _| []).expect("a step");
        let mut sum = [0.0; 12];
        let mut k = [0.0; 12];
        for (node, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            let point: [f64; 12] = std::array::from_fn(|i| y[i] + node * h * k[i]);
            equations.rates(0.0, &point, &mut k);
            sum = std::array::from_fn(|i| sum[i] + weight * k[i]);
        }
        y = std::array::from_fn(|i| y[i] + h / 6.0 * sum[i]);
    }
    let end = equations.state(1.0, &y).expect("a state");
    // The same method, but for rounding and the last projection.
    assert!(distance(end.xi, state.xi) < 1e-13);
    assert!(distance(end.x, so3::polar(state.x)) < 1e-13);
}
