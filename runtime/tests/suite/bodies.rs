//! Bodies in potentials on hard cases: few evaluations, large steps, symmetry in time, both storages of
//! rotations, single precision.

use std::cell::Cell;

use crate::common::{FreeBody, QuaternionTop, Reference, Spin, Top, distance, relative, run};
use hamel::flows::Flow;
use hamel::methods::{Free, Gauss4, Gauss6, Lgvi, Scheme, Splitting};
use hamel::{Method, State, StepError, System, s3, so3};

/// The error of R at the end of a run, and the evaluations.
fn evaluated(case: &str, scheme: Scheme, until: f64, n: u32) -> (f64, u32) {
    let reference = Reference::read(case);
    let top = Top(reference.body());
    let mut state = State::start(&top);
    // Inputs are asked for once an evaluation.
    let count = Cell::new(0);
    let inputs = |_: f64, _: &_, _: &_| {
        count.set(count.get() + 1);
        []
    };
    let (method, h) = (Splitting::new(&top, scheme), until / f64::from(n));
    hamel::integrate(&top, method, &mut state, h, until, inputs, |_| {}).expect(case);
    (distance(state.x, reference.sample(until, "R")), count.get())
}

#[test]
fn heavy_top_benchmark_within_250_evaluations() {
    for (scheme, n) in [(Scheme::Nystrom4, 40), (Scheme::Nystrom6, 18)] {
        let (error, evaluations) = evaluated("heavy-top-benchmark-150", scheme, 1.0, n);
        println!("{scheme:?}: {error:e} in {evaluations}");
        assert!(
            error <= 1e-9 && evaluations <= 250,
            "{scheme:?}: {error:e} in {evaluations}"
        );
    }
}

#[test]
fn fast_top_and_kovalevskaya_top_within_their_evaluations() {
    for (case, until, scheme, n, most) in [
        ("lagrange-fast-top", 5.0, Scheme::Nystrom6, 140, 2700),
        ("kovalevskaya-top", 20.0, Scheme::Nystrom6, 120, 1400),
    ] {
        let (error, evaluations) = evaluated(case, scheme, until, n);
        println!("{case}: {error:e} in {evaluations}");
        assert!(
            error <= 1e-9 && evaluations <= most,
            "{case}: {error:e} in {evaluations}"
        );
    }
}

/// Runs of 50 steps: the force at the end of a step is that at the start of the next, to the bit.
#[test]
fn a_run_evaluates_the_force_between_two_steps_once() -> Result<(), StepError> {
    fn compare<M: Method<Top<f64>> + Copy>(
        top: &Top<f64>,
        method: M,
        drifts: u32,
    ) -> Result<(), StepError> {
        const STEPS: u32 = 50;
        let count = Cell::new(0);
        let inputs = |_: f64, _: &_, _: &_| {
            count.set(count.get() + 1);
            []
        };
        let mut together = State::start(top);
        hamel::integrate(top, method, &mut together, 0.04, 2.0, inputs, |_| {})?;
        assert_eq!(count.take(), STEPS * drifts + 1);
        let mut stepped = State::start(top);
        for _ in 0..STEPS {
            hamel::step(top, method, &mut stepped, 0.04, &inputs)?;
        }
        assert_eq!(count.get(), STEPS * (drifts + 1));
        assert_eq!((together.x, together.xi), (stepped.x, stepped.xi));
        Ok(())
    }
    let mut body = Reference::read("kovalevskaya-top").body();
    for inertia in [2.0, 1.7] {
        body.inertia[4] = inertia;
        let top = Top(body.clone());
        for scheme in Scheme::ALL.iter().copied() {
            compare(&top, Splitting::new(&top, scheme), scheme.drifts() as u32)?;
        }
        compare(&top, Lgvi, 1)?;
    }
    Ok(())
}

/// Angle of the body's third axis with the vertical, without cancellation.
fn tilt(r: &[f64; 9]) -> f64 {
    f64::hypot(r[2], r[5]).atan2(r[8])
}

#[test]
fn a_sleeping_top_keeps_its_tilt() {
    let case = "lagrange-sleeping-top-stable";
    let reference = Reference::read(case);
    let top = Top(reference.body());
    let mut state = State::start(&top);
    let mut largest = 0.0_f64;
    let method = Splitting::new(&top, Scheme::Nystrom4);
    let observe = |state: &State<Top<f64>>| largest = largest.max(tilt(&state.x));
    hamel::integrate(&top, method, &mut state, 0.04, 20.0, |_, _, _| [], observe).expect(case);
    let error = distance(state.x, reference.sample(20.0, "R"));
    println!("tilt {largest:e}, R {error:e}");
    // 7.04e-6 in the reference, from 1e-6.
    assert!(largest < 7.2e-6, "{largest:e}");
    assert!(error <= 1e-10, "{error:e}");
}

