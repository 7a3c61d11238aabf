//! Compares time, prescribed motion and moving frames with closed forms, with equivalent descriptions of the same
//! mechanism, and with inverse dynamics.

use crate::described::{TOLERANCE, assert_near, generated, states, text, value};
use hamel::methods::{General, Rkmk4, Rkmk8};
use hamel::{State, System};
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Program;
use hamel_codegen::proof::check::{Verdict, check};
use hamel_tests::belt_sleigh::{BeltSleigh, BeltSleighParameters};
use hamel_tests::driven_crank::{DrivenCrank, DrivenCrankInputs, DrivenCrankParameters};
use hamel_tests::driven_hoop::{DrivenHoop, DrivenHoopParameters};
use hamel_tests::kapitza::{Kapitza, KapitzaParameters};
use hamel_tests::reference::run;
use hamel_tests::turntable_ball::{TurntableBall, TurntableBallParameters};
use std::f64::consts::{PI, TAU};

/// q̈ = −(g + ÿ) sin q / l with the pivot at y = a cos Ω t.
#[test]
fn kapitzas_pendulum() {
    let (m, l, g, a, w) = (1.3, 0.8, 9.81, 0.1, 60.0);
    let system = Kapitza::new(KapitzaParameters {
        m,
        l,
        g,
        a,
        omega: w,
    })
    .expect("a pendulum");
    for [t, q, rate] in states() {
        let [found] = system.accel(&[t, q], &[rate], &[]).expect("a value");
        let lift = -a * w * w * (w * t).cos();
        assert_near("ξ̇", found, -(g + lift) * q.sin() / l, TOLERANCE);
        let (vx, vy) = (
            l * q.cos() * rate,
            l * q.sin() * rate - a * w * (w * t).sin(),
        );
        let kinetic = m * (vx * vx + vy * vy) / 2.0;
        assert_near(
            "T",
            system.kinetic_energy(&[t, q], &[rate]),
            kinetic,
            TOLERANCE,
        );
    }
}

/// The inverted position is stable if a² Ω² > 2 g l (Kapitza 1951, to first order in a/l), and unstable otherwise.
#[test]
fn kapitzas_pendulum_stands_on_its_head() {
    let (l, g, a) = (1.0, 9.81_f64, 0.05);
    let limit = (2.0 * g * l).sqrt() / a;
    for (factor, stands) in [(1.2, true), (0.8, false)] {
        let system = Kapitza::new(KapitzaParameters {
            m: 1.0,
            l,
            g,
            a,
            omega: factor * limit,
        })
        .expect("a pendulum");
        let mut state = State {
            t: 0.0,
            x: [0.0, PI - 0.02],
            xi: [0.0],
        };
        let mut farthest = 0.0_f64;
        for k in 1..=200 {
            state = run(&system, Rkmk8, state, 0.1 * f64::from(k), 40).expect("a run");
            farthest = farthest.max((state.x[1] - PI).abs());
        }
        assert_eq!(farthest < 0.3, stands, "{factor}: {farthest} rad");
    }
}

/// q̈ = φ̇² sin q cos q − (g/r) sin q, torque (J + m r² sin² q) φ̈ + 2 m r² sin q cos q φ̇ q̇.
#[test]
fn a_bead_on_a_driven_hoop() {
    let (m, r, j, g, w, b) = (0.5, 1.2, 0.3, 9.81, 3.0, 0.2);
    let system = DrivenHoop::new(DrivenHoopParameters { m, r, j, g, w, b }).expect("a hoop");
    for [t, q, rate] in states() {
        // The prescribed position of the hoop is used, whatever x contains.
        let (x, xi) = ([t, 17.0, q], [rate]);
        let spin = w + 2.0 * b * (2.0 * t).cos();
        let spin_rate = -4.0 * b * (2.0 * t).sin();
        let (s, c) = q.sin_cos();
        let [found] = system.accel(&x, &xi, &[]).expect("a value");
        assert_near("ξ̇", found, spin * spin * s * c - g / r * s, TOLERANCE);
        let [torque] = system.constraint_force(&x, &xi, &[]).expect("a value");
        let inertia = j + m * r * r * s * s;
        let needed = inertia * spin_rate + 2.0 * m * r * r * s * c * spin * rate;
        assert_near("torque", torque, needed, TOLERANCE);
        let kinetic = (inertia * spin * spin + m * r * r * rate * rate) / 2.0;
        assert_near("T", system.kinetic_energy(&x, &xi), kinetic, TOLERANCE);
        assert_near("φ̇", system.rate(&x, &xi)[1], spin, TOLERANCE);
    }
}

