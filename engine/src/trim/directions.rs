//! Directions in which a trim is not determined, and the stability of the motion apart from them.

use super::conditions::{Conditions, Local, Point};
use super::problem::TrimProblem;
use super::solve::{POLISHED_RESIDUAL, RANK_TOLERANCE, Scales, Solution};
use crate::linearize::eigenvalues::eigenvalues;
use crate::names;
use hamel_codegen::algebra::dense::{apply, dot, largest, product};
use hamel_codegen::model::layout::Block;
use hamel_files::number::digits;
use nalgebra::{DMatrix, SVD};
use std::fmt;
use std::ops::Range;

/// Displacement along an undetermined direction from which the solution is sought again.
const MOVE: f64 = 1e-2;
/// Largest part of that displacement which a correction may take back where solutions form a family.
const MAX_CORRECTION: f64 = 0.3;
/// Largest number of steps of the correction.
const MAX_CORRECTIONS: usize = 10;
/// Entries of a direction below this, relative to the largest, are rounding errors.
const ENTRY_TOLERANCE: f64 = 1e-6;
/// Eigenvalues below this, relative to the largest entry of the matrix, are zero to rounding: a rounding error ε moves
/// a double zero of the characteristic polynomial by √ε.
const EIGENVALUE_TOLERANCE: f64 = 1e-7;
/// Smallest entry of a kind of quantity that identifies a direction, relative to the largest of all.
const KIND_TOLERANCE: f64 = 1e-5;
/// Largest number of entries that are shown.
const MAX_SHOWN: usize = 6;

/// Direction along which solutions form a family: entries of x, ξ, z and u that change in proportion. Turns of circles,
/// quaternions and rotation matrices are displacements `h(…)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction(pub Vec<(String, f64)>);

/// Eigenvalues of a motion apart from displacements along which it does not change.
#[derive(Clone, Debug)]
pub struct Spectrum {
    /// Real and imaginary parts, the fastest growing first.
    pub values: Vec<(f64, f64)>,
    /// Largest entry of their matrix.
    pub size: f64,
    /// Stability of the motion, judged by these eigenvalues.
    pub stability: Stability,
}

/// Stability of a motion under small deviations of the state, apart from displacements along which it does not change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// All of them decay.
    Asymptotic,
    /// None of them grows exponentially, but some do not decay: the linearisation does not decide.
    Neutral,
    /// Some grow.
    Unstable,
}

impl fmt::Display for Stability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Stability::Asymptotic => "asymptotic",
            Stability::Neutral => "neutral",
            Stability::Unstable => "unstable",
        })
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, (name, part)) in self.0.iter().take(MAX_SHOWN).enumerate() {
            let sign = match (place, *part < 0.0) {
                (0, false) => "",
                (0, true) => "-",
                (_, false) => " + ",
                (_, true) => " - ",
            };
            f.write_str(sign)?;
            if part.abs() != 1.0 {
                write!(f, "{} ", digits(part.abs(), 3))?;
            }
            f.write_str(name)?;
        }
        match self.0.len() > MAX_SHOWN {
            true => f.write_str(" and others"),
            false => Ok(()),
        }
    }
}

/// Returns the rank of the conditions, and the directions in which they leave the solution undetermined.
///
/// # Errors
/// The conditions change along such a direction, to higher order.
pub fn undetermined(
    conditions: &Conditions,
    solution: &Solution,
) -> Result<(usize, Vec<Direction>), TrimProblem> {
    let Solution {
        point,
        local,
        probes,
        ..
    } = solution;
    // Slopes that vanish at the solution alone are small beside those of its neighbours.
    let mut scales = Scales::new(conditions);
    scales.meet(local);
    probes.iter().for_each(|probe| scales.meet(probe));
    let none = || TrimProblem::Singular {
        direction: "an unknown direction".into(),
        residual: largest(&local.residuals),
    };
    let factored = scales.factor(local).ok_or_else(none)?;
    let kernel = kernel_of(&factored.svd);
    let (names, rows, kinds) = named_rows(conditions, local);
    let steps: Vec<Vec<f64>> = kernel
        .iter()
        .map(|v| {
            v.iter()
                .zip(&factored.units)
                .map(|(v, unit)| v * unit)
                .collect()
        })
        .collect();
    let rank = local.columns.len() - steps.len();
    let mut directions = Vec::new();
    for (entries, step) in reduced(&steps, &rows, &kinds) {
        let named = names
            .iter()
            .zip(&entries)
            .filter(|(_, e)| e.abs() > ENTRY_TOLERANCE);
        let direction = Direction(named.map(|(name, entry)| (name.clone(), *entry)).collect());
        if !is_family(conditions, &scales, (point, local), &step) {
            return Err(TrimProblem::Singular {
                direction: direction.to_string(),
                residual: largest(&local.residuals),
            });
        }
        directions.push(direction);
    }
    Ok((rank, directions))
}

