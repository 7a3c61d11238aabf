//! Euler's implicit step by Newton's method: solutions that are known, other methods, and what has none.

use crate::common::solve;
use crate::lanes::Pair;
use crate::size::size;
use hamel::methods::{BackwardEuler, Rkmk8, StiffEuler};
use hamel::{Dual, Method, Scalar, Singular, State, StepError, System, Tangent, integrate, step};
use std::cell::Cell;

hamel::rigid_eom! {
    /// Three masses in a chain on springs that grow stiff, pushed at its end.
    system Chain {
        param k = 100000, hardening = 0, damping = 0.1;
        coord q: R3;
        velocity v: vec3;
        rate q = v;
        kinetic dot(v, v) / 2;
        let a = q[1];
        let b = q[2] - q[1];
        let c = q[3] - q[2];
        potential k * (0.8 * a^2 + 1.2 * b^2 + 1.1 * c^2) / 2;
        potential k * hardening * (0.8 * a^4 + 1.2 * b^4 + 1.1 * c^4) / 4;
        damper coefficient damping on v[1];
        damper coefficient damping on v[2] - v[1];
        damper coefficient damping on v[3] - v[2];
        input push: vec3;
        generalized force v = push;
        generate all, linearize;
    }
}

hamel::rigid_eom! {
    /// A body on a ball joint with a stiff bushing, which holds it near the attitude in which its parts are parallel.
    system Bushing {
        param k = 1000000, c = 10, g = 9.81;
        param s: vec3 = [0.1, -0.2, 0.3];
        param Theta: sym3 = [[2.1, 0.1, -0.2], [0.1, 1.7, 0.15], [-0.2, 0.15, 1.2]];
        coord R: SO3;
        velocity w: vec3;
        rate R = R * hat(w);
        frame top = pose(R, [0, 0, 0]);
        body on top { mass 1.3; com s; inertia Theta about origin; }
        gravity [0, 0, -g];
        potential -k * (R[1, 1] + 0.7 * R[2, 2] + 0.4 * R[3, 3]);
        damper coefficient c on w[1];
        damper coefficient c on w[2];
        damper coefficient c on w[3];
        generate all, linearize;
    }
}

hamel::rigid_eom! {
    /// The same by a quaternion.
    system QuaternionBushing {
        param k = 1000000, c = 10, g = 9.81;
        param s: vec3 = [0.1, -0.2, 0.3];
        param Theta: sym3 = [[2.1, 0.1, -0.2], [0.1, 1.7, 0.15], [-0.2, 0.15, 1.2]];
        coord q: S3;
        velocity w: vec3;
        rate q = qmul(q, [0, w[1], w[2], w[3]]) / 2;
        frame top = pose(rot(q), [0, 0, 0]);
        body on top { mass 1.3; com s; inertia Theta about origin; }
        gravity [0, 0, -g];
        let R = rot(q);
        potential -k * (R[1, 1] + 0.7 * R[2, 2] + 0.4 * R[3, 3]);
        damper coefficient c on w[1];
        damper coefficient c on w[2];
        damper coefficient c on w[3];
        generate all, linearize;
    }
}

hamel::rigid_eom! {
    /// A pendulum on a circle with a stiff spring at its joint.
    system Sprung {
        param k = 10000, g = 9.81;
        coord a: S1;
        velocity w;
        rate a.c = -a.s * w;
        rate a.s = a.c * w;
        kinetic w^2 / 2;
        potential k * (1 - a.c) + g * a.s;
        generate all, linearize;
    }
}

hamel::rigid_eom! {
    /// A force that grows with the place, a mass that may be nothing, and a drive with the time.
    system Runaway {
        time t;
        param m = 1, a = 1, b = 0, drive = 0, stiffness = 0;
        coord x;
        velocity v;
        rate x = v;
        kinetic m * v^2 / 2;
        generalized force v = a + b * x^2 - stiffness * (x - drive * sin(t));
        generate all, linearize;
    }
}

hamel::rigid_eom! {
    /// A mass that vanishes at x = 0.
    system Weightless {
        coord x;
        velocity v;
        rate x = v;
        kinetic x^2 * v^2 / 2;
        generalized force v = 1;
        start x = 1;
        generate all, linearize;
    }
}

