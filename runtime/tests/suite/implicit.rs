//! Implicit steps converge in everything: in slopes where values rest, in small unknowns beside large ones, and in stiff
//! motion to what rounding leaves.

use crate::common::points::Points;
use hamel::adapter::OdeEquations;
use hamel::adaptive::Adaptive;
use hamel::methods::{BackwardEuler, Gauss4, Gauss6};
use hamel::{Dual, Method, State, StepError, System, step_slopes};

hamel::rigid_eom! {
    system Pendulum {
        param k = 9.81;
        coord q;
        velocity w;
        rate q = w;
        kinetic w^2 / 2;
        potential -k * cos(q);
        input tau;
        generalized force w = tau;
        generate all, linearize;
    }
}

hamel::rigid_eom! {
    /// A pendulum beside a mass that coasts.
    system Two {
        param m = 800000;
        coord x, q;
        velocity v, w;
        rate x = v;
        rate q = w;
        kinetic m * v^2 / 2 + w^2 / 2;
        potential -cos(q);
        generate all;
    }
}

type Sloped = Pendulum<Dual<f64, 2>>;

/// The pendulum at rest, with slopes by q₀ and w₀.
fn at_rest() -> (Sloped, State<Sloped>) {
    let system = Sloped::default();
    let mut state = State::start(&system);
    state.x = [Dual::along(0.0, 0)];
    state.xi = [Dual::along(0.0, 1)];
    (system, state)
}

fn run<Sys: System, M: Method<Sys> + Copy>(
    system: &Sys,
    method: M,
    state: &mut State<Sys>,
    h: f64,
    steps: u32,
) -> Result<(), StepError> {
    for _ in 0..steps {
        hamel::step(system, method, state, h, &|_, _, _| system.zero_inputs())?;
    }
    Ok(())
}

/// Slopes at rest are those of the oscillator q̈ = −k q, which methods turn by an angle and shrink by a factor.
fn assert_turned(name: &str, state: &State<Sloped>, angle: f64, factor: f64, within: f64) {
    let omega = 9.81_f64.sqrt();
    let (sin, cos) = angle.sin_cos();
    let (q, w) = (state.x.as_ref()[0], state.xi.as_ref()[0]);
    assert_eq!((q.value, w.value), (0.0, 0.0), "{name}");
    let wanted = [cos, sin / omega, -omega * sin, cos].map(|entry| factor * entry);
    let found = [q.slopes[0], q.slopes[1], w.slopes[0], w.slopes[1]];
    for (found, wanted) in found.into_iter().zip(wanted) {
        assert!((found - wanted).abs() < within, "{name}: {found} {wanted}");
    }
}

#[test]
fn runs_from_rest_have_slopes() -> Result<(), StepError> {
    let omega = 9.81_f64.sqrt();
    // 1/(1 − i y)
    let (system, mut state) = at_rest();
    run(&system, BackwardEuler, &mut state, 0.01, 100)?;
    let y = 0.01 * omega;
    let factor = (1.0 + y * y).powi(-50);
    assert_turned("Euler", &state, 100.0 * y.atan(), factor, 1e-11);
    // The diagonal approximants of Padé to exp(i y)
    let y = 0.1 * omega;
    let (system, mut state) = at_rest();
    run(&system, Gauss4, &mut state, 0.1, 10)?;
    let angle = 20.0 * (0.5 * y / (1.0 - y * y / 12.0)).atan();
    assert_turned("Gauss 4", &state, angle, 1.0, 1e-13);
    let (system, mut state) = at_rest();
    run(&system, Gauss6, &mut state, 0.1, 10)?;
    let angle = 20.0 * ((0.5 * y - y * y * y / 120.0) / (1.0 - 0.1 * y * y)).atan();
    assert_turned("Gauss 6", &state, angle, 1.0, 1e-13);
    let (system, mut state) = at_rest();
    let still = |_: f64, _: &_, _: &_| system.zero_inputs();
    Adaptive::rkmk54(1e-9).integrate(&system, &mut state, 1.0, still, &[], |_| {})?;
    assert_turned("RKMK 5(4)", &state, omega, 1.0, 1e-7);
    let (system, mut state) = at_rest();
    Adaptive::rkmk8(1e-9).integrate(&system, &mut state, 1.0, still, &[], |_| {})?;
    assert_turned("RKMK 8", &state, omega, 1.0, 1e-7);
    Ok(())
}

