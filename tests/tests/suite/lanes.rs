//! Compares generated code on SIMD lanes and in ensembles with the same code on one number.

use std::ops::ControlFlow;
use std::sync::Mutex;

use hamel::ensemble::{self, Failure, Group, Outcome, Progress, quietly};
use hamel::methods::{Gauss4, Rkmk4};
use hamel::wide::{f32x8, f64x4, f64x8};
use hamel::{Lanes, Method, Scalar, State, StepError, System, integrate};
use hamel_tests::bouncing_ball::BouncingBall;
use hamel_tests::cart_pole::{CartPole, CartPoleParameters};
use hamel_tests::double_pendulum_angles::DoublePendulum;
use hamel_tests::free_body::FreeBody;
use hamel_tests::heavy_top_quaternion::QuaternionTop;
use hamel_tests::pendulum::Pendulum;
use hamel_tests::torque_curve::TorqueCurve;
use hamel_tests::two_bodies::TwoBodies;

/// Rounding of sin and cos, which differ by a unit in the last place, over 100 steps of motions that are not chaotic on
/// this time scale.
const TOLERANCE: f64 = 1e-12;
const H: f64 = 0.01;
const UNTIL: f64 = 1.0;

/// Returns states around the start of the description, with different velocities.
fn members<Single: System<Scalar = f64>>(system: &Single, count: usize) -> Vec<State<Single>> {
    let state = |member: usize| {
        let mut state = State::start(system);
        for (entry, xi) in state.xi.as_mut().iter_mut().enumerate() {
            *xi += 0.3 * ((7 * member + 3 * entry) as f64).sin();
        }
        state
    };
    (0..count).map(state).collect()
}

fn alone<Single: System<Scalar = f64>, M: Method<Single>>(
    system: &Single,
    method: M,
    states: &[State<Single>],
) -> Vec<State<Single>> {
    let end = |state: &State<Single>| {
        let mut state = state.clone();
        let none = |_: f64, _: &_, _: &_| system.zero_inputs();
        integrate(system, &method, &mut state, H, UNTIL, none, |_| {}).expect("a regular motion");
        state
    };
    states.iter().map(end).collect()
}

fn distance<A: System<Scalar = f64>>(a: &State<A>, b: &State<A>) -> f64 {
    let pairs = a.x.as_ref().iter().zip(b.x.as_ref());
    let pairs = pairs.chain(a.xi.as_ref().iter().zip(b.xi.as_ref()));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Runs full groups, a group with unused lanes, a single member, and none.
fn agrees<Single, Wide>(single: &Single, wide: &Wide)
where
    Single: System<Scalar = f64>,
    Wide: System<Scalar: Lanes<Element = f64>> + Clone + Sync,
    State<Single>: Send,
{
    for count in [0, 1, 8, 13] {
        let mut states = members(single, count);
        let expected = alone(single, Rkmk4, &states);
        let none = |_: &Group, _: f64, _: &_, _: &_| wide.zero_inputs();
        let outcome = ensemble::integrate(wide, &Rkmk4, &mut states, H, UNTIL, none, quietly);
        assert_eq!(outcome, Outcome::default());
        for (found, expected) in states.iter().zip(&expected) {
            assert_eq!(found.t, UNTIL);
            let error = distance(found, expected);
            assert!(error < TOLERANCE, "{error:e}");
        }
    }
}

macro_rules! generated {
    ($($system:ident)*) => {$(
        agrees(&$system::<f64>::default(), &$system::<f64>::default());
        agrees(&$system::<f64>::default(), &$system::<f64x4>::default());
        agrees(&$system::<f64>::default(), &$system::<f64x8>::default());
    )*};
}

#[test]
fn lanes_agree_with_single_runs() {
    generated! { CartPole DoublePendulum FreeBody QuaternionTop TwoBodies }
}

#[test]
fn lanes_of_f32_agree_with_single_runs() -> Result<(), StepError> {
    let (single, wide) = (CartPole::<f32>::default(), CartPole::<f32x8>::default());
    let mut states: Vec<State<CartPole<f32>>> = (0..8)
        .map(|member| State {
            t: 0.0,
            x: [0.0, 0.1 * member as f32],
            xi: [0.0; 2],
        })
        .collect();
    let mut expected = states.clone();
    let outcome = ensemble::integrate(
        &wide,
        &Rkmk4,
        &mut states,
        H,
        UNTIL,
        |_, _, _, _| [f32x8::default()],
        quietly,
    );
    assert!(outcome.failures.is_empty());
    for (found, expected) in states.iter().zip(&mut expected) {
        integrate(&single, Rkmk4, expected, H, UNTIL, |_, _, _| [0.0], |_| {})?;
        for (a, b) in found.x.iter().zip(expected.x) {
            // A hundred steps of rounding, in a motion that departs from the upright like exp(4 t).
            assert!((a - b).abs() < 2e-4 * b.abs().max(1.0), "{a} {b}");
        }
    }
    Ok(())
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let system = DoublePendulum::<f64x4>::default();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let mut states = members(&DoublePendulum::<f64>::default(), 41);
        let outcome = pool.expect("threads").install(|| {
            ensemble::integrate(
                &system,
                &Rkmk4,
                &mut states,
                H,
                UNTIL,
                |_, _, _, _| [],
                quietly,
            )
        });
        assert_eq!(outcome, Outcome::default());
        states.into_iter().map(|s| (s.x, s.xi)).collect::<Vec<_>>()
    };
    let one = run(1);
    assert_eq!(run(2), one);
    assert_eq!(run(5), one);
}

