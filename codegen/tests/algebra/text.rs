//! Short expressions as text: parentheses only where necessary.

use hamel_algebra::graph::Graph;
use hamel_algebra::residue_pair::Random;
use hamel_algebra::text::short;

#[test]
fn parentheses_stand_where_they_are_needed() {
    let mut graph = Graph::new(1);
    let value = |seed: u64| Random::new(seed).element();
    let a = graph.symbol("a", 2, value(11));
    let b = graph.symbol("b", 2, value(23));
    let sum = graph.sub(a, b);
    let product = graph.mul(sum, b);
    let quotient = graph
        .div(product, sum)
        .and_then(|_| graph.div(a, product))
        .expect("not 0");
    assert_eq!(short(&graph, -product, 40).as_deref(), Some("-b * (a - b)"));
    assert_eq!(
        short(&graph, quotient, 40).as_deref(),
        Some("a / (b * (a - b))")
    );
    assert_eq!(short(&graph, quotient, 10), None);
}
