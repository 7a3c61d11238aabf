//! Laws of the graph: expressions equal on X are one node, different ones are not, and derivatives agree with numbers.

use crate::common::functions;
use hamel_algebra::derivation::Derivation;
use hamel_algebra::double::Double;
use hamel_algebra::field_point::circle_point;
use hamel_algebra::function::Parity;
use hamel_algebra::graph::{Edge, Function, Graph};
use hamel_algebra::interval::Interval;
use hamel_algebra::numeric::evaluate;
use hamel_algebra::poly::monomial::Var;
use hamel_algebra::reals::{Real, contradict};
use hamel_algebra::residue_pair::Random;
use hamel_algebra::topoly::Expander;
use hamel_algebra::transplant::{copy, rebuild};
use num_rational::BigRational;

const PARAM: u8 = 1;
const COORD: u8 = 2;

/// A graph with two parameters, two free coordinates and a point of the circle.
fn graph() -> (Graph, [Edge; 6]) {
    let mut graph = Graph::new(PARAM);
    let mut random = Random::new(11);
    let mut free = |graph: &mut Graph, name: &str, class: u8| {
        let value = random.element();
        graph.symbol(name, class, value)
    };
    let p = free(&mut graph, "p", PARAM);
    let q = free(&mut graph, "q", PARAM);
    let a = free(&mut graph, "a", COORD);
    let b = free(&mut graph, "b", COORD);
    let mut random = Random::new(13);
    let point = circle_point(&mut random);
    let c = graph.symbol("c", COORD, point.0);
    let s = graph.symbol("s", COORD, point.1);
    (graph, [p, q, a, b, c, s])
}

/// √(e²) is not identified with e or −e, whatever the sign of the root at the points.
#[test]
fn the_root_of_a_square_is_no_more_than_a_root() {
    let (mut g, [.., a, _, _, _]) = graph();
    for shift in 0..8 {
        let number = g.ratio(shift, 1);
        let e = g.sub(a, number);
        let square = g.mul(e, e);
        let root = g.apply(Function::Sqrt, square);
        assert!(root != e && root != -e, "{shift}");
        assert_eq!(g.mul(root, root), square);
        assert_eq!(g.apply(Function::Sqrt, square), root);
        let known = g.known_root(square).expect("e");
        assert_eq!(known.abs(), e.abs());
    }
}

#[test]
fn what_is_equal_on_the_variety_is_one_node() {
    let (mut g, [p, q, a, b, c, s]) = graph();
    let (cc, ss) = (g.mul(c, c), g.mul(s, s));
    assert_eq!(g.add(cc, ss), g.one());
    // 1 − s² is c².
    assert_eq!(g.sub(g.one(), ss), cc);
    // (a + b)(a − b) = a² − b²
    let (sum, difference) = (g.add(a, b), g.sub(a, b));
    let product = g.mul(sum, difference);
    let (aa, bb) = (g.mul(a, a), g.mul(b, b));
    assert_eq!(g.sub(aa, bb), product);
    // Signs are on edges: b − a is the negative of a − b.
    assert_eq!(g.sub(b, a), -difference);
    // Constants are collected: p (q a) is (p q) a.
    let qa = g.mul(q, a);
    let pq = g.mul(p, q);
    let left = g.mul(p, qa);
    assert_eq!(left, g.mul(pq, a));
    assert!(g.is_free(pq.node()) && !g.is_free(left.node()));
}

#[test]
fn what_differs_is_not_merged() {
    let (mut g, [p, q, a, b, c, s]) = graph();
    let mut seen = std::collections::BTreeSet::new();
    let edges = [p, q, a, b, c, s];
    for x in edges {
        for y in edges {
            let (sum, product) = (g.add(x, y), g.mul(x, y));
            let quotient = g.div(x, y);
            seen.extend([Some(sum), Some(product), quotient]);
        }
    }
    // 21 sums, 21 products, 30 quotients and 1
    assert_eq!(seen.len(), 21 + 21 + 31);
}

