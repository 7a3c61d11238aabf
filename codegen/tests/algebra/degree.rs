//! Bounds of the degrees of expressions as rational functions.

use hamel_algebra::degree::DegreeBounds;
use hamel_algebra::graph::{Function, Graph};
use hamel_algebra::residue_pair::Random;

#[test]
fn degrees_are_those_of_the_functions() {
    let mut graph = Graph::new(1);
    let mut random = Random::new(6);
    let [a, b, c] = ["a", "b", "c"].map(|name| graph.symbol(name, 2, random.element()));
    let product = graph.mul(a, b);
    let cubic = graph.mul(product, c);
    let sum = graph.add(cubic, a);
    assert_eq!(DegreeBounds::new(&graph, Vec::new()).bound(&[sum]), 3.0);
    // 1/(a b c + a) + 1/b: numerator of degree 3, denominator of degree 4; the sum of both, plus the denominator for
    // sums with other terms.
    let one = graph.one();
    let (x, y) = (
        graph.div(one, sum).expect("not 0"),
        graph.div(one, b).expect("not 0"),
    );
    let both = graph.add(x, y);
    assert_eq!(
        DegreeBounds::new(&graph, Vec::new()).bound(&[both]),
        3.0 + 4.0 + 4.0
    );
    // (a b c + a)/(a b c + a + 1) · (a b c + a + 1) does not grow.
    let more = graph.add(sum, one);
    let quotient = graph.div(sum, more).expect("not 0");
    let inverse = graph.div(one, quotient).expect("not 0");
    let back = graph.div(b, inverse).expect("not 0");
    assert!(DegreeBounds::new(&graph, Vec::new()).bound(&[back]) <= 4.0 + 3.0 + 3.0 + 6.0);
    // b/((a b c + a)/(a b c + a + 1)) + a: the factor of the first term raises its numerator.
    let over = graph.div(b, quotient).expect("not 0");
    let raised = graph.add(over, a);
    let mut degrees = DegreeBounds::new(&graph, Vec::new());
    assert_eq!(degrees.bound(&[raised]), 4.0 + 3.0 + 3.0);
    // A coordinate of a circle, the sine of 3 a, and a root.
    let circle = vec![Some(0)];
    assert_eq!(
        DegreeBounds::new(&graph, circle).bound(&[a]),
        2.0 + 2.0 + 2.0
    );
    let three = graph.ratio(3, 1);
    let triple = graph.mul(three, a);
    let sine = graph.apply(Function::Sin, triple);
    assert_eq!(
        DegreeBounds::new(&graph, Vec::new()).bound(&[sine]),
        36.0 * 6.0
    );
    let root = graph.apply(Function::Sqrt, sum);
    assert_eq!(
        DegreeBounds::new(&graph, Vec::new()).bound(&[root]),
        2.0 * 4.0
    );
}
