//! Scales of equations: that of a circle is its radius.

use hamel_algebra::graph::Graph;
use hamel_algebra::residual_scale::{relative_residuals, residual_scales};
use hamel_algebra::residue_pair::Random;

/// x² + z² = r² has terms of size r², and slopes 2 x and 2 z.
#[test]
fn a_circle_is_as_large_as_its_radius() {
    let mut random = Random::new(5);
    let mut graph = Graph::new(1);
    graph.symbol("pi", 0, hamel_algebra::residue_pair::ResiduePair::PI);
    let [r, x, z] = ["r", "x", "z"].map(|name| graph.symbol(name, 2, random.element()));
    let squares = [x, z, r].map(|a| graph.mul(a, a));
    let sum = graph.add(squares[0], squares[1]);
    let circle = graph.sub(sum, squares[2]);
    for r in [1e-6, 1.0, 1e4] {
        let numbers = [0.0, r, 0.6 * r, 0.8 * r];
        let size = residual_scales(&graph, &[circle], &numbers, 2..4)[0];
        assert!((size / (2.8 * r + 2.0 * r * r) - 1.0).abs() < 1e-12);
        assert!(relative_residuals(&graph, &[circle], &numbers, 2..4)[0].abs() < 1e-15);
    }
    assert_eq!(residual_scales(&graph, &[circle], &[0.0; 4], 2..4), [0.0]);
}
