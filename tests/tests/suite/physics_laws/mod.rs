//! Laws that every generated system obeys at pseudo-random states: no reference numbers, only the relations of KR18
//! between x, ξ, A, M, γ, T and V. Parameters are those of the descriptions.

mod lists;
mod point;

use lists::{assert_close, derivative, dot, factor, largest, plus, solve, times};
use point::{Point, everywhere};

/// Rounding of several hundred operations, 1e-16 each, relative to the largest term.
const ROUNDING_TOLERANCE: f64 = 1e-13;
/// Relative error of an extrapolated central difference: h⁴/480 times fifth derivatives, which are below 1e4 in states
/// and systems of this size, and rounding of 1e-12.
const DIFFERENCE_TOLERANCE: f64 = 1e-10;

/// Returns the columns of A at the state.
fn frame(point: &dyn Point, x: &[f64]) -> Vec<Vec<f64>> {
    let n = point.xi().len();
    (0..n)
        .map(|i| {
            let mut unit = vec![0.0; n];
            unit[i] = 1.0;
            point.rate(x, &unit)
        })
        .collect()
}

/// (20): M is a Gram matrix.
#[test]
fn mass_matrix_is_symmetric_and_positive_definite() {
    everywhere(|point| {
        let m = point.mass(point.x());
        let bound = ROUNDING_TOLERANCE * largest(&m.concat());
        for (i, row) in m.iter().enumerate() {
            let column: Vec<f64> = m.iter().map(|row| row[i]).collect();
            assert_close(point.label(), row, &column, bound);
        }
        assert!(factor(&m).is_some(), "{}: {m:?}", point.label());
    });
}

#[test]
fn kinetic_energy_momentum_and_mass_matrix_agree() {
    everywhere(|point| {
        let m_xi = times(&point.mass(point.x()), point.xi());
        let momentum = point.momentum(point.x(), point.xi());
        let bound = ROUNDING_TOLERANCE * largest(&m_xi).max(1.0);
        assert_close(point.label(), &momentum, &m_xi, bound);
        let t = point.kinetic(point.x());
        let half = 0.5 * dot(point.xi(), &m_xi);
        assert_close(point.label(), &[t], &[half], ROUNDING_TOLERANCE * t);
        let v = point.potential(point.x());
        let bound = ROUNDING_TOLERANCE * t.max(v.abs());
        assert_close(point.label(), &[point.energy()], &[t + v], bound);
    });
}

/// M⁻¹ p equals ξ, computed without M.
#[test]
fn velocities_are_those_of_their_momenta() {
    everywhere(|point| {
        let xi = point.xi();
        let back = point.velocity_of(&point.momentum(point.x(), xi));
        let m = point.mass(point.x());
        // Compared as momenta, so that the condition of M does not amplify rounding.
        let change = times(&m, &plus(&back, -1.0, xi));
        let bound = ROUNDING_TOLERANCE * largest(&times(&m, xi)).max(1.0);
        assert_close(point.label(), &change, &vec![0.0; xi.len()], bound);
    });
}

/// (30c), by the functions of its terms and by the inverse dynamics.
#[test]
fn the_terms_of_the_equations_of_motion_add_up() {
    everywhere(|point| {
        let (bias, slope, load) = (point.bias(), point.slope(), point.load());
        let m = point.mass(point.x());
        let rest = plus(&bias, 1.0, &slope);
        for (xi_dot, force) in [
            (point.accel(), Some(load)),
            (point.random(bias.len()), None),
        ] {
            let inertia = times(&m, &xi_dot);
            let bound =
                ROUNDING_TOLERANCE * largest(&[&inertia[..], &bias, &slope].concat()).max(1.0);
            let sum = plus(&rest, 1.0, &inertia);
            assert_close(point.label(), &point.needed(&xi_dot), &sum, bound);
            if let Some(force) = force {
                assert_close(point.label(), &sum, &force, bound);
            }
        }
    });
}

/// (5) and (7): φ(x) = 0 at the state, and ẋ = A ξ preserves it.
#[test]
fn rates_are_tangent_to_the_constraint() {
    everywhere(|point| {
        let x = point.x();
        let rate = point.rate(x, point.xi());
        let phi = point.phi(x);
        let zero = vec![0.0; phi.len()];
        assert_close(point.label(), &phi, &zero, 1e-14);
        let phi_dot = derivative(|s| point.phi(&plus(x, s, &rate)));
        let bound = DIFFERENCE_TOLERANCE * largest(&rate).max(1.0);
        assert_close(point.label(), &phi_dot, &zero, bound);
    });
}

/// The chart of the integrators moves x by A ξ.
#[test]
fn chart_rates_and_rates_agree() {
    everywhere(|point| {
        let u_dot = point.chart_rate();
        let rate = point.rate(point.x(), point.xi());
        let by_chart = derivative(|s| point.retracted(&plus(&vec![0.0; u_dot.len()], s, &u_dot)));
        let bound = DIFFERENCE_TOLERANCE * largest(&rate).max(largest(point.x()));
        assert_close(point.label(), &by_chart, &rate, bound);
    });
}