/// Right singular vectors of singular values that count as zero.
fn kernel_of(svd: &SVD<f64, nalgebra::Dyn, nalgebra::Dyn>) -> Vec<Vec<f64>> {
    let most = svd.singular_values.amax();
    let rows = svd
        .v_t
        .iter()
        .flat_map(|v| v.row_iter())
        .zip(svd.singular_values.iter());
    let small = rows.filter(|(_, value)| **value <= RANK_TOLERANCE * most.max(1.0));
    small
        .map(|(row, _)| row.iter().copied().collect())
        .collect()
}

/// Names and rows of the map from unknowns to changes of flat coordinates, turns of the others, ξ, z and u, with the
/// ranges of coordinates, of ξ and z, and of u.
fn named_rows(
    conditions: &Conditions,
    local: &Local,
) -> (Vec<String>, Vec<Vec<f64>>, [Range<usize>; 3]) {
    let model = &conditions.generated.model;
    let flat = model.blocks.iter().flat_map(|block| {
        let is_flat = matches!(block, Block::Flat(_));
        std::iter::repeat_n(is_flat, block.len())
    });
    let flat: Vec<bool> = flat.collect();
    let displaced = product(&local.frame, &local.lift[..conditions.sizes[0]]);
    let coordinates = names::coordinates(model).into_iter().zip(displaced);
    let mut named: Vec<(String, Vec<f64>)> = coordinates
        .zip(&flat)
        .filter_map(|(named, is_flat)| is_flat.then_some(named))
        .collect();
    for (place, (name, row)) in conditions.names.iter().zip(&local.lift).enumerate() {
        let turns = || {
            local
                .frame
                .iter()
                .zip(&flat)
                .any(|(row, flat)| !flat && row[place] != 0.0)
        };
        if place >= conditions.sizes[0] || turns() {
            named.push((name.clone(), row.clone()));
        }
    }
    let behind: usize = conditions.names.len() - conditions.sizes[0];
    let inputs = conditions.generated.active.m();
    let [first, second] = [named.len() - behind, named.len() - inputs];
    let kinds = [0..first, first..second, second..named.len()];
    let (names, rows) = named.into_iter().unzip();
    (names, rows, kinds)
}

/// Returns a basis of the span of `steps` whose images under `rows` have each an entry 1 that is 0 in the others, with
/// these images.
fn reduced(
    steps: &[Vec<f64>],
    rows: &[Vec<f64>],
    kinds: &[Range<usize>],
) -> Vec<(Vec<f64>, Vec<f64>)> {
    let mut all: Vec<(Vec<f64>, Vec<f64>)> = steps
        .iter()
        .map(|step| (apply(rows, step), step.clone()))
        .collect();
    for done in 0..all.len() {
        let size = |(row, k): (usize, usize)| all[k].0[row].abs();
        // An earlier entry is preferred unless a later one is clearly larger.
        let largest = |rows: Range<usize>| {
            let entries = rows.flat_map(|row| (done..steps.len()).map(move |k| (row, k)));
            entries.reduce(|best, next| {
                if size(next) > 1.001 * size(best) {
                    next
                } else {
                    best
                }
            })
        };
        // So are coordinates to velocities, whose numbers depend on units, and velocities to inputs.
        let most = largest(0..rows.len()).map_or(0.0, size);
        let kinds = kinds.iter().filter_map(|rows| largest(rows.clone()));
        let mut large = kinds.filter(|&entry| size(entry) > KIND_TOLERANCE * most);
        let Some((row, k)) = large.next() else {
            break;
        };
        all.swap(done, k);
        let pivot = all[done].0[row];
        let scale = |list: &mut Vec<f64>| list.iter_mut().for_each(|entry| *entry /= pivot);
        scale(&mut all[done].0);
        scale(&mut all[done].1);
        let by = all[done].clone();
        for (_, other) in all.iter_mut().enumerate().filter(|(k, _)| *k != done) {
            let factor = other.0[row];
            let less = |list: &mut Vec<f64>, by: &[f64]| {
                list.iter_mut()
                    .zip(by)
                    .for_each(|(entry, by)| *entry -= factor * by);
            };
            less(&mut other.0, &by.0);
            less(&mut other.1, &by.1);
        }
    }
    all
}

