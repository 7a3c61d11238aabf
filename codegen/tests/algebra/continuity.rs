//! Jumps between branches: discontinuous expressions are found, and continuous ones are not.

use hamel_algebra::graph::{Edge, Function, Graph, NodeId};
use hamel_algebra::residue_pair::Random;

fn made() -> (Graph, [Edge; 4]) {
    let mut random = Random::new(17);
    let mut g = Graph::new(1);
    let symbols = [("p", 1), ("a", 2), ("b", 2), ("d", 2)]
        .map(|(name, class)| g.symbol(name, class, random.element()));
    (g, symbols)
}

fn jumps(g: &Graph, edge: Edge) -> bool {
    let every = |_: NodeId| true;
    g.find_discontinuity(&[edge], 1, &every).is_some()
}

#[test]
fn what_jumps_is_found() {
    let (mut g, [p, a, b, _]) = made();
    let one = g.one();
    let less = g.sub(a, one);
    let square = g.mul(less, less);
    let (difference, back) = (g.sub(a, b), g.sub(b, a));
    let size = g.apply(Function::Abs, less);
    let inner = g.select(difference, a, b);
    let steep = g.mul(p, inner);
    let nested = g.select(less, size, -square);
    let still = g.select(p, one, a);
    let smooth = [
        size,
        inner,
        steep,
        nested,
        still,
        g.select(back, size, nested),
    ];
    // The last one jumps: |a − 1| and the nested expression differ where b − a = 0.
    let sign = g.apply(Function::Sign, less);
    let product = g.mul(sign, less);
    let step = g.select(less, one, p);
    // Not linear in a symbol, so that nothing is known.
    let curved = g.select(square, a, b);
    let found: Vec<bool> = smooth.iter().map(|&edge| jumps(&g, edge)).collect();
    assert_eq!(found, [false, false, false, false, false, true]);
    assert!(jumps(&g, sign) && jumps(&g, step) && jumps(&g, curved) && !jumps(&g, product));
    // If no symbol can be moved alone, c = 0 is still used.
    assert!(g.find_discontinuity(&[inner], 1, &|_| false).is_none());
    assert!(g.find_discontinuity(&[step], 1, &|_| false).is_some());
}

/// The maximum of two expressions is continuous, and so are functions of it.
#[test]
fn the_greater_of_two_never_jumps() {
    let (mut g, [p, a, b, d]) = made();
    let zero = g.zero();
    let squares = g.dot(&[a, b, d], &[a, b, d]);
    let length = g.apply(Function::Norm, squares);
    let (sine, root) = (g.apply(Function::Sin, a), g.apply(Function::Abs, b));
    let product = g.mul(a, sine);
    let ratio = g.div(sine, squares).expect("is not 0");
    let ten = g.ratio(1, 10);
    let all = [squares, length, sine, root, product, ratio, a];
    for of in all {
        for with in [p, zero, ten, d] {
            let more = g.sub(of, with);
            let greater = g.select(more, of, with);
            let excess = g.select(more, more, zero);
            let (square, further) = (g.mul(excess, excess), g.select(-more, p, greater));
            // The same maximum twice, nested.
            let least = g.sub(greater, b);
            let twice = g.select(least, b, greater);
            assert!(
                ![greater, excess, square, twice]
                    .iter()
                    .any(|&e| jumps(&g, e))
            );
            // Selects p, or something where of > with.
            assert!(with == p || jumps(&g, further), "{of:?} {with:?}");
            let cut = g.select(more, of, zero);
            assert!(with == zero || jumps(&g, cut), "{of:?} {with:?}");
        }
    }
}

#[test]
fn every_place_at_which_a_side_changes_is_seen() {
    let (mut g, [p, a, b, d]) = made();
    let (zero, one) = (g.zero(), g.one());
    // a b and a/b change sign at a = 0 and at b = 0; c = a b + a d is a (b + d).
    let (product, ratio) = (g.mul(a, b), g.div(a, b).expect("is not 0"));
    let other = g.mul(a, d);
    let sum = g.add(product, other);
    for by in [product, ratio, sum] {
        let choice = g.select(by, a, zero);
        assert!(jumps(&g, choice), "{by:?}");
        let choice = g.select(by, product, zero);
        assert!(by == sum || !jumps(&g, choice));
    }
    // An expression without a value at a = 0 is not continuous there.
    let inverse = g.div(one, a).expect("is not 0");
    let infinite = g.select(a, inverse, zero);
    assert!(jumps(&g, infinite));
    // 2a > 0 is equivalent to a > 0: neither hides the jump of the other.
    let double = g.add(a, a);
    let hidden = g.select(double, one, zero);
    let step = g.select(a, hidden, zero);
    assert!(jumps(&g, step));
    // p a = 0 also where p = 0, but p does not change.
    let scaled = g.mul(p, a);
    let kink = g.select(scaled, a, zero);
    assert!(!jumps(&g, kink));
}