#[test]
fn functions_obey_their_group_laws() {
    let (mut g, [_, _, a, b, ..]) = graph();
    let sum = g.add(a, b);
    let (sa, ca) = (g.apply(Function::Sin, a), g.apply(Function::Cos, a));
    let (sb, cb) = (g.apply(Function::Sin, b), g.apply(Function::Cos, b));
    let sine = g.dot(&[sa, ca], &[cb, sb]);
    assert_eq!(g.apply(Function::Sin, sum), sine);
    assert_eq!(g.apply(Function::Sin, -a), -sa);
    let third = g.ratio(1, 3);
    let part = g.mul(third, a);
    let c3 = g.apply(Function::Cos, part);
    // cos a = 4 cos³(a/3) − 3 cos(a/3)
    let (four, three) = (g.ratio(4, 1), g.ratio(3, 1));
    let cube = g.powi(c3, 3).expect("no division");
    let (left, right) = (g.mul(four, cube), g.mul(three, c3));
    assert_eq!(g.sub(left, right), ca);
    let (ea, eb) = (g.apply(Function::Exp, a), g.apply(Function::Exp, b));
    let product = g.mul(ea, eb);
    assert_eq!(g.apply(Function::Exp, sum), product);
    // Identities from exp: eᵃ = cosh a + sinh a, cosh² − sinh² = 1, tanh = sinh/cosh.
    let (sinh, cosh) = (g.apply(Function::Sinh, a), g.apply(Function::Cosh, a));
    assert_eq!(g.add(sinh, cosh), ea);
    let squares = g.dot(&[cosh, sinh], &[cosh, -sinh]);
    assert_eq!(squares, g.one());
    assert_eq!(g.div(sinh, cosh), Some(g.apply(Function::Tanh, a)));
    assert_eq!(g.apply(Function::Tanh, -a), -g.apply(Function::Tanh, a));
    let twice = g.mul(ea, g.one());
    let inverse = g.apply(Function::Exp, -a);
    assert_eq!(g.mul(twice, inverse), g.one());
}

/// Identities that hold on both sides of 0 are found; identities that hold on one side only, or fail at 0, are not.
#[test]
fn absolute_values_are_what_they_are_on_both_sides() {
    let (mut g, [p, _, a, b, c, s]) = graph();
    let abs = |g: &mut Graph, e| g.apply(Function::Abs, e);
    let sign = |g: &mut Graph, e| g.apply(Function::Sign, e);
    let (x, y) = (abs(&mut g, a), abs(&mut g, b));
    assert_eq!((abs(&mut g, -a), sign(&mut g, -a)), (x, -sign(&mut g, a)));
    let (sx, sy) = (sign(&mut g, a), sign(&mut g, b));
    assert_eq!(g.mul(sx, a), x);
    let (ab, xy, ss) = (g.mul(a, b), g.mul(x, y), g.mul(sx, sy));
    let (of_product, sign_of_product) = (abs(&mut g, ab), sign(&mut g, ab));
    // No two of these are identified: they differ, or their equality is not recognised.
    let squares = [g.mul(x, x), g.mul(a, a), g.mul(sx, sx), g.one()];
    let mut all = vec![x, a, y, b, xy, ab, of_product, ss, sign_of_product];
    all.extend(squares);
    for e in [p, c, s, ab] {
        let less = g.sub(e, g.one());
        all.extend([abs(&mut g, less), less, sign(&mut g, less)]);
    }
    let some: std::collections::BTreeSet<_> = all.iter().map(|edge| edge.abs()).collect();
    assert_eq!(some.len(), all.len());
    // A constant is on one side: 1/4 as c² + s² − 3/4, and √2 − √3.
    let (cc, ss, number) = (g.mul(c, c), g.mul(s, s), g.ratio(-3, 4));
    let quarter = g.sum(&[cc, ss, number]);
    assert_eq!(
        (abs(&mut g, -quarter), sign(&mut g, quarter)),
        (quarter, g.one())
    );
    let (two, three) = (g.ratio(2, 1), g.ratio(3, 1));
    let root = [two, three].map(|number| g.apply(Function::Sqrt, number));
    let less = g.sub(root[0], root[1]);
    assert_eq!((abs(&mut g, less), sign(&mut g, less)), (-less, -g.one()));
    assert_eq!(sign(&mut g, three), g.one());
}