hamel::rigid_eom! {
    /// A free hull with a leg: a hip at 45°, a knee that is almost parallel to it, and stiff springs at both.
    system Legged {
        gravity [1.1, -2.3, -9.81];
        param k = 100000000;
        joint base: free moves hull;
        body on hull { mass 2; com [0.1, 0.05, -0.02]; inertia [[1.2, 0.1, 0.2], [0.1, 1.5, 0.3], [0.2, 0.3, 1.1]] about com; }
        joint hip: continuous [1, 0, 0] on hull at pose(roty(pi / 4), [0.3, 0.2, 0.1]) moves thigh {
            force -k * (1 + hip.c) * hip.s;
        }
        body on thigh { mass 1; com [0.1, 0.2, 0.3]; inertia [[0.5, 0.1, 0.02], [0.1, 0.6, 0.03], [0.02, 0.03, 0.7]] about com; }
        joint knee: revolute [1, 0.0000001, 0] on thigh at [0.1, 0.05, -0.6] moves shank {
            force -k * (knee + 30 * knee^3);
        }
        body on shank { mass 0.5; com [0.1, 0.2, -0.2]; inertia [[0.08, 0.01, 0.02], [0.01, 0.09, 0.01], [0.02, 0.01, 0.07]] about com; }
        generate all, linearize;
    }
}

hamel::rigid_eom! {
    /// Two rods, and a spring from the end of the second one to the ground: where it is stiff, a four-bar linkage.
    system Tied {
        param k = 100000000, length = 0;
        gravity [0, 0, -9.81];
        joint a: revolute [0, 1, 0] moves upper;
        body on upper { mass 1; com [0.2, 0.02, 0.01]; inertia diag(0.02, 0.1, 0.1) about com; }
        joint b: revolute [0, 1, 0] on upper at [0.5, 0, 0] moves lower;
        body on lower { mass 1; com [0.2, 0.02, 0.01]; inertia diag(0.02, 0.1, 0.1) about com; }
        let apart = norm(position(lower, [0.3, 0, 0]) - [0.5, 0.1, 0.6]) - length;
        potential k * apart^2 / 2;
        output stretched = apart;
        start b = -1;
        generate all, linearize;
    }
}

type Linear = [[f64; 3]; 3];

/// K of the chain for k = 1, and of its dampers.
fn tied(springs: [f64; 3]) -> Linear {
    let [a, b, c] = springs;
    [[a + b, -b, 0.0], [-b, b + c, -c], [0.0, -c, c]]
}

fn chain(k: f64, hardening: f64) -> Chain<f64> {
    let parameters = ChainParameters {
        k,
        hardening,
        ..Default::default()
    };
    Chain::new(parameters).expect("a chain")
}

/// Numbers between −1 and 1.
fn numbers() -> impl FnMut() -> f64 {
    let mut seed = 1_u64;
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// (I + h C + h² K) v₁ = v − h K q and q₁ = q + h v₁, solved by Cholesky's factors, of a symmetric matrix.
#[test]
fn a_stiff_chain_is_solved_exactly() {
    let mut number = numbers();
    for (k, h) in [
        (1e2, 0.1),
        (1e5, 0.1),
        (1e8, 0.1),
        (1e12, 0.1),
        (1e5, -0.1),
        (1e8, 1e-3),
    ] {
        let system = chain(k, 0.0);
        let (springs, dampers) = (tied([0.8, 1.2, 1.1]), tied([0.1; 3]));
        let matrix: Linear = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                f64::from(u8::from(i == j)) + h * dampers[i][j] + h * h * k * springs[i][j]
            })
        });
        for _ in 0..100 {
            let mut state = State::start(&system);
            state.x = std::array::from_fn(|_| number());
            state.xi = std::array::from_fn(|_| number());
            let force: [f64; 3] = std::array::from_fn(|i| {
                state.xi[i] - h * k * (0..3).map(|j| springs[i][j] * state.x[j]).sum::<f64>()
            });
            let v = solve(matrix, force).expect("a positive definite matrix");
            let q: [f64; 3] = std::array::from_fn(|i| state.x[i] + h * v[i]);
            step(&system, StiffEuler, &mut state, h, &|_, _, _| [0.0; 3]).expect("a step");
            for i in 0..3 {
                // Some units of rounding of x, and of x/h.
                assert!(
                    (state.x[i] - q[i]).abs() < 1e-14,
                    "{k:e} {h}: {} {}",
                    state.x[i],
                    q[i]
                );
                assert!(
                    h.abs() * (state.xi[i] - v[i]).abs() < 1e-14,
                    "{k:e} {h}: {} {}",
                    state.xi[i],
                    v[i]
                );
            }
        }
    }
}

