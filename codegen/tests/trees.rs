//! Random trees of bodies: what is generated against Newton and Euler in numbers.

mod common;
#[path = "common/tree.rs"]
mod tree;

use common::{Random, difference, generated, value};
use tree::{Kind, Link, Tree, text};

/// Roundings of a few thousand operations, forces of the order of 100.
const CLOSE: f64 = 1e-10;
/// States tried per tree.
const STATES: usize = 3;

const SIMPLE: [Kind; 4] = [
    Kind::Revolute,
    Kind::Revolute,
    Kind::Continuous,
    Kind::Prismatic,
];
const ALL: [Kind; 7] = [
    Kind::Revolute,
    Kind::Continuous,
    Kind::Prismatic,
    Kind::Spherical,
    Kind::Cylindrical,
    Kind::Free,
    Kind::Revolute,
];

/// A tree of so many links agrees with Newton and Euler in F, M, the bias, ξ̇ and the energy.
fn agrees(seed: u64, count: usize, kinds: &[Kind]) {
    let mut random = Random(seed);
    let links: Vec<Link> = (0..count)
        .map(|before| Link::random(&mut random, before, kinds))
        .collect();
    let text = text(&links);
    let system = generated(&text);
    let program = &system.program;
    for _ in 0..STATES {
        let x = random.configuration(&program.blocks);
        let (xi, dot) = (random.numbers(program.n), random.numbers(program.n));
        let tree = Tree::new(&links, &x, &xi);
        let still = vec![0.0; program.n];
        let at = [x.as_slice(), &xi, &[], &dot];
        let same = |what: &str, found: &[f64], wanted: &[f64]| {
            let apart = difference(wanted, found);
            assert!(apart < CLOSE, "seed {seed:#x}: {what} {apart:e} of\n{text}");
        };
        let of = |name: &str| value(&system, name, at);
        same(
            "inverse dynamics",
            &of("inverse_dynamics"),
            &tree.needed(&dot, 1.0),
        );
        let bias = tree.needed(&still, 0.0);
        same("bias", &of("bias"), &bias);
        let weight: Vec<f64> = tree.needed(&still, 1.0);
        let weight: Vec<f64> = weight.iter().zip(&bias).map(|(a, b)| a - b).collect();
        same("gravity", &of("potential_force"), &weight);
        same("energy", &of("energy"), &[tree.energy()]);
        let mass = of("mass_matrix");
        for i in 0..program.n {
            let mut unit = still.clone();
            unit[i] = 1.0;
            let column = tree.needed(&unit, 0.0);
            let column: Vec<f64> = column.iter().zip(&bias).map(|(a, b)| a - b).collect();
            let row = &mass[i * program.n..(i + 1) * program.n];
            same("mass matrix", row, &column);
        }
        // The motion that friction alone leaves.
        same("motion", &tree.needed(&of("accel"), 1.0), &tree.friction());
    }
}

#[test]
fn trees_of_one_freedom_a_joint() {
    for (seed, count) in [(0x51, 2), (0x52, 3), (0x53, 4)] {
        agrees(seed, count, &SIMPLE);
    }
}

#[test]
fn trees_of_all_kinds() {
    for (seed, count) in [(0xa1, 2), (0xa2, 2), (0xa3, 3)] {
        agrees(seed, count, &ALL);
    }
}
