//! Compares systems with branches, lengths and tables with equations by hand.

use hamel::methods::Rkmk4;
use hamel::{State, System};
use hamel_codegen::generate::from_text;
use hamel_codegen::program::interpret::Interpreter;
use hamel_tests::bouncing_ball::{BouncingBall, BouncingBallParameters};
use hamel_tests::cart_pole_friction::FrictionCartPole;
use hamel_tests::drag_ball::DragBall;
use hamel_tests::reference::run;
use hamel_tests::torque_curve::TorqueCurve;
use hamel_tests::wing::Wing;
use std::f64::consts::PI;

#[track_caller]
fn near(what: &str, value: f64, expected: f64, bound: f64) {
    let off = (value - expected).abs();
    assert!(
        off <= bound,
        "{what}: {value}, expected {expected}, off by {off:.1e}"
    );
}

/// The equations of the cart-pole in the form of Barto, Sutton and Anderson, with a massless rod; the force on the cart
/// is clamped to ±10 N, less the friction.
#[test]
fn a_cart_with_a_largest_force_and_friction() {
    let system = FrictionCartPole::<f64>::default();
    let (cart, pole, l, g) = (1.0, 0.1, 0.5, 9.81);
    for (k, force) in [-40.0, -10.0, -3.0, 0.0, 9.999, 10.001, 25.0]
        .into_iter()
        .enumerate()
    {
        for speed in [-0.4, -0.003, 0.0, 0.004, 2.0] {
            let (angle, turn) = (0.3 - 0.2 * k as f64, 0.7);
            let cut = f64::clamp(force, -10.0, 10.0);
            let applied = cut - 0.3 * f64::tanh(speed / 0.01);
            let (s, c) = f64::sin_cos(angle);
            let v_dot = (applied + pole * s * (l * turn * turn - g * c)) / (cart + pole * s * s);
            let w_dot = (g * s - c * v_dot) / l;
            let found = system
                .accel(&[0.2, angle], &[speed, turn], &[force])
                .expect("regular");
            near("cart", found[0], v_dot, 1e-12);
            near("pole", found[1], w_dot, 1e-11);
            let saturated = system.saturated(&[force]);
            let beyond = force.abs() - 10.0;
            let expected = if beyond == 0.0 { 0.0 } else { beyond.signum() };
            assert_eq!(saturated, expected);
        }
    }
}

/// Without damping, a ball that falls from h is in contact with the ground for 2 (π − arctan(ω v/g))/ω, v² = 2 g h, and
/// returns to h after 2 √(2h/g) plus this time.
#[test]
fn a_ball_bounces_as_long_as_it_should() {
    let system = BouncingBall::<f64>::new(BouncingBallParameters {
        m: 0.5,
        g: 9.81,
        k: 2000.0,
        c: 0.0,
    })
    .expect("a ball");
    let (m, g, k, h) = (0.5, 9.81, 2000.0_f64, 1.0);
    let (omega, v) = ((k / m).sqrt(), f64::sqrt(2.0 * g * h));
    let touching = 2.0 * (PI - f64::atan(omega * v / g)) / omega;
    let period = 2.0 * f64::sqrt(2.0 * h / g) + touching;
    let start = State {
        t: 0.0,
        x: [0.0, h],
        xi: [0.3, 0.0],
    };
    let end = run(&system, Rkmk4, start, period, 40_000).expect("a run");
    near("x", end.x[0], 0.3 * period, 1e-9);
    near("height", end.x[1], h, 1e-7);
    near("speed", end.xi[1], 0.0, 1e-5);
    // The force is zero above the ground, and never pulls.
    let force = |z: f64| system.generalized_force(&[0.0, z], &[0.0, 1.0], &[])[1];
    assert_eq!([force(0.1), force(0.0), force(-0.01)], [0.0, 0.0, 20.0]);
}