/// Where springs harden, from any start: every step ends, the equations hold, and the method without derivatives ends at the
/// same place.
#[test]
fn hardening_chains_are_solved_from_any_start() {
    let (h, mut number) = (0.1, numbers());
    for k in [1e2, 1e3, 1e5, 1e7] {
        let system = chain(k, 0.3);
        for size in [0.1, 1.0, 100.0] {
            for _ in 0..100 {
                let mut state = State::start(&system);
                state.x = std::array::from_fn(|_| size * number());
                state.xi = std::array::from_fn(|_| size * number());
                let start = state.clone();
                step(&system, StiffEuler, &mut state, h, &|_, _, _| [0.0; 3])
                    .unwrap_or_else(|error| panic!("{k:e} {size} {start:?}: {error}"));
                let force = system
                    .accel(&state.x, &state.xi, &[0.0; 3])
                    .expect("a force");
                for i in 0..3 {
                    let moved = (state.x[i] - start.x[i] - h * state.xi[i]).abs();
                    assert!(moved < 1e-14 * size, "{k:e} {start:?}: {moved:e}");
                    // The force of what rounding leaves of x.
                    let pushed = (state.xi[i] - start.xi[i] - h * force[i]).abs();
                    let within = 1e-14 * h * k * size * (1.0 + size * size);
                    assert!(pushed < within, "{k:e} {size} {start:?}: {pushed:e}");
                }
                let mut other = start.clone();
                step(&system, BackwardEuler, &mut other, h, &|_, _, _| [0.0; 3])
                    .unwrap_or_else(|error| panic!("{k:e} {size} {start:?}: {error}"));
                for (a, b) in state.x.iter().zip(&other.x) {
                    assert!((a - b).abs() < 1e-12 * size, "{k:e} {start:?}: {a} {b}");
                }
            }
        }
    }
}

/// The end of a run of n steps to `until`.
fn end<Sys: System, M: Method<Sys>>(
    system: &Sys,
    method: M,
    start: &State<Sys>,
    until: f64,
    n: u32,
) -> State<Sys> {
    let mut state = start.clone();
    let inputs = |_: f64, _: &_, _: &_| system.zero_inputs();
    integrate(
        system,
        method,
        &mut state,
        until / f64::from(n),
        until,
        inputs,
        |_| {},
    )
    .expect("a run");
    state
}

fn distance<Sys: System<Scalar = f64>>(a: &State<Sys>, b: &State<Sys>) -> f64 {
    let pairs = a.x.as_ref().iter().zip(b.x.as_ref());
    pairs.fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()))
}

#[test]
fn half_the_step_makes_half_the_error() {
    let system = Bushing::<f64>::new(BushingParameters {
        k: 3.0,
        c: 0.5,
        ..Default::default()
    })
    .expect("a body");
    let mut start = State::start(&system);
    start.xi = [0.3, -1.0, 0.7];
    let exact = end(&system, Rkmk8, &start, 1.0, 100);
    let errors =
        [200, 400, 800].map(|n| distance(&end(&system, StiffEuler, &start, 1.0, n), &exact));
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 1.0).abs() < 0.05, "{errors:?}");
    }
}

