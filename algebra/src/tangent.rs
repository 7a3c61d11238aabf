//! Directional derivatives modulo p by dual numbers: value and slope of every node, without a
//! derivative ever being written as an expression.

use super::fp::Fp;
use super::graph::{Edge, Function, Graph, Node};
use super::lane::Lane;

/// A value and its slope.
pub type Dual = (Fp, Fp);

/// The expressions and their slopes along `direction` (one entry for each symbol, 0 beyond its end)
/// at a point; `None` where something has no value there.
pub fn tangent_at(
    graph: &Graph,
    roots: &[Edge],
    lane: &mut Lane,
    direction: &[Fp],
) -> Option<Vec<Dual>> {
    let zero = (Fp::ZERO, Fp::ZERO);
    let mut values = vec![zero; graph.len()];
    // The number 1 is the atom of constant angles.
    values[1] = (Fp::ONE, Fp::ZERO);
    let read = |values: &[Dual], edge: Edge| {
        let (value, slope) = values[edge.node() as usize];
        if edge.is_negative() {
            (-value, -slope)
        } else {
            (value, slope)
        }
    };
    for id in graph.reachable(roots) {
        values[id as usize] = match graph.node(id) {
            Node::Constant(index) => (Fp::from_rational(graph.constant(index))?, Fp::ZERO),
            Node::Symbol(index) => {
                let index = index as usize;
                let slope = direction.get(index).copied().unwrap_or(Fp::ZERO);
                (lane.symbol(index), slope)
            }
            Node::Add(a, b) => {
                let (a, b) = (read(&values, a), read(&values, b));
                (a.0 + b.0, a.1 + b.1)
            }
            Node::Mul(a, b) => {
                let (a, b) = (read(&values, a), read(&values, b));
                (a.0 * b.0, a.1 * b.0 + a.0 * b.1)
            }
            Node::Div(a, b) => {
                let (a, b) = (read(&values, a), read(&values, b));
                let inverse = b.0.inv()?;
                let quotient = a.0 * inverse;
                (quotient, (a.1 - quotient * b.1) * inverse)
            }
            Node::Apply(function, a) => {
                let (argument, slope) = read(&values, a);
                let form: Vec<_> = graph
                    .form(function, a)
                    .into_iter()
                    .map(|(atom, c)| (values[atom as usize].0, c))
                    .collect();
                let value = lane.function(function, argument, &form);
                let factor = lane.slope(function, argument, &form, value)?;
                (value, factor * slope)
            }
            Node::Atan2(y, x) => {
                let (y, x) = (read(&values, y), read(&values, x));
                let square = x.0 * x.0 + y.0 * y.0;
                let value = lane.opaque(Function::Atan2, y.0, x.0);
                (value, (x.0 * y.1 - y.0 * x.1) * square.inv()?)
            }
        };
    }
    (!lane.is_stuck()).then(|| roots.iter().map(|&root| read(&values, root)).collect())
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
