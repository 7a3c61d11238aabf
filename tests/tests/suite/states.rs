//! Compares first-order states with closed forms, with the Newton-Euler equations by hand, and with the same mechanism
//! with inputs instead of states.

use crate::described::{TOLERANCE, assert_near, generated, states, text, value};
use hamel::adaptive::Adaptive;
use hamel::methods::{General, Rkmk54};
use hamel::{State, System};
use hamel_codegen::generate::Generated;
use hamel_codegen::program::FunctionId;
use hamel_codegen::program::count::count;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::proof::check::{Verdict, check};
use hamel_tests::dc_pendulum::{DcPendulum, DcPendulumParameters};
use hamel_tests::lagging_drone::{LaggingDrone, LaggingDroneParameters};
use hamel_tests::reference::run;
use hamel_tests::wheel_motors::{WheelMotors, WheelMotorsParameters};

/// (m l² + J n²) ẇ = n k i − m g l sin q − d w, L di/dt = V − R i − n k w; and the supplied energy is in the coil, in
/// heat and in the motion.
#[test]
fn a_motor_turns_a_pendulum() {
    let (m, l, g, j, n, k, r, coil, d) = (0.5, 0.3, 9.81, 2e-5, 20.0, 0.03, 1.2, 1e-3, 0.002);
    let system = DcPendulum::new(DcPendulumParameters {
        m,
        l,
        g,
        j,
        n,
        k,
        r,
        l_upper: coil,
        d,
    })
    .expect("a motor");
    assert_eq!(DcPendulum::<f64>::STATES, 1);
    assert_eq!(system.start().1, [0.0, 0.2]);
    let inertia = m * l * l + j * n * n;
    for [q, w, i, v] in states() {
        let [dw, di] = system.accel(&[q], &[w, i], &[v]).expect("a value");
        assert_near(
            "ẇ",
            dw,
            (n * k * i - m * g * l * q.sin() - d * w) / inertia,
            TOLERANCE,
        );
        assert_near("di/dt", di, (v - r * i - n * k * w) / coil, TOLERANCE);
        let stored = inertia * w * dw + m * g * l * q.sin() * w + coil * i * di;
        let supplied = system.supplied(&[w, i], &[v]);
        assert_near("power", stored + r * i * i + d * w * w, supplied, 1e-10);
        let rows = system.linearize(&[q], &[w, i], &[v]).expect("a value");
        let expected = [
            [0.0, 1.0, 0.0, 0.0],
            [
                -m * g * l * q.cos() / inertia,
                -d / inertia,
                n * k / inertia,
                0.0,
            ],
            [0.0, -n * k / coil, -r / coil, 1.0 / coil],
        ];
        for (found, expected) in rows.concat().into_iter().zip(expected.concat()) {
            assert_near("[A B]", found, expected, TOLERANCE);
        }
    }
}

/// m v̇ = f e₃ + Rᵀ(drag − m g e₃) − w × m v, Θ ẇ = τ − w × Θ w, ḟ = (command − f)/T, in body axes.
#[test]
fn rotors_lag_behind_their_commands() {
    let generated = generated(&text("lagging_drone"));
    let (m, g, a, kappa, c, lag) = (1.1, 9.81, 0.2, 0.02, 0.04, 0.05);
    let theta = [0.012, 0.014, 0.021];
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    for numbers in states::<21>() {
        let [e1, e2, e3] = [numbers[0], numbers[1], numbers[2]];
        let rotation = hamel::so3::exp([e1, e2, e3]);
        let v: [f64; 3] = numbers[3..6].try_into().expect("three");
        let w: [f64; 3] = numbers[6..9].try_into().expect("three");
        let f: [f64; 4] = numbers[9..13].try_into().expect("four");
        let u: [f64; 7] = numbers[13..20].try_into().expect("seven");
        let x = [&[0.3, -0.2, numbers[20]], &rotation[..]].concat();
        let world: [f64; 3] =
            std::array::from_fn(|i| (0..3).map(|j| rotation[3 * i + j] * v[j]).sum());
        let air: [f64; 3] = std::array::from_fn(|i| world[i] - u[4 + i]);
        let speed = air.iter().map(|e| e * e).sum::<f64>().sqrt();
        let mut outside: [f64; 3] = std::array::from_fn(|i| -c * speed * air[i]);
        outside[2] -= m * g;
        let turned = cross(w, v);
        let spin = cross(w, std::array::from_fn(|i| theta[i] * w[i]));
        let torque = [
            a * (f[1] - f[3]),
            a * (f[2] - f[0]),
            kappa * (f[0] - f[1] + f[2] - f[3]),
        ];
        let mut expected = Vec::new();
        for i in 0..3 {
            let force: f64 = (0..3).map(|j| rotation[3 * j + i] * outside[j]).sum();
            let lift = if i == 2 { f.iter().sum() } else { 0.0 };
            expected.push((force + lift) / m - turned[i]);
        }
        expected.extend((0..3).map(|i| (torque[i] - spin[i]) / theta[i]));
        expected.extend((0..4).map(|i| (u[i] - f[i]) / lag));
        let found = value(&generated, "accel", [&x, &[&v[..], &w, &f].concat(), &u]);
        assert_eq!(found.len(), 10);
        for (found, expected) in found.into_iter().zip(expected) {
            assert_near("ξ̇, ż", found, expected, 1e-10);
        }
    }
    let start = LaggingDrone::new(LaggingDroneParameters {
        m,
        g,
        a,
        kappa,
        c,
        t: lag,
        theta: theta_of(theta),
    })
    .expect("a drone");
    let (_, xi) = start.start();
    assert_near(
        "thrust at the start",
        xi[6..].iter().sum(),
        m * g,
        TOLERANCE,
    );
}

