//! The hard cases by explicit methods: errors agree in size with those of independent implementations of the same
//! methods with the same steps.

use hamel::System;
use hamel::methods::{Cf4, Method, Rkmk4, Rkmk8, Rkmk54};
use hamel_cases::{Case, bodies, mechanisms};

/// Relative tolerance of a measured error.
const ERROR_TOLERANCE: f64 = 0.10;
/// Factor for errors below [`ROUNDED_ERROR`], whose rounding depends on the order of operations.
const ROUNDING_FACTOR: f64 = 3.0;
const ROUNDED_ERROR: f64 = 1e-9;
/// Rounding over a run of thousands of steps: smaller expected errors are bounds.
const ROUNDING_FLOOR: f64 = 1e-11;

/// Expected errors for some numbers of steps.
type Sizes<'a> = &'a [(u32, f64)];

fn check<Sys, M>(case: &Case<Sys>, method: M, sizes: Sizes)
where
    Sys: System<Scalar = f64>,
    M: Method<Sys> + Copy + std::fmt::Debug,
{
    for &(n, expected) in sizes {
        let end = case.run(method, case.until, n).expect(case.name);
        let error = case.error(&end);
        let holds = if expected <= ROUNDING_FLOOR {
            error <= ROUNDING_FACTOR * ROUNDING_FLOOR
        } else if expected < ROUNDED_ERROR {
            error <= ROUNDING_FACTOR * expected && error >= expected / ROUNDING_FACTOR
        } else {
            (error / expected - 1.0).abs() <= ERROR_TOLERANCE
        };
        assert!(
            holds,
            "{} by {method:?}, {n} steps: error {error:e}, expected {expected:e}",
            case.name
        );
    }
}

/// Checks all three methods of a case.
fn all<Sys: System<Scalar = f64>>(case: &Case<Sys>, four: Sizes, five: Sizes, eight: Sizes) {
    check(case, Rkmk4, four);
    check(case, Rkmk54, five);
    check(case, Rkmk8, eight);
}

#[test]
fn bodies_in_flight() {
    all(
        &bodies::offset_body(),
        &[(1000, 3.26e-7), (2000, 2.01e-8), (4000, 1.25e-9)],
        &[(1000, 4.54e-10), (2000, 1.4e-11)],
        &[(250, 5e-12), (500, 2e-12), (1000, 5e-12)],
    );
    all(
        &bodies::constant_wrench(),
        &[(1000, 3.00e-6), (2000, 1.88e-7), (4000, 1.18e-8)],
        &[(1000, 6.95e-9), (2000, 2.2e-10)],
        &[(250, 5.9e-11), (500, 2e-12), (1000, 4e-12)],
    );
}

#[test]
fn several_bodies() {
    all(
        &mechanisms::two_bodies(),
        &[(1000, 8.84e-6), (2000, 5.62e-7), (4000, 4.12e-8)],
        &[(1000, 1.83e-7), (2000, 6.10e-9)],
        &[(250, 1.98e-8), (500, 3.5e-11), (1000, 2e-13)],
    );
    all(
        &mechanisms::double_pendulum(),
        &[(2000, 4.61), (4000, 0.366)],
        &[(2000, 7.1e-2)],
        &[(1000, 7.4e-5)],
    );
    // With more steps, rounding amplified by chaos dominates; one more halving has only a bound.
    let chaotic = mechanisms::double_pendulum();
    let end = chaotic.run(Rkmk8, chaotic.until, 4000).expect("a run");
    assert!(chaotic.error(&end) <= 1e-6, "{:e}", chaotic.error(&end));
}

#[test]
fn constraints_on_velocities() {
    all(
        &mechanisms::rolling_disk(),
        &[(1000, 2.23e-7), (2000, 1.32e-8), (4000, 8.0e-10)],
        &[(1000, 6.12e-10), (2000, 1.9e-11)],
        &[(250, 5e-12), (500, 3e-14), (1000, 9e-15)],
    );
    all(
        &mechanisms::sleigh(),
        &[(1000, 2.23e-8), (2000, 1.38e-9), (4000, 8.6e-11)],
        &[(1000, 2.24e-11), (2000, 7e-13)],
        &[(250, 9e-13), (500, 2e-15), (1000, 5e-15)],
    );
}

#[test]
fn satellite_and_poles() {
    all(
        &bodies::gravity_gradient(),
        &[(1000, 1.77e-6), (2000, 1.81e-7), (4000, 1.36e-8)],
        &[(1000, 6.42e-8), (2000, 2.06e-9)],
        &[(250, 1.16e-9), (500, 3e-12), (1000, 1e-12)],
    );
    all(
        &bodies::spherical_pendulum(),
        &[(1000, 7.38e-7), (2000, 3.21e-8), (4000, 1.57e-9)],
        &[(1000, 6.17e-9), (2000, 1.9e-10)],
        &[(250, 1.5e-10), (500, 3e-13), (1000, 3e-13)],
    );
}

#[test]
fn tops() {
    let benchmark = bodies::benchmark_top();
    all(
        &benchmark,
        &[(2000, 2.75e-5)],
        &[(2000, 2.11e-7)],
        &[(2000, 7e-14)],
    );
    check(&benchmark, Cf4, &[(2000, 2.75e-5)]);
    let kovalevskaya = bodies::kovalevskaya();
    all(
        &kovalevskaya,
        &[(2000, 3.70e-9)],
        &[(2000, 5.8e-12)],
        &[(2000, 1e-13)],
    );
    check(&kovalevskaya, Cf4, &[(2000, 3.84e-9)]);
    let fast = bodies::fast_top();
    all(
        &fast,
        &[(16000, 1.68e-5)],
        &[(16000, 3.27e-8)],
        &[(16000, 1e-12)],
    );
    check(&fast, Cf4, &[(16000, 1.66e-5)]);
}

#[test]
fn free_bodies() {
    let flips = bodies::dzhanibekov();
    check(&flips, Rkmk4, &[(2000, 4.27e-7)]);
    check(&flips, Cf4, &[(2000, 4.52e-7)]);
    check(&flips, Rkmk54, &[(2000, 3.5e-9)]);
    let rod = bodies::elongated();
    all(
        &rod,
        &[(16000, 1.99e-4)],
        &[(16000, 5.30e-7)],
        &[(16000, 1e-11)],
    );
    check(&rod, Cf4, &[(16000, 1.99e-4)]);
    let spin = bodies::fast_spin();
    all(
        &spin,
        &[(16000, 2.23e-7)],
        &[(16000, 4.5e-9)],
        &[(16000, 8e-12)],
    );
    check(&spin, Cf4, &[(16000, 2.40e-7)]);
}

/// Near the separatrix, stepping loses the phase by rounding: this is the best error of order 8, and a bound for
/// stepping methods.
#[test]
fn stepping_near_the_separatrix() {
    let near = bodies::dzhanibekov_near();
    let end = near.run(Rkmk8, 60.0, 2400).expect("a run");
    assert!(near.error_at(60.0, &end) <= 1e-8, "before the second flip");
    let flips = bodies::dzhanibekov();
    let best = [1000, 2000, 4000]
        .map(|n| flips.error(&flips.run(Rkmk8, 100.0, n).expect("a run")))
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    assert!(best <= 3e-9, "{best:e}");
    let symmetric = bodies::nearly_symmetric();
    let end = symmetric.run(Rkmk8, 100.0, 4000).expect("a run");
    assert!(symmetric.error(&end) <= 1e-9, "two moments 10⁻⁶ apart");
}