/// Choices satisfy the identities that hold for both branches, and no others.
#[test]
fn choices_are_equal_where_both_branches_are() {
    let (mut g, [p, _, a, b, c, s]) = graph();
    let (zero, one) = (g.zero(), g.one());
    let choose = |g: &mut Graph, c, a, b| g.select(c, a, b);
    let e = choose(&mut g, a, b, p);
    assert_eq!(choose(&mut g, a, b, b), b);
    assert_eq!(choose(&mut g, a, -b, -p), -e);
    let (cb, cp) = (g.mul(c, b), g.mul(c, p));
    assert_eq!(choose(&mut g, a, cb, cp), g.mul(c, e));
    let [step, other] = [(one, zero), (zero, one)].map(|(x, y)| g.select(a, x, y));
    assert_eq!(g.add(step, other), one);
    assert_eq!(g.dot(&[step, other], &[b, p]), e);
    // The sign is the difference of both steps.
    let back = g.select(-a, one, zero);
    assert_eq!(g.sub(step, back), g.apply(Function::Sign, a));
    let less = g.sub(a, one);
    let later = g.select(less, one, zero);
    // [a > 1][a > 0] = [a > 1] and [a > 0]² = [a > 0] are true but not recognised; [a > 0] + [−a > 0] = 1 is false at
    // 0. That the maximum is one of its arguments is false, and that it is symmetric is not recognised.
    let both = g.mul(later, step);
    let (difference, reverse) = (g.sub(a, b), g.sub(b, a));
    let greater = [g.select(difference, a, b), g.select(reverse, b, a)];
    let all = [
        step, other, back, later, both, e, one, a, b, greater[0], greater[1],
    ];
    let sum = g.add(step, back);
    let square = g.mul(step, step);
    let all: Vec<Edge> = all.into_iter().chain([sum, square]).collect();
    let some: std::collections::BTreeSet<_> = all.iter().map(|edge| edge.abs()).collect();
    assert_eq!(some.len(), all.len());
    // A constant is on one side.
    let (cc, ss) = (g.mul(c, c), g.mul(s, s));
    let unit = g.add(cc, ss);
    assert_eq!((g.select(unit, a, b), g.select(-unit, a, b)), (a, b));
    assert_eq!(g.select(zero, a, b), b);
}

#[test]
fn division_by_zero_on_the_variety_is_refused() {
    let (mut g, [_, _, a, _, c, s]) = graph();
    let (cc, ss) = (g.mul(c, c), g.mul(s, s));
    let sum = g.add(cc, ss);
    let zero = g.sub(sum, g.one());
    assert_eq!(g.div(a, zero), None);
    assert_eq!(g.powi(zero, -1), None);
}

/// Returns a random expression in a, b and p, with all functions.
fn expression(g: &mut Graph, leaves: &[Edge], random: &mut Random, depth: usize) -> Edge {
    if depth == 0 {
        return leaves[random.bits() as usize % leaves.len()];
    }
    let x = expression(g, leaves, random, depth - 1);
    let y = expression(g, leaves, random, depth - 1);
    let (xx, two) = (g.mul(x, x), g.ratio(2, 1));
    let positive = g.add(xx, two);
    match random.bits() % 10 {
        0 => g.add(x, y),
        1 => g.sub(x, y),
        2 => g.mul(x, y),
        3 => g.div(y, positive).expect("not zero"),
        4 => g.apply(Function::Sin, x),
        5 => g.apply(Function::Sqrt, positive),
        6 => g.apply(Function::Log, positive),
        7 => g.apply(Function::Abs, x),
        8 => g.select(x, y, positive),
        _ => g.atan2(y, positive),
    }
}

#[test]
fn derivatives_are_those_of_numbers() {
    let mut random = Random::new(5);
    for _ in 0..200 {
        let (mut g, [p, _, a, b, ..]) = graph();
        let f = expression(&mut g, &[p, a, b], &mut random, 3);
        let slope = Derivation::new([(a.node(), g.one())]).of(&mut g, f);
        let at =
            |g: &Graph, edge: Edge, x: f64| evaluate(g, &[edge], &[0.7, 0.2, x, -0.4, 0.0, 0.0])[0];
        let h = 1e-5;
        let numeric = (at(&g, f, 0.3 + h) - at(&g, f, 0.3 - h)) / (2.0 * h);
        let exact = at(&g, slope, 0.3);
        assert!(
            (numeric - exact).abs() <= 1e-7 * (1.0 + exact.abs()),
            "{numeric} and {exact}"
        );
    }
}

