//! Selection of the rows to keep among those that were not solved: all rows that add information.

use super::redundant::{contradicting_row_error, redundant_row_error};
use hamel_algebra::graph::Edge;
use hamel_algebra::numeric::{evaluate, rank};
use hamel_algebra::residue_pair::{Random, ResiduePair};
use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::Model;
use hamel_language::model::pfaffian::Kind;

/// Size, relative to the largest row, below which the part of a row orthogonal to the previous rows makes it
/// redundant.
const REDUNDANCY_TOLERANCE: f64 = 1e-8;

/// Distance from the start, in the units of the coordinates, at which rows are compared.
const COMPARISON_DISTANCE: f64 = 1.0 / 1024.0;

/// Largest ratio of the largest remaining row to the first one that may come next.
const MAX_ROW_RATIO: f64 = 8.0;

/// Returns the indices of the constraint rows that multipliers have to enforce, and the number of them that are
/// independent at the start; adds redundant rows to `dropped`.
///
/// A loop may have rows that depend on others where it is closed (an overconstrained mechanism); a nonholonomic
/// constraint may not. Rows that depend on others at every configuration of the tree add no information and are
/// dropped, provided that the rows of which they are multiples do not vanish where the loop is closed: of cos u
/// du = 0 and sin u du = 0, the first one must be kept if u is zero there.
///
/// # Errors
///
/// A diagnostic if a row contradicts the others, or is redundant and cannot be dropped.
pub fn select_rows(
    model: &Model,
    rows: &[Vec<Edge>],
    solved: &[(usize, usize)],
    dropped: &mut Vec<usize>,
) -> Result<(Vec<usize>, usize), Diagnostic> {
    let time = model.clock.map(|clock| clock.xi);
    // Returns the entries of a row except that of ξ⁰.
    let moving = |row: &[Edge]| -> Vec<Edge> {
        let entries = row.iter().enumerate();
        let entries = entries.filter(|(j, _)| Some(*j) != time);
        entries.map(|(_, entry)| *entry).collect()
    };
    let left = (0..rows.len()).filter(|&i| solved.iter().all(|&(row, _)| row != i));
    let left = left.filter(|i| !dropped.contains(i));
    let (loops, others): (Vec<usize>, Vec<usize>) =
        left.partition(|&i| model.constraints[i].kind == Kind::Loop);
    let value = |&entry: &Edge| model.graph.value(entry);
    let at_point =
        |&i: &usize| -> Vec<ResiduePair> { moving(&rows[i]).iter().map(value).collect() };
    let (mut open, mut values): (Vec<usize>, Vec<Vec<ResiduePair>>) = (Vec::new(), Vec::new());
    for &i in &others {
        values.push(at_point(&i));
        open.push(i);
        if rank(values.clone()) == values.len() {
            continue;
        }
        let whole = open.iter().map(|&i| rows[i].iter().map(value).collect());
        if rank(whole.collect()) == open.len() {
            return Err(contradicting_row_error(&model.constraints, i));
        }
        if matches!(model.constraints[i].kind, Kind::Drive { .. }) {
            return Err(redundant_row_error(&model.constraints, i, ""));
        }
        values.pop();
        dropped.extend(open.pop());
    }
    let all: Vec<Vec<Edge>> = open
        .iter()
        .chain(&loops)
        .map(|&i| moving(&rows[i]))
        .collect();
    for place in order_by_size(model, &all, open.len()) {
        values.push(at_point(&loops[place]));
        if rank(values.clone()) < values.len() {
            values.pop();
            dropped.push(loops[place]);
        } else {
            open.push(loops[place]);
        }
    }
    dropped.sort_unstable();
    open.sort_unstable();
    let edges: Vec<Edge> = open.iter().flat_map(|&i| moving(&rows[i])).collect();
    let values = evaluate(&model.graph, &edges, &start_values(model));
    let columns = moving(&model.xi).len().max(1);
    let left: Vec<Vec<f64>> = values.chunks(columns).map(<[f64]>::to_vec).collect();
    let independent: Vec<usize> = (independent_rows(left).into_iter())
        .map(|row| open[row])
        .collect();
    let redundant_row = open
        .iter()
        .find(|i| !independent.contains(i) && model.constraints[**i].kind != Kind::Loop);
    match redundant_row {
        Some(&row) => Err(redundant_row_error(
            &model.constraints,
            row,
            " at the start",
        )),
        None => Ok((open, independent.len())),
    }
}

