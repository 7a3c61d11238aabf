//! Directional derivatives modulo p by dual numbers: value and slope of every node, without a
//! derivative ever being written as an expression.

use super::dual::{Along, Duals};
use super::fp::Fp;
use super::graph::{Edge, Graph};
use super::lane::Lane;
use super::walk::evaluate;

/// A value and its slope.
pub type Dual = (Fp, Fp);

/// Values modulo p with slopes along a direction: one entry for each symbol, 0 beyond its end.
pub(super) fn duals(lane: &Lane, direction: &[Fp]) -> Duals<Lane, Along<impl Fn(usize) -> Fp>> {
    Duals {
        numbers: lane.clone(),
        slopes: Along(|index: usize| direction.get(index).copied().unwrap_or(Fp::ZERO)),
    }
}

/// The expressions and their slopes along `direction` at a point; `None` where something has no value
/// there.
pub fn tangent_at(
    graph: &Graph,
    roots: &[Edge],
    lane: &mut Lane,
    direction: &[Fp],
) -> Option<Vec<Dual>> {
    let mut duals = duals(lane, direction);
    let values = evaluate(graph, roots, &mut duals)?;
    (!duals.numbers.is_stuck()).then_some(values)
}

#[cfg(test)]
mod tests {
    use super::tangent_at;
    use crate::derivation::Derivation;
    use crate::fp::Random;
    use crate::graph::Graph;
    use crate::lane::Lane;
    use crate::numeric::evaluate_at;
    use crate::tests::quotients;

    #[test]
    fn slopes_are_those_of_the_symbolic_derivative() {
        let mut random = Random::new(3);
        let mut graph = Graph::new(1, 0);
        let mut symbol = |graph: &mut Graph, name: &str| {
            let value = random.element();
            graph.symbol(name, 2, value)
        };
        let (a, b) = (symbol(&mut graph, "a"), symbol(&mut graph, "b"));
        let product = graph.mul(a, b);
        let sum = graph.add(product, b);
        let mut roots = quotients(&mut graph, sum, a);
        roots.push(graph.atan2(sum, b));
        // Along (1, 2).
        let two = graph.ratio(2, 1);
        let mut along = Derivation::new([(a.node(), graph.one()), (b.node(), two)]);
        let slopes = along.all(&mut graph, &roots);
        let mut found = 0;
        for seed in 0..40 {
            let mut lane = Lane::new(seed);
            let direction = [1, 2].map(crate::fp::Fp::new);
            (0..2).for_each(|_| lane.push_symbol(random.element()));
            let Some(duals) = tangent_at(&graph, &roots, &mut lane.clone(), &direction) else {
                continue;
            };
            let expected = evaluate_at(&graph, &slopes, &mut lane).expect("has a value");
            let slopes: Vec<_> = duals.iter().map(|dual| dual.1).collect();
            assert_eq!(slopes, expected);
            found += 1;
        }
        assert!(found > 5);
    }
}