/// Returns a diagonal matrix by rows.
fn theta_of(diagonal: [f64; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { diagonal[i] } else { 0.0 }))
}

/// With currents as inputs, the platform has the same motion, and its slopes along the inputs equal those along the
/// states.
#[test]
fn states_act_as_inputs_do() {
    let states_text = text("wheel_motors");
    let mut inputs_text = String::new();
    for line in states_text.lines() {
        let word = line.split_whitespace().next().unwrap_or_default();
        let line = match word {
            "input" => "    input V: vec2, i: vec2;".into(),
            "state" => continue,
            "rate"
                if ["i", "far", "felt"]
                    .iter()
                    .any(|name| line.contains(&format!("rate {name} "))) =>
            {
                continue;
            }
            _ => line.replace("    generate", "    output speed = u; generate"),
        };
        inputs_text.push_str(&line);
        inputs_text.push('\n');
    }
    let (with, without) = (generated(&states_text), generated(&inputs_text));
    let (na, k, ra, la, tau) = (with.program.n, 0.4, 0.6, 0.002, 0.03);
    assert_eq!((na, with.program.n_z), (2, 6));
    let system = WheelMotors::new(WheelMotorsParameters {
        m: 9.0,
        d: 0.05,
        j: 0.3,
        mw: 0.5,
        r: 0.1,
        b: 0.2,
        jy: 0.003,
        jz: 0.0015,
        k,
        ra,
        la,
        tau,
    })
    .expect("a platform");
    for [t, q, w, wl, v1, v2, i1, i2, far] in states() {
        let x = [t, 0.3, 0.1, q.cos(), q.sin(), 0.2, -0.4];
        let (z, u) = ([i1, i2, far, 0.3, -0.2, 0.1], [v1, v2]);
        let xi = [&[w, wl][..], &z].concat();
        let plain: [&[f64]; 3] = [&x, &[w, wl], &[v1, v2, i1, i2]];
        let found = value(&with, "accel", [&x, &xi, &u]);
        let expected = value(&without, "accel", plain);
        let rate = value(&without, "rate", plain);
        let speed = value(&without, "speed", plain)[0];
        let wheels = [rate[5], rate[6]];
        let function = without
            .program
            .function("accelerometer")
            .expect("generated");
        let compiled = Interpreter::new(&without.program, function, &without.program.defaults);
        let felt = compiled
            .call(&x, &[w, wl], plain[2], &expected)
            .expect("a value");
        let mut all = expected.clone();
        all.push((v1 + t.sin() - ra * i1 - k * wheels[0]) / la);
        all.push((v2 - ra * i2 - k * wheels[1]) / la);
        all.push(speed.abs());
        all.extend((0..3).map(|j| (felt[j] - z[3 + j]) / tau));
        assert_eq!(found.len(), all.len());
        for (found, expected) in found.iter().zip(&all) {
            assert_near("ξ̇, ż", *found, *expected, 1e-9);
        }
        // The compiled function equals the interpreted one.
        let xi: [f64; 8] = xi.try_into().expect("eight");
        let compiled = system.accel(&x, &xi, &u).expect("a value");
        for (compiled, found) in compiled.iter().zip(&found) {
            assert_near("compiled", *compiled, *found, 1e-12);
        }
        // Slopes: the rows of h and δξ by (h, δξ, δi) equal those by (h, δξ, δu) of inputs.
        let linear = system.linearize(&x, &xi, &u).expect("a value");
        let plain_linear = value(&without, "linearize", plain);
        let (n, width) = (5, linear[0].len());
        assert_eq!((linear.len(), width), (n + na + 6, n + na + 6 + 2));
        for row in 0..n + na {
            let plain = &plain_linear[row * (n + na + 4)..][..n + na + 4];
            for column in 0..n + na {
                assert_near("∂/∂(h, ξ)", linear[row][column], plain[column], 1e-9);
            }
            for input in 0..2 {
                assert_near(
                    "∂/∂i",
                    linear[row][n + na + input],
                    plain[n + na + 2 + input],
                    1e-9,
                );
                assert_near(
                    "∂/∂V",
                    linear[row][n + na + 6 + input],
                    plain[n + na + input],
                    1e-9,
                );
            }
            for state in 2..6 {
                assert_near("∂/∂z", linear[row][n + na + state], 0.0, 1e-12);
            }
        }
        // Rows of δz by central differences of ż along ξ, z and u; their errors are those of the third derivative.
        let step = 1e-5;
        for column in 0..na + 6 + 2 {
            let moved = |sign: f64| {
                let (mut xi, mut u) = (xi, u);
                match column.checked_sub(na + 6) {
                    None => xi[column] += sign * step,
                    Some(input) => u[input] += sign * step,
                }
                system.accel(&x, &xi, &u).expect("a value")
            };
            let (ahead, behind) = (moved(1.0), moved(-1.0));
            for row in 0..6 {
                let slope = (ahead[na + row] - behind[na + row]) / (2.0 * step);
                assert_near("δż", linear[n + na + row][n + column], slope, 1e-6);
            }
        }
    }
}