/// A stiff joint comes to rest where steps of an explicit method that are short enough to follow its oscillation, two
/// hundred in the place of one, find it at rest.
#[test]
fn a_stiff_bushing_comes_to_rest_where_short_steps_find_it() {
    fn run<Sys: Tangent<Scalar = f64>>(system: &Sys, velocities: Sys::Velocities) -> State<Sys> {
        let mut start = State::start(system);
        start.xi = velocities;
        let rest = end(system, StiffEuler, &start, 0.4, 40);
        let fine = end(system, Rkmk8, &start, 2.0, 40_000);
        assert!(distance(&rest, &fine) < 1e-9, "{rest:?} {fine:?}");
        assert!(rest.xi.as_ref().iter().all(|w| w.abs() < 1e-9), "{rest:?}");
        rest
    }
    let matrix = Bushing::<f64>::new(BushingParameters {
        c: 100.0,
        ..Default::default()
    })
    .expect("a body");
    let quaternion = QuaternionBushing::<f64>::new(QuaternionBushingParameters {
        c: 100.0,
        ..Default::default()
    })
    .expect("a body");
    let (one, other) = (
        run(&matrix, [30.0, -20.0, 50.0]),
        run(&quaternion, [30.0, -20.0, 50.0]),
    );
    let turned = hamel::s3::to_matrix(other.x);
    assert!(
        one.x.iter().zip(turned).all(|(a, b)| (a - b).abs() < 1e-12),
        "{one:?} {other:?}"
    );
}

/// The equations of a step of a rotation, in f64 of their own: w₁ = w + h f(R exp(h ŵ₁), w₁), and the same by a quaternion
/// and by secants.
#[test]
fn steps_of_a_stiff_bushing_hold_their_equations() {
    let mut number = numbers();
    let (mut secants, mut all) = (0, 0);
    for (k, h) in [
        (1e2, 0.01),
        (1e4, 0.01),
        (1e6, 0.01),
        (1e8, 0.01),
        (1e6, -0.001),
        (1e10, 0.1),
    ] {
        let system = Bushing::<f64>::new(BushingParameters {
            k,
            ..Default::default()
        })
        .expect("a body");
        let quaternion = QuaternionBushing::<f64>::new(QuaternionBushingParameters {
            k,
            ..Default::default()
        })
        .expect("a body");
        for _ in 0..50 {
            let attitude = hamel::s3::exp([number(), number(), number()].map(|u| 0.5 * u));
            let mut state = State::start(&system);
            state.x = hamel::s3::to_matrix(attitude);
            state.xi = [number(), number(), number()];
            let start = state.clone();
            step(&system, StiffEuler, &mut state, h, &|_, _, _| [])
                .unwrap_or_else(|error| panic!("{k:e} {h} {start:?}: {error}"));
            let place = hamel::so3::retract(start.x, state.xi.map(|w| h * w));
            assert!(
                place
                    .iter()
                    .zip(&state.x)
                    .all(|(a, b)| (a - b).abs() < 1e-14)
            );
            let f = system.accel(&place, &state.xi, &[]).expect("a force");
            for i in 0..3 {
                let left = (state.xi[i] - start.xi[i] - h * f[i]).abs();
                assert!(
                    left < 3e-15 * (1.0 + h.abs() * k + k * h * h),
                    "{k:e} {h}: {left:e} {start:?}"
                );
            }
            let mut other = State::start(&quaternion);
            (other.x, other.xi) = (attitude, start.xi);
            step(&quaternion, StiffEuler, &mut other, h, &|_, _, _| []).expect("a step");
            let near = |xi: &[f64; 3]| {
                xi.iter()
                    .zip(&state.xi)
                    .all(|(a, b)| (h * (a - b)).abs() < 1e-13)
            };
            assert!(near(&other.xi), "{k:e} {h}: {other:?} {state:?}");
            all += 1;
            let mut learnt = start.clone();
            let found = step(&system, BackwardEuler, &mut learnt, h, &|_, _, _| []);
            // There are other solutions, more than a turn away.
            if found.is_ok() && learnt.xi.iter().all(|w| (h * w).abs() < 2.0) {
                secants += 1;
                assert!(near(&learnt.xi), "{k:e} {h}: {learnt:?} {state:?}");
            }
        }
    }
    println!("{secants} of {all} by secants");
    assert!(secants > 50);
}

