//! Mixed second derivatives by hyper-dual numbers agree with symbolic derivatives.

use crate::common::quotients;
use hamel_algebra::derivation::Derivation;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::jets::Seeds;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::{Random, ResiduePair};
use hamel_algebra::tape::Tape;

/// The chain rule for symbols s, t, a(s, t) = s t + s, b(s, t) = s² − t, and functions of a and b.
#[test]
fn mixed_derivatives_are_those_of_the_symbolic_derivative() {
    let mut random = Random::new(5);
    let mut graph = Graph::new(0);
    let [s, t, a, b] = ["s", "t", "a", "b"].map(|name| graph.symbol(name, 2, random.element()));
    let product = graph.mul(a, b);
    let mut roots = vec![graph.sub(product, b)];
    roots.extend(quotients(&mut graph, roots[0], a));
    roots.push(graph.atan2(roots[0], b));
    let seeded = |graph: &mut Graph, seeds: [(Edge, Edge); 3]| {
        let _ = &graph;
        Derivation::new(seeds.map(|(symbol, seed)| (symbol.node(), seed)))
    };
    // a₁ = t + 1, b₁ = 2 s; a₂ = s, b₂ = −1; a₁₂ = 1, b₁₂ = 0
    let one = graph.one();
    let (more, twice) = (graph.add(t, one), graph.add(s, s));
    let mut by_s = seeded(&mut graph, [(s, one), (a, more), (b, twice)]);
    let mut by_t = seeded(&mut graph, [(t, one), (a, s), (b, -one)]);
    let along = by_s.all(&mut graph, &roots);
    let across = by_t.all(&mut graph, &roots);
    let mixed = by_t.all(&mut graph, &along);
    let tape = Tape::new(&graph, &roots).expect("numbers");
    let mut found = 0;
    for _ in 0..40 {
        let mut point = FieldPoint::new();
        (0..4).for_each(|_| point.push_symbol(random.element()));
        let (s, t) = (point.symbol(0), point.symbol(1));
        let (zero, one) = (ResiduePair::ZERO, ResiduePair::ONE);
        let seeds = Seeds {
            along: vec![one, zero, t + one, s + s],
            across: vec![vec![zero, one, s, -one], vec![]],
            mixed: vec![vec![zero, zero, one, zero]],
        };
        let Some(jets) = tape.jets(&point, &seeds) else {
            continue;
        };
        let expect =
            |edges: &[Edge]| evaluate_at(&graph, edges, &mut point.clone()).expect("a value");
        let tables = [
            expect(&roots),
            expect(&along),
            expect(&across),
            expect(&mixed),
        ];
        for (i, jet) in jets.iter().enumerate() {
            assert_eq!(
                [jet.value, jet.along, jet.across[0], jet.mixed[0]],
                [tables[0][i], tables[1][i], tables[2][i], tables[3][i]],
                "expression {i}"
            );
            assert_eq!([jet.across[1], jet.mixed[1]], [zero, zero]);
        }
        assert_eq!(tape.values(&point), Some(tables[0].clone()));
        found += 1;
    }
    assert!(found > 5);
}