#[test]
fn a_top_passes_the_vertical() {
    let case = "lagrange-top-through-vertical";
    let reference = Reference::read(case);
    let top = Top(reference.body());
    let state = run(&top, Splitting::new(&top, Scheme::Nystrom4), 10.0, 1000).expect(case);
    let error = distance(state.x, reference.sample(10.0, "R"));
    println!("{error:e}");
    assert!(error <= 1e-9, "{error:e}");
}

/// There in `n` steps and back; how far R, ω end from the start.
fn there_and_back<Sys, M>(system: &Sys, method: &M, h: f64, n: u32) -> f64
where
    Sys: System<Scalar = f64>,
    M: Method<Sys>,
{
    let mut state = State::start(system);
    let none = |_, _: &_, _: &_| system.zero_inputs();
    for h in [h, -h] {
        for _ in 0..n {
            hamel::step(system, method, &mut state, h, &none).expect("a step");
        }
    }
    let start = State::start(system);
    relative(state.x.as_ref(), start.x.as_ref()).max(relative(state.xi.as_ref(), start.xi.as_ref()))
}

/// Rounding of 200 steps, magnified by the motion.
const RETURN: f64 = 2e-12;

#[test]
fn symmetric_methods_return_to_the_start() {
    for case in ["kovalevskaya-top", "lagrange-top-through-vertical"] {
        let top = Top(Reference::read(case).body());
        let mut returns = Vec::new();
        for scheme in Scheme::ALL.iter().copied() {
            for flow in [Flow::Exact, Flow::Turns, Flow::Pair, Flow::Axes] {
                let method = Splitting::with_flow(&top, scheme, flow);
                returns.push(there_and_back(&top, &method, 0.02, 100));
            }
        }
        returns.push(there_and_back(&top, &Lgvi, 0.02, 100));
        returns.push(there_and_back(&top, &Gauss4, 0.02, 100));
        returns.push(there_and_back(&top, &Gauss6, 0.02, 100));
        assert!(returns.iter().all(|r| *r < RETURN), "{case}: {returns:?}");
    }
}

#[test]
fn a_step_of_zero_changes_nothing() {
    let mut body = Reference::read("kovalevskaya-top").body();
    body.inertia[4] = 1.7;
    let top = Top(body.clone());
    for scheme in Scheme::ALL.iter().copied() {
        for flow in [Flow::Exact, Flow::Pair, Flow::Axes] {
            let method = Splitting::with_flow(&top, scheme, flow);
            assert!(there_and_back(&top, &method, 0.0, 1) < 2e-15);
        }
    }
    assert!(there_and_back(&top, &Lgvi, 0.0, 1) < 2e-15);
    assert!(there_and_back(&top, &Gauss4, 0.0, 1) < 2e-15);
    assert!(there_and_back(&top, &Gauss6, 0.0, 1) < 2e-15);
    assert!(there_and_back(&Spin(top), &Free, 0.0, 1) < 2e-15);
}

#[test]
fn zero_and_denormal_velocities_are_no_trouble() {
    for w in [0.0, 1e-310, 1e-160] {
        let mut body = Reference::read("kovalevskaya-top").body();
        for inertia in [2.0, 1.7] {
            body.inertia[4] = inertia;
            body.w0 = [w, -w, w];
            let top = Top(body.clone());
            let exact = Splitting::with_flow(&top, Scheme::Nystrom4, Flow::Exact);
            let fine = run(&top, exact, 1.0, 200).expect("a run");
            for flow in [Flow::Exact, Flow::Pair, Flow::Axes] {
                let method = Splitting::with_flow(&top, Scheme::Suzuki4, flow);
                let state = run(&top, method, 1.0, 200).expect("a run");
                assert!(distance(state.x, fine.x) < 1e-8, "{flow:?} {w:e}");
            }
            let state = run(&top, Lgvi, 1.0, 200).expect("a run");
            assert!(distance(state.x, fine.x) < 1e-4, "{w:e}");
            let state = run(&top, Gauss6, 1.0, 200).expect("a run");
            assert!(distance(state.x, fine.x) < 1e-10, "{w:e}");
        }
    }
}

#[test]
fn steps_beyond_convergence_are_errors() {
    // h|ω| = 3 and 15.
    let top = Top(Reference::read("heavy-top-benchmark-150").body());
    for h in [0.02, 0.1] {
        let mut state = State::start(&top);
        let refused = hamel::step(&top, Lgvi, &mut state, h, &|_, _, _| []);
        assert!(
            matches!(
                refused,
                Err(StepError::NotConverged {
                    time: 0.0,
                    iterations: 1..
                })
            ),
            "{refused:?}"
        );
        assert_eq!(state.x, top.0.r0);
    }
    for h in [0.1, 1.0] {
        let mut state = State::start(&top);
        let refused = hamel::step(&top, Gauss6, &mut state, h, &|_, _, _| []);
        assert!(
            matches!(refused, Err(StepError::NotConverged { .. })),
            "{refused:?}"
        );
    }
}