/// x₁ = x ⊕ h w(x₁, ξ₁) and ξ₁ = ξ + h f(x₁, ξ₁), the second within `rounding` of f.
fn holds<Sys: System<Scalar = f64>>(
    system: &Sys,
    start: &State<Sys>,
    end: &State<Sys>,
    h: f64,
    rounding: f64,
) {
    let mut u = system.chart_rate(&end.x, &end.xi);
    u.as_mut().iter_mut().for_each(|u| *u *= h);
    let mut place = start.x.clone();
    hamel::manifold::retract(system.blocks(), place.as_mut(), u.as_ref());
    for (a, b) in place.as_ref().iter().zip(end.x.as_ref()) {
        assert!((a - b).abs() < 1e-13, "{start:?}: {a} {b}");
    }
    let f = system.forward_dynamics(&end.x, &end.xi, &system.zero_inputs());
    let f = f.expect("a force");
    let pairs = end.xi.as_ref().iter().zip(start.xi.as_ref());
    for ((new, old), f) in pairs.zip(f.as_ref()) {
        let left = (new - old - h * f).abs();
        assert!(left < rounding, "{start:?}: {left:e}");
    }
}

/// At a start forces are larger by h² k/m than where the step ends, and M⁻¹ turns with the joints that they move: the
/// equations need weights, or the iteration takes that for stiffness.
#[test]
fn stiff_legs_are_solved_far_from_rest() {
    let mut number = numbers();
    for far in [0.5, 0.05, 0.005] {
        for k in [1e2, 1e5, 1e8, 1e11] {
            let system = Legged::<f64>::new(LeggedParameters { k }).expect("a leg");
            for h in [0.001, 0.01, 0.05] {
                for _ in 0..size(5, 40) {
                    let mut state = State::start(&system);
                    let away: [f64; 8] =
                        std::array::from_fn(|i| number() * if i < 6 { 0.5 } else { far });
                    let u = system.chart_rate(&state.x, &away);
                    hamel::manifold::retract(system.blocks(), &mut state.x, &u);
                    state.xi = std::array::from_fn(|_| number());
                    let start = state.clone();
                    step(&system, StiffEuler, &mut state, h, &|_, _, _| [])
                        .unwrap_or_else(|error| panic!("{far} {k:e} {h} {start:?}: {error}"));
                    holds(&system, &start, &state, h, 1e-13 + 1e-11 * h * k);
                    // Differences have half of the digits.
                    if k < 1e10 {
                        let mut other = start.clone();
                        step(&system, BackwardEuler, &mut other, h, &|_, _, _| [])
                            .unwrap_or_else(|error| panic!("{far} {k:e} {h} {start:?}: {error}"));
                        holds(&system, &start, &other, h, 1e-13 + 1e-11 * h * k);
                    }
                }
            }
        }
    }
}

/// The end of the spring stays on a circle, and goes some way along it in a step: the solution is at the end of those of
/// shorter steps.
#[test]
fn stiff_ties_are_followed() {
    let mut number = numbers();
    let of =
        |k: f64, length: f64| Tied::<f64>::new(TiedParameters { k, length }).expect("two rods");
    let plain = of(1.0, 0.0);
    let length = plain.stretched(&plain.start().0);
    for (k, h) in [
        (1e4, 0.1),
        (1e6, 0.01),
        (1e6, 0.1),
        (1e8, 0.01),
        (1e8, 0.1),
        (1e10, 0.01),
    ] {
        let system = of(k, length);
        for _ in 0..20 {
            let mut state = State::start(&system);
            for x in &mut state.x {
                *x += 1e-3 * number();
            }
            state.xi = [number(), number()];
            let start = state.clone();
            step(&system, StiffEuler, &mut state, h, &|_, _, _| [])
                .unwrap_or_else(|error| panic!("{k:e} {h} {start:?}: {error}"));
            holds(&system, &start, &state, h, 1e-13 + 1e-14 * h * k);
            let stretched = system.stretched(&state.x);
            assert!(stretched.abs() < 1e3 / k, "{k:e}: {stretched:e}");
        }
    }
}

/// The stiff oscillation shrinks by 1/√(1 + (h ω)²) in every step; the slow one stays.
#[test]
fn what_is_stiff_is_damped() {
    let system = Sprung::<f64>::default();
    let mut state = State::start(&system);
    state.x = hamel::s1::exp(1e-4);
    for _ in 0..20 {
        step(&system, StiffEuler, &mut state, 0.1, &|_, _, _| []).expect("a step");
    }
    // tan a = −g/k
    assert!(
        (state.x[1] / state.x[0] + 9.81e-4).abs() < 1e-15,
        "{state:?}"
    );
    assert!(state.xi[0].abs() < 1e-14, "{state:?}");
}