/// (I − h A)⁻¹ and h (I − h A)⁻¹ B, A at the end of the step: at both equilibria and away from them, of a slack pendulum
/// and of a stiff one.
#[test]
fn slopes_of_an_implicit_step() {
    for (q, k, h) in [
        (0.0_f64, 9.81, 0.1),
        (0.0, 1e6, 0.1),
        (0.0, 1e10, 0.1),
        (std::f64::consts::PI, 9.81, 0.01),
        (0.3, 9.81, 0.1),
        (0.3, 1e5, 0.01),
    ] {
        let system = Pendulum::<f64>::new(PendulumParameters { k }).expect("a pendulum");
        let mut state = State::start(&system);
        state.x[0] = q;
        let slopes = step_slopes(&BackwardEuler, &system, &state, &[0.0], h).expect("slopes");
        let k = k * slopes.0.x[0].cos();
        let scale = 1.0 / (1.0 + h * h * k);
        let wanted = [[1.0, h, h * h], [-h * k, 1.0, h]].map(|row| row.map(|entry| scale * entry));
        for (i, row) in wanted.iter().enumerate() {
            for (j, wanted) in row.iter().enumerate() {
                let found = hamel::Table::row(&slopes.1, i)[j];
                // Rounding of I − h A, which is 1 beside h² k.
                let within = 1e-11 * row[0].abs() + 1e-15;
                assert!((found - wanted).abs() < within, "{found} {wanted}");
            }
        }
    }
}

/// q̈ = −k (q − 1) − d q̇.
fn spring<const K: u64, const D: u64>(
    x: &[f64; 1],
    v: &[f64; 1],
) -> Result<[f64; 1], hamel::Singular> {
    Ok([-(K as f64) * (x[0] - 1.0) - D as f64 * v[0]])
}

#[test]
fn stiff_springs_come_to_rest() -> Result<(), StepError> {
    for (accel, k, d, h) in [
        (spring::<1_000_000, 0> as fn(&_, &_) -> _, 1e6, 0.0, 0.01),
        (spring::<100_000_000, 1000>, 1e8, 1e3, 1e-4),
        (spring::<10_000_000_000, 0>, 1e10, 0.0, 1e-3),
    ] {
        let system = Points {
            start: ([1.001], [0.0]),
            accel,
        };
        let mut state = State::start(&system);
        let (mut q, mut v) = (0.001, 0.0);
        for _ in 0..3000 {
            run(&system, BackwardEuler, &mut state, h, 1)?;
            v = (v - h * k * q) / (1.0 + h * d + h * h * k);
            q += h * v;
            // Some units of rounding of x, and of x/h.
            assert!(
                (state.x[0] - 1.0 - q).abs() < 2e-13,
                "{k:e} {}: {} {q}",
                state.t,
                state.x[0] - 1.0
            );
            assert!(
                h * (state.xi[0] - v).abs() < 2e-13,
                "{k:e} {}: {} {v}",
                state.t,
                state.xi[0]
            );
        }
    }
    Ok(())
}

