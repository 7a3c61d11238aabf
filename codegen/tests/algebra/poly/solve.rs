//! Points of catalogue ideals, of rods and frameworks, and of loops; and systems without points.

use hamel_algebra::poly::ideals::{circle, quaternion, rotation};
use hamel_algebra::poly::monomial::Var;
use hamel_algebra::poly::polynomial::Poly;
use hamel_algebra::poly::solve::point;
use hamel_algebra::prime::Residue;
use hamel_algebra::residue_pair::Random;

type ResiduePair = Residue<0>;

fn n(value: i64) -> Poly<ResiduePair> {
    Poly::constant(ResiduePair::from_i64(value))
}

fn x(v: Var) -> Poly<ResiduePair> {
    Poly::var(v)
}

/// Returns |p − q|² − l² for points given by their coordinates.
fn distance(p: &[Poly<ResiduePair>], q: &[Poly<ResiduePair>], square: i64) -> Poly<ResiduePair> {
    let squares = p.iter().zip(q).map(|(a, b)| a.sub(b).pow(2));
    squares.fold(n(-square), |sum, square| sum.add(&square))
}

/// Returns the coordinates of point i in the given dimension.
fn at(i: u32, dimension: u32) -> Vec<Poly<ResiduePair>> {
    (0..dimension).map(|k| x(dimension * i + k)).collect()
}

fn chain(rods: u32, dimension: u32) -> Vec<Poly<ResiduePair>> {
    let origin = vec![n(0); dimension as usize];
    let rod = |i: u32| match i {
        0 => distance(&at(0, dimension), &origin, 3),
        _ => distance(&at(i, dimension), &at(i - 1, dimension), 3 + i64::from(i)),
    };
    (0..rods).map(rod).collect()
}

fn four_bar() -> Vec<Poly<ResiduePair>> {
    let side = |k: u32, length| {
        let sum = n(2).mul(&x(k)).add(&n(5).mul(&x(2 + k)));
        sum.sub(&n(4).mul(&x(4 + k))).sub(&n(length))
    };
    let circles = [circle(0, 1), circle(2, 3), circle(4, 5)].concat();
    [circles, vec![side(0, 6), side(1, 0)]].concat()
}

/// Asserts that points are found for many seeds, that all are on the variety, and that they differ.
fn assert_points(name: &str, generators: &[Poly<ResiduePair>], variables: u32) {
    let variables: Vec<Var> = (0..variables).collect();
    let start = std::time::Instant::now();
    let points: Vec<_> = (0..6)
        .map(|seed| point(generators, &variables, &mut Random::new(seed)).expect(name))
        .collect();
    println!("{name}: {:?} each", start.elapsed() / 6);
    for values in &points {
        let value = |v: Var| values.iter().find(|entry| entry.0 == v).expect("value").1;
        assert!(generators.iter().all(|f| f.eval(&value).is_zero()));
        assert!(
            values
                .iter()
                .map(|entry| entry.0)
                .eq(variables.iter().copied())
        );
    }
    assert_ne!(points[0], points[1], "{name}");
}

#[test]
fn catalogue_ideals_have_points() {
    assert_points("circle", &circle(0, 1), 2);
    assert_points("quaternion", &quaternion([0, 1, 2, 3]), 4);
    assert_points("rotation", &rotation([0, 1, 2, 3, 4, 5, 6, 7, 8]), 9);
    assert_points("nothing", &[], 3);
    assert_eq!(point::<0>(&[], &[], &mut Random::new(1)), Some(Vec::new()));
}

#[test]
fn rods_and_triangles_have_points() {
    assert_points("plane chain", &chain(3, 2), 6);
    assert_points("space chain", &chain(3, 3), 9);
    assert_points("long chain", &chain(6, 3), 18);
    let sides = [(0, 1, 9), (1, 2, 25), (2, 0, 16)];
    let side = |(i, j, length)| distance(&at(i, 3), &at(j, 3), length);
    assert_points("triangle", &sides.map(side), 9);
    let mut tetrahedron: Vec<Poly<ResiduePair>> = sides.map(side).to_vec();
    // The corners (0, 0, 0), (3, 0, 0), (0, 4, 0), (1, 2, 5).
    tetrahedron.extend([(0, 3, 30), (1, 3, 33), (2, 3, 30)].map(side));
    assert_points("tetrahedron", &tetrahedron, 12);
}