#[test]
fn what_has_no_solution_is_an_error() {
    let runaway = |parameters| Runaway::<f64>::new(parameters);
    // v = h (1 + h² v²) has no root for h⁴ > 1/4.
    let system = runaway(RunawayParameters {
        b: 1.0,
        ..Default::default()
    })
    .expect("a force");
    let of = |h: f64| {
        let mut state = State::start(&system);
        let found = step(&system, StiffEuler, &mut state, h, &|_, _, _| []);
        found.map(|()| state)
    };
    for h in [0.72, 1.0, 10.0, -1.0] {
        let error = of(h).expect_err("no root");
        let StepError::NotConverged {
            time: 0.0,
            iterations,
        } = error
        else {
            panic!("{error}")
        };
        assert!(iterations <= 200, "{iterations}");
    }
    let v = of(0.7).expect("a root").xi[0];
    let h = 0.7_f64;
    assert!(
        (v - (1.0 - (1.0 - 4.0 * h.powi(4)).sqrt()) / (2.0 * h.powi(3))).abs() < 1e-13,
        "{v}"
    );
    // A spring that pushes away, at the length at which 1 − h² k is nothing.
    let system = runaway(RunawayParameters {
        stiffness: -4.0,
        ..Default::default()
    })
    .expect("a force");
    let mut state = State::start(&system);
    let error = step(&system, StiffEuler, &mut state, 0.5, &|_, _, _| []);
    assert!(
        matches!(error, Err(StepError::NotConverged { .. })),
        "{error:?}"
    );
    // The state is as it was.
    assert_eq!(
        (state.t, state.x, state.xi),
        (0.0, State::start(&system).x, [0.0])
    );
}

#[test]
fn what_has_no_value_is_an_error() {
    let system = chain(1e5, 0.3);
    let start = State::start(&system);
    for wrong in [f64::NAN, f64::INFINITY] {
        let error = StiffEuler.step(&system, &start, 0.1, &|_, _: &_, _: &_| [0.0, wrong, 0.0]);
        assert!(
            matches!(error, Err(StepError::NonFinite { time: 0.0 })),
            "{error:?}"
        );
        let mut state = start.clone();
        state.xi[1] = wrong;
        let error = StiffEuler.step(&system, &state, 0.1, &|_, _: &_, _: &_| [0.0; 3]);
        assert!(
            matches!(error, Err(StepError::NonFinite { .. })),
            "{error:?}"
        );
        let error = StiffEuler.step(&system, &start, wrong, &|_, _: &_, _: &_| [1.0; 3]);
        assert!(error.is_err(), "{error:?}");
    }
    // Without inertia.
    let system = Weightless::<f64>::default();
    let mut state = State::start(&system);
    assert!(
        StiffEuler
            .step(&system, &state, 0.1, &|_, _: &_, _: &_| [])
            .is_ok()
    );
    state.x = [0.0];
    let error = StiffEuler.step(&system, &state, 0.1, &|_, _: &_, _: &_| []);
    assert!(
        matches!(
            error,
            Err(StepError::Singular {
                time: 0.0,
                cause: Singular::Inertia { .. }
            })
        ),
        "{error:?}"
    );
    // No step at all leaves all as it is.
    let system = chain(1e5, 0.3);
    let mut state = State::start(&system);
    (state.x, state.xi) = ([0.1, 0.2, 0.3], [1.0, 2.0, 3.0]);
    let end = StiffEuler
        .step(&system, &state, 0.0, &|_, _: &_, _: &_| [0.0; 3])
        .expect("no step");
    assert_eq!((end.x, end.xi), (state.x, state.xi));
}

/// The force is that of the end of the step: a stiff spring follows its drive, d sin t, at once.
#[test]
fn the_time_is_that_of_the_end() {
    let parameters = RunawayParameters {
        a: 0.0,
        drive: 0.3,
        stiffness: 1e12,
        ..Default::default()
    };
    let system = Runaway::<f64>::new(parameters).expect("a drive");
    for h in [0.1, -0.1] {
        let mut state = State::start(&system);
        for n in 1..=20 {
            step(&system, StiffEuler, &mut state, h, &|_, _, _| []).expect("a step");
            let t = h * f64::from(n);
            let x = state.x.iter().find(|&&x| (x - 0.3 * t.sin()).abs() < 1e-9);
            assert!(x.is_some(), "{state:?} {t}");
        }
    }
}

