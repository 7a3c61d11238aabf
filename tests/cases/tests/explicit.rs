//! The hard cases by explicit methods: errors of the size that independent implementations of the
//! same methods have.

use hamel::System;
use hamel::methods::Rkmk4;
use hamel_cases::{Case, bodies, mechanisms};

/// How far a measured error may be from the expected one.
const SIZE: f64 = 0.10;

#[test]
fn rkmk4_errors() {
    check(&mechanisms::sleigh(), &[(1000, 2.23e-8)]);
    check(&mechanisms::double_pendulum(), &[(2000, 4.61)]);
    check(&mechanisms::two_bodies(), &[(1000, 8.84e-6)]);
    check(&mechanisms::rolling_disk(), &[(1000, 2.23e-7)]);
    check(&bodies::benchmark_top(), &[(2000, 2.75e-5)]);
    check(&bodies::kovalevskaya(), &[(2000, 3.70e-9)]);
    check(&bodies::fast_top(), &[(16000, 1.68e-5)]);
    check(&bodies::dzhanibekov(), &[(2000, 4.27e-7)]);
    check(&bodies::elongated(), &[(16000, 1.99e-4)]);
    check(&bodies::fast_spin(), &[(16000, 2.23e-7)]);
    check(&bodies::offset_body(), &[(1000, 3.26e-7)]);
    check(&bodies::constant_wrench(), &[(1000, 3.00e-6)]);
    check(&bodies::gravity_gradient(), &[(1000, 1.77e-6)]);
    check(&bodies::spherical_pendulum(), &[(1000, 7.38e-7)]);
}

fn check<Sys: System<Scalar = f64>>(case: &Case<Sys>, sizes: &[(u32, f64)]) {
    for &(n, expected) in sizes {
        let end = case.run(Rkmk4, case.until, n).expect(case.name);
        let error = case.error(&end);
        println!(
            "{} n = {n}: {error:.3e}, expected {expected:.2e}",
            case.name
        );
        assert!(
            (error / expected - 1.0).abs() <= SIZE,
            "{} n = {n}: error {error:e}, expected {expected:e}",
            case.name
        );
    }
}
