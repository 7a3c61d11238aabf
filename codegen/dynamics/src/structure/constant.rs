//! Rewriting of expressions without the symbols on which their values do not depend.

use super::rates::CoordinateBlock;
use super::variation::Variation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::transplant::substitute;
use hamel_language::model::Model;
use hamel_language::model::layout::identity;

/// Pairs of a symbol's number and the expression that replaces it.
pub type Substitution = Vec<(usize, Edge)>;

/// Returns numbers for all coordinates: no rotation, angle 0, and the number `plain` for plain
/// ones.
pub fn rest_configuration(
    model: &Model,
    graph: &mut Graph,
    parts: &[CoordinateBlock],
    plain: i64,
) -> Substitution {
    let mut set = Substitution::new();
    for part in parts {
        let flat = !part.is_rotor() && part.block.len() == part.block.dimension();
        for (&entry, value) in part.entries(&model.x).iter().zip(identity(part.block)) {
            let value = if flat { plain } else { value as i64 };
            let number = graph.ratio(value, 1);
            set.extend(graph.as_symbol(entry).map(|index| (index, number)));
        }
    }
    set
}

/// Rewrites expressions that depend on no coordinate or velocity such that they contain none of
/// them.
///
/// Expressions that cannot be written in this way remain as they are.
pub fn eliminate_symbols(
    model: &Model,
    graph: &mut Graph,
    parts: &[CoordinateBlock],
    variation: &Variation,
    edges: &[Edge],
) -> Vec<Edge> {
    let open = edges.iter().any(|edge| !graph.is_free(edge.node()));
    if !open {
        return edges.to_vec();
    }
    let moved: Vec<Edge> = model.x.iter().chain(&model.xi).copied().collect();
    let changes = variation.changes(graph, edges, &moved);
    let zero = graph.zero();
    let mut settled = edges.to_vec();
    // Expressions that do change are left alone: with numbers in place of symbols, their own
    // expressions would grow without bound.
    let places: Vec<usize> = (0..edges.len())
        .filter(|&index| !changes[index] && !graph.is_free(edges[index].node()))
        .collect();
    let constant: Vec<Edge> = places.iter().map(|&index| edges[index]).collect();
    for plain in [0, 1] {
        let mut set = rest_configuration(model, graph, parts, plain);
        set.extend(
            model
                .xi
                .iter()
                .filter_map(|&xi| Some((graph.as_symbol(xi)?, zero))),
        );
        let images = substitute(graph, &constant, &set);
        for (&index, image) in places.iter().zip(images) {
            let same = graph.value(image) == graph.value(edges[index]);
            if same && !graph.is_free(settled[index].node()) {
                settled[index] = image;
            }
        }
    }
    settled
}
