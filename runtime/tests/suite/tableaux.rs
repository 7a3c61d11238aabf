//! Order conditions of the tableaux, over all rooted trees.
//!
//! With φᵢ(•) = 1 and φᵢ(t) = Π Σⱼ aᵢⱼ φⱼ(t') over the subtrees t' at the root, weights b have order p
//! when Σ bᵢ φᵢ(t) = 1/γ(t) for every tree of at most p nodes, γ(t) = |t| Π γ(t'). Source: E. Hairer,
//! S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I* (1993), II.2.

use hamel::adaptive::Pair;
use hamel::methods::tableau::Weights;
use hamel::methods::{rkmk8, rkmk54};

/// Coefficients of size up to 400, rounded to 16 digits, in sums of products.
const ROUNDING: f64 = 2e-13;

/// A rooted tree, as its subtrees.
#[derive(Clone, Debug, PartialEq)]
struct Tree(Vec<Tree>);

impl Tree {
    fn nodes(&self) -> usize {
        1 + self.0.iter().map(Tree::nodes).sum::<usize>()
    }

    /// γ
    fn density(&self) -> f64 {
        self.nodes() as f64 * self.0.iter().map(Tree::density).product::<f64>()
    }

    /// φᵢ
    fn weights(&self, a: &[Vec<f64>]) -> Vec<f64> {
        let children: Vec<_> = self.0.iter().map(|child| child.weights(a)).collect();
        let along = |row: &Vec<f64>| children.iter().map(|child| dot(row, child)).product();
        a.iter().map(along).collect()
    }
}

/// All trees of up to `most` nodes; the subtrees of each in the order of this list.
fn trees(most: usize) -> Vec<Tree> {
    fn extend(known: &[Tree], first: usize, left: usize, so_far: &Tree, into: &mut Vec<Tree>) {
        if left == 0 {
            into.push(so_far.clone());
        }
        for (index, tree) in known.iter().enumerate().skip(first) {
            if tree.nodes() <= left {
                let mut larger = so_far.clone();
                larger.0.push(tree.clone());
                extend(known, index, left - tree.nodes(), &larger, into);
            }
        }
    }
    let mut known = Vec::new();
    for nodes in 1..=most {
        let mut of_this_size = Vec::new();
        extend(&known, 0, nodes - 1, &Tree(Vec::new()), &mut of_this_size);
        known.extend(of_this_size);
    }
    known
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn full(weights: Weights, stages: usize) -> Vec<f64> {
    let mut row = vec![0.0; stages];
    for (index, weight) in weights {
        assert_eq!(row[*index], 0.0, "a weight stands once");
        row[*index] = *weight;
    }
    row
}

fn matrix<const M: usize, const D: usize>(pair: &Pair<M, D>) -> Vec<Vec<f64>> {
    let rows = pair.rows.iter().enumerate();
    rows.map(|(index, row)| {
        assert!(row.weights.iter().all(|(j, _)| *j < index), "explicit");
        full(row.weights, M)
    })
    .collect()
}

/// Largest |Σ bᵢ φᵢ(t) − expected(t)| over the trees of `order` nodes.
fn defect(a: &[Vec<f64>], b: &[f64], order: usize, expected: impl Fn(&Tree) -> f64) -> f64 {
    let trees = trees(order);
    let of_order = trees.iter().filter(|tree| tree.nodes() == order);
    of_order.fold(0.0, |largest: f64, tree| {
        largest.max((dot(b, &tree.weights(a)) - expected(tree)).abs())
    })
}

/// b(θ) of the dense output.
fn path<const M: usize, const D: usize>(pair: &Pair<M, D>, theta: f64) -> Vec<f64> {
    let b = full(pair.rows[pair.end].weights, M);
    let unit = |index: usize| -> Vec<f64> { (0..M).map(|j| f64::from(j == index)).collect() };
    let minus =
        |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a - b).collect() };
    let rise = minus(&unit(0), &b);
    let fall = minus(&minus(&b, &unit(pair.end)), &rise);
    let mut terms = vec![b, rise, fall];
    terms.extend(pair.dense.iter().map(|weights| full(weights, M)));
    let mut sum = vec![0.0; M];
    for (index, term) in terms.iter().enumerate().rev() {
        let factor = if index % 2 == 0 { theta } else { 1.0 - theta };
        for (sum, term) in sum.iter_mut().zip(term) {
            *sum = factor * (*sum + term);
        }
    }
    sum
}

fn assert_pair<const M: usize, const D: usize>(
    pair: &Pair<M, D>,
    embedded: &[usize],
    dense_order: usize,
) {
    let a = matrix(pair);
    let order = pair.order as usize;
    for (row, weights) in pair.rows.iter().zip(&a) {
        let sum: f64 = weights.iter().sum();
        assert!(
            (sum - row.node).abs() < ROUNDING,
            "row sum of node {}",
            row.node
        );
    }
    let b = full(pair.rows[pair.end].weights, M);
    let exact = |tree: &Tree| 1.0 / tree.density();
    for p in 1..=order {
        let defect = defect(&a, &b, p, exact);
        assert!(defect < ROUNDING, "order {p}: {defect:e}");
    }
    assert!(
        defect(&a, &b, order + 1, exact) > 1e-6,
        "not of a higher order"
    );

    assert_eq!(pair.errors.len(), embedded.len());
    for (weights, order) in pair.errors.iter().zip(embedded) {
        let e = full(weights, M);
        for p in 1..=*order {
            assert!(defect(&a, &e, p, |_| 0.0) < ROUNDING, "estimate, order {p}");
        }
        assert!(
            defect(&a, &e, order + 1, |_| 0.0) > 1e-6,
            "an estimate sees its order"
        );
    }

    for theta in [0.2, 0.5, 0.9] {
        let b = path(pair, theta);
        for p in 1..=dense_order {
            let moved = |tree: &Tree| theta.powi(tree.nodes() as i32) / tree.density();
            let defect = defect(&a, &b, p, moved);
            assert!(
                defect < ROUNDING,
                "dense output at {theta}, order {p}: {defect:e}"
            );
        }
    }
    let end = path(pair, 1.0);
    assert!(
        end.iter()
            .zip(&b)
            .all(|(end, b)| (end - b).abs() < ROUNDING)
    );
}

#[test]
fn there_are_as_many_trees_as_the_literature_says() {
    let all = trees(8);
    let of = |nodes| all.iter().filter(|tree| tree.nodes() == nodes).count();
    assert_eq!(
        [1, 2, 3, 4, 5, 6, 7, 8].map(of),
        [1, 1, 2, 4, 9, 20, 48, 115]
    );
}

#[test]
fn dormand_prince_5_4() {
    assert_pair(&rkmk54::PAIR, &[4], 4);
}

#[test]
fn dormand_prince_8_5_3() {
    assert_pair(&rkmk8::PAIR, &[5, 3], 7);
}