/// Three of fifteen members fail: one has no finite start, one becomes infinite on its way, one has a length for which
/// the mass matrix is singular. The other members are not affected.
#[test]
fn failures_do_not_spread() {
    let single = CartPole::<f64>::default();
    let build = |group: &Group| {
        let same = f64x4::from_f64;
        let length = group.gather(|member| if member == 9 { 0.0 } else { 0.5 });
        CartPole::<f64x4>::new(CartPoleParameters {
            mc: same(1.0),
            mp: same(0.1),
            l: length,
            g: same(9.81),
        })
    };
    // A permanent push of one member from t = 0.5 on.
    let push = |group: &Group, t: f64, _: &_, _: &_| {
        [group.gather(|member| {
            if member == 6 && t > 0.5 {
                f64::INFINITY
            } else {
                0.0
            }
        })]
    };
    let mut states = members(&single, 15);
    states[2].xi[1] = f64::NAN;
    let expected: Vec<_> = (0..15)
        .map(|member| {
            let state = &members(&single, 15)[member..=member];
            alone(&single, Rkmk4, state).remove(0)
        })
        .collect();
    let outcome = ensemble::integrate_each(build, &Rkmk4, &mut states, H, UNTIL, push, quietly);
    assert!(!outcome.cancelled);
    let [
        Failure {
            member: 2,
            error: StepError::NonFinite { time: 0.0 },
        },
        Failure {
            member: 6,
            error: late,
        },
        Failure {
            member: 9,
            error: StepError::Singular { time: 0.0, .. },
        },
    ] = outcome.failures[..]
    else {
        panic!("{outcome:?}");
    };
    let (StepError::NonFinite { time } | StepError::Singular { time, .. }) = late else {
        panic!("{late:?}");
    };
    // The last valid state: the start of the first step that extends beyond 0.5.
    assert_eq!(states[6].t, time);
    assert!(
        (0.48..=0.51).contains(&time) && states[6].is_finite(),
        "{time}"
    );
    for member in (0..15).filter(|member| ![2, 6, 9].contains(member)) {
        assert_eq!(states[member].t, UNTIL);
        assert!(distance(&states[member], &expected[member]) < TOLERANCE);
    }
}

#[test]
fn members_start_when_they_like() {
    let single = CartPole::<f64>::default();
    let mut states = members(&single, 10);
    for (member, state) in states.iter_mut().enumerate() {
        state.t = if member < 3 { 0.25 } else { -0.5 };
    }
    states[9].t = UNTIL;
    let expected = alone(&single, Rkmk4, &states);
    let wide = CartPole::<f64x8>::default();
    let none = |_: &Group, _: f64, _: &_, _: &_| [f64x8::default()];
    let outcome = ensemble::integrate(&wide, &Rkmk4, &mut states, H, UNTIL, none, quietly);
    assert_eq!(outcome, Outcome::default());
    for (found, expected) in states.iter().zip(&expected) {
        assert!(distance(found, expected) < TOLERANCE);
    }
    let outcome = ensemble::integrate(&wide, &Rkmk4, &mut states, 0.0, 2.0, none, quietly);
    assert_eq!(outcome.failures.len(), 10, "steps of no length");
}

#[test]
fn implicit_methods_iterate_until_all_lanes_are_content() {
    let single = Pendulum::<f64>::default();
    let mut states = members(&single, 8);
    let expected = alone(&single, Gauss4, &states);
    let wide = Pendulum::<f64x8>::default();
    let none = |_: &Group, _: f64, _: &_, _: &_| wide.zero_inputs();
    let outcome = ensemble::integrate(&wide, &Gauss4, &mut states, H, UNTIL, none, quietly);
    assert_eq!(outcome, Outcome::default());
    for (found, expected) in states.iter().zip(&expected) {
        assert!(distance(found, expected) < TOLERANCE);
    }
}