/// A controller is not in the linearisation: what it feeds back, one stiff loop or three, is learnt. Differences see all of
/// it, however stiff it is.
#[test]
fn stiff_controllers_are_learnt() {
    let (h, mut number) = (0.1, numbers());
    for (loops, stiffness, gain) in [
        (1, 10.0, 0.0),
        (1, 10.0, 1e3),
        (1, 1e5, 1e2),
        (1, 1e5, 1e4),
        (1, 1e5, 1e6),
        (3, 10.0, 1e2),
        (3, 10.0, 1e4),
        (3, 1e5, 1e4),
        (3, 1e5, 1e7),
    ] {
        let system = chain(stiffness, 0.0);
        for _ in 0..50 {
            let mut state = State::start(&system);
            state.x = std::array::from_fn(|_| number());
            state.xi = std::array::from_fn(|_| number());
            let start = state.clone();
            let held = |_: f64, x: &[f64; 3], v: &[f64; 3]| {
                let at = |i: usize| -gain * (x[i] - 0.5) - 0.1 * gain * v[i];
                match loops {
                    1 => [0.0, 0.0, at(2)],
                    _ => [at(0), 2.0 * at(1), 3.0 * at(2) + at(0)],
                }
            };
            let holds = |state: &State<Chain<f64>>| {
                let inputs = held(0.0, &state.x, &state.xi);
                let force = system.accel(&state.x, &state.xi, &inputs).expect("a force");
                for i in 0..3 {
                    let left = (state.xi[i] - start.xi[i] - h * force[i]).abs();
                    assert!(
                        left < 1e-13 * (1.0 + h * (gain + stiffness)) * 3.0,
                        "{stiffness:e} {gain:e}: {left:e}"
                    );
                }
            };
            if gain < 1e7 {
                step(&system, StiffEuler, &mut state, h, &held)
                    .unwrap_or_else(|error| panic!("{stiffness:e} {gain:e}: {error}"));
                holds(&state);
            }
            let mut other = start.clone();
            step(&system, BackwardEuler, &mut other, h, &held)
                .unwrap_or_else(|error| panic!("{stiffness:e} {gain:e}: {error}"));
            holds(&other);
        }
    }
}

/// With slopes by q₀ and v₀ through whole runs in dual numbers: each step multiplies them by (I − h A)⁻¹.
#[test]
fn runs_in_dual_numbers_have_the_slopes_of_the_step() {
    // At rest at a = 0 without gravity.
    let system = Sprung::<Dual<f64, 1>>::new(SprungParameters {
        g: Dual::constant(0.0),
        ..Default::default()
    })
    .expect("a pendulum");
    let mut state = State::start(&system);
    state.xi = [Dual::along(0.0, 0)];
    let (h, k) = (0.1, 1e4);
    step(&system, StiffEuler, &mut state, h, &|_, _, _| []).expect("a step");
    let factor = 1.0 / (1.0 + h * h * k);
    assert_eq!(state.xi[0].value, 0.0);
    assert!((state.xi[0].slopes[0] - factor).abs() < 1e-15, "{state:?}");
    assert!(
        (state.x[1].slopes[0] - h * factor).abs() < 1e-15,
        "{state:?}"
    );
}

/// The same in f32, to its own rounding.
#[test]
fn short_numbers_are_solved_to_their_rounding() {
    let coarse = Chain::<f32>::new(ChainParameters {
        k: 1e5,
        hardening: 0.3,
        ..Default::default()
    })
    .expect("a chain");
    let fine = chain(1e5, 0.3);
    for derivatives in [true, false] {
        let (mut one, mut other) = (State::start(&coarse), State::start(&fine));
        (one.x, other.x) = ([0.1, -0.2, 0.3], [0.1, -0.2, 0.3]);
        for _ in 0..10 {
            let found = match derivatives {
                true => step(&coarse, StiffEuler, &mut one, 0.1, &|_, _, _| [0.0; 3]),
                false => step(&coarse, BackwardEuler, &mut one, 0.1, &|_, _, _| [0.0; 3]),
            };
            found.expect("a step");
            step(&fine, StiffEuler, &mut other, 0.1, &|_, _, _| [0.0; 3]).expect("a step");
            for (a, b) in one.x.iter().zip(&other.x) {
                assert!((f64::from(*a) - b).abs() < 1e-6, "{one:?} {other:?}");
            }
        }
    }
}