/// The table entries of each function agree with differences of its values: its slope, its parity, and its value for
/// every type of number.
#[test]
fn the_table_of_functions_is_true() {
    for function in functions() {
        let row = function.row();
        for at in [0.3, 0.8, 1.7] {
            let (mut g, [_, _, a, ..]) = graph();
            let f = g.apply(function, a);
            let slope = Derivation::new([(a.node(), g.one())]).of(&mut g, f);
            let value =
                |edge: Edge, x: f64| evaluate(&g, &[edge], &[0.0, 0.0, x, 0.0, 0.0, 0.0])[0];
            assert_eq!(value(f, at), (row.value)(at), "{function:?}");
            let h = 1e-5;
            let numeric = (value(f, at + h) - value(f, at - h)) / (2.0 * h);
            let exact = value(slope, at);
            assert!(
                (numeric - exact).abs() < 1e-8 * (1.0 + exact.abs()),
                "{function:?}"
            );
            let negative = (row.value)(-at);
            match row.parity {
                Parity::Even => assert_eq!(negative, (row.value)(at), "{function:?}"),
                Parity::Odd => assert_eq!(negative, -(row.value)(at), "{function:?}"),
                Parity::Neither => assert!(negative.abs() != (row.value)(at).abs(), "{function:?}"),
            }
            let expected = (row.value)(at);
            let near = |found: f64| (found - expected).abs() < 1e-14 * (1.0 + expected.abs());
            assert!(near((row.double)(Double::new(at)).to_f64()), "{function:?}");
            let real = [(row.real)(Real::new(at, 0.0))];
            assert!(
                !contradict(&real, &[Real::new(expected, 1e-14)]),
                "{function:?}"
            );
            assert!(
                contradict(&real, &[Real::new(expected + 1e-9, 1e-14)]),
                "{function:?}"
            );
            let number = BigRational::from_float(at).expect("finite");
            let between = (row.interval)(&Interval::rational(&number));
            if let Some(between) = between {
                assert!(near(between.to_f64()), "{function:?}");
            }
        }
        if let Some([at, value]) = row.at {
            assert_eq!((row.value)(f64::from(at)), f64::from(value), "{function:?}");
        }
    }
}

#[test]
fn carried_expressions_keep_their_values() {
    let mut random = Random::new(6);
    for _ in 0..50 {
        let (mut g, [p, _, a, b, ..]) = graph();
        let f = expression(&mut g, &[p, a, b], &mut random, 3);
        let numbers = [0.7, 0.2, 0.3, -0.4, 0.0, 0.0];
        let expected = evaluate(&g, &[f], &numbers)[0];
        for carry in [rebuild, copy] {
            let (mut other, _) = graph();
            let moved = carry(&g, &mut other, &[f]);
            let value = evaluate(&other, &moved, &numbers)[0];
            assert!((value - expected).abs() <= 1e-12 * (1.0 + expected.abs()));
        }
    }
}

#[test]
fn polynomials_have_the_values_of_their_nodes() {
    let (mut g, [p, q, a, b, c, s]) = graph();
    let mut random = Random::new(9);
    for _ in 0..50 {
        let leaves = [p, q, a, b, c, s];
        let pick = |random: &mut Random| leaves[random.bits() as usize % leaves.len()];
        let mut f = g.one();
        for _ in 0..6 {
            let (x, y) = (pick(&mut random), pick(&mut random));
            let product = g.mul(f, x);
            f = g.sub(product, y);
        }
        let polynomial = Expander::default().expand(&g, f).expect("small");
        let numbers: [f64; 6] = [0.7, 0.2, 0.3, -0.4, 0.6, 0.8];
        let value: f64 = polynomial
            .terms()
            .iter()
            .map(|(monomial, number)| {
                let powers = monomial
                    .powers()
                    .iter()
                    .map(|&(var, exponent): &(Var, u32)| {
                        numbers[var as usize].powi(exponent as i32)
                    });
                num_traits::ToPrimitive::to_f64(number).unwrap_or(f64::NAN)
                    * powers.product::<f64>()
            })
            .sum();
        let expected = evaluate(&g, &[f], &numbers)[0];
        assert!(
            (value - expected).abs() <= 1e-12 * (1.0 + expected.abs()),
            "{value} and {expected}"
        );
    }
}

/// Nested sums, each of which occurs twice in the next: the coefficients are Fibonacci numbers, found in linear time.
#[test]
fn linear_forms_take_each_sum_once() {
    let (mut g, [_, _, a, b, ..]) = graph();
    let (mut last, mut next) = (a, b);
    let (mut x, mut y) = ((1u128, 0u128), (0, 1));
    for _ in 0..90 {
        (last, next) = (next, g.add(next, last));
        (x, y) = (y, (x.0 + y.0, x.1 + y.1));
    }
    let number = |n: u128| BigRational::from_integer(n.into());
    let mut form = g.linear_form(next);
    form.sort();
    assert_eq!(form, [(a.node(), number(y.0)), (b.node(), number(y.1))]);
    // Terms that cancel are left out; constants multiply 1.
    let seven = g.ratio(7, 3);
    let sum = g.sum(&[a, seven, b]);
    let rest = g.sub(sum, a);
    let mut form = g.linear_form(-rest);
    form.sort();
    let seven = BigRational::new(7.into(), 3.into());
    assert_eq!(form, [(1, -seven), (b.node(), -number(1))]);
}

