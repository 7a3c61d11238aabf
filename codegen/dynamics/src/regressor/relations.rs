//! Elimination with exact coefficients, and the resulting base parameters.

use super::error::RegressorError;
use super::local_relations::{
    ExactConstants, Relation, is_satisfied, local_relations, relation_of,
};
use super::parameters::{Link, to_second_moments};
use super::samples::RegressorSamples;
use crate::tree::Tree;
use hamel_algebra::echelon::Echelon;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::numeric::evaluate;
use hamel_language::model::Model;

/// Smallest coefficient of a parameter that is solved for, relative to the largest one of its kind in the relation.
///
/// This keeps the coefficients in β from becoming large when an axis is slightly tilted. First moments, second
/// moments and masses are of different kinds.
const MIN_COEFFICIENT_RATIO: f64 = 0.1;

/// Order of the moment that each of the ten parameters of a link is: 2, 1, or 0 for the mass.
const MOMENT_ORDERS: [u8; 10] = [2, 2, 2, 2, 2, 2, 1, 1, 1, 0];

/// Terms of a base parameter: place of the moment that is kept, and all moments with their coefficients; its own, with
/// coefficient 1, comes first.
pub type BaseParameterTerms = (usize, Vec<(usize, Edge)>);

/// Finds all relations between standard parameters, and solves them as relations between moments, some of which are
/// kept.
pub fn solve_relations(
    model: &mut Model,
    samples: &RegressorSamples,
    tree: &Tree,
    links: &[Link],
    total: usize,
) -> Result<Vec<BaseParameterTerms>, RegressorError> {
    let massless = |k: usize| links.get(k / 10).is_some_and(|link| !link.present);
    let present: Vec<usize> = (0..total).filter(|&k| !massless(k)).collect();
    let rank = Echelon::new(samples.columns_of(&present)).rank();
    // Eliminate the parameters of links without mass first, since nothing is lost with them; then the others, the
    // last one first.
    let mut order: Vec<usize> = (0..total).filter(|&k| massless(k)).collect();
    let nothing = order.len();
    order.extend(present.iter().rev());
    let known = ExactConstants::new(model, samples);
    let mut relations = local_relations(model, samples, &known, tree, links);
    let numbers = model.numbers(&model.defaults, &model.start_x, &[], &[], &[]);
    let ordered = (&order[..], nothing);
    let mut solved = solve(&mut model.graph, &numbers, &relations, ordered, links.len());
    if solved.len() + rank < present.len() {
        let dependent: Vec<usize> = solved.iter().map(|(pivot, _)| *pivot).collect();
        let left: Vec<usize> = present
            .iter()
            .copied()
            .filter(|k| !dependent.contains(k))
            .collect();
        for values in samples.relations(&left) {
            let exact = known
                .exact_constants(&mut model.graph, &values)
                .ok_or(RegressorError::InexactRelations)?;
            relations.push(relation_of(&model.graph, &left, &exact));
        }
        solved = solve(&mut model.graph, &numbers, &relations, ordered, links.len());
    }
    let graph = &model.graph;
    if solved.len() + rank != present.len()
        || !solved
            .iter()
            .all(|(_, relation)| is_satisfied(graph, samples, relation))
    {
        return Err(RegressorError::WrongRank);
    }
    let graph = &mut model.graph;
    let relations: Vec<Relation> = relations
        .iter()
        .map(|relation| to_second_moments(graph, links, relation))
        .collect();
    let solved = solve(graph, &numbers, &relations, ordered, links.len());
    if solved.len() + rank != present.len() {
        return Err(RegressorError::UnsolvableRelations);
    }
    let kept = present
        .iter()
        .copied()
        .filter(|k| solved.iter().all(|(pivot, _)| pivot != k));
    // Y_p = −Σ v_k Y_k, so that β_k = π_k − Σ v_k π_p.
    let base = kept.map(|k| {
        let mut terms = vec![(k, graph.one())];
        for (pivot, relation) in &solved {
            let factor = relation.iter().find(|(place, _)| *place == k);
            terms.extend(factor.map(|&(_, factor)| (*pivot, -factor)));
        }
        (k, terms)
    });
    Ok(base.collect())
}