#[test]
fn progress_ends_at_the_total_and_may_cancel() {
    let wide = CartPole::<f64x4>::default();
    let none = |_: &Group, _: f64, _: &_, _: &_| [f64x4::default()];
    let start = members(&CartPole::<f64>::default(), 10);
    let seen = Mutex::new(Vec::new());
    let tell = |progress: Progress| {
        seen.lock().expect("no panic").push(progress);
        ControlFlow::Continue(())
    };
    let mut states = start.clone();
    let outcome = ensemble::integrate(&wide, &Rkmk4, &mut states, 1e-3, UNTIL, none, tell);
    assert_eq!(outcome, Outcome::default());
    let mut seen = seen.into_inner().expect("no panic");
    seen.sort_by_key(|progress| progress.done);
    // Several calls for a thousand steps of each of three groups.
    assert!(seen.len() >= 9, "{}", seen.len());
    assert!(seen.iter().all(|progress| progress.total == 10_000));
    assert_eq!(seen.last().map(|progress| progress.done), Some(10_000));

    let mut states = start.clone();
    let outcome = ensemble::integrate(&wide, &Rkmk4, &mut states, 1e-3, UNTIL, none, |_| {
        ControlFlow::Break(())
    });
    assert!(outcome.cancelled && outcome.failures.is_empty());
    assert!(
        states
            .iter()
            .all(|state| state.t < UNTIL && state.is_finite())
    );
}

/// Branches are selected lane by lane with the bits of a single number, on both sides at once.
#[test]
fn branches_are_selected_in_every_lane() {
    let (one, four) = (
        TorqueCurve::<f64>::default(),
        TorqueCurve::<f64x4>::default(),
    );
    let (ball, balls) = (
        BouncingBall::<f64>::default(),
        BouncingBall::<f64x4>::default(),
    );
    let spread = |at: f64| -> [f64; 4] { std::array::from_fn(|lane| at + 0.9 * lane as f64) };
    for k in 0..40 {
        let (q, w) = (
            spread(-1.5 + 0.05 * k as f64),
            spread(-1.0 + 0.125 * k as f64),
        );
        let pack = |values: [f64; 4]| f64x4::from_lanes(|lane| values[lane]);
        let force = four.generalized_force(&[pack(q)], &[pack(w)], &[f64x4::from_f64(1.5)]);
        let energy = four.potential_energy(&[pack(q)]);
        let zone = balls.zone(&[pack(w), pack(q)]);
        for lane in 0..4 {
            let expected = one.generalized_force(&[q[lane]], &[w[lane]], &[1.5]);
            assert_eq!(force[0].lanes()[lane], expected[0]);
            assert_eq!(energy.lanes()[lane], one.potential_energy(&[q[lane]]));
            let alone = ball.zone(&[w[lane], q[lane]]);
            assert_eq!(zone.map(|entry| entry.lanes()[lane]), alone);
        }
    }
}

/// A choice depends on a finite or infinite condition; if it is NaN, so is the result.
#[test]
fn choices_of_numbers_and_lanes() {
    let cases = [
        -2.0,
        -0.0,
        0.0,
        1e-30,
        3.0,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
    ];
    for value in cases {
        let chosen = value.select_positive(1.0, 2.0);
        let lanes =
            f64x4::from_f64(value).select_positive(f64x4::from_f64(1.0), f64x4::from_f64(2.0));
        let sign = Scalar::sign(value);
        if value.is_nan() {
            assert!(chosen.is_nan() && sign.is_nan() && lanes.lanes()[2].is_nan());
            continue;
        }
        assert_eq!(chosen, if value > 0.0 { 1.0 } else { 2.0 });
        assert_eq!(lanes.lanes(), [chosen; 4]);
        assert_eq!(sign, if value == 0.0 { 0.0 } else { value.signum() });
        assert_eq!(Scalar::sign(f64x4::from_f64(value)).lanes(), [sign; 4]);
        assert_eq!(Scalar::sign(value as f32), sign as f32);
    }
    assert_eq!([2.0, -4.0].map(Scalar::inverse_of_length), [0.5, -0.25]);
    assert_eq!(
        [0.0, 1e-120].map(|a| 0.0 * Scalar::inverse_of_length(a)),
        [0.0; 2]
    );
    assert_eq!(0.0f32 * Scalar::inverse_of_length(0.0f32), 0.0);
    assert!(Scalar::inverse_of_length(f64::NAN).is_nan());
    // The increment is significant in either precision, and the same in every lane.
    assert_eq!(Scalar::inflated(1.0f64) - 1.0, 2f64.powi(-26));
    assert_eq!(Scalar::inflated(1.0f32) - 1.0, 2f32.powi(-15));
    let lanes = f64x4::from_f64(-3.0).inflated();
    assert_eq!(lanes.lanes(), [Scalar::inflated(-3.0f64); 4]);
}