/// Returns whether solutions continue in a direction: a solution near a displaced point is near that point, not near
/// the first solution.
fn is_family(
    conditions: &Conditions,
    scales: &Scales,
    (point, local): (&Point, &Local),
    step: &[f64],
) -> bool {
    let most = largest(&apply(&local.lift, step)).max(f64::MIN_POSITIVE);
    let step: Vec<f64> = step.iter().map(|entry| MOVE / most * entry).collect();
    let Some(mut there) = local.moved(conditions, point, &step) else {
        return false;
    };
    let mut back = vec![0.0; step.len()];
    for _ in 0..MAX_CORRECTIONS {
        let Some(at) = conditions
            .at(&there)
            .filter(|at| at.columns == local.columns)
        else {
            return false;
        };
        if at.is_solved(conditions, &there, POLISHED_RESIDUAL) {
            let squares = |list: &[f64]| list.iter().map(|entry| entry * entry).sum::<f64>();
            return dot(&back, &step).abs() <= MAX_CORRECTION * squares(&step);
        }
        let Some(correction) = scales.factor(&at).map(|factored| factored.step(0.0)) else {
            return false;
        };
        back.iter_mut()
            .zip(&correction)
            .for_each(|(back, part)| *back += part);
        match at.moved(conditions, &there, &correction) {
            Some(next) => there = next,
            None => return false,
        }
    }
    false
}

/// Returns the eigenvalues of the motion apart from displacements along which it does not change; `None` if they are
/// not found.
///
/// The rates of ξ and z do not depend on the displacements of the largest subspace N with ∂F/∂h N = 0 and A_hh N ⊂ N; with
/// respect to it A is block triangular.
pub fn spectrum(conditions: &Conditions, local: &Local) -> Option<Spectrum> {
    let count = local.kept.len();
    let nh = local
        .kept
        .iter()
        .filter(|&&k| k < conditions.sizes[0])
        .count();
    let a = &local.motion;
    let (moving, forced) = a.split_at(nh);
    let part = |row: &Vec<f64>| row[..nh].to_vec();
    let moving: Vec<Vec<f64>> = moving.iter().map(part).collect();
    let unit = |rows: &mut Vec<Vec<f64>>| {
        let most = rows
            .iter()
            .map(|row| largest(row))
            .fold(f64::MIN_POSITIVE, f64::max);
        rows.iter_mut().flatten().for_each(|entry| *entry /= most);
    };
    // Rows of ∂F/∂h A_hhᵏ.
    let mut block: Vec<Vec<f64>> = forced.iter().map(part).collect();
    block.iter_mut().for_each(|row| {
        let most = largest(row).max(f64::MIN_POSITIVE);
        row.iter_mut()
            .for_each(|entry| *entry /= most.max(ENTRY_TOLERANCE * largest(&a.concat())));
    });
    let mut seen = block.clone();
    for _ in 1..nh {
        block = product(&block, &moving);
        unit(&mut block);
        seen.extend(block.clone());
    }
    let matrix = DMatrix::from_fn(seen.len().max(nh), nh, |i, j| {
        seen.get(i).map_or(0.0, |row| row[j])
    });
    let svd = SVD::try_new(matrix, false, true, f64::EPSILON, 10_000)?;
    let most = svd.singular_values.amax();
    let v = svd.v_t.as_ref()?;
    let kept = (0..nh).filter(|&i| svd.singular_values[i] > RANK_TOLERANCE * most);
    let kept: Vec<usize> = kept.collect();
    // Columns of the basis of what is left: displacements across N, then velocities and states.
    let width = kept.len() + count - nh;
    let basis = DMatrix::from_fn(count, width, |i, j| match kept.get(j) {
        Some(&row) if i < nh => v[(row, i)],
        Some(_) => 0.0,
        None => f64::from(i + kept.len() == j + nh),
    });
    let a = DMatrix::from_fn(count, count, |i, j| a[i][j]);
    let quotient = basis.transpose() * a * basis;
    let rows: Vec<Vec<f64>> = quotient
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect();
    let size = if rows.is_empty() {
        0.0
    } else {
        quotient.amax()
    };
    let values = eigenvalues(&rows)?;
    let zero = EIGENVALUE_TOLERANCE * size;
    let growth = values
        .iter()
        .fold(f64::NEG_INFINITY, |most, (re, _)| most.max(*re));
    let stability = match growth {
        _ if growth > zero => Stability::Unstable,
        _ if growth < -zero => Stability::Asymptotic,
        _ => Stability::Neutral,
    };
    Some(Spectrum {
        values,
        size,
        stability,
    })
}
