//! Elimination with exact factors, and the base parameters that it leaves.

use super::Base;
use super::candidates::{Known, Relation, candidates, holds, joined};
use super::parameters::Link;
use super::samples::Samples;
use crate::algebra::echelon::Echelon;
use crate::algebra::graph::{Edge, Graph};
use crate::derive::tree::Tree;
use crate::model::Model;

/// Base parameters by the places of parameters among all.
pub struct Found {
    /// The base parameters.
    pub base: Vec<Base>,
    /// Parameters without effect.
    pub idle: Vec<usize>,
}

/// Finds all relations and solves them.
pub fn find(
    model: &mut Model,
    samples: &Samples,
    tree: &Tree,
    links: &[Link],
    total: usize,
) -> Result<Found, String> {
    let massless = |k: usize| links.get(k / 10).is_some_and(|link| !link.present);
    let present: Vec<usize> = (0..total).filter(|&k| !massless(k)).collect();
    let rank = Echelon::new(samples.of(&present)).rank();
    // Links without mass give nothing away: their parameters are eliminated first; the last ones after them.
    let mut order: Vec<usize> = (0..total).filter(|&k| massless(k)).collect();
    let nothing = order.len();
    order.extend(present.iter().rev());
    let known = Known::new(model, samples);
    let mut relations = candidates(model, samples, &known, tree, links);
    let mut solved = solve(&mut model.graph, &relations, &order, nothing);
    if solved.len() + rank < present.len() {
        let dependent: Vec<usize> = solved.iter().map(|(pivot, _)| *pivot).collect();
        let left: Vec<usize> = present
            .iter()
            .copied()
            .filter(|k| !dependent.contains(k))
            .collect();
        for values in samples.relations(&left) {
            let exact = known.all(&mut model.graph, &values).ok_or(
                "it has relations between parameters whose coefficients are neither plain fractions nor built of one or two entries of its poses: write lengths as numbers with few digits, or place frames one on the other by joints",
            )?;
            relations.push(joined(&model.graph, &left, &exact));
        }
        solved = solve(&mut model.graph, &relations, &order, nothing);
    }
    let graph = &model.graph;
    if solved.len() + rank != present.len()
        || !solved
            .iter()
            .all(|(_, relation)| holds(graph, samples, relation))
    {
        return Err(
            "internal check failed: its relations do not agree with the rank of the regressor"
                .into(),
        );
    }
    let zero_column = |k: usize| samples.rows.iter().all(|row| row[k].is_zero());
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
        terms[1..].sort_by_key(|(place, _)| *place);
        Base { kept: k, terms }
    });
    Ok(Found {
        base: base.collect(),
        idle: present
            .iter()
            .copied()
            .filter(|&k| zero_column(k))
            .collect(),
    })
}

/// Reduces relations: each of the result has the factor 1 at its pivot, where all others have 0. Columns are taken in
/// the order given; what is solved for the first `nothing` of them is left out.
fn solve(
    graph: &mut Graph,
    relations: &[Relation],
    order: &[usize],
    nothing: usize,
) -> Vec<(usize, Relation)> {
    let zero = graph.zero();
    let mut rows: Vec<Vec<Edge>> = relations
        .iter()
        .map(|relation| {
            let mut row = vec![zero; order.len()];
            relation.iter().for_each(|&(k, factor)| row[k] = factor);
            row
        })
        .collect();
    let mut pivots = Vec::new();
    for &column in order {
        let done = pivots.len();
        // The pivot 1 first, then the shortest row.
        let cost = |row: &Vec<Edge>| {
            let plain = row[column].abs() == graph.one();
            (!plain, row.iter().filter(|entry| **entry != zero).count())
        };
        let open = (done..rows.len()).filter(|&row| rows[row][column] != zero);
        let Some(found) = open.min_by_key(|&row| cost(&rows[row])) else {
            continue;
        };
        rows.swap(done, found);
        let pivot = rows[done][column];
        let divided = rows[done].iter().map(|&entry| graph.div(entry, pivot));
        let Some(row) = divided.collect::<Option<Vec<Edge>>>() else {
            continue;
        };
        for (index, other) in rows.iter_mut().enumerate() {
            let factor = other[column];
            if index == done || factor == zero {
                continue;
            }
            for (entry, &by) in other.iter_mut().zip(&row) {
                if by != zero {
                    let product = graph.mul(factor, by);
                    *entry = graph.sub(*entry, product);
                }
            }
        }
        rows[done] = row;
        pivots.push(column);
    }
    let all: Vec<usize> = (0..order.len()).collect();
    let solved = pivots
        .iter()
        .zip(&rows)
        .filter(|(pivot, _)| !order[..nothing].contains(pivot));
    solved
        .map(|(&pivot, row)| (pivot, joined(graph, &all, row)))
        .collect()
}