/// Steps of any method for bodies that are far too long, or none at all.
fn overstep<Sys, M>(system: &Sys, method: &M) -> u32
where
    Sys: System<Scalar = f64>,
    M: Method<Sys>,
{
    let none = |_, _: &_, _: &_| system.zero_inputs();
    let mut refused = 0;
    for h in [1.0, 1e3, 1e80, 1e160, 1e300, f64::INFINITY, f64::NAN] {
        let mut state = State::start(system);
        for _ in 0..20 {
            let outcome = hamel::step(system, method, &mut state, h, &none);
            // A step is taken whole or not at all.
            assert!(state.is_finite(), "h = {h}");
            match outcome {
                Ok(()) => assert!(system.constraint_norm(&state.x) < 1e-13, "h = {h}"),
                Err(StepError::NonFinite { .. } | StepError::NotConverged { .. }) => {
                    refused += 1;
                    break;
                }
                Err(other) => panic!("h = {h}: {other}"),
            }
        }
    }
    refused
}

#[test]
fn steps_far_too_long_end_on_the_manifold_or_in_a_typed_error() {
    // Infinite steps and steps of NaN are refused by all of them.
    for case in ["heavy-top-benchmark-150", "kovalevskaya-top"] {
        let mut body = Reference::read(case).body();
        for stretch in [1.0, 1.3] {
            body.inertia[0] *= stretch;
            let top = Top(body.clone());
            for scheme in Scheme::ALL.iter().copied() {
                for flow in [Flow::Exact, Flow::Turns, Flow::Pair, Flow::Axes] {
                    let method = Splitting::with_flow(&top, scheme, flow);
                    assert!(overstep(&top, &method) >= 2, "{scheme:?} {flow:?}");
                }
            }
            assert!(overstep(&top, &Lgvi) >= 2);
            assert!(overstep(&top, &Gauss4) >= 2);
            assert!(overstep(&top, &Gauss6) >= 2);
            assert!(overstep(&Spin(top), &Free) >= 2);
        }
    }
}

/// At rest and without torque nothing moves, by any method and for any symmetry. The closed form of a body
/// without symmetry takes R apart and builds it again, up to 110 times here, to a last place each.
#[test]
fn spherical_and_symmetric_bodies_at_rest_or_hardly_moving_stay() {
    let double = Reference::read("free-dzhanibekov-1e-3").body();
    for moments in [[2.0; 3], [2.0, 2.0, 1.0], [1.0, 1.7, 2.4]] {
        for velocity in [0.0, 5e-324, 1e-310, 1e-160] {
            let mut body = double.clone();
            for axis in 0..3 {
                body.inertia[4 * axis] = moments[axis];
            }
            body.w0 = [velocity, -velocity, velocity];
            let spin = Spin(Top(body.clone()));
            let stays = |name: &str, state: Result<State<Spin<Top<f64>>>, StepError>| {
                let off = distance(state.expect(name).x, body.r0);
                assert!(
                    off < 110.0 * f64::EPSILON,
                    "{name} {moments:?} {velocity:e}: {off:e}"
                );
            };
            for scheme in Scheme::ALL.iter().copied() {
                let method = Splitting::new(&spin, scheme);
                stays(&format!("{scheme:?}"), run(&spin, method, 10.0, 10));
            }
            stays("free", run(&spin, Free, 10.0, 10));
            stays("LGVI", run(&spin, Lgvi, 10.0, 10));
            stays("Gauss 4", run(&spin, Gauss4, 10.0, 10));
            stays("Gauss 6", run(&spin, Gauss6, 10.0, 10));
        }
    }
}

#[test]
fn a_state_of_nan_is_an_error() {
    let mut body = Reference::read("kovalevskaya-top").body();
    body.w0[1] = f64::NAN;
    let top = Top(body);
    let none = |_, _: &_, _: &_| [];
    let mut state = State::start(&top);
    for scheme in Scheme::ALL.iter().copied() {
        let outcome = hamel::step(&top, Splitting::new(&top, scheme), &mut state, 0.1, &none);
        assert_eq!(outcome, Err(StepError::NonFinite { time: 0.0 }));
    }
    assert!(hamel::step(&top, Lgvi, &mut state, 0.1, &none).is_err());
    assert!(hamel::step(&top, Gauss4, &mut state, 0.1, &none).is_err());
}