/// The engine has no degree of freedom: with the slider at x = l₁ cos φ + √(l₂² − l₁² sin² φ), the drive's power is
/// d/dt (T + V) plus the power into the gas.
#[test]
fn an_engine_at_constant_speed() {
    let of = DrivenCrankParameters::<f64>::default();
    let system = DrivenCrank::new(of).expect("an engine");
    let gas = 25.0;
    // The angle of the rod, the slider, and their rates relative to the crank's.
    let motion = |angle: f64| {
        let (s, c) = angle.sin_cos();
        let along = (of.l2 * of.l2 - of.l1 * of.l1 * s * s).sqrt();
        let (rod, slider) = ((-of.l1 * s).atan2(along), of.l1 * c + along);
        let (turn, slide) = (-of.l1 * c / along, -of.l1 * s * (1.0 + of.l1 * c / along));
        (rod, slider, turn, slide)
    };
    let energy = |angle: f64| {
        let (s, c) = angle.sin_cos();
        let (rod, _, turn, slide) = motion(angle);
        let (vx, vy) = (
            -of.l1 * s - turn * of.l2 / 2.0 * rod.sin(),
            of.l1 * c + turn * of.l2 / 2.0 * rod.cos(),
        );
        let crank = of.j1 + of.m1 * of.l1 * of.l1 / 4.0;
        let inertia =
            crank + of.m2 * (vx * vx + vy * vy) + of.j2 * turn * turn + of.m3 * slide * slide;
        let height = of.m1 * of.l1 / 2.0 * s + of.m2 * (of.l1 * s + of.l2 / 2.0 * rod.sin());
        inertia * of.speed * of.speed / 2.0 + of.g * height
    };
    let inputs = DrivenCrankInputs { gas }.to_array();
    for k in 0..24 {
        let angle = 0.3 + TAU * f64::from(k) / 24.0;
        let (rod, slider, turn, slide) = motion(angle);
        let x = [0.0, angle.cos(), angle.sin(), rod.cos(), rod.sin(), slider];
        assert_near("T + V", system.energy(&x, &[]), energy(angle), TOLERANCE);
        let rate = system.rate(&x, &[]);
        assert_near("ẋ", rate[5], slide * of.speed, TOLERANCE);
        assert_near("rod", rate[4], rod.cos() * turn * of.speed, TOLERANCE);
        let []: [f64; 0] = system.accel(&x, &[], &inputs).expect("nothing to move");
        let centred = |h: f64| (energy(angle + h) - energy(angle - h)) / (2.0 * h);
        let slope = (64.0 * centred(0.005) - 20.0 * centred(0.01) + centred(0.02)) / 45.0;
        let [torque] = system.constraint_force(&x, &[], &inputs).expect("a torque");
        assert_near(
            "torque",
            torque,
            slope + gas * slide,
            1e-7 * slope.abs().max(1.0),
        );
    }
    // After a turn of the crank the engine returns to its state.
    let start = State::start(&system);
    let end = run(&system, Rkmk8, start.clone(), TAU / of.speed, 200).expect("a run");
    for (end, start) in end.x[1..].iter().zip(&start.x[1..]) {
        assert_near("after a turn", *end, *start, 1e-11);
    }
}