/// e^(c a) e^(−c a) = 1 where 12 c is −2⁶³, the least value of its integer type.
#[test]
fn coefficients_at_the_end_of_the_whole_numbers() {
    let (mut g, [_, _, a, ..]) = graph();
    let least = BigRational::from_integer(i64::MIN.into()) / BigRational::from_integer(12.into());
    let factor = g.rational(&least);
    let argument = g.mul(factor, a);
    let powers = [argument, -argument].map(|argument| g.apply(Function::Exp, argument));
    assert_eq!(g.mul(powers[0], powers[1]), g.one());
    let sine = g.apply(Function::Sin, argument);
    assert_eq!(g.apply(Function::Sin, -argument), -sine);
}

/// (w aᵏ exp(f log a))′ for several fractions f, finite at a = 0.
#[test]
fn slopes_of_fractional_powers_are_finite_at_zero() {
    let (mut g, [k, b, a, ..]) = graph();
    for (whole, n, d) in [(1, 1, 3), (2, 3, 10), (2, 2, 3), (3, 1, 5)] {
        let fraction = g.ratio(n, d);
        let p = f64::from(whole) + n as f64 / d as f64;
        let log = g.apply(Function::Log, a);
        let product = g.mul(fraction, log);
        let rest = g.apply(Function::Exp, product);
        let power = g.powi(a, whole.into()).expect("no divisor");
        let power = g.mul(power, rest);
        let with = g.mul(b, power);
        let factor = g.mul(k, with);
        let first = Derivation::new([(a.node(), g.one())]).of(&mut g, factor);
        let second = Derivation::new([(a.node(), g.one())]).of(&mut g, first);
        let cross = Derivation::new([(b.node(), g.one())]).of(&mut g, first);
        for at in [0.0, 0.25, 4.0] {
            let mut numbers = vec![0.0; g.symbols().len()];
            for (edge, value) in [(k, 2.0), (b, -3.0), (a, at)] {
                numbers[g.as_symbol(edge).expect("a symbol")] = value;
            }
            let found = evaluate(&g, &[first, second, cross], &numbers);
            let slope = p * at.powf(p - 1.0);
            let bend = p * (p - 1.0) * at.powf(p - 2.0);
            let expected = [-6.0 * slope, -6.0 * bend, 2.0 * slope];
            for (found, expected) in found.iter().zip(expected) {
                let close = (found - expected).abs() <= 1e-12 * expected.abs();
                assert!(close || expected.is_infinite(), "{p} at {at}: {found}");
            }
        }
    }
}

/// (w a^p)′ = w′ a^p + p w a^(p−1) a′ for half-integer p, which is finite at a = 0 if p > 1.
#[test]
fn slopes_of_half_integer_powers_are_finite_at_zero() {
    let (mut g, [k, ..]) = graph();
    let mut random = Random::new(17);
    let (of_a, of_b) = (random.element(), random.element());
    // A square, so that its root exists.
    let a = g.symbol("square", COORD, of_a * of_a);
    let b = g.symbol("other", COORD, of_b);
    let root = g.apply(Function::Sqrt, a);
    let numbers = |a: f64| [2.0, 0.0, 0.0, 0.0, 0.0, 0.0, a, -3.0];
    for n in [3, 5, 7, 9] {
        let p = f64::from(n) / 2.0;
        let power = g.powi(root, n.into()).expect("no divisor");
        let with = g.mul(b, power);
        let factor = g.mul(k, with);
        let first = Derivation::new([(a.node(), g.one())]).of(&mut g, factor);
        let second = Derivation::new([(a.node(), g.one())]).of(&mut g, first);
        let cross = Derivation::new([(b.node(), g.one())]).of(&mut g, first);
        for at in [0.0, 0.25, 4.0] {
            let found = evaluate(&g, &[first, second, cross], &numbers(at));
            let slope = p * at.powf(p - 1.0);
            let bend = p * (p - 1.0) * at.powf(p - 2.0);
            let expected = [-6.0 * slope, -6.0 * bend, 2.0 * slope];
            for (found, expected) in found.iter().zip(expected) {
                let close = (found - expected).abs() <= 1e-12 * expected.abs();
                assert!(close || expected.is_infinite(), "{n}/2 at {at}: {found}");
            }
        }
    }
    // √(−c) of a negative symbol, with the sign inside and outside.
    let c = g.symbol("negative", COORD, -(of_b * of_b));
    let root = g.apply(Function::Sqrt, -c);
    for (base, sign) in [(c, 1.0), (-c, -1.0)] {
        let power = g.mul(base, root);
        let slope = Derivation::new([(c.node(), g.one())]).of(&mut g, power);
        for at in [0.0_f64, -4.0] {
            let numbers = [2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, at];
            let found = evaluate(&g, &[slope], &numbers)[0];
            assert_eq!(found, sign * 1.5 * (-at).sqrt());
        }
    }
}