#[test]
fn quaternions_and_matrices_move_alike() {
    let mut skew = Reference::read("kovalevskaya-top").body();
    // Full inertia: the principal axes are not the body axes.
    let turn = so3::exp([0.3, -0.2, 0.5]);
    let scaled: [f64; 9] = std::array::from_fn(|k| turn[k] * [2.0, 1.7, 1.0][k % 3]);
    let transposed: [f64; 9] = std::array::from_fn(|k| turn[3 * (k % 3) + k / 3]);
    skew.inertia = so3::product(scaled, transposed);
    for body in [skew, Reference::read("kovalevskaya-top").body()] {
        let (by_matrix, by_quaternion) = (Top(body.clone()), QuaternionTop(body));
        for flow in [Flow::Exact, Flow::Pair, Flow::Axes] {
            let method = Splitting::with_flow(&by_matrix, Scheme::Suzuki4, flow);
            let a = run(&by_matrix, method, 2.0, 100).expect("a run");
            let b = run(&by_quaternion, method, 2.0, 100).expect("a run");
            assert!(distance(a.x, s3::to_matrix(b.x)) < 1e-13, "{flow:?}");
            assert!(by_quaternion.constraint_norm(&b.x) < 1e-15);
        }
        let a = run(&by_matrix, Lgvi, 2.0, 100).expect("a run");
        let b = run(&by_quaternion, Lgvi, 2.0, 100).expect("a run");
        assert!(distance(a.x, s3::to_matrix(b.x)) < 1e-13);
        let a = run(&by_matrix, Gauss6, 2.0, 100).expect("a run");
        let b = run(&by_quaternion, Gauss6, 2.0, 100).expect("a run");
        assert!(distance(a.x, s3::to_matrix(b.x)) < 1e-13);
        // The three kinds of method agree with each other as well.
        let exact = Splitting::with_flow(&by_matrix, Scheme::Nystrom6, Flow::Exact);
        let fine = run(&by_matrix, exact, 2.0, 100).expect("a run");
        assert!(distance(fine.x, a.x) < 1e-9, "{:e}", distance(fine.x, a.x));
    }
}

#[test]
fn a_falling_body_is_exact_whatever_the_step() {
    // Gravity acts on the centre of mass alone: kicks of a constant and free rotation.
    let case = "free-body-offset-gravity";
    let reference = Reference::read(case);
    let body: FreeBody = reference.free_body();
    for n in [1, 7] {
        let state = run(&body, Splitting::new(&body, Scheme::Nystrom4), 10.0, n).expect(case);
        let errors = [
            relative(&state.x[..3], &reference.sample::<3>(10.0, "r")),
            relative(&state.x[3..], &reference.sample::<9>(10.0, "R")),
            relative(&state.xi[..3], &reference.sample::<3>(10.0, "v")),
            relative(&state.xi[3..], &reference.sample::<3>(10.0, "omega")),
        ];
        println!("{n}: {errors:?}");
        assert!(errors.iter().all(|error| *error < 1e-12), "{errors:?}");
    }
}

#[test]
fn single_precision_reaches_its_own_rounding() {
    let reference = Reference::read("kovalevskaya-top");
    let double = reference.body();
    let single = |inertia: [f64; 9]| crate::common::Body {
        inertia: inertia.map(|v| v as f32),
        m: double.m as f32,
        s: double.s.map(|v| v as f32),
        g: double.g.map(|v| v as f32),
        r0: double.r0.map(|v| v as f32),
        w0: double.w0.map(|v| v as f32),
    };
    let top = Top(single(double.inertia));
    let sample: [f64; 9] = reference.sample(20.0, "R");
    let error = |x: [f32; 9]| distance(x.map(f64::from), sample);
    // Rounding of some thousand operations of 6e-8, magnified thirty times.
    let bar = 5e-4;
    for flow in [Flow::Exact, Flow::Axes] {
        let method = Splitting::with_flow(&top, Scheme::KahanLi6, flow);
        let state = run(&top, method, 20.0, 200).expect("a run of f32");
        assert!(error(state.x) < bar, "{flow:?} {:e}", error(state.x));
        assert!(top.constraint_norm(&state.x) < 1e-6);
    }
    let state = run(&top, Gauss6, 20.0, 400).expect("a run of f32");
    assert!(error(state.x) < bar, "{:e}", error(state.x));
    run(&top, Lgvi, 20.0, 400).expect("a run of f32");

    // The elliptic functions of a rotor without symmetry, against double precision.
    let mut inertia = double.inertia;
    inertia[4] = 1.7;
    let spin = Spin(Top(single(inertia)));
    let mut body = double.clone();
    body.inertia = inertia;
    let exact = Spin(Top(body));
    for t in [0.05, 0.3, 20.0] {
        let a = run(&spin, Free, t, 1).expect("a run of f32");
        let b = run(&exact, Free, t, 1).expect("a run");
        let error = distance(a.x.map(f64::from), b.x);
        assert!(error < 2e-6 * (1.0 + t), "{t}: {error:e}");
    }
}
