//! Resubstitution saves operations and preserves values.

mod sieve;

use hamel_algebra::graph::{Edge, Graph, Node};
use hamel_algebra::residue_pair::Random;
use hamel_algebra::resubstitute::resubstitute;

/// Returns the number of operations at run time.
fn cost(graph: &Graph, roots: &[Edge]) -> usize {
    let operates = |node| matches!(node, Node::Add(..) | Node::Mul(..) | Node::Div(..));
    let ids = graph.reachable(roots).into_iter();
    ids.filter(|&id| !graph.is_free(id) && operates(graph.node(id)))
        .count()
}

/// x (a + b) + c is x a + c plus x b: the sum a + b, which has no other use, disappears.
#[test]
fn a_sum_that_is_only_multiplied_is_spread() {
    let mut graph = Graph::new(1);
    let mut random = Random::new(5);
    let [a, b, c, d, x, y] = ["a", "b", "c", "d", "x", "y"].map(|name| {
        let value = random.element();
        graph.symbol(name, 2, value)
    });
    let base = graph.clone();
    let sum = graph.add(a, b);
    let mut roots = Vec::new();
    for (factor, more, negative) in [(x, c, false), (y, d, true)] {
        for summand in [a, sum] {
            let product = graph.mul(factor, summand);
            roots.push(graph.add(product.signed(negative), more));
        }
    }
    let (better, edges) = resubstitute(&graph, &roots, &base).expect("one operation less");
    assert_eq!((cost(&graph, &roots), cost(&better, &edges)), (9, 8));
    for (old, new) in roots.iter().zip(&edges) {
        assert_eq!(graph.value(*old), better.value(*new));
    }
}

/// (a b + c) and (a b + c + d), the second built separately as ((a b + d) + c): resubstitution finds that it is the
/// first plus d.
#[test]
fn a_sum_that_is_there_is_used() {
    let mut graph = Graph::new(1);
    let mut random = Random::new(4);
    let [a, b, c, d] = ["a", "b", "c", "d"].map(|name| {
        let value = random.element();
        graph.symbol(name, 2, value)
    });
    let base = graph.clone();
    let product = graph.mul(a, b);
    let first = graph.add(product, c);
    let other = graph.add(product, d);
    let second = graph.add(other, c);
    // d needs another use.
    let third = graph.mul(c, d);
    let roots = [first, second, third];
    let (better, edges) = resubstitute(&graph, &roots, &base).expect("one operation less");
    assert_eq!((cost(&graph, &roots), cost(&better, &edges)), (5, 4));
    for (old, new) in roots.iter().zip(&edges) {
        assert_eq!(graph.value(*old), better.value(*new));
    }
}
