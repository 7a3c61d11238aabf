//! Parameters, states and inputs by name: the views of generated types, as used in a program.

use hamel::methods::Rkmk8;
use hamel::{State, System, ZeroOrderHold, integrate};
use hamel_tests::free_body::{FreeBody, FreeBodyInputs, FreeBodyParameters, FreeBodyState};
use hamel_tests::wheel_motors::{WheelMotors, WheelMotorsState};

/// The example of the book: a body under a constant force along its third axis, whose centre of mass falls accordingly.
#[test]
fn a_program_needs_no_index() {
    let body = FreeBody::<f64>::new(FreeBodyParameters {
        m: 2.0,
        s: [0.0; 3],
        ..Default::default()
    })
    .expect("a body");
    assert_eq!((body.m(), body.g()), (2.0, FreeBody::<f64>::default().g()));
    let mut state = State::from(FreeBodyState {
        w: [0.0; 3],
        v: [1.0, 0.0, 0.0],
        ..Default::default()
    });
    let push = FreeBodyInputs {
        f: [0.0, 0.0, 20.0],
        ..Default::default()
    };
    let push = push.to_array();
    integrate(&body, Rkmk8, &mut state, 1e-2, 3.0, |_, _, _| push, |_| {}).expect("a run");
    let end = FreeBodyState::from(&state);
    let height = (20.0 / 2.0 - 9.81) * 9.0 / 2.0;
    for (found, expected) in end.r.into_iter().zip([3.0, 0.0, height]) {
        assert!((found - expected).abs() < 1e-11, "{:?}", end.r);
    }
    // A controller that brakes the rotation: within a period, d/dt of the rotational energy is −0.5 |w|².
    let mut state = State::from(FreeBodyState {
        w: [0.3, 1.0, -0.4],
        ..Default::default()
    });
    let mut asked = 0;
    let mut controller = ZeroOrderHold::new(0.01, |state: &State<FreeBody<f64>>| {
        asked += 1;
        let here = FreeBodyState::from(state);
        FreeBodyInputs {
            tau: here.w.map(|rate| -0.5 * rate),
            ..Default::default()
        }
        .to_array()
    });
    controller
        .integrate(&body, Rkmk8, &mut state, 1e-2, 30.0, |_| {})
        .expect("a run");
    let end = FreeBodyState::from(&state);
    assert!(end.w.iter().all(|rate| rate.abs() < 2e-3), "{:?}", end.w);
    assert_eq!(asked, 3000);
}

/// Conversions are inverse, ranges match the positions, and `default` is the start.
#[test]
fn views_are_the_arrays() {
    let x: [f64; 12] = std::array::from_fn(|i| 0.1 + i as f64);
    let xi: [f64; 6] = std::array::from_fn(|i| 20.0 + i as f64);
    let view = FreeBodyState::from_arrays(&x, &xi);
    assert_eq!(view.to_arrays(), (x, xi));
    assert_eq!(view.r_upper.concat(), x[FreeBodyState::<f64>::R_UPPER]);
    assert_eq!(view.w, xi[FreeBodyState::<f64>::W]);
    let u: [f64; 6] = std::array::from_fn(|i| 30.0 + i as f64);
    assert_eq!(FreeBodyInputs::from_array(&u).to_array(), u);
    assert_eq!(FreeBodyInputs::<f32>::default().to_array(), [0.0; 6]);
    let body = FreeBody::<f64>::default();
    assert_eq!(FreeBodyState::default().to_arrays(), body.start());
    // First-order states follow the velocities; the time is a coordinate.
    let motors = WheelMotors::<f64>::default();
    let start = WheelMotorsState::default();
    assert_eq!(start.to_arrays(), motors.start());
    assert_eq!((start.t, start.q, start.i), (0.0, [1.0, 0.0], [0.3, -0.1]));
    assert_eq!(WheelMotorsState::<f64>::FELT, 5..8);
}
