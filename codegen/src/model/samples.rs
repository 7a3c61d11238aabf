//! Real points of X, at which expressions with square roots are told apart.

use super::layout::Block;
use super::nearest::Equations;
use super::points::Points;
use crate::algebra::fp::Random;
use crate::algebra::graph::Edge;
use crate::algebra::reals::{Real, Reals, SAMPLES};

/// Error of coordinates that solve the user's constraints numerically.
const SOLVED: f64 = 1e-9;
/// Error of the others.
const ROUNDED: f64 = 1e-15;

/// π alone: all that numbers need.
pub fn pi() -> Vec<Reals> {
    vec![[Real::new(std::f64::consts::PI, ROUNDED); SAMPLES]]
}

/// The values of all symbols at random real points with φ = 0. At the first two all symbols but
/// coordinates are positive, at the others of either sign. Coordinates of a constraint that was not
/// solved have no value.
pub fn sample(points: &Points, phi: &[(Edge, String)], seed: u64) -> Vec<Reals> {
    let mut random = Random::new(seed ^ 0x7ea1);
    let equations = (!points.constraints.is_empty()).then(|| Equations::new(points, phi));
    let mut all = vec![[Real::UNKNOWN; SAMPLES]; points.symbols];
    for sample in 0..SAMPLES {
        let values = one(points, &mut random, sample < 2);
        let solved = equations.as_ref().map(|equations| equations.near(&values));
        for (index, value) in values.into_iter().enumerate() {
            let coordinate = index.checked_sub(points.first);
            all[index][sample] = match (&solved, coordinate) {
                (Some(x), Some(alpha)) if alpha < points.dimension() => {
                    let x = x.as_ref().and_then(|x| x.get(alpha));
                    x.map_or(Real::UNKNOWN, |&x| Real::new(x, SOLVED))
                }
                _ => Real::new(value, ROUNDED),
            };
        }
    }
    all
}

/// Random values of symbols that are under no constraint.
pub fn anywhere(count: usize, seed: u64) -> Vec<Reals> {
    let mut random = Random::new(seed ^ 0x7ea1);
    let mut all = vec![[Real::UNKNOWN; SAMPLES]; count];
    for sample in 0..SAMPLES {
        let values = numbers(count, &mut random, sample < 2);
        for (reals, value) in all.iter_mut().zip(values) {
            reals[sample] = Real::new(value, ROUNDED);
        }
    }
    all
}

/// Random values of all symbols, with φ = 0 of the coordinates' kinds.
fn one(points: &Points, random: &mut Random, positive: bool) -> Vec<f64> {
    let mut values = numbers(points.symbols, random, positive);
    let mut place = points.first;
    for &block in &points.blocks {
        for value in coordinates(block, random) {
            values[place] = value;
            place += 1;
        }
    }
    values
}

/// π, and random values of the symbols after it.
fn numbers(count: usize, random: &mut Random, positive: bool) -> Vec<f64> {
    let mut values: Vec<f64> = (0..count)
        .map(|_| {
            if positive {
                size(random)
            } else {
                number(random)
            }
        })
        .collect();
    if let Some(first) = values.first_mut() {
        *first = std::f64::consts::PI;
    }
    values
}

/// A number in ½…3/2.
fn size(random: &mut Random) -> f64 {
    0.5 + (random.bits() >> 11) as f64 / (1u64 << 53) as f64
}

/// The same of either sign.
fn number(random: &mut Random) -> f64 {
    let size = size(random);
    if random.bits() & 1 == 0 { size } else { -size }
}

fn coordinates(block: Block, random: &mut Random) -> Vec<f64> {
    let mut unit = |n: usize| {
        let entries: Vec<f64> = (0..n).map(|_| number(random)).collect();
        let length = entries.iter().map(|x| x * x).sum::<f64>().sqrt();
        entries.iter().map(|x| x / length).collect::<Vec<f64>>()
    };
    match block {
        Block::Flat(n) => (0..n).map(|_| number(random)).collect(),
        Block::Circle => unit(2),
        Block::Quaternion => unit(4),
        Block::Rotation => {
            let q = unit(4);
            super::layout::rotation([q[0], q[1], q[2], q[3]], 2.0)
        }
    }
}
