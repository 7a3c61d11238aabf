//! Detection of multipliers that are not determined: those of rows of B that depend on other rows.
//!
//! λ is unique up to the kernel of Bᵀ, so that the multiplier of a row is unique if the row is
//! independent of all others. Rows that were dropped as redundant count, too: they share the force
//! of the rows from which they follow.

use super::reduction::{independent_rows, normalize_row};
use hamel_algebra::numeric::evaluate;
use hamel_algebra::residue_pair::Random;
use hamel_language::model::Model;
use hamel_language::model::loop_closure::{LoopClosure, normalise};

/// Distance from the start, in the units of the coordinates, at which rows are examined as well,
/// since a start may be singular.
const EXAMINED_DISTANCE: f64 = 0.1;
/// Number of such configurations.
const EXAMINED_CONFIGURATIONS: u64 = 3;

/// Returns, for each non-redundant constraint of the full frame and then for each drive with a prescribed rate, whether
/// its force is not determined where the loops are closed, singular positions excepted.
pub fn undetermined_multipliers(full: &Model) -> Vec<bool> {
    let shown = || {
        let constraints = full.constraints.iter().map(|row| !row.redundant);
        constraints.chain(full.accelerated.iter().map(|_| true))
    };
    let mut best: Option<(usize, Vec<bool>)> = None;
    for x in examined_configurations(full) {
        let rows = normalized_rows(full, &x);
        let rank = independent_rows(rows.clone()).len();
        if best.as_ref().is_some_and(|(most, _)| *most >= rank) {
            continue;
        }
        let depends = (0..rows.len()).map(|i| {
            let mut others = rows.clone();
            others.remove(i);
            independent_rows(others).len() == rank
        });
        best = Some((rank, depends.collect()));
    }
    let depends = best.map_or(Vec::new(), |(_, depends)| depends);
    let shown = shown().zip(depends).filter(|(shown, _)| *shown);
    shown.map(|(_, depends)| depends).collect()
}

/// Returns configurations that close the loops: some near the start, then the start itself.
fn examined_configurations(full: &Model) -> Vec<Vec<f64>> {
    let closure = LoopClosure::of(full, &full.defaults);
    let time = full.clock.map(|clock| clock.x);
    let beside = (0..EXAMINED_CONFIGURATIONS).filter_map(|place| {
        let mut random = Random::new(0x57a7 + place);
        let mut x = full.start_x.clone();
        for (alpha, entry) in x.iter_mut().enumerate() {
            let number = (random.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
            if Some(alpha) != time {
                *entry += EXAMINED_DISTANCE * number;
            }
        }
        normalise(&full.blocks, &mut x);
        let given: Vec<bool> = (0..x.len()).map(|alpha| Some(alpha) == time).collect();
        closure.close_loops(&mut x, &given).ok()?;
        Some(x)
    });
    let mut places: Vec<Vec<f64>> = beside.collect();
    places.push(full.start_x.clone());
    places
}

/// Returns the rows of B and those of drives, normalised, without the column of the time.
fn normalized_rows(full: &Model, x: &[f64]) -> Vec<Vec<f64>> {
    let n = full.n();
    let numbers = full.numbers(
        &full.defaults,
        x,
        &full.start_xi,
        &vec![0.0; full.u.len()],
        &vec![0.0; n],
    );
    let edges: Vec<_> = full
        .constraints
        .iter()
        .flat_map(|row| row.row.clone())
        .collect();
    let values = evaluate(&full.graph, &edges, &numbers);
    let time = full.clock.map(|clock| clock.xi);
    let given = full.accelerated.iter();
    let given =
        given.map(|&(velocity, _)| (0..n).map(|i| f64::from(u8::from(i == velocity))).collect());
    let rows = values.chunks(n.max(1)).map(<[f64]>::to_vec).chain(given);
    rows.map(|mut row| {
        if let Some(time) = time {
            row[time] = 0.0;
        }
        normalize_row(&row)
    })
    .collect()
}