/// Coefficient, and its value with the default parameters of the description.
type Factor = (Edge, f64);

/// Reduces relations so that each has the coefficient 1 at its pivot, where all others have 0.
///
/// Columns are taken in the given order, except that small coefficients come last. Relations solved for one of the
/// first `nothing` columns are left out of the result.
fn solve(
    graph: &mut Graph,
    numbers: &[f64],
    relations: &[Relation],
    (order, nothing): (&[usize], usize),
    links: usize,
) -> Vec<(usize, Relation)> {
    let (zero, one) = (graph.zero(), graph.one());
    let mut symbols = numbers.to_vec();
    symbols.resize(graph.symbols().len(), f64::NAN);
    let mut rows: Vec<Vec<Factor>> = relations
        .iter()
        .map(|relation| {
            let factors: Vec<Edge> = relation.iter().map(|&(_, factor)| factor).collect();
            let values = evaluate(graph, &factors, &symbols);
            let mut row = vec![(zero, 0.0); order.len()];
            for (&(k, factor), value) in relation.iter().zip(values) {
                row[k] = (factor, value);
            }
            row
        })
        .collect();
    let mut pivots: Vec<usize> = Vec::new();
    // Columns that have only small coefficients come last.
    for least in [MIN_COEFFICIENT_RATIO, 0.0] {
        for &column in order {
            if pivots.contains(&column) {
                continue;
            }
            let done = pivots.len();
            // Prefer the pivot ±1, then the shortest row.
            let cost = |row: &Vec<Factor>| {
                let plain = row[column].0.abs() == one;
                let length = row.iter().filter(|(entry, _)| *entry != zero).count();
                (!plain, length)
            };
            let open = (done..rows.len()).filter(|&row| {
                rows[row][column].0 != zero && !is_small(&rows[row], column, links, least)
            });
            let Some(found) = open.min_by_key(|&row| cost(&rows[row])) else {
                continue;
            };
            rows.swap(done, found);
            let pivot = rows[done][column];
            let divided = rows[done]
                .iter()
                .map(|entry| Some((graph.div(entry.0, pivot.0)?, entry.1 / pivot.1)));
            let Some(row) = divided.collect::<Option<Vec<Factor>>>() else {
                continue;
            };
            for (index, other) in rows.iter_mut().enumerate() {
                let factor = other[column];
                if index == done || factor.0 == zero {
                    continue;
                }
                for (entry, &by) in other.iter_mut().zip(&row) {
                    if by.0 != zero {
                        let product = graph.mul(factor.0, by.0);
                        entry.0 = graph.sub(entry.0, product);
                        entry.1 -= factor.1 * by.1;
                    }
                }
            }
            rows[done] = row;
            pivots.push(column);
        }
    }
    let all: Vec<usize> = (0..order.len()).collect();
    let solved = pivots
        .iter()
        .zip(&rows)
        .filter(|(pivot, _)| !order[..nothing].contains(pivot));
    solved
        .map(|(&pivot, row)| {
            let factors: Vec<Edge> = row.iter().map(|&(factor, _)| factor).collect();
            (pivot, relation_of(graph, &all, &factors))
        })
        .collect()
}

/// Returns whether the coefficient of a column is small compared with another one of the same kind and link;
/// parameters of joints, such as an armature, are each of a kind of their own.
fn is_small(row: &[Factor], column: usize, links: usize, least: f64) -> bool {
    if column >= 10 * links {
        return false;
    }
    let (link, kind) = (column / 10, MOMENT_ORDERS[column % 10]);
    let alike = row.iter().enumerate().skip(10 * link).take(10);
    let alike = alike.filter(|(k, _)| MOMENT_ORDERS[k % 10] == kind);
    let largest = alike.fold(0.0, |largest, (_, (_, value))| {
        f64::max(largest, value.abs())
    });
    row[column].1.abs() < least * largest
}
