//! Slopes modulo p by dual numbers agree with symbolic derivatives.

use crate::common::quotients;
use hamel_algebra::derivation::Derivation;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Graph;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::Random;
use hamel_algebra::tangent::tangent_at;

#[test]
fn slopes_are_those_of_the_symbolic_derivative() {
    let mut random = Random::new(3);
    let mut graph = Graph::new(0);
    let [a, b] = ["a", "b"].map(|name| graph.symbol(name, 2, random.element()));
    let product = graph.mul(a, b);
    let sum = graph.add(product, b);
    let mut roots = quotients(&mut graph, sum, a);
    roots.push(graph.atan2(sum, b));
    // Along (1, 2)
    let two = graph.ratio(2, 1);
    let mut along = Derivation::new([(a.node(), graph.one()), (b.node(), two)]);
    let slopes = along.all(&mut graph, &roots);
    let mut found = 0;
    for _ in 0..40 {
        let mut point = FieldPoint::new();
        let direction = [1, 2].map(hamel_algebra::residue_pair::ResiduePair::new);
        (0..2).for_each(|_| point.push_symbol(random.element()));
        let Some(duals) = tangent_at(&graph, &roots, &mut point.clone(), &direction) else {
            continue;
        };
        let expected = evaluate_at(&graph, &slopes, &mut point).expect("has a value");
        let slopes: Vec<_> = duals.iter().map(|dual| dual.1).collect();
        assert_eq!(slopes, expected);
        found += 1;
    }
    assert!(found > 5);
}