/// v = u tanh(g t/u), z = −(u²/g) log cosh(g t/u) with u² = m g/c.
#[test]
fn a_ball_falls_through_air() {
    let system = DragBall::<f64>::default();
    let (m, c, g) = (0.2, 0.05, 9.81_f64);
    let u = (m * g / c).sqrt();
    let start = System::start(&system);
    let start = State {
        t: 0.0,
        x: start.0,
        xi: start.1,
    };
    let until = 2.0;
    let end = run(&system, Rkmk4, start, until, 4000).expect("a run");
    near("speed", end.xi[2], -u * (g * until / u).tanh(), 1e-11);
    let fallen = u * u / g * (g * until / u).cosh().ln();
    near("height", end.x[2], -fallen, 1e-11);
}

/// ∂(|v| v)/∂v = |v| I + v vᵀ/|v|, and 0 at rest; in wind, v is the air speed.
#[test]
fn drag_linearises_at_rest() {
    let system = DragBall::<f64>::default();
    for (v, wind) in [
        ([0.0; 3], [0.0; 3]),
        ([0.3, -0.4, 1.2], [0.0; 3]),
        ([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]),
        ([1e-120, 0.0, 0.0], [0.0; 3]),
        ([1e-30, 0.0, 0.0], [0.0; 3]),
    ] {
        let rows = system.linearize(&[0.0; 3], &v, &wind).expect("regular");
        let air: [f64; 3] = std::array::from_fn(|i| v[i] - wind[i]);
        let length = air.iter().map(|a| a * a).sum::<f64>().sqrt();
        for i in 0..3 {
            for j in 0..3 {
                let same = f64::from(u8::from(i == j));
                let slope = match length > 0.0 {
                    true => length * same + air[i] * air[j] / length,
                    false => 0.0,
                };
                let row: &[f64] = rows[3 + i].as_ref();
                near("by v", row[3 + j], -0.25 * slope, 1e-14);
                near("by the wind", row[6 + j], 0.25 * slope, 1e-14);
            }
        }
    }
}

/// f(|v|) v for several forms of f: ∂/∂v is f I + f′ v vᵀ/|v|, and f(0) I at rest.
#[test]
fn drag_of_any_law_linearises_at_rest() {
    type Law = fn(f64) -> (f64, f64);
    let laws: [(&str, Law); 9] = [
        ("sqrt(v^2 + w^2)", |a| (a, 1.0)),
        ("(w * w + v * v)^0.5", |a| (a, 1.0)),
        ("hypot(v, w)", |a| (a, 1.0)),
        ("sqrt(norm([v, w]))", |a| (a.sqrt(), 0.5 / a.sqrt())),
        ("sqrt(sqrt(v^2 + w^2))", |a| (a.sqrt(), 0.5 / a.sqrt())),
        ("norm([v, w])^1.5", |a| (a.powf(1.5), 1.5 * a.sqrt())),
        ("tanh(norm([v, w]))", |a| (a.tanh(), 1.0 - a.tanh().powi(2))),
        ("exp(-norm([v, w]))", |a| ((-a).exp(), -(-a).exp())),
        ("(1 + norm([v, w]))", |a| (1.0 + a, 1.0)),
    ];
    for (law, of) in laws {
        let text = format!(
            "system A {{ coord x, y; velocity v, w; rate x = v, y = w; particle mass 1 at [x, y, 0];
             generalized force v = -{law} * v; generalized force w = -{law} * w; generate linearize; }}"
        );
        let generated = from_text(&text).unwrap_or_else(|errors| panic!("{law}: {errors:?}"));
        let program = &generated.program;
        let function = program.function("linearize").expect("asked for");
        let linearize = Interpreter::new(program, function, &program.defaults);
        for v in [[0.0, 0.0], [0.3, -0.4], [-1.2, 0.5]] {
            let length = f64::hypot(v[0], v[1]);
            let (f, slope) = of(length);
            let rows = linearize.call(&[0.0; 2], &v, &[], &[]).expect("regular");
            for i in 0..2 {
                for j in 0..2 {
                    let same = f64::from(u8::from(i == j));
                    let expected = match length > 0.0 {
                        true => f * same + slope * v[i] * v[j] / length,
                        false => f * same,
                    };
                    near(law, rows[4 * (2 + i) + 2 + j], -expected, 1e-14);
                }
            }
        }
    }
}

