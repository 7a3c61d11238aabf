//! The energy ẋ · ∂L/∂ẋ − L if `kinetic` has terms that are linear in the velocities or independent of them.

use crate::common::{Random, generated, value};
use hamel_codegen::generate::from_text;

const MAGNETIC: &str = "system Magnetic {
    param m = 1.3, q = 2, B = 3, g = 0.7;
    time t; coord r: R3; velocity v: vec3; rate r = v;
    particle mass m at r;
    kinetic q * B / 2 * (r[1] * v[2] - r[2] * v[1]);
    potential m * g * r[3];
    invariant energy;
}";

/// A charge in a uniform field rotates at q B / m and conserves ½ m v² + V; the field does no work.
#[test]
fn a_magnetic_field_does_no_work() {
    let of = generated(MAGNETIC);
    let mut random = Random::new(3);
    for _ in 0..20 {
        // The time, then r
        let (x, v) = (random.numbers(4), random.numbers(3));
        let squares: f64 = v.iter().map(|v| v * v).sum();
        let kinetic = value(&of, "kinetic_energy", [&x, &v, &[], &[]])[0];
        assert!((kinetic - 0.65 * squares).abs() < 1e-14);
        let energy = value(&of, "energy", [&x, &v, &[], &[]])[0];
        assert!((energy - kinetic - 1.3 * 0.7 * x[3]).abs() < 1e-14);
        let rates = value(&of, "accel", [&x, &v, &[], &[]]);
        let turn = 2.0 * 3.0 / 1.3;
        for (found, expected) in rates.iter().zip([turn * v[1], -turn * v[0], -0.7]) {
            assert!((found - expected).abs() < 1e-13, "{rates:?}");
        }
        // The momentum includes the vector potential of the field.
        let p = value(&of, "momentum", [&x, &v, &[], &[]]);
        assert!((p[0] - 1.3 * v[0] + 3.0 * x[2]).abs() < 1e-13);
        assert!((p[1] - 1.3 * v[1] - 3.0 * x[1]).abs() < 1e-13);
    }
}

/// In rotating axes, T₂ − T₀ + V is Jacobi's integral; an inactive velocity does not change it.
#[test]
fn jacobis_integral_is_constant() {
    for more in [
        "",
        "coord z; velocity u; rate z = u; inactive u; kinetic u^2 / 2 + u * x;",
    ] {
        let of = generated(&format!(
            "system Turning {{
                param m = 2, W = 0.7, k = 3;
                time t; coord x, y; velocity v, w; rate x = v, y = w;
                kinetic m / 2 * ((v - W * y)^2 + (w + W * x)^2);
                potential k * x^2 / 2;
                invariant energy;
                {more}
            }}"
        ));
        let (x, y, v, w) = (0.3, -0.4, 1.1, 0.2);
        let mut at = vec![0.0, x, y];
        at.resize(of.model.nu(), 0.0);
        let energy = value(&of, "energy", [&at, &[v, w], &[], &[]])[0];
        let expected = (v * v + w * w) - 0.49 * (x * x + y * y) + 1.5 * x * x;
        assert!((energy - expected).abs() < 1e-13, "{energy} {expected}");
        let rates = value(&of, "accel", [&at, &[v, w], &[], &[]]);
        let power = 2.0 * (v * rates[0] + w * rates[1]) - 0.98 * (x * v + y * w) + 3.0 * x * v;
        assert!(power.abs() < 1e-12, "{power}");
    }
}

/// Random energies T₂ + T₁ + T₀ and V conserve T₂ − T₀ + V if they are independent of time: the claim is proved, and it
/// is refuted with a V that depends on time.
#[test]
fn the_energy_of_random_gyroscopic_terms_is_constant() {
    for seed in 0..6 {
        let mut random = Random::new(0x9e0 + seed);
        let mut c = || (8.0 * random.number()).round() / 4.0 + 0.125;
        let text = format!(
            "system G {{
                time t; coord x, y; velocity v, w; rate x = v * (2 + sin(y)), y = w + {} * v;
                kinetic v^2 + {} * sin(x) * v * w / 8 + (2 + cos(y)) * w^2 + {} * x * w + {} * sin(y) * v + {} * x * y;
                potential {} * cos(x) + y^2;
                invariant energy;
            }}",
            c(), c(), c(), c(), c(), c()
        );
        generated(&text);
        let moving = text.replace("y^2;", "y^2 * cos(t);");
        assert!(from_text(&moving).is_err());
    }
}

/// With pivots that move with time, the energy is still the kinetic energy in space.
#[test]
fn moving_points_have_their_energy_in_space() {
    let of = generated(
        "system Pivot {
            time t; coord q; velocity w; rate q = w;
            particle mass 2 at [sin(q), 0, 0.1 * cos(9 * t) - cos(q)];
        }",
    );
    let (q, w, t) = (0.4_f64, 1.5, 0.2_f64);
    let rates = [q.cos() * w, -0.9 * (9.0 * t).sin() + q.sin() * w];
    let expected: f64 = rates.iter().map(|v| v * v).sum();
    let found =
        ["kinetic_energy", "energy"].map(|name| value(&of, name, [&[t, q], &[w], &[], &[]])[0]);
    for found in found {
        assert!((found - expected).abs() < 1e-13, "{found} {expected}");
    }
}

/// Velocities relative to a drifting frame do not change the energy: T is quadratic in ẋ, and so is its part of h.
#[test]
fn drifting_velocities_leave_the_energy_as_it_is() {
    let of = generated(
        "system Drifting {
            param m = 1.5, c = 3;
            time t; coord x, y; velocity u, w; rate x = u + c * t, y = w - 2 * x;
            kinetic m * (u + c * t)^2 / 2 + m * (w - 2 * x)^2 / 2 + 4 * (w - 2 * x) * x + x^2;
        }",
    );
    let (t, x, u, w) = (0.3, 0.7, -0.4, 1.1);
    let [first, second] = [u + 3.0 * t, w - 2.0 * x];
    let expected = 0.75 * (first * first + second * second) - x * x;
    let found = value(&of, "energy", [&[t, x, 0.0], &[u, w], &[], &[]])[0];
    assert!((found - expected).abs() < 1e-13, "{found} {expected}");
}