/// A state adds only its expression to ξ̇.
#[test]
fn a_state_costs_its_expression() {
    let flops = |of: &Generated, places: std::ops::Range<usize>| {
        let accel = of.program.function(FunctionId::Accel).expect("generated");
        count(&of.program.graph, &accel.outputs[places]).flops()
    };
    let text = text("dc_pendulum");
    let with = generated(&text);
    let as_input = text.replace("state i = 0.2;", "input i;");
    let as_input: Vec<&str> = as_input
        .lines()
        .filter(|line| !line.contains("rate i ="))
        .collect();
    let without = generated(&as_input.join("\n"));
    assert_eq!(flops(&with, 0..1), flops(&without, 0..1));
    // V − R i − (n k) w, divided by L: two products, two sums and the product with 1/L.
    assert_eq!(flops(&with, 0..2), flops(&with, 0..1) + 5);
    for name in [
        "rate",
        "mass_matrix",
        "bias",
        "momentum",
        "energy",
        "inverse_dynamics",
    ] {
        let of = |generated: &Generated| {
            let function = generated.program.function(name).expect("generated");
            count(&generated.program.graph, &function.outputs).flops()
        };
        assert_eq!(of(&with), of(&without), "{name}");
    }
}

/// i(t) = V/R + (i₀ − V/R) exp(−R t/L) while the motor does not turn, by every general method with its order.
#[test]
fn methods_keep_their_orders() {
    // Without a gear, the current does not depend on the pendulum.
    let system = DcPendulum::<f64>::new(DcPendulumParameters {
        n: 0.0,
        l_upper: 0.8,
        ..Default::default()
    })
    .expect("a motor");
    let start = State {
        t: 0.0,
        x: [0.4],
        xi: [0.0, 0.2],
    };
    let supply = 3.0;
    let exact = supply / 1.2 + (0.2 - supply / 1.2) * (-1.2_f64 / 0.8).exp();
    for &method in General::ALL {
        let order = hamel::Method::<DcPendulum<f64>>::order(&method);
        let coarse = if order >= 8 { 2 } else { 10 };
        let errors = [1, 2, 4].map(|k| {
            let mut state = start.clone();
            let steps = coarse * k;
            for _ in 0..steps {
                let h = 1.0 / f64::from(steps);
                hamel::step(&system, method, &mut state, h, &|_, _, _| [supply]).expect("a step");
            }
            (state.xi[1] - exact).abs()
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

/// Error control follows a state that is faster than the motion.
#[test]
fn error_control_sees_states() {
    let system = DcPendulum::<f64>::new(DcPendulumParameters {
        n: 0.0,
        l_upper: 1e-3,
        ..Default::default()
    })
    .expect("a motor");
    let (x, xi) = system.start();
    let state = State { t: 0.0, x, xi };
    let end = run(&system, Rkmk54, state.clone(), 0.01, 4000).expect("a run");
    let exact = 0.2 * (-1.2_f64 * 0.01 / 1e-3).exp();
    assert_near("fixed", end.xi[1], exact, 1e-12);
    let mut controlled = state;
    Adaptive::rkmk54(1e-9)
        .run(&system, &mut controlled, 0.01, |_, _: &_, _: &_| [0.0])
        .expect("a run");
    assert_near("controlled", controlled.xi[1], exact, 1e-7);
}

/// An error in ż, or in one of its slopes, is detected.
#[test]
fn a_wrong_rate_of_a_state_is_noticed() {
    for name in ["dc_pendulum", "wheel_motors"] {
        let Generated {
            model, mut program, ..
        } = generated(&text(name));
        let failures = |program: &hamel_codegen::program::Program| {
            let all = check(&model, program).into_iter();
            all.filter(|identity| matches!(identity.verdict, Verdict::Failed(_)))
                .count()
        };
        assert_eq!(failures(&program), 0);
        let whole = program.clone();
        let n = program.n;
        let graph = &mut program.graph;
        let place = program
            .functions
            .iter()
            .position(|f| f.name == "accel")
            .expect("generated");
        let accel = &mut program.functions[place].outputs;
        accel[n] = graph.add(accel[n], accel[0]);
        assert!(failures(&program) > 0, "{name}");
        program = whole;
        let last = program
            .functions
            .iter_mut()
            .find(|f| f.name == "linearize")
            .expect("generated");
        let end = last.outputs.len() - 1;
        last.outputs[end] = -last.outputs[end];
        let error = hamel_codegen::proof::validate::validate(&model, &program);
        assert!(name == "wheel_motors" || error.is_err(), "{name}");
    }
}