/// Values and slopes of SciPy 1.17.1, `PchipInterpolator(x, y)(a)` and `.derivative()(a)`: Fritsch-Butland slopes d =
/// (w₁ + w₂)/(w₁/δ₁ + w₂/δ₂) with w₁ = 2 h₂ + h₁, w₂ = h₂ + 2 h₁.
const MOTOR: [[f64; 3]; 6] = [
    [0.25, 1.66171875, 2.515625],
    [0.5, 2.24375, 2.1125],
    [1.5, 3.35, 0.55],
    [2.75, 2.475446428571429, -2.008928571428571],
    [3.25, 1.5518973214285714, -1.8683035714285714],
    [3.9999999999999996, 8.881784197001252e-16, -2.25],
];
const SPRING: [[f64; 3]; 10] = [
    [-1.0, 2.0, -3.7142857142857144],
    [-0.6, 0.6747936507936508, -2.891428571428571],
    [0.1, -0.7643174603174604, -1.1580952380952374],
    [0.6, -1.0, 0.0],
    [1.0, -0.4946499102333931, 3.7374506283662483],
    [1.9, 3.8781207899461423, 2.0224804308797175],
    [2.5, 4.164206396701909, 0.2914921204867345],
    [4.0, 4.4517587605558875, 0.10013963694394573],
    [5.1, 4.213809523809526, -5.433333333333318],
    [5.4, 1.3152380952380915, -11.276190476190473],
];

#[test]
fn tables_are_those_of_scipy() {
    let system = TorqueCurve::<f64>::default();
    let force = |w: f64, u: f64| system.generalized_force(&[0.0], &[w], &[u])[0];
    for [w, value, slope] in MOTOR {
        // The torque of the fan does not depend on the voltage.
        near("motor", force(w, 1.0) - force(w, 0.0), value, 1e-13);
        let rows = [1.0, 0.0].map(|u| system.linearize(&[0.0], &[w], &[u]).expect("regular"));
        let by_w = rows.map(|rows| rows[1][1]);
        near("motor's slope", 0.02 * (by_w[0] - by_w[1]), slope, 1e-12);
    }
    for [q, value, slope] in SPRING {
        near("energy", system.potential_energy(&[q]), 2.0 * value, 1e-13);
        near("force", system.potential_force(&[q])[0], 2.0 * slope, 1e-11);
    }
    // At the points, bit by bit, from both sides.
    for (w, value) in [(0.0, 1.0), (1.0, 3.0), (2.0, 3.5), (3.0, 2.0), (4.0, 0.0)] {
        assert_eq!(force(w, 1.0) - force(w, 0.0), value, "{w}");
    }
    // Extrapolated as a constant, and as a line.
    assert_eq!(force(-3.0, 1.0) - force(-3.0, 0.0), 1.0);
    assert_eq!(force(9.0, 1.0) - force(9.0, 0.0), 0.0);
    near(
        "before",
        system.potential_energy(&[-3.0]),
        2.0 * (2.0 + 2.0 * 3.7142857142857144),
        1e-12,
    );
    // Linear between points and beyond them.
    for (w, fan) in [
        (-2.0, 0.4),
        (-0.5, 0.1),
        (0.5, 0.125),
        (2.0, 1.375),
        (4.0, 3.625),
    ] {
        near("fan", -force(w, 0.0), fan, 1e-14);
    }
    // NaN beyond the points of a table without extrapolation.
    let power = |w: f64| system.power(&[w]);
    near("power", power(1.0), 3.0 / 0.55, 1e-14);
    near("power", power(4.0), 0.0, 1e-14);
    assert!(power(4.0001).is_nan() && power(-0.0001).is_nan());
}

/// A table from a file: at its points, with the rate that `Builder` reads, and beyond.
#[test]
fn a_table_of_a_file() {
    let system = Wing::<f64>::default();
    let lift =
        |pitch: f64| system.generalized_force(&[0.0, pitch], &[0.0, 0.0], &[])[0] / (0.05 * 144.0);
    for (pitch, cl) in [
        (-0.3, -0.9),
        (0.0, 0.2),
        (0.25, 1.3),
        (0.4, 0.8),
        (0.7, 0.8),
        (-1.0, -0.9),
    ] {
        near("lift", lift(pitch), cl, 1e-15);
    }
}
