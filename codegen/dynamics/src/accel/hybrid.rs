//! Hybrid dynamics: if the rates of some velocities are given, M ξ̇ = f − h − ∂V is solved for the others, and the
//! rows of the given ones yield the forces of their drives (Featherstone, *Rigid Body Dynamics Algorithms*, 2008,
//! 9.2).

use super::parts::EquationTerms;
use hamel_algebra::graph::Edge;
use hamel_language::model::Model;

/// Returns the indices in ξ of the velocities whose rates are not given.
pub fn free_velocities(model: &Model) -> Vec<usize> {
    let given = |i: &usize| model.accelerated.iter().any(|(place, _)| place == i);
    (0..model.n()).filter(|i| !given(i)).collect()
}

/// Restricts M and the right-hand sides to the free velocities, in the traced model's graph; returns them unchanged
/// if no rate is given.
pub fn restrict_to_free(mut traced: Model, parts: &EquationTerms) -> (Model, EquationTerms) {
    if traced.accelerated.is_empty() {
        return (traced, parts.clone());
    }
    let places = free_velocities(&traced);
    let of = |list: &[Edge]| places.iter().map(|&i| list[i]).collect::<Vec<Edge>>();
    let graph = &mut traced.graph;
    let driven: Vec<Edge> = (places.iter())
        .map(|&i| {
            let terms = traced.accelerated.iter();
            let terms: Vec<Edge> = terms
                .map(|&(j, rate)| -graph.mul(parts.mass[i][j], rate))
                .collect();
            graph.sum(&terms)
        })
        .collect();
    let mut groups: Vec<Vec<Edge>> = parts.groups.iter().map(|group| of(group)).collect();
    groups.push(driven);
    let free = EquationTerms {
        mass: places.iter().map(|&i| of(&parts.mass[i])).collect(),
        groups,
        ..EquationTerms::default()
    };
    (traced, free)
}

/// Extends ξ̇ of the velocities whose rates are not given to all velocities, by the given rates.
pub fn expand_rates(model: &Model, free: Vec<Edge>) -> Vec<Edge> {
    if model.accelerated.is_empty() {
        return free;
    }
    let mut free = free.into_iter();
    let given = |i: usize| model.accelerated.iter().find(|(place, _)| *place == i);
    (0..model.n())
        .filter_map(|i| given(i).map(|(_, rate)| *rate).or_else(|| free.next()))
        .collect()
}

/// Extends the pivots of the velocities whose rates are not given to all velocities: 1 for a velocity whose rate is
/// given, which requires no inertia.
pub fn expand_pivots(model: &Model, free: Vec<Edge>) -> Vec<Edge> {
    let mut all = vec![model.graph.one(); model.n()];
    for (place, pivot) in free_velocities(model).into_iter().zip(free) {
        all[place] = pivot;
    }
    all
}

/// Replaces the given rates in ξ̇ by their exact expressions.
pub fn insert_given_rates(model: &Model, mut xi_dot: Vec<Edge>) -> Vec<Edge> {
    for &(place, rate) in &model.accelerated {
        xi_dot[place] = rate;
    }
    xi_dot
}
