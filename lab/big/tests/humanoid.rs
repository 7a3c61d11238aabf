//! Compares the compiled functions of a tree with 38 degrees of freedom with the recursive Newton-Euler algorithm in
//! numbers.

use common::{Random, generated};
use hamel_tests_big::humanoid::Humanoid;
use tree::{Tree, humanoid, text};

#[path = "../../../codegen/tests/suite/common/mod.rs"]
mod common;
#[path = "../../../codegen/tests/suite/common/tree/mod.rs"]
mod tree;

/// Rounding of several thousand operations, relative to the largest force.
const ROUNDING: f64 = 1e-10;
/// Rounding of the motion, in which light links at the end of long limbs are fast.
const MOTION: f64 = 1e-8;
/// Number of states.
const STATES: usize = 5;

fn largest(list: &[f64]) -> f64 {
    list.iter()
        .fold(1.0, |most: f64, entry| most.max(entry.abs()))
}

/// Fails for NaN as well.
fn assert_near(what: &str, found: &[f64], wanted: &[f64], bound: f64) {
    assert_eq!(found.len(), wanted.len());
    for (a, b) in found.iter().zip(wanted) {
        assert!((a - b).abs() <= bound, "{what}: {a} instead of {b}");
    }
}

fn array<const N: usize>(list: &[f64]) -> [f64; N] {
    list.try_into().expect("as many numbers as the tree has")
}

#[test]
fn forces_and_motion_are_those_of_newton_and_euler() {
    let (system, links) = (Humanoid::<f64>::default(), humanoid());
    let blocks = generated(&text(&links, "rate")).program.blocks;
    let mut random = Random::new(0x38b);
    for _ in 0..STATES {
        let x = array::<54>(&random.configuration(&blocks));
        let [xi, wanted] = [(); 2].map(|()| array::<38>(&random.numbers(38)));
        let u = [random.number()];
        let tree = Tree::new(&links, &x, &xi);
        let springs = tree.springs();
        let needed = |xi_dot: &[f64]| -> Vec<f64> {
            let inertial = tree.needed(xi_dot, 1.0);
            inertial.iter().zip(&springs).map(|(a, b)| a + b).collect()
        };
        let force = needed(&wanted);
        let found = system.inverse_dynamics(&x, &xi, &wanted);
        assert_near("force", &found, &force, ROUNDING * largest(&force));
        let motion = system.accel(&x, &xi, &u).expect("all links have mass");
        // The terms of the forces in this motion are of the size of M ξ̇.
        let rest = needed(&[0.0; 38]);
        let balance = needed(&motion);
        let inertial: Vec<f64> = balance.iter().zip(&rest).map(|(a, b)| a - b).collect();
        let bound = MOTION * largest(&inertial);
        assert_near("motion", &balance, &tree.applied(u[0]), bound);
    }
}
