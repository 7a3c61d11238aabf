//! Elimination of velocities by constraints B(x, t) ξ = 0 and by time: ξ = C ξₐ + c with the active velocities ξₐ,
//! and the model in ξₐ.
//!
//! Without explicit time c = 0. With it, c results from inserting ξ⁰ = 1, so that a row B ξ = b ξ⁰ becomes affine.
//!
//! A row is solved for a velocity whose coefficient is constant at run time, so that nothing is divided by an
//! expression that may vanish on X. Rows without such a coefficient are kept and get multipliers. Loops with
//! varying coefficients are kept too, because integrating a velocity that was solved for would let its coordinate
//! drift away from the loop. With C the equations of motion are Cᵀ (M ξ̇ + Γ ξ ξ + ∂V − f) = 0; for an inactive
//! velocity of an adapted frame these are the active rows of KR18 (30).

mod kinetic;
mod projection;
mod redundant;
mod rows;

pub use kinetic::{VelocityParametrization, velocity_drift};

use crate::inertia;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::numeric::evaluate;
use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::pfaffian::{Kind, Pfaffian};
use hamel_language::model::{FullFrame, Model};
use hamel_language::syntax::ast::Span;
use projection::ModelProjection;
pub use redundant::dropped_row_warnings;
use redundant::{contradicting_row_error, redundant_row_error};
pub use rows::{independent_rows, normalize_row};
use rows::{select_rows, start_values};
use std::sync::Arc;

/// Largest ratio at the start of another coefficient of the same row, or of the same velocity in other rows, to a
/// coefficient that is used as a pivot.
///
/// A solution by a smaller pivot would lose twice as many digits as that ratio has. A row without pivots gets a
/// multiplier.
const MAX_COEFFICIENT_RATIO: f64 = 30.0;

/// Result of solving constraints: the active velocities, and the model in them.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// Model in ξₐ; its constraints are the rows that are kept.
    pub model: Model,
    /// Places of ξₐ in ξ.
    pub active: Vec<usize>,
    /// Rows that were solved, each with the velocity that it determines.
    pub solved: Vec<(usize, usize)>,
    /// Rows that are kept, by their places among the constraints.
    pub kept: Vec<usize>,
    /// Rows that follow from the others everywhere and are left out, by their places among the constraints.
    pub dropped: Vec<usize>,
    /// Affine map ξ = C ξₐ + c, in `graph`.
    pub parametrization: VelocityParametrization,
    /// Graph of the full model, with C and c.
    pub graph: Graph,
    /// Image of each symbol of the full model, in the graph of the reduced model.
    pub images: Vec<Edge>,
}

/// Solves the constraints of a model as far as constant coefficients allow; `None` if the model has no constraints.
///
/// # Errors
///
/// A diagnostic if rows contradict one another, are redundant and cannot be left out, cannot be solved as the
/// description demands, or leave no motion.
pub fn reduce(model: &Model) -> Result<Option<Reduction>, Diagnostic> {
    if !model.is_constrained() {
        return Ok(None);
    }
    let mut full = model.clone();
    let Echelon {
        rows,
        solved,
        mut dropped,
    } = eliminate(&mut full)?;
    let n = full.n();
    let active: Vec<usize> = (0..n)
        .filter(|&i| model.clock.is_none_or(|clock| clock.xi != i))
        .filter(|&i| solved.iter().all(|&(_, velocity)| velocity != i))
        .collect();
    let (kept, rank) = select_rows(&full, &rows, &solved, &mut dropped)?;
    check_given_rates(&full, &rows, &kept, &active)?;
    let drives = |c: &Pfaffian| matches!(c.kind, Kind::Drive { .. });
    let driven = model.constraints.iter().any(drives);
    // If drives leave nothing that moves freely, the equations of motion still give the forces that the drives
    // need.
    if active.len() < rank || active.len() == rank && !driven {
        let span = model.constraints.last().map_or(model.span, |c| c.span);
        return Err(Diagnostic::new(
            span,
            format!(
                "the constraints leave no motion: {} rows for {n} velocities",
                solved.len() + rank
            ),
        )
        .help("remove a constraint, or add velocities"));
    }
    let graph = &mut full.graph;
    let mut complement = vec![vec![graph.zero(); active.len()]; n];
    for (place, &i) in active.iter().enumerate() {
        complement[i][place] = graph.one();
    }
    let mut shift = vec![graph.zero(); n];
    if let Some(clock) = model.clock {
        shift[clock.xi] = graph.one();
    }
    let mut pivots = Vec::new();
    for &(row, velocity) in &solved {
        let pivot = rows[row][velocity];
        for (place, &i) in active.iter().enumerate() {
            complement[velocity][place] = graph
                .div(-rows[row][i], pivot)
                .ok_or_else(|| Diagnostic::new(model.constraints[row].span, "division by zero"))?;
        }
        if let Some(clock) = model.clock {
            shift[velocity] = graph
                .div(-rows[row][clock.xi], pivot)
                .ok_or_else(|| Diagnostic::new(model.constraints[row].span, "division by zero"))?;
        }
        if graph.as_rational(pivot).is_none() {
            pivots.push(graph.mul(pivot, pivot));
        }
    }
    let zero = graph.zero();
    let rows: Vec<(Vec<Edge>, Edge)> = kept
        .iter()
        .map(|&row| {
            let shift = model.clock.map_or(zero, |clock| rows[row][clock.xi]);
            (active.iter().map(|&i| rows[row][i]).collect(), shift)
        })
        .collect();
    let graph = full.graph.clone();
    // Whether every velocity is either active or a given function of time.
    let given = kept.is_empty()
        && model.clock.is_some()
        && (0..n).all(|i| active.contains(&i) || complement[i].iter().all(|&entry| entry == zero));
    let parametrization = VelocityParametrization { complement, shift };
    let before = full.clone();
    let projection = ModelProjection::new(full, &active, &parametrization);
    let images = projection.images.clone();
    let mut model = projection.model(&rows, &kept, &pivots);
    model.overconstrained = kept.len() > rank;
    model.augmented = !kept.is_empty() && inertia::is_mass_matrix_singular(&model);
    model.full_frame = given.then(|| FullFrame {
        full: Arc::new(before),
        images: images.clone(),
        active: active.clone(),
    });
    Ok(Some(Reduction {
        model,
        graph,
        images,
        active,
        solved,
        kept,
        dropped,
        parametrization,
    }))
}