/// Two masses that a damper all but joins fall as one, against another damper: 2 v̇ = g − v, to 1 part in h d.
#[test]
fn stiff_dampers_join() -> Result<(), StepError> {
    let system = Points {
        start: ([100.0, 99.0], [0.0, 0.0]),
        accel: |x, v| {
            let between = 1e9 * (v[0] - v[1]);
            let apart = x[0] - x[1];
            Ok([9.81 - apart - between, apart + between - v[1]])
        },
    };
    for h in [0.1, 0.01, 0.001] {
        let mut state = State::start(&system);
        let mut v = 0.0;
        for _ in 0..100 {
            run(&system, BackwardEuler, &mut state, h, 1)?;
            v = (v + 0.5 * h * 9.81) / (1.0 + 0.5 * h);
            for (found, at) in state.xi.iter().zip(["first", "second"]) {
                assert!(
                    (found - v).abs() < 1e-7,
                    "{h} {at} {}: {found} {v}",
                    state.t
                );
            }
        }
    }
    Ok(())
}

#[test]
fn small_motions_are_not_frozen() -> Result<(), StepError> {
    // Beside a fast body: w = 1e-6 t, and q = h Σ w.
    let system = Points {
        start: ([0.0; 2], [7500.0, 0.0]),
        accel: |_, _| Ok([0.0, 1e-6]),
    };
    let mut state = State::start(&system);
    run(&system, BackwardEuler, &mut state, 1e-3, 10_000)?;
    assert!((state.xi[1] - 1e-5).abs() < 1e-16, "{}", state.xi[1]);
    assert!(
        (state.x[1] - 5e-5 * (1.0 + 1e-4)).abs() < 1e-15,
        "{}",
        state.x[1]
    );
    // However small: 1/(1 − i h)ⁿ.
    for size in [1.0, 1e-10, 1e-100] {
        let system = Points {
            start: ([1.0], [0.0]),
            accel: |x, _| Ok([-x[0]]),
        };
        let mut state = State::start(&system);
        state.x = [size];
        run(&system, BackwardEuler, &mut state, 1e-3, 1000)?;
        let (angle, factor) = (1000.0 * 1e-3_f64.atan(), (1.0 + 1e-6_f64).powi(-500));
        assert!(
            (state.x[0] / size - factor * angle.cos()).abs() < 1e-12,
            "{}",
            state.x[0]
        );
        assert!(
            (state.xi[0] / size + factor * angle.sin()).abs() < 1e-12,
            "{}",
            state.xi[0]
        );
    }
    // A pendulum in f32 follows that in f64, also in steps that change little.
    let coarse = Pendulum::<f32>::default();
    let fine = Pendulum::<f64>::default();
    let (mut one, mut other) = (State::start(&coarse), State::start(&fine));
    (one.x, other.x) = ([0.4], [0.4]);
    run(&coarse, BackwardEuler, &mut one, 1e-4, 5000)?;
    run(&fine, BackwardEuler, &mut other, 1e-4, 5000)?;
    let (q, w) = (f64::from(one.x.as_ref()[0]), f64::from(one.xi.as_ref()[0]));
    assert!(
        (q - other.x.as_ref()[0]).abs() < 1e-3 && (w - other.xi.as_ref()[0]).abs() < 1e-3,
        "{q} {w}"
    );
    assert!((w + 1.24).abs() < 0.01, "{w}");
    Ok(())
}

