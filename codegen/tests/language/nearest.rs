//! The configuration nearest to a start, and the residual if there is none.

use hamel_language::algebra::graph::Graph;
use hamel_language::algebra::residue_pair::ResiduePair;
use hamel_language::model::class;
use hamel_language::model::layout::Block;
use hamel_language::model::nearest::{Nearest, nearest};
use hamel_language::model::points::Points;

/// Searches with constant φ, so that no start helps; returns max |φ|, or infinity for NaN.
fn largest(list: &[f64]) -> Nearest {
    let mut graph = Graph::new(1);
    let phi: Vec<_> = (list.iter().enumerate())
        .map(|(k, _)| graph.symbol(&format!("c{k}"), class::PARAM, ResiduePair::from_i64(3)))
        .map(|edge| (edge, "c".to_owned()))
        .collect();
    graph.symbol("x", class::COORD, ResiduePair::from_i64(5));
    let rows = phi.iter().map(|(edge, _)| *edge).collect();
    let points = Points::new(graph, rows, vec![Block::Flat(1)], list.len());
    let numbers: Vec<f64> = list.iter().copied().chain([0.0]).collect();
    nearest(&points, &phi, &numbers, &[0.0])
}

#[test]
fn what_is_no_number_is_not_close() {
    for list in [[f64::NAN, 1e-13], [1e-13, f64::NAN]] {
        assert_eq!(largest(&list), Nearest::Nowhere(f64::INFINITY));
    }
    assert_eq!(largest(&[1.0, -2.0]), Nearest::Nowhere(2.0));
}
