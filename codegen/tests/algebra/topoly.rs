//! Polynomials of nodes: powers that are kept, and bounded expansion.

use hamel_algebra::graph::Graph;
use hamel_algebra::residue_pair::Random;
use hamel_algebra::topoly::Expander;

/// 2 (x − a)³ y is 2 t³ y; and an earlier expansion is replaced.
#[test]
fn powers_of_linear_forms_are_kept_where_that_is_asked_for() {
    let mut random = Random::new(7);
    let mut graph = Graph::new(0);
    let [x, y, a] = ["x", "y", "a"].map(|name| {
        let value = random.element();
        graph.symbol(name, 2, value)
    });
    let base = graph.sub(x, a);
    let square = graph.mul(base, base);
    let twice = graph.add(base, base);
    let cube = graph.mul(square, twice);
    let all = graph.mul(cube, y);
    let terms = |expander: &mut Expander, edge| {
        let polynomial = expander.expand(&graph, edge);
        polynomial.map(|polynomial| polynomial.terms().len())
    };
    let plain = &mut Expander::default();
    assert_eq!(
        [terms(plain, square), terms(plain, all)],
        [Some(3), Some(4)]
    );
    let keeping = &mut Expander::default().with_kept_powers();
    assert_eq!(terms(keeping, square), Some(3));
    assert_eq!([terms(keeping, all), terms(keeping, square)], [Some(1); 2]);
    // Not a linear form: (x y + a)³.
    let product = graph.mul(x, y);
    let other = graph.add(product, a);
    let square = graph.mul(other, other);
    let cube = graph.mul(square, other);
    let polynomial = keeping.expand(&graph, cube).expect("four terms");
    assert_eq!(polynomial.terms().len(), 4);
}

#[test]
fn an_expansion_ends_with_its_work() {
    let mut random = Random::new(5);
    let mut graph = Graph::new(0);
    let symbols: Vec<_> = (0..6)
        .map(|i| {
            let value = random.element();
            graph.symbol(&format!("x{i}"), 2, value)
        })
        .collect();
    let sum = graph.sum(&symbols);
    let square = graph.mul(sum, sum);
    let fourth = graph.mul(square, square);
    let terms = |work: usize, edge| {
        let polynomial = Expander::with_work_limit(work).expand(&graph, edge);
        polynomial.map(|polynomial| polynomial.terms().len())
    };
    // 20 terms added, 36 products, and 21² more.
    assert_eq!(terms(19, sum), None);
    assert_eq!(terms(20, sum), Some(6));
    assert_eq!(terms(56, square), Some(21));
    assert_eq!(terms(56, fourth), None);
    assert_eq!(terms(20 + 36 + 441, fourth), Some(126));
    assert_eq!(terms(20 + 36 + 440, fourth), None);
}
