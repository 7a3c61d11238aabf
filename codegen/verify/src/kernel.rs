//! Points of systems with constraints on their velocities: ξ is changed so that B ξ + b = 0.

use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::{Random, ResiduePair};
use hamel_language::model::points::Moved;
use hamel_language::model::{Model, class};

/// Returns velocities that satisfy all constraints of a model, with their symbols, by changing those of a point.
pub(super) fn satisfying_constraints(model: &Model, point: FieldPoint) -> Option<Moved> {
    let rows = model.constraints.iter().flat_map(|c| c.row.clone());
    let rows: Vec<Edge> = rows.collect();
    satisfying_rows(model, &rows, point)
}

/// Does the same with other expressions for the rows of B; in the full frame with time ξ⁰ is 1.
pub(super) fn satisfying_rows(
    model: &Model,
    rows: &[Edge],
    mut point: FieldPoint,
) -> Option<Moved> {
    let places = places(&model.graph, class::VELOCITY);
    let shifts: Vec<Edge> = model.constraints.iter().map(|c| c.shift).collect();
    let mut xi: Vec<ResiduePair> = places.iter().map(|&place| point.symbol(place)).collect();
    let time = model.clock.filter(|_| model.spans).map(|clock| clock.xi);
    if let Some(time) = time {
        xi[time] = ResiduePair::ONE;
    }
    let mut rows = evaluate_at(&model.graph, rows, &mut point)?;
    let mut shifts = evaluate_at(&model.graph, &shifts, &mut point)?;
    if let Some(time) = time {
        for (row, shift) in rows.chunks_mut(xi.len()).zip(&mut shifts) {
            *shift = *shift + std::mem::replace(&mut row[time], ResiduePair::ZERO);
        }
    }
    let moved = solve_for_velocities(&rows, &shifts, &xi)?;
    Some(places.into_iter().zip(moved).collect())
}

/// Changes the dependent entries of ξ by elimination, so that B ξ + b = 0; `None` if there is no solution.
pub(super) fn solve_for_velocities(
    rows: &[ResiduePair],
    shifts: &[ResiduePair],
    xi: &[ResiduePair],
) -> Option<Vec<ResiduePair>> {
    let n = xi.len();
    let mut rows: Vec<Vec<ResiduePair>> = rows
        .chunks(n.max(1))
        .zip(shifts)
        .map(|(row, &shift)| [row, &[shift]].concat())
        .collect();
    let mut xi = xi.to_vec();
    let mut pivots: Vec<(usize, usize)> = Vec::new();
    for i in 0..rows.len() {
        let Some(pivot) = (0..n).find(|&j| !rows[i][j].is_zero()) else {
            // The row follows from the others, or contradicts them.
            if rows[i][n].is_zero() {
                continue;
            }
            return None;
        };
        let inverse = rows[i][pivot].inv()?;
        let row: Vec<ResiduePair> = rows[i].iter().map(|&entry| entry * inverse).collect();
        for (k, other) in rows.iter_mut().enumerate() {
            if k != i {
                let factor = other[pivot];
                for (entry, &by) in other.iter_mut().zip(&row) {
                    *entry = *entry - factor * by;
                }
            }
        }
        rows[i] = row;
        pivots.push((i, pivot));
    }
    for &(row, pivot) in &pivots {
        xi[pivot] = (0..n)
            .filter(|j| pivots.iter().all(|(_, pivot)| pivot != j))
            .fold(-rows[row][n], |sum, j| sum - rows[row][j] * xi[j]);
    }
    Some(xi)
}

/// Returns the indices of the symbols of a class.
pub(super) fn places(graph: &Graph, class: u8) -> Vec<usize> {
    let symbols = graph.symbols().iter().enumerate();
    symbols
        .filter(|(_, symbol)| symbol.class == class)
        .map(|(index, _)| index)
        .collect()
}

/// Returns a random virtual velocity v: B v = 0 for the kept rows, and vⁱ = 0 for velocities whose rates are given.
pub(super) fn virtual_velocity(
    model: &Model,
    kept: &[ResiduePair],
    xi: &[ResiduePair],
) -> Option<Vec<ResiduePair>> {
    let n = model.n();
    let mut rows = kept.to_vec();
    for (place, _) in &model.accelerated {
        rows.extend((0..n).map(|j| {
            if j == *place {
                ResiduePair::ONE
            } else {
                ResiduePair::ZERO
            }
        }));
    }
    let seed = xi
        .iter()
        .fold(n as u64, |seed, xi| seed.rotate_left(7) ^ xi.bits());
    let mut random = Random::new(seed);
    let random: Vec<ResiduePair> = (0..n).map(|_| random.element()).collect();
    solve_for_velocities(
        &rows,
        &vec![ResiduePair::ZERO; rows.len() / n.max(1)],
        &random,
    )
}

/// Returns the sum Σ aᵢ bᵢ of numbers modulo p.
pub fn dot(a: &[ResiduePair], b: &[ResiduePair]) -> ResiduePair {
    a.iter()
        .zip(b)
        .fold(ResiduePair::ZERO, |sum, (&x, &y)| sum + x * y)
}

/// Returns a matrix of numbers modulo p, given by rows one after another, times a vector; `count` zeros if the vector
/// is empty.
pub fn multiply(count: usize, rows: &[ResiduePair], vector: &[ResiduePair]) -> Vec<ResiduePair> {
    match vector.len() {
        0 => vec![ResiduePair::ZERO; count],
        n => rows.chunks(n).map(|row| dot(row, vector)).collect(),
    }
}
