//! Slopes in floating point agree with symbolic derivatives.

use crate::common::quotients;
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::Graph;
use hamel_algebra::numeric::evaluate;
use hamel_algebra::residue_pair::Random;
use hamel_algebra::slopes::slopes;

#[test]
fn slopes_are_the_numbers_of_symbolic_derivatives() {
    let mut random = Random::new(7);
    let mut graph = Graph::new(0);
    let [a, b] = ["a", "b"].map(|name| graph.symbol(name, 2, random.element()));
    let product = graph.mul(a, b);
    let sum = graph.sub(product, b);
    let mut roots = vec![-product];
    roots.extend(quotients(&mut graph, sum, a));
    roots.push(graph.atan2(sum, b));
    // Along (1, 2) and (0, 1)
    let (one, two) = (graph.one(), graph.ratio(2, 1));
    let mut first = Derivation::new([(a.node(), one), (b.node(), two)]);
    let mut second = Derivation::new([(b.node(), one)]);
    let expected = [
        first.all(&mut graph, &roots),
        second.all(&mut graph, &roots),
    ];
    let before = graph.symbols().len() - 2;
    let row = |own: [f64; 2]| [vec![0.0; before], own.to_vec()].concat();
    let symbols = row([1.7, 0.6]);
    let found = slopes(
        &graph,
        &roots,
        &symbols,
        &[row([1.0, 2.0]), row([0.0, 1.0])],
    );
    for (direction, expected) in expected.iter().enumerate() {
        let expected = evaluate(&graph, expected, &symbols);
        for (found, expected) in found.iter().zip(expected) {
            let error = (found.slope(direction) - expected).abs();
            assert!(
                error <= 1e-14 * expected.abs().max(1.0),
                "{found:?} {expected}"
            );
        }
    }
}
