//! External functions: equality, and slopes by the chain rule.

use hamel_algebra::derivation::Derivation;
use hamel_algebra::dual::{Duals, ForwardMode};
use hamel_algebra::external::{Component, External};
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::residue_pair::{Random, ResiduePair};
use hamel_algebra::walk::evaluate;

fn graph() -> (Graph, [Edge; 2], [ResiduePair; 2]) {
    let mut random = Random::new(9);
    let mut graph = Graph::new(1);
    graph.set_externals(vec![External {
        name: "f".into(),
        arguments: vec!["a".into(), "b".into()],
        components: 2,
    }]);
    let values = [random.element(), random.element()];
    let symbols = [("x", values[0]), ("y", values[1])].map(|(n, v)| graph.symbol(n, 2, v));
    (graph, symbols, values)
}

/// Values are equal for equal component and arguments only, and never become constants, even for constant arguments.
#[test]
fn values_belong_to_component_and_arguments() {
    let (mut graph, [x, y], _) = graph();
    let [first, second] = [0, 1].map(|component| Component::new(0, component, 2));
    let one = graph.external(first, &[x, y]);
    let (sum, back) = (graph.add(x, y), graph.sub(x, y));
    let twice = graph.add(sum, back);
    let two = graph.ratio(2, 1);
    let same = graph.mul(two, x);
    assert_eq!(
        graph.external(first, &[twice, y]),
        graph.external(first, &[same, y])
    );
    for other in [[y, x], [-x, y], [x, -y], [x, x]] {
        assert_ne!(graph.external(first, &other).abs(), one);
    }
    assert_ne!(graph.external(second, &[x, y]), one);
    assert_ne!(
        graph.external(first.differentiate(0), &[x, y]),
        graph.external(first.differentiate(1), &[x, y])
    );
    assert_eq!(
        first.differentiate(0).differentiate(1),
        first.differentiate(1).differentiate(0)
    );
    let number = graph.external(first, &[two, two]);
    assert!(graph.is_free(number.node()) && graph.as_rational(number).is_none());
    assert_eq!(
        graph.external_call_text(first.differentiate(1), "x, y"),
        "f_by_b(x, y)[1]"
    );
}

/// Derivatives as expressions agree with numbers with slopes, including second derivatives.
#[test]
fn slopes_go_by_the_chain_rule() {
    let (mut graph, [x, y], values) = graph();
    let (product, one) = (graph.mul(x, y), graph.one());
    let f = graph.external(Component::new(0, 1, 2), &[product, -x]);
    let whole = graph.mul(f, y);
    let three = graph.ratio(3, 1);
    let mut along = Derivation::new([(x.node(), one), (y.node(), three)]);
    let slope = along.of(&mut graph, whole);
    let bend = along.of(&mut graph, slope);
    let mut point = at(values);
    let seeds = [ResiduePair::ONE, ResiduePair::new(3)];
    let mut duals = Duals {
        numbers: point.clone(),
        slopes: ForwardMode(|index: usize| seeds[index]),
    };
    let expected = evaluate(&graph, &[slope, bend], &mut point).expect("values");
    let found = evaluate(&graph, &[whole, slope], &mut duals).expect("slopes");
    assert_eq!([found[0].1, found[1].1], [expected[0], expected[1]]);
    assert_eq!(expected[0], graph.value(slope));
}

fn at(values: [ResiduePair; 2]) -> FieldPoint {
    let mut point = FieldPoint::new();
    values
        .into_iter()
        .for_each(|value| point.push_symbol(value));
    point
}