/// A homogeneous ball moves on a circle at 2/7 Ω: its acceleration is 2/7 Ω e₃ × v (Milne 1948).
#[test]
fn a_ball_on_a_turntable() {
    let omega = 2.0;
    let system = TurntableBall::new(TurntableBallParameters {
        m: 0.8,
        a: 0.1,
        omega,
    })
    .expect("a ball");
    let (x, xi) = system.start();
    let [vx, vy, vz] = system.run(&x, &xi);
    let xi_dot = system.accel(&x, &xi, &[]).expect("a value");
    let push = system.push(&x, &xi, &xi_dot);
    let turn = 2.0 / 7.0 * omega;
    for (found, expected) in push.into_iter().zip([-turn * vy, turn * vx, 0.0]) {
        assert_near("acceleration", found, expected, TOLERANCE);
    }
    assert_near("vz", vz, 0.0, TOLERANCE);
    let start = State { t: 0.0, x, xi };
    let end = run(&system, Rkmk8, start, TAU / turn, 400).expect("a run");
    assert_near("x after a turn", end.x[1], x[1], 1e-10);
    assert_near("y after a turn", end.x[2], x[2], 1e-10);
}

/// In the belt's frame, the belt's acceleration c is a uniform field −c: v̇ = a w² − c cos θ, (J + m a²) ẇ = −m a v w +
/// m a c sin θ.
#[test]
fn a_sleigh_on_a_belt() {
    let (m, j, a, c) = (2.0, 0.5, 0.2, 0.3);
    let system = BeltSleigh::new(BeltSleighParameters { m, j, a, c }).expect("a sleigh");
    for [t, angle, v, w] in states() {
        let x = [t, 0.4, -0.7, angle];
        let [dv, dw] = system.accel(&x, &[v, w], &[]).expect("a value");
        assert_near("v̇", dv, a * w * w - c * angle.cos(), TOLERANCE);
        let turned = m * a * (c * angle.sin() - v * w) / (j + m * a * a);
        assert_near("ẇ", dw, turned, TOLERANCE);
        let rate = system.rate(&x, &[v, w]);
        assert_near("ẋ", rate[1], v * angle.cos() + c * t, TOLERANCE);
    }
}

/// With p = ẋ and q = ẏ: m ṗ = −k (x − cos t) − d (p − 1), m q̇ = −k y, and u = p − c t, w = q + x sin t.
#[test]
fn energies_with_terms_of_all_degrees() {
    let (m, k, d, c) = (1.5, 10.0, 0.7, 3.0);
    let system = generated(&text("drifting_oscillator"));
    for [t, a, b, u, w] in states() {
        let (x, y) = (a, b);
        let (p, q) = (u + c * t, w - t.sin() * x);
        let du = (-k * (x - t.cos()) - d * (p - 1.0)) / m - c;
        let dw = -k * y / m + t.cos() * x + t.sin() * p;
        let state: [&[f64]; 3] = [&[t, x, y], &[u, w], &[]];
        let found = value(&system, "accel", state);
        assert_near("u̇", found[0], du, TOLERANCE);
        assert_near("ẇ", found[1], dw, TOLERANCE);
        let kinetic = m * (p * p + q * q) / 2.0;
        assert_near(
            "T",
            value(&system, "kinetic_energy", state)[0],
            kinetic,
            TOLERANCE,
        );
        let momentum = value(&system, "momentum", state);
        assert_near("∂T/∂u", momentum[0], m * p, TOLERANCE);
        assert_near("∂T/∂w", momentum[1], m * q, TOLERANCE);
        let dissipation = d * (p - 1.0) * (p - 1.0) / 2.0;
        assert_near(
            "D",
            value(&system, "dissipation", state)[0],
            dissipation,
            TOLERANCE,
        );
    }
}

/// A frame that depends on time is equivalent to joints with the same prescribed motion.
#[test]
fn a_moving_frame_is_a_prescribed_joint() {
    let (frame, joints) = (
        generated(&text("ship_arm")),
        generated(&text("ship_arm_joints")),
    );
    for [t, pan, lift, v, w, a] in states() {
        let (xi, u) = ([v, w], [a, 2.0 * a]);
        // The ship's joints in x do not matter: they are prescribed.
        let on_frame: [&[f64]; 3] = [&[t, pan, lift], &xi, &u];
        let on_joints: [&[f64]; 3] = [&[t, 5.0, 6.0, 7.0, pan, lift], &xi, &u];
        for name in ["accel", "mass_matrix", "bias", "energy", "momentum"] {
            let (found, expected) = (
                value(&joints, name, on_joints),
                value(&frame, name, on_frame),
            );
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.into_iter().zip(expected) {
                assert_near(name, found, expected, 1e-10);
            }
        }
    }
}