#[test]
fn loops_have_points() {
    assert_points("four-bar", &four_bar(), 6);
    // The same loop with relative angles of the rods.
    let (c, s) = (
        x(0).mul(&x(2)).sub(&x(1).mul(&x(3))),
        x(1).mul(&x(2)).add(&x(0).mul(&x(3))),
    );
    let relative = [
        c.mul(&x(4)).sub(&s.mul(&x(5))),
        s.mul(&x(4)).add(&c.mul(&x(5))),
    ];
    let mut closed = [circle(0, 1), circle(2, 3), circle(4, 5)].concat();
    for (k, (mine, sum)) in [c, s].iter().zip(&relative).enumerate() {
        let sum = x(k as Var)
            .scale(&ResiduePair::from_i64(2))
            .add(&mine.scale(&ResiduePair::from_i64(5)))
            .add(&sum.scale(&ResiduePair::from_i64(4)));
        closed.push(if k == 0 { sum.sub(&n(6)) } else { sum });
    }
    assert_points("relative four-bar", &closed, 6);
    // A body (r, R) with one point on a sphere and another in a plane.
    let mut body = rotation([0, 1, 2, 3, 4, 5, 6, 7, 8]);
    let corner = |k: u32, a: i64, b: i64| {
        let column = x(3 * k).scale(&ResiduePair::from_i64(a));
        x(9 + k)
            .add(&column)
            .add(&x(3 * k + 1).scale(&ResiduePair::from_i64(b)))
    };
    let p: Vec<Poly<ResiduePair>> = (0..3).map(|k| corner(k, 1, 2)).collect();
    body.push(distance(&p, &[n(0), n(0), n(0)], 4));
    body.push(corner(2, 3, -1).sub(&n(1)));
    assert_points("body with two contacts", &body, 12);
    let mut platform = rotation([0, 1, 2, 3, 4, 5, 6, 7, 8]);
    for (a, b, length) in [(1, 0, 5), (-1, 2, 6), (0, -2, 7), (2, 2, 6), (1, 5, 4)] {
        let p: Vec<Poly<ResiduePair>> = (0..3).map(|k| corner(k, a, b)).collect();
        platform.push(distance(&p, &[n(a + b), n(2 * b), n(0)], length));
    }
    assert_points("platform on three legs", &platform[..24], 12);
    assert_points("platform on five legs", &platform, 12);
}

#[test]
fn linear_constraints_are_solved() {
    let plane = x(0).add(&x(1)).add(&x(2)).sub(&n(3));
    let line = x(0).sub(&x(2));
    assert_points("line", &[plane.clone(), line.clone()], 3);
    let point_only = [plane, line, x(1).sub(&n(5))];
    let values = point(&point_only, &[0, 1, 2], &mut Random::new(3));
    let expected = [(0, -1), (1, 5), (2, -1)].map(|(v, c)| (v, ResiduePair::from_i64(c)));
    assert_eq!(values, Some(expected.to_vec()));
}

#[test]
fn without_a_point_the_search_ends() {
    let none = |generators: &[Poly<ResiduePair>], variables: u32| {
        let variables: Vec<Var> = (0..variables).collect();
        let start = std::time::Instant::now();
        assert_eq!(point(generators, &variables, &mut Random::new(1)), None);
        println!("no point: {:?}", start.elapsed());
    };
    none(&[n(1)], 1);
    none(&[x(0).sub(&n(1)), x(0).sub(&n(2))], 1);
    // −1 is not a square; and x² + y² = 0 has only one point, which no random choice meets.
    none(&[x(0).mul(&x(0)).add(&n(1))], 1);
    none(&[x(0).pow(2).add(&x(1).pow(2))], 2);
    none(&[x(0).mul(&x(1)).sub(&n(1)), x(0)], 2);
    // Rods that cannot meet, and a variable that must not be solved for.
    let apart = [n(0), n(0)];
    none(
        &[
            distance(&at(0, 2), &apart, 1),
            distance(&at(0, 2), &apart, 2),
        ],
        2,
    );
    none(&circle(0, 7), 1);
    let mut odd = chain(4, 3);
    odd.push(x(30).pow(2).add(&n(1)));
    none(
        &odd.iter()
            .map(|f| f.specialize(&|_| None))
            .collect::<Vec<_>>(),
        31,
    );
}