/// Inputs are asked for once in each evaluation.
fn evaluations<Sys: System, M: Method<Sys>>(
    system: &Sys,
    method: M,
    start: &State<Sys>,
    h: f64,
    steps: u32,
) -> Option<f64> {
    let asked = Cell::new(0);
    let mut state = start.clone();
    for _ in 0..steps {
        let inputs = |_: f64, _: &_, _: &_| {
            asked.set(asked.get() + 1);
            system.zero_inputs()
        };
        step(system, &method, &mut state, h, &inputs).ok()?;
    }
    Some(f64::from(asked.get()) / f64::from(steps))
}

#[test]
fn evaluations_are_few() {
    fn both<Sys: Tangent>(name: &str, system: &Sys, start: &State<Sys>, h: f64) -> f64 {
        let newton = evaluations(system, StiffEuler, start, h, 20).expect("a run");
        let secants = evaluations(system, BackwardEuler, start, h, 20);
        println!("{name}: {newton} a step, by secants {secants:?}");
        newton
    }
    for (k, hardening, most) in [
        (1e2, 0.0, 2.5),
        (1e5, 0.0, 6.0),
        (1e8, 0.0, 6.0),
        (1e2, 0.3, 6.0),
        (1e5, 0.3, 8.0),
        (1e8, 0.3, 8.0),
    ] {
        let system = chain(k, hardening);
        let mut start = State::start(&system);
        (start.x, start.xi) = ([0.1, -0.2, 0.3], [0.3, 0.5, -0.7]);
        let found = both(&format!("chain, {k:e}, {hardening}"), &system, &start, 0.1);
        assert!(found <= most, "{k:e} {hardening}: {found}");
    }
    for (k, h) in [(1.0, 0.01), (1e4, 0.01), (1e6, 0.01), (1e8, 0.01)] {
        let system = Bushing::<f64>::new(BushingParameters {
            k,
            ..Default::default()
        })
        .expect("a body");
        let mut start = State::start(&system);
        start.xi = [0.3, -1.0, 0.7];
        let found = both(&format!("bushing, {k:e}"), &system, &start, h);
        assert!(found <= 10.0, "{k:e}: {found}");
    }
}

/// Lanes that need different steps of the iteration, and different pivots, end as they do alone.
#[test]
fn lanes_end_as_they_do_alone() {
    let (ks, starts) = ([1e2, 1e8], [[0.1, -0.2, 0.3], [-2.0, 0.7, 1.0]]);
    let alone = [0, 1].map(|lane| {
        let system = chain(ks[lane], 0.3);
        let mut state = State::start(&system);
        state.x = starts[lane];
        step(&system, StiffEuler, &mut state, 0.1, &|_, _, _| [0.0; 3]).expect("a step");
        state
    });
    let system = Chain::<Pair>::new(ChainParameters {
        k: Pair(ks),
        hardening: Pair::from_f64(0.3),
        ..Default::default()
    })
    .expect("a chain");
    let mut state = State::start(&system);
    state.x = std::array::from_fn(|i| Pair([starts[0][i], starts[1][i]]));
    step(&system, StiffEuler, &mut state, 0.1, &|_, _, _| {
        [Pair::from_f64(0.0); 3]
    })
    .expect("a step");
    for (lane, alone) in alone.iter().enumerate() {
        for i in 0..3 {
            let (x, v) = (state.x[i].0[lane], state.xi[i].0[lane]);
            assert!((x - alone.x[i]).abs() < 1e-14, "{lane}: {x} {}", alone.x[i]);
            assert!(
                (v - alone.xi[i]).abs() < 1e-13,
                "{lane}: {v} {}",
                alone.xi[i]
            );
        }
    }
}