/// Matrix B in echelon form, by constant pivots.
struct Echelon {
    rows: Vec<Vec<Edge>>,
    /// Pivots (row, velocity).
    solved: Vec<(usize, usize)>,
    /// Rows of which nothing is left.
    dropped: Vec<usize>,
}

fn eliminate(model: &mut Model) -> Result<Echelon, Diagnostic> {
    let numbers = start_values(model);
    let constraints = model.constraints.clone();
    let graph = &mut model.graph;
    let zero = graph.zero();
    let mut rows: Vec<Vec<Edge>> = constraints.iter().map(|c| c.row.clone()).collect();
    let mut solved: Vec<(usize, usize)> = Vec::new();
    let is_time = |velocity: usize| model.clock.is_some_and(|clock| clock.xi == velocity);
    let stays = |velocity: usize| {
        model
            .independent
            .iter()
            .any(|(place, _)| *place == velocity)
    };
    let sizes = |graph: &Graph, row: &[Edge]| -> Vec<f64> {
        let values = evaluate(graph, row, &numbers);
        values.into_iter().map(f64::abs).collect()
    };
    let mut at_start: Vec<Vec<f64>> = rows.iter().map(|row| sizes(graph, row)).collect();
    let kept: Vec<bool> = constraints
        .iter()
        .map(|c| needs_multiplier(graph, c))
        .collect();
    loop {
        // Largest entry of each column in the rows that are still to be solved.
        let open = (0..rows.len()).filter(|i| solved.iter().all(|&(row, _)| row != *i));
        let tallest = open.fold(vec![0.0_f64; model.xi.len()], |most, i| {
            let pairs = most.iter().zip(&at_start[i]);
            pairs.map(|(most, size)| most.max(*size)).collect()
        });
        let mut best = None;
        for i in 0..constraints.len() {
            if kept[i] || solved.iter().any(|&(row, _)| row == i) {
                continue;
            }
            // The two largest entries of the row; if there is only one, no digits are lost.
            let moving = at_start[i].iter().enumerate();
            let moving = moving.filter(|&(k, _)| !is_time(k));
            let [top, second] =
                moving.fold([(0, 0.0); 2], |[top, second], (k, &size)| match size {
                    size if size > top.1 => [(k, size), top],
                    size if size > second.1 => [top, (k, size)],
                    _ => [top, second],
                });
            // Do not solve for a velocity with a prescribed rate, unless it is the only one in its row: the row can
            // determine another velocity or get a multiplier.
            let alone = (0..rows[i].len())
                .filter(|&j| rows[i][j] != zero && !is_time(j))
                .count()
                == 1;
            let driven = |j: usize| !alone && model.accelerated.iter().any(|given| given.0 == j);
            for (j, &entry) in rows[i].iter().enumerate() {
                let unfit = entry == zero || is_time(j) || stays(j) || driven(j);
                if unfit || !graph.is_free(entry.node()) {
                    continue;
                }
                let beside = if j == top.0 { second.1 } else { top.1 };
                if beside > 0.0 && at_start[i][j] * MAX_COEFFICIENT_RATIO < beside.max(tallest[j]) {
                    continue;
                }
                let effort = match graph.as_rational(entry) {
                    Some(_) if entry.abs() == graph.one() => 0,
                    Some(_) => 1,
                    None if evaluate(graph, &[entry], &numbers)[0].abs() > 1e-9 => 2,
                    None => continue,
                };
                let others = rows.iter().filter(|row| row[j] != zero).count();
                let key = (effort, others, i, j);
                if best.is_none_or(|least| key < least) {
                    best = Some(key);
                }
            }
        }
        let Some((_, _, row, velocity)) = best else {
            break;
        };
        let pivot_row = rows[row].clone();
        for (other, entries) in rows.iter_mut().enumerate() {
            if other == row || entries[velocity] == zero {
                continue;
            }
            let Some(factor) = graph.div(entries[velocity], pivot_row[velocity]) else {
                continue;
            };
            for (entry, &pivot) in entries.iter_mut().zip(&pivot_row) {
                let product = graph.mul(factor, pivot);
                *entry = graph.sub(*entry, product);
            }
            at_start[other] = sizes(graph, entries);
        }
        solved.push((row, velocity));
    }
    let mut dropped = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        if row.iter().all(|&entry| entry == zero) {
            if matches!(constraints[i].kind, Kind::Drive { .. }) {
                return Err(redundant_row_error(&constraints, i, ""));
            }
            dropped.push(i);
            continue;
        }
        if (0..row.len()).all(|j| row[j] == zero || is_time(j)) {
            return Err(contradicting_row_error(&constraints, i));
        }
        if !kept[i] && solved.iter().all(|&(row, _)| row != i) {
            check_independent(model, &model.graph, (row, &constraints[i]))?;
        }
    }
    Ok(Echelon {
        rows,
        solved,
        dropped,
    })
}

