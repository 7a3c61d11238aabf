//! Rows of second derivatives by reverse accumulation agree with hyper-dual numbers.

use crate::common::functions;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Graph;
use hamel_algebra::jets::Seeds;
use hamel_algebra::residue_pair::{Random, ResiduePair};
use hamel_algebra::tape::Tape;

#[test]
fn rows_are_the_mixed_derivatives_of_jets() {
    let mut random = Random::new(11);
    let mut graph = Graph::new(0);
    let [a, b, c] = ["a", "b", "c"].map(|name| graph.symbol(name, 2, random.element()));
    let product = graph.mul(a, b);
    let mut sum = graph.sub(c, product);
    for function in functions() {
        let value = graph.apply(function, sum);
        let quotient = graph.div(value, product).expect("not 0");
        sum = graph.add(sum, quotient);
    }
    let angle = graph.atan2(sum, a);
    let root = graph.mul(angle, sum);
    let tape = Tape::new(&graph, &[root]).expect("has a tape");
    let first = graph.symbols().len() - 3;
    let unit = |k: usize| -> Vec<ResiduePair> {
        (0..first + 3)
            .map(|i| {
                if i == first + k {
                    ResiduePair::ONE
                } else {
                    ResiduePair::ZERO
                }
            })
            .collect()
    };
    let mut found = 0;
    // In both fields, both roots have values at one point in sixteen.
    for _ in 0..240 {
        let mut point = FieldPoint::new();
        (0..first + 3).for_each(|_| point.push_symbol(random.element()));
        for k in 0..3 {
            let seeds = Seeds {
                along: unit(k),
                across: (0..3).map(unit).collect(),
                mixed: Vec::new(),
            };
            let Some(jets) = tape.jets(&point, &seeds) else {
                continue;
            };
            let row = tape
                .second_derivative(&point, &unit(k))
                .expect("has a value there, too");
            assert_eq!(row[first..], jets[0].mixed[..]);
            found += 1;
        }
    }
    assert!(found > 10, "{found} points had values");
}
