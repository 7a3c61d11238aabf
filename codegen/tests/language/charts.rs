//! The tangents of every kind of coordinate.

use hamel_language::algebra::graph::{Edge, Graph};
use hamel_language::algebra::residue_pair::Random;
use hamel_language::model::charts::tangents;
use hamel_language::model::layout::{Block, chart_rate, sample};

/// C K = I on X for every kind of coordinate.
#[test]
fn canonical_velocities_of_the_tangents_are_units() {
    for block in [
        Block::Flat(2),
        Block::Circle,
        Block::Quaternion,
        Block::Rotation,
    ] {
        let mut random = Random::new(7);
        let mut graph = Graph::new(1);
        let point = sample(block, &mut random);
        let x: Vec<Edge> = (0..block.len())
            .map(|i| graph.symbol("x", 2, point[i]))
            .collect();
        for (k, column) in tangents(&mut graph, block, &x).iter().enumerate() {
            let rates = chart_rate(&mut graph, block, &x, column);
            for (i, rate) in rates.into_iter().enumerate() {
                let unit = if i == k { graph.one() } else { graph.zero() };
                assert_eq!(rate, unit, "{block:?}: entry {i} of column {k}");
            }
        }
    }
}