/// Returns whether integration must be led back to a constraint, so that it needs its multiplier.
///
/// This holds for stabilised constraints, and for loops with varying coefficients. A loop with constant
/// coefficients, such as a gear ratio, is preserved by every integration method.
fn needs_multiplier(graph: &Graph, constraint: &Pfaffian) -> bool {
    let bent = |entry: &Edge| !graph.is_free(entry.node());
    constraint.stabilized.is_some()
        || constraint.kind == Kind::Loop && constraint.row.iter().any(bent)
}

/// Returns an error if a row could be solved only for velocities that the user declared as independent.
fn check_independent(
    model: &Model,
    graph: &Graph,
    (row, constraint): (&[Edge], &Pfaffian),
) -> Result<(), Diagnostic> {
    let fits = |&&(place, _): &&(usize, Span)| {
        row[place] != graph.zero() && graph.is_free(row[place].node())
    };
    let Some(&(place, span)) = model.independent.iter().find(fits) else {
        return Ok(());
    };
    let others = (0..row.len()).filter(|&j| row[j] != graph.zero() && j != place);
    let name = entry_name(model, place);
    let message = match others.count() {
        0 => format!("`{name}` cannot be independent: a constraint determines it"),
        _ => format!("`{name}` cannot be independent: a constraint can be solved only for it"),
    };
    let error = Diagnostic::new(span, message)
        .help("remove from `independent` a velocity whose factor in this constraint is constant");
    Err(error.note(constraint.span, "this constraint"))
}

/// Returns the name of an entry of ξ.
fn entry_name(model: &Model, place: usize) -> String {
    let node = model.xi[place].node();
    let mut symbols = model.graph.symbols().iter();
    symbols
        .find(|s| s.node == node)
        .map_or(String::new(), |s| s.name.clone())
}

/// Checks that velocities with given rates are active, and that the kept rows leave them free at the start.
fn check_given_rates(
    full: &Model,
    rows: &[Vec<Edge>],
    kept: &[usize],
    active: &[usize],
) -> Result<(), Diagnostic> {
    let edges: Vec<Edge> = (kept.iter())
        .flat_map(|&row| active.iter().map(move |&i| rows[row][i]))
        .collect();
    let values = evaluate(&full.graph, &edges, &start_values(full));
    let mut given: Vec<Vec<f64>> = values
        .chunks(active.len().max(1))
        .map(normalize_row)
        .collect();
    let mut rank = independent_rows(given.clone()).len();
    for &(velocity, _) in &full.accelerated {
        let place = active.iter().position(|&i| i == velocity);
        if let Some(place) = place {
            let entries = (0..active.len()).map(|i| f64::from(i == place));
            given.push(entries.collect());
            if independent_rows(given.clone()).len() > rank {
                rank += 1;
                continue;
            }
        }
        let name = entry_name(full, velocity);
        let message = match place {
            Some(_) => format!(
                "the rate of `{name}` is prescribed, but the constraints already determine it at the start"
            ),
            None => {
                format!(
                    "the rate of `{name}` is prescribed, but a constraint determines this velocity"
                )
            }
        };
        let error = Diagnostic::new(full.velocity_spans[velocity], message);
        return Err(error.help("prescribe the rate of a velocity that the constraints and the rates prescribed before it leave free"));
    }
    Ok(())
}
