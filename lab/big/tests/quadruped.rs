//! Compares the slopes of a robot with legs, whose function is split into short parts, with dual numbers through its
//! accelerations.

use common::{Random, generated};
use hamel::{Dual, Scalar};
use hamel_tests_big::quadruped::Quadruped;

#[path = "../../../codegen/tests/suite/common/mod.rs"]
mod common;

/// Number of coordinates: position and rotation of the trunk, and the hinges.
const X: usize = 24;
/// Numbers of velocities and of inputs, which are twelve torques.
const XI: usize = 18;
const U: usize = 12;
/// Rounding of ten thousand operations, relative to the largest slope.
const ROUNDING: f64 = 1e-10;

type Slope = Dual<f64, 1>;

/// Makes a number with its slope.
fn along(value: f64, slope: f64) -> Slope {
    Dual {
        value,
        slopes: [slope],
    }
}

#[test]
fn slopes_are_those_of_dual_numbers() {
    let text = include_str!(concat!(env!("OUT_DIR"), "/quadruped.rs"));
    let parts = text.matches("of `accel_and_linearize`.").count();
    let statements = text.matches("let ").count();
    assert!(
        parts > 50 && statements > 10_000,
        "{parts} parts, {statements} statements"
    );
    let blocks = generated(include_str!("../models/quadruped.eom"))
        .program
        .blocks;
    let system = Quadruped::<f64>::new().expect("masses are positive");
    let dual = Quadruped::<Slope>::new().expect("masses are positive");
    let mut random = Random::new(0x4e6);
    for _ in 0..3 {
        let x: [f64; X] = random.configuration(&blocks).try_into().expect("as many");
        let xi: [f64; XI] = random.numbers(XI).try_into().expect("as many");
        let u: [f64; U] = random.numbers(U).try_into().expect("as many");
        let frame = system.displacement_frame(&x);
        // The previous contents must not affect the result.
        let mut slopes = [[f64::NAN; 2 * XI + U]; 2 * XI];
        let motion = system.accel_and_linearize(&x, &xi, &u, &mut slopes);
        let motion = motion.expect("all links have mass");
        let alone = system.linearize(&x, &xi, &u).expect("all links have mass");
        assert_eq!(slopes, alone);
        for (found, wanted) in motion.iter().zip(system.accel(&x, &xi, &u).expect("mass")) {
            assert!(
                (found - wanted).abs() <= ROUNDING * wanted.abs().max(1.0),
                "{found} {wanted}"
            );
        }
        let largest = slopes
            .iter()
            .flatten()
            .fold(1.0, |most: f64, s| most.max(s.abs()));
        for column in 0..2 * XI + U {
            let moved = |place: usize| f64::from(u8::from(place == column));
            let x =
                std::array::from_fn(|i| along(x[i], frame[i].get(column).copied().unwrap_or(0.0)));
            let xi = std::array::from_fn(|i| along(xi[i], moved(XI + i)));
            let u = std::array::from_fn(|i| along(u[i], moved(2 * XI + i)));
            let wanted = dual.accel(&x, &xi, &u).expect("all links have mass");
            for (row, wanted) in wanted.iter().enumerate() {
                let found = slopes[XI + row][column];
                let difference = (found - wanted.slopes[0]).abs();
                assert!(
                    difference <= ROUNDING * largest,
                    "row {row}, column {column}: {found} instead of {}",
                    wanted.slopes[0]
                );
            }
        }
    }
    assert_eq!(Slope::from_f64(1.0), along(1.0, 0.0));
}