/// Returns an order of the rows after the first `given` ones in which large rows come first.
///
/// Each next row has a part orthogonal to the previous ones about as large as any other's, at a configuration close
/// to the start, where loops are not quite closed. The rows of which the others are multiples are then not rows
/// that vanish on the loop. Each row is scaled by its size far from there.
fn order_by_size(model: &Model, rows: &[Vec<Edge>], given: usize) -> Vec<usize> {
    let mut random = Random::new(1);
    let mut coordinate = || (random.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
    let step: Vec<f64> = model.xi.iter().map(|_| coordinate()).collect();
    let start = start_values(model);
    let a = evaluate(&model.graph, &model.a.concat(), &start);
    let places: Vec<usize> = model.x.iter().map(|x| x.node() as usize).collect();
    let symbols = model.graph.symbols();
    let at = |far: f64| -> Vec<Vec<f64>> {
        let mut numbers = start.clone();
        for (row, &node) in a.chunks(step.len().max(1)).zip(&places) {
            let moved: f64 = row.iter().zip(&step).map(|(a, h)| a * h).sum();
            let symbol = symbols.iter().position(|s| s.node as usize == node);
            if let Some(number) = symbol.and_then(|symbol| numbers.get_mut(symbol)) {
                *number += far * moved;
            }
        }
        let values = evaluate(&model.graph, &rows.concat(), &numbers);
        let chunks = values.chunks((values.len() / rows.len().max(1)).max(1));
        chunks.map(<[f64]>::to_vec).collect()
    };
    let (mut close, far) = (at(COMPARISON_DISTANCE), at(1.0));
    for (row, far) in close.iter_mut().zip(&far) {
        let size = norm(far);
        if size > 0.0 && size.is_finite() {
            row.iter_mut().for_each(|entry| *entry /= size);
        }
    }
    for row in 0..given {
        remove_component(&mut close, row);
    }
    let mut order: Vec<usize> = Vec::new();
    for _ in given..rows.len() {
        let left = (given..rows.len()).filter(|row| !order.contains(row));
        let largest = left
            .clone()
            .map(|row| norm(&close[row]))
            .fold(0.0, f64::max);
        let large = |row: &usize| norm(&close[*row]) >= largest / MAX_ROW_RATIO;
        let Some(next) = left.clone().find(large).or(left.clone().next()) else {
            break;
        };
        remove_component(&mut close, next);
        order.push(next);
    }
    order.into_iter().map(|row| row - given).collect()
}

/// Removes from all rows their component along one row.
fn remove_component(rows: &mut [Vec<f64>], row: usize) {
    let size = norm(&rows[row]);
    if size > 0.0 && size.is_finite() {
        let unit: Vec<f64> = rows[row].iter().map(|v| v / size).collect();
        for other in rows {
            let along: f64 = other.iter().zip(&unit).map(|(a, b)| a * b).sum();
            let pairs = other.iter_mut().zip(&unit);
            pairs.for_each(|(a, b)| *a -= along * b);
        }
    }
}

fn norm(row: &[f64]) -> f64 {
    row.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Returns the indices of rows of numbers that are numerically independent, as many as there are; the largest come
/// first.
pub fn independent_rows(mut left: Vec<Vec<f64>>) -> Vec<usize> {
    let most = left.iter().map(|row| norm(row)).fold(0.0, f64::max);
    let mut independent = Vec::new();
    loop {
        let sizes = left.iter().map(|row| norm(row)).enumerate();
        let largest = sizes.fold(None, |best: Option<(usize, f64)>, (i, size)| match best {
            Some((_, found)) if size <= found => best,
            _ => Some((i, size)),
        });
        let Some((row, _)) = largest.filter(|(_, size)| *size > REDUNDANCY_TOLERANCE * most) else {
            return independent;
        };
        independent.push(row);
        remove_component(&mut left, row);
        left[row].fill(0.0);
    }
}

/// Returns a row divided by its length; a row of zeros is returned unchanged.
pub fn normalize_row(row: &[f64]) -> Vec<f64> {
    let length = norm(row);
    let divided = row.iter().map(|v| v / length);
    if length > 0.0 {
        divided.collect()
    } else {
        row.to_vec()
    }
}

/// Returns the values of all symbols of a model at the start, in `f64`.
pub fn start_values(model: &Model) -> Vec<f64> {
    let (m, n) = (model.u.len(), model.n());
    let zeros = vec![0.0; n];
    model.numbers(
        &model.defaults,
        &model.start_x,
        &model.start_xi,
        &vec![0.0; m],
        &zeros,
    )
}