/// A pendulum moves as it does alone beside what stands still or coasts, however large that is.
#[test]
fn large_neighbours_change_nothing() -> Result<(), StepError> {
    let start = |large: f64| Points {
        start: ([large, 1.0], [large, 0.0]),
        accel: |x: &[f64; 2], _: &[f64; 2]| Ok([0.0, -x[1].sin()]),
    };
    let mut ends = [0.0, 1.0, 1e9, 1e15].map(|large| {
        let system = start(large);
        let mut state = State::start(&system);
        run(&system, BackwardEuler, &mut state, 0.01, 1000).expect("a run");
        state.x[1]
    });
    let alone = ends[0];
    ends.iter_mut().for_each(|end| *end -= alone);
    assert!(ends.iter().all(|gap| gap.abs() < 1e-12), "{ends:?}");

    let swung = |x: &[f64], xi: &[f64]| 0.5 * xi[1] * xi[1] - x[1].cos();
    for (method, within) in [(true, 2e-8), (false, 2e-11)] {
        for speed in [0.0, 7700.0] {
            let system = Two::<f64>::default();
            let mut state = State::start(&system);
            state.x[1] = 1.0;
            state.xi[0] = speed;
            let mut worst: f64 = 0.0;
            for _ in 0..5000 {
                match method {
                    true => run(&system, Gauss4, &mut state, 0.02, 1)?,
                    false => run(&system, Gauss6, &mut state, 0.1, 1)?,
                }
                worst = worst.max((swung(state.x.as_ref(), state.xi.as_ref()) + 1_f64.cos()).abs());
            }
            println!("{method} {speed} {worst:e}");
            assert!(worst < within, "{method} {speed} {worst:e}");
        }
    }
    Ok(())
}

/// What the direction does not move does not set the difference.
#[test]
fn products_with_the_jacobian_beside_large_unknowns() {
    let system = Two::<f64>::default();
    let equations = OdeEquations::new(&system, |_, _, _| system.zero_inputs(), 0.0);
    for x in [0.0, 1e3, 1e6, 1e12] {
        let mut product = [f64::NAN; 4];
        equations.jacobian_product(
            0.0,
            &[x, 1.0, 0.0, 0.0],
            &[0.0, 1.0, 0.0, 0.0],
            &mut product,
        );
        assert!(
            (product[3] + 1_f64.cos()).abs() < 1e-9,
            "{x:e}: {product:?}"
        );
    }
}

/// Three masses in a chain on springs that grow stiff.
fn chain<const K: u64>(x: &[f64; 3], v: &[f64; 3]) -> Result<[f64; 3], hamel::Singular> {
    let mut force = [0.0; 3];
    for (i, stiffness) in [0.8, 1.2, 1.1].into_iter().enumerate() {
        let (at, rate) = i.checked_sub(1).map_or((0.0, 0.0), |j| (x[j], v[j]));
        let stretch = x[i] - at;
        let elastic = K as f64 * stiffness * (stretch + 0.3 * stretch.powi(3));
        let tension = elastic + 0.1 * (v[i] - rate);
        force[i] -= tension;
        if i > 0 {
            force[i - 1] += tension;
        }
    }
    Ok(force)
}

/// The iteration may fail where several springs are stiff, but where it ends the equations of the step hold.
#[test]
fn iterations_that_run_away_are_errors() {
    let (h, mut seed) = (0.1, 1_u64);
    let mut number = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let chains: [fn(&_, &_) -> _; 4] = [
        chain::<100>,
        chain::<1000>,
        chain::<100_000>,
        chain::<10_000_000>,
    ];
    let mut ended = [0; 4];
    for (accel, ended) in chains.into_iter().zip(&mut ended) {
        for _ in 0..1000 {
            let x = std::array::from_fn(|_| 0.1 * number());
            let v = std::array::from_fn(|_| number() - 0.5);
            let system = Points {
                start: (x, v),
                accel,
            };
            let mut state = State::start(&system);
            match run(&system, BackwardEuler, &mut state, h, 1) {
                Err(StepError::NotConverged { .. } | StepError::NonFinite { .. }) => {}
                Err(error) => panic!("{error}"),
                Ok(()) => {
                    *ended += 1;
                    let force = accel(&state.x, &state.xi).expect("a force");
                    for i in 0..3 {
                        let moved = (state.x[i] - x[i] - h * state.xi[i]).abs();
                        let pushed = (state.xi[i] - v[i] - h * force[i]).abs();
                        assert!(
                            moved < 1e-11 && pushed < 1e-8,
                            "{x:?} {v:?}: {moved:e} {pushed:e}"
                        );
                    }
                }
            }
        }
    }
    println!("{ended:?} of 1000");
    assert_eq!(ended[0], 1000);
}
