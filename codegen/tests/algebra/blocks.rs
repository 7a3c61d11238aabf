//! Small linear systems with restricted divisors.

use hamel_algebra::blocks::{Failure, solve};
use hamel_algebra::field_point::circle_point;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::multiply;
use hamel_algebra::residue_pair::Random;

/// Returns a graph with (c, s) on the circle, a parameter l and a free coordinate x.
fn graph() -> (Graph, [Edge; 4]) {
    let mut graph = Graph::new(1);
    let mut random = Random::new(11);
    let point = circle_point(&mut random);
    let c = graph.symbol("c", 2, point.0);
    let s = graph.symbol("s", 2, point.1);
    let l = graph.symbol("l", 1, random.element());
    let x = graph.symbol("x", 2, random.element());
    (graph, [c, s, l, x])
}

/// Returns whether M X = B holds at the graph's point.
fn holds(graph: &mut Graph, m: &[Vec<Edge>], x: &[Vec<Edge>], b: &[Vec<Edge>]) -> bool {
    multiply(graph, m, x) == b
}

fn at_start(_: &Graph, edges: &[Edge]) -> Vec<f64> {
    vec![-1.0; edges.len()]
}

#[test]
fn a_block_with_a_constant_determinant_needs_no_division() {
    let (mut graph, [c, s, _, _]) = graph();
    let (one, zero) = (graph.one(), graph.zero());
    let m = [vec![c, -s], vec![s, c]];
    let b = [vec![one, zero], vec![zero, one]];
    let solution = solve(&mut graph, &m, &b, Some(&at_start)).expect("regular");
    assert!(solution.pivots.is_empty() && solution.constants.is_empty());
    assert_eq!(solution.x, [vec![c, s], vec![-s, c]]);
}

#[test]
fn equations_in_excess_are_solved_by_their_gram_matrix() {
    let (mut graph, [c, s, l, _]) = graph();
    // l (c, s) u = (c, s): u = 1/l, without a division by c or s; l² is recognised as a constant.
    let square = graph.mul(l, l);
    let m = [vec![graph.mul(l, c)], vec![graph.mul(l, s)]];
    let b = [vec![c], vec![s]];
    let solution = solve(&mut graph, &m, &b, None).expect("regular");
    assert!(holds(&mut graph, &m, &solution.x, &b));
    assert_eq!(solution.constants, [square]);
    assert!(solution.pivots.is_empty());
}

#[test]
fn varying_divisors_are_positive_at_the_start() {
    let (mut graph, [c, s, _, x]) = graph();
    let (one, zero) = (graph.one(), graph.zero());
    let m = [vec![x, zero], vec![c, s]];
    let b = [vec![one], vec![zero]];
    let solution = solve(&mut graph, &m, &b, Some(&at_start)).expect("regular");
    assert!(holds(&mut graph, &m, &solution.x, &b));
    assert_eq!(solution.pivots, [-x, -s]);
    let zeros = |_: &Graph, edges: &[Edge]| vec![0.0; edges.len()];
    assert!(solve(&mut graph, &m, &b, Some(&zeros)).is_ok_and(|s| !s.pivots.is_empty()));
}

#[test]
fn unknowns_without_an_equation_are_named() {
    let (mut graph, [c, s, _, x]) = graph();
    let zero = graph.zero();
    let m = [vec![x, zero, zero], vec![zero, c, s]];
    let b = [vec![c], vec![s]];
    let failure = solve(&mut graph, &m, &b, None).map(|_| ());
    assert_eq!(failure, Err(Failure::Undetermined(vec![1, 2])));
}