/// φ(x, t) = 0 with a velocity given by rates, and the same mechanism with an angle.
#[test]
fn a_moving_constraint() {
    let (rows, angle) = (
        generated(&text("growing_rod")),
        generated(&text("growing_rod_angle")),
    );
    for [t, q, w] in states() {
        let length = 1.0 + 0.1 * (2.0 * t).sin();
        let growth = 0.2 * (2.0 * t).cos();
        let (s, c) = q.sin_cos();
        let on_rows: [&[f64]; 3] = [&[t, length * c, length * s], &[w], &[]];
        let on_angle: [&[f64]; 3] = [&[t, q], &[w], &[]];
        for name in [
            "accel",
            "energy",
            "potential_force",
            "bias",
            "mass_matrix",
            "momentum",
        ] {
            let [found, expected] = [value(&rows, name, on_rows), value(&angle, name, on_angle)];
            assert_near(name, found[0], expected[0], TOLERANCE);
        }
        let rate = value(&rows, "rate", on_rows);
        assert_near("ẋ", rate[1], growth * c - length * s * w, TOLERANCE);
        assert_near("ż", rate[2], growth * s + length * c * w, TOLERANCE);
        // l² q̈ + 2 l l̇ q̇ + g l cos q = 0.
        let expected = -(2.0 * growth * w + 9.81 * c) / length;
        assert_near("ξ̇", value(&rows, "accel", on_rows)[0], expected, TOLERANCE);
    }
}

/// An error of ξ̇ that does no work leaves the power balance satisfied, but has to break the equations of motion. Here
/// it is δξ̇ = (p₂, −p₁), so that δξ̇ · p = 0.
#[test]
fn a_workless_error_is_noticed() {
    for name in [
        "ship_arm",
        "drifting_oscillator",
        "snakeboard",
        "two_wheeled_robot",
    ] {
        for functions in ["accel, momentum", "all"] {
            let generate = format!("generate {functions};");
            let text = text(name);
            let end = text.rfind('}').expect("a description");
            let Generated {
                model, mut program, ..
            } = generated(&format!("{}{generate}}}", &text[..end]));
            let failures = |program: &Program| {
                let all = check(&model, program).into_iter();
                let failed = all.filter(|identity| matches!(identity.verdict, Verdict::Failed(_)));
                failed.map(|identity| identity.label).collect::<Vec<_>>()
            };
            assert!(failures(&program).is_empty(), "{name}, {functions}");
            let momentum = program
                .function("momentum")
                .expect("it is asked for")
                .outputs
                .clone();
            let graph = &mut program.graph;
            let place = program.functions.iter().position(|f| f.name == "accel");
            let accel = &mut program.functions[place.expect("it is asked for")].outputs;
            accel[0] = graph.add(accel[0], momentum[1]);
            accel[1] = graph.sub(accel[1], momentum[0]);
            let broken = failures(&program);
            assert!(broken.contains(&"(30c)"), "{name}, {functions}: {broken:?}");
        }
    }
}