/// (8) with Λ = I: by Φ Ψ = I, −Ψ φ is a Newton step back to φ = 0.
#[test]
fn corrections_lead_back_to_the_constraint() {
    /// Size of the disturbance; φ is of this size before the step, and of its square after it.
    const DISTURBANCE: f64 = 1e-5;
    /// Second derivatives of φ and Ψ, summed over the coordinates.
    const MAX_CURVATURE: f64 = 100.0;
    everywhere(|point| {
        let x = plus(point.x(), DISTURBANCE, &point.random(point.x().len()));
        let back = plus(&x, 1.0, &point.correction(&x));
        let phi = point.phi(&back);
        let bound = MAX_CURVATURE * DISTURBANCE * DISTURBANCE;
        assert_close(point.label(), &phi, &vec![0.0; phi.len()], bound);
    });
}

/// (9): the slope of V along each column of A.
#[test]
fn potential_force_is_the_slope_of_the_potential() {
    everywhere(|point| {
        let x = point.x();
        let slope: Vec<f64> = frame(point, x)
            .iter()
            .map(|column| derivative(|s| vec![point.potential(&plus(x, s, column))])[0])
            .collect();
        let scale = point.potential(x).abs().max(largest(&slope)).max(1.0);
        assert_close(
            point.label(),
            &point.slope(),
            &slope,
            DIFFERENCE_TOLERANCE * scale,
        );
    });
}

/// d/dt (T + V) = fᵢ ξⁱ along the computed motion.
#[test]
fn power_balance() {
    everywhere(|point| {
        let power = dot(&point.load(), point.xi());
        let energy_dot = derivative(|h| vec![point.energy_after(h)]);
        let x = point.x();
        let scale = point.kinetic(x).max(point.potential(x).abs()).max(1.0);
        // One order of the step's error enters as one of the difference's: it is 100 times larger, since the motion's
        // derivatives grow with powers of its speeds.
        let bound = 100.0 * DIFFERENCE_TOLERANCE * scale.max(power.abs());
        assert_close(point.label(), &energy_dot, &[power], bound);
    });
}

/// ṗ is the derivative of p along (ẋ, ξ̇).
#[test]
fn momentum_rate_is_the_rate_of_the_momentum() {
    everywhere(|point| {
        let rate = point.momentum_rate();
        let (x, xi) = (point.x(), point.xi());
        let (x_dot, xi_dot) = (point.rate(x, xi), point.accel());
        let along = derivative(|s| point.momentum(&plus(x, s, &x_dot), &plus(xi, s, &xi_dot)));
        // M ξ̇, and the part of it that remains.
        let inertia = largest(&times(&point.mass(x), &xi_dot));
        let scale = inertia.max(point.kinetic(x)).max(1.0);
        assert_close(
            point.label(),
            &rate,
            &along,
            10.0 * DIFFERENCE_TOLERANCE * scale,
        );
    });
}

/// (30a) without tables of the generator: γ from the commutators of the columns of A, (12) by differences, and cᵢ =
/// (d/dt Mᵢⱼ) ξʲ + γᵢⱼᵏ ξʲ pₖ − ∂ᵢT. The commutators must be tangent, (∂ᵢAⱼ − ∂ⱼAᵢ) = A γᵢⱼ.
#[test]
fn bias_is_that_of_hamels_equation() {
    everywhere(|point| {
        let (x, xi) = (point.x(), point.xi());
        let n = xi.len();
        let a = frame(point, x);
        // ∂ᵢAⱼ by i and j.
        let slopes: Vec<Vec<Vec<f64>>> = a
            .iter()
            .map(|along| {
                let all = derivative(|s| frame(point, &plus(x, s, along)).concat());
                all.chunks(x.len()).map(<[f64]>::to_vec).collect()
            })
            .collect();
        let gram: Vec<Vec<f64>> = a.iter().map(|row| times(&a, row)).collect();
        let momentum = times(&point.mass(x), xi);
        let rate = point.rate(x, xi);
        let mut bias = derivative(|s| times(&point.mass(&plus(x, s, &rate)), xi));
        for i in 0..n {
            for j in 0..n {
                let commutator = plus(&slopes[i][j], -1.0, &slopes[j][i]);
                let gamma = solve(&gram, &times(&a, &commutator));
                bias[i] += xi[j] * dot(&gamma, &momentum);
                let tangent: Vec<f64> = (0..x.len())
                    .map(|alpha| a.iter().zip(&gamma).map(|(a, g)| a[alpha] * g).sum())
                    .collect();
                let bound = DIFFERENCE_TOLERANCE * largest(&commutator).max(1.0);
                assert_close(point.label(), &commutator, &tangent, bound);
            }
            bias[i] -= derivative(|s| vec![point.kinetic(&plus(x, s, &a[i]))])[0];
        }
        // Terms are of the size of the energy, apart from the units of ξ, and cancel partly.
        let scale = largest(&bias).max(point.kinetic(x)).max(1.0);
        assert_close(
            point.label(),
            &point.bias(),
            &bias,
            10.0 * DIFFERENCE_TOLERANCE * scale,
        );
    });
}
