//! Real points of X, at which expressions with square roots are distinguished.

use super::layout::Block;
use super::points::Points;
use crate::algebra::graph::Edge;
use crate::algebra::reals::{Real, Reals, SAMPLES};
use crate::algebra::residue_pair::Random;

/// Error of coordinates that solve the user's constraints numerically.
const SOLVED: f64 = 1e-9;
/// Error of coordinates near the start, which may be poorly determined by parts of the constraints.
const BLURRED: f64 = 1e-7;
/// How far points near the start are from it.
const NEAR: f64 = 0.05;
/// Error of all other values.
const ROUNDED: f64 = 1e-14;

/// Returns samples with the value of π alone, which is all that numbers need.
pub fn pi() -> Vec<Reals> {
    vec![[Real::new(std::f64::consts::PI, ROUNDED); SAMPLES]]
}

/// Returns the values of all symbols, in real enclosures, at random real points with φ = 0.
///
/// At every other point all symbols but coordinates are positive; at the rest they have either sign. At the first
/// half of the points their sizes are about 1, at the second half from 1/100 to 1000. Coordinates are unknown where
/// the constraints could not be solved.
///
/// Constraints may have several branches. If the values of the start are given, the first half of the points lies
/// near the start, with its parameters, and so on the branch that matters.
pub fn sample(
    points: &Points,
    phi: &[(Edge, String)],
    seed: u64,
    near: Option<&[f64]>,
) -> Vec<Reals> {
    let mut random = Random::new(seed ^ 0x7ea1);
    let equations = (!points.constraints.is_empty()).then(|| points.equations(phi));
    let mut all = vec![[Real::UNKNOWN; SAMPLES]; points.symbols];
    for sample in 0..SAMPLES {
        let mut values = one(points, &mut random, sample);
        let near = near.filter(|_| sample < SAMPLES / 2);
        if let Some(near) = near {
            let end = points.first + points.dimension();
            for (value, start) in values.iter_mut().zip(near).take(end) {
                *value = *start;
            }
            for value in &mut values[points.first..end] {
                *value += NEAR * number(&mut random);
            }
        }
        let solved = equations
            .as_ref()
            .map(|equations| equations.solve_near(&values));
        for (index, value) in values.into_iter().enumerate() {
            let coordinate = index.checked_sub(points.first);
            all[index][sample] = match (&solved, coordinate) {
                (Some(x), Some(alpha)) if alpha < points.dimension() => {
                    let x = x.as_ref().and_then(|x| x.get(alpha));
                    let error = if near.is_some() { BLURRED } else { SOLVED };
                    x.map_or(Real::UNKNOWN, |&x| Real::new(x, error))
                }
                _ => Real::new(value, ROUNDED),
            };
        }
    }
    all
}

/// Returns random real values of symbols that are under no constraint.
pub fn anywhere(count: usize, seed: u64) -> Vec<Reals> {
    let mut random = Random::new(seed ^ 0x7ea1);
    let mut all = vec![[Real::UNKNOWN; SAMPLES]; count];
    for sample in 0..SAMPLES {
        let values = numbers(count, &mut random, sample);
        for (reals, value) in all.iter_mut().zip(values) {
            reals[sample] = Real::new(value, ROUNDED);
        }
    }
    all
}

/// Returns random values of all symbols, with φ = 0 of the coordinates' own kinds.
fn one(points: &Points, random: &mut Random, sample: usize) -> Vec<f64> {
    let mut values = numbers(points.symbols, random, sample);
    let mut place = points.first;
    for &block in &points.blocks {
        for value in coordinates(block, random, sample) {
            values[place] = value;
            place += 1;
        }
    }
    values
}

/// Returns π, followed by random values of the symbols after it.
fn numbers(count: usize, random: &mut Random, sample: usize) -> Vec<f64> {
    let mut values: Vec<f64> = (0..count)
        .map(|_| {
            let size = if sample < SAMPLES / 2 {
                size(random)
            } else {
                wide(random)
            };
            let positive = sample.is_multiple_of(2) || random.bits() & 1 == 0;
            if positive { size } else { -size }
        })
        .collect();
    if let Some(first) = values.first_mut() {
        *first = std::f64::consts::PI;
    }
    values
}

/// Returns a random number between ½ and 3/2.
fn size(random: &mut Random) -> f64 {
    0.5 + (random.bits() >> 11) as f64 / (1u64 << 53) as f64
}

/// Returns a random number between 1/100 and 1000, on a logarithmic scale.
fn wide(random: &mut Random) -> f64 {
    10f64.powf(5.0 * (size(random) - 0.5) - 2.0)
}

/// Returns a random number of size about 1 and either sign.
fn number(random: &mut Random) -> f64 {
    let size = size(random);
    if random.bits() & 1 == 0 { size } else { -size }
}

fn coordinates(block: Block, random: &mut Random, sample: usize) -> Vec<f64> {
    let scaled = sample >= SAMPLES / 2 && matches!(block, Block::Flat(_));
    block.point(|| match scaled {
        true => number(random) * wide(random),
        false => number(random),
    })
}