/// Prescribed motion equals the motion under the drive's force without prescription.
#[test]
fn prescribed_motion_is_that_of_the_force_of_the_drive() {
    for (name, statement, velocity) in [
        (
            "driven_hoop",
            "prescribe phi = W * t + b * sin(2 * t);",
            "spin",
        ),
        (
            "crank_drive",
            "prescribe crank = W * t + 0.1 * sin(3 * t);",
            "crank_dot",
        ),
        (
            "tracking_arm",
            "prescribe rate(shoulder_dot) = push;",
            "shoulder_dot",
        ),
        (
            "ship_arm_joints",
            "prescribe sway = roll * sin(s * t);",
            "sway_dot",
        ),
    ] {
        let driven = generated(&text(name));
        let load = format!("input drive; generalized force {velocity} = drive;");
        let undriven = text(name).replace(statement, &load);
        assert_ne!(undriven, text(name), "{name} has this statement");
        let undriven = generated(&undriven);
        let target = statement.split(' ').nth(1).expect("a target");
        let rows = driven.model.constraints.iter();
        let mut rows = rows.map(|row| row.written.split(' ').next() == Some(target));
        let place = rows.position(|found| found).unwrap_or(0);
        let (x, mut xi) = (&driven.model.start_x, driven.active.start_xi.clone());
        xi.iter_mut()
            .enumerate()
            .for_each(|(i, v)| *v += 0.3 * (i as f64 + 1.0).sin());
        let keeps = driven.active.constraints.is_empty();
        if !keeps {
            xi.clone_from(&driven.active.start_xi);
        }
        let u = vec![0.4; driven.program.m];
        let force = value(&driven, "constraint_force", [x, &xi, &u])[place];
        let expected = value(&driven, "accel", [x, &xi, &u]);
        // The velocity of the drive is among the others now.
        let rate = value(&driven, "rate", [x, &xi, &u]);
        let group = |of: &Generated, name: &str| {
            let mut groups = of.active.velocities.iter();
            groups
                .find(|group| group.name == name)
                .map(|group| group.offset)
        };
        let place = group(&undriven, velocity).expect("it is free");
        let mut all = xi.clone();
        if group(&driven, velocity).is_none() {
            let coordinate = velocity.strip_suffix("_dot").unwrap_or("phi");
            let mut coordinates = driven.model.coordinates.iter();
            let coordinate = coordinates
                .find(|c| c.name == coordinate)
                .expect("it has one");
            all.insert(place, rate[coordinate.offset]);
        }
        // Inputs of the driven description keep their values by name.
        let before = |name: &str| driven.model.inputs.iter().find(|group| group.name == name);
        let mut inputs = Vec::new();
        for group in &undriven.model.inputs {
            match before(&group.name) {
                Some(known) => inputs.extend(&u[known.offset..known.offset + known.len]),
                None => inputs.push(force),
            }
        }
        let found = value(&undriven, "accel", [x, &all, &inputs]);
        let mut found = found;
        if all.len() > xi.len() {
            found.remove(place);
        }
        for (found, expected) in found.iter().zip(&expected) {
            assert_near(name, *found, *expected, 1e-9);
        }
    }
}

/// Every general method keeps its order if the right-hand side depends on time: stages are evaluated at their times.
#[test]
fn methods_keep_their_orders() {
    let system = Kapitza::<f64>::new(KapitzaParameters {
        m: 1.0,
        l: 1.0,
        g: 9.81,
        a: 0.3,
        omega: 4.0,
    })
    .expect("a pendulum");
    let start = State {
        t: 0.0,
        x: [0.0, 0.4],
        xi: [0.3],
    };
    let end = |method: General, steps: u32| {
        let end = run(&system, method, start.clone(), 2.0, steps).expect("a run");
        assert!(
            (end.x[0] - 2.0).abs() < 1e-12,
            "{}: t = {}",
            method.name(),
            end.x[0]
        );
        end
    };
    let exact = end(General::Rkmk8, 4000);
    for &method in General::ALL {
        let order = hamel::Method::<Kapitza<f64>>::order(&method);
        let coarse = if order >= 8 { 8 } else { 40 };
        let errors = [1, 2, 4].map(|k| {
            let end = end(method, coarse * k);
            (end.x[1] - exact.x[1])
                .abs()
                .max((end.xi[0] - exact.xi[0]).abs())
        });
        let slope = (errors[0] / errors[2]).log2() / 2.0;
        println!(
            "{}: order {order}, errors {errors:?}, slope {slope:.2}",
            method.name()
        );
        assert!(
            slope > f64::from(order) - 0.5,
            "{}: {errors:?}",
            method.name()
        );
    }
}

/// Generated code exposes its clock: it equals the time of the run, not a sum of ten thousand steps.
#[test]
fn a_clock_does_not_drift() {
    let system = Kapitza::new(KapitzaParameters {
        m: 1.0,
        l: 1.0,
        g: 9.81,
        a: 0.05,
        omega: 60.0,
    })
    .expect("a pendulum");
    let mut state = State::start(&system);
    state.x[0] = 1.7e9;
    let none = |_: f64, _: &[f64; 2], _: &[f64; 1]| [];
    hamel::integrate(&system, Rkmk4, &mut state, 1e-4, 1.0, none, |_| {}).expect("a run");
    assert_eq!(state.x[0], 1.7e9 + 1.0);
}
