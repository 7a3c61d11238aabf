//! Recursions against the derivation that knows no trees: the same values on X.

use super::inverse::{collect, inverse, wrenches};
use super::{Tree, articulated, composite, nearby};
use crate::algebra::graph::Edge;
use crate::derive::accel::parts::{Axes, Reference, Variant, parts};
use crate::derive::accel::solve::{Plan, solve};
use crate::derive::calculus::Calculus;
use crate::model::{self, Model};
use crate::program::count::count;

fn chain(n: usize, placement: &str) -> Model {
    let mut text = String::from("system Chain { gravity [0, 0, -9.81];\n");
    for i in 1..=n {
        let on = if i > 1 {
            format!("on f{}", i - 1)
        } else {
            String::new()
        };
        let place = placement.replace('#', &i.to_string());
        text += &format!(
            "coord q{i}; velocity u{i}; rate q{i} = u{i}; frame b{i} {on} = {place}; frame f{i} on b{i} = pose(rotz(q{i}), [0, 0, 0]);
             body on f{i} {{ mass 1.{i}; com [0.1, 0.2, 0.{i}]; inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.{i}]] about com; }}\n"
        );
    }
    text += "}";
    let system = crate::syntax::parse_text(&text).expect("parses");
    model::build(&system).expect("is a model")
}

fn flops(model: &Model, roots: &[Edge]) -> usize {
    count(&model.graph, roots).flops()
}

fn agree(mut model: Model, name: &str) {
    let mut calculus = Calculus::new(&model);
    let variant = Variant {
        axes: Axes::Body,
        reference: Reference::Com,
        shift: None,
    };
    let mut plain = model.clone();
    let parts = parts(&mut plain, &mut calculus.clone(), variant);
    let tree = Tree::of(&mut model, &mut calculus).expect("is a tree");
    let n = model.n();
    let zero = model.graph.zero();
    let (xi, gravity) = (model.xi.clone(), model.gravity);
    let id = inverse(&mut model.graph, &tree, &xi, &model.xi_dot.clone(), gravity);
    let xi_dot = model.xi_dot.clone();
    for i in 0..n {
        let inertial = plain.graph.dot(&parts.mass[i], &xi_dot);
        let right = plain.graph.add(parts.inertia[i], parts.conservative[i]);
        let expected = plain.graph.sub(inertial, right);
        assert_eq!(
            plain.graph.value(expected),
            model.graph.value(id[i]),
            "row {i} of inverse dynamics"
        );
    }
    let id_count = flops(&model, &id);
    let mut slopes = model.graph.clone();
    let found =
        nearby::slopes(&mut slopes, &tree, &xi, &model.xi_dot.clone(), gravity).expect("is plain");
    for i in 0..n {
        for j in 0..n {
            let by_place = calculus.along(&mut model.graph, j, id[i]);
            assert_eq!(
                model.graph.value(by_place),
                slopes.value(found.displacement[i][j]),
                "row {i} along displacement {j}"
            );
            let by_rate =
                crate::algebra::derivation::Derivation::new([(xi[j].node(), model.graph.one())])
                    .of(&mut model.graph, id[i]);
            assert_eq!(
                model.graph.value(by_rate),
                slopes.value(found.velocity[i][j]),
                "row {i} along velocity {j}"
            );
        }
    }
    let mut other = model.clone();
    let mass = composite::mass_matrix(&mut other.graph, &tree, n);
    for i in 0..n {
        for j in 0..n {
            assert_eq!(
                plain.graph.value(parts.mass[i][j]),
                other.graph.value(mass[i][j]),
                "M {i} {j}"
            );
        }
    }
    let mass_count = flops(&other, &mass.concat());
    let bias = inverse(&mut other.graph, &tree, &xi, &vec![zero; n], gravity);
    let bias_count = flops(&other, &bias);
    let mut best = Vec::new();
    for order in [(0..n).collect::<Vec<_>>(), (0..n).rev().collect()] {
        let plan = Plan {
            order,
            apart: 0,
            scale: false,
            inverse: false,
        };
        let mut graph = other.graph.clone();
        let right = bias.iter().map(|&b| -b).collect();
        let given = super::super::accel::parts::Parts {
            mass: mass.clone(),
            groups: vec![right],
            ..Default::default()
        };
        let solution = solve(&mut graph, &given, &plan).expect("solves");
        best.push(count(&graph, &solution.xi_dot).flops());
        if n < 8 {
            other.graph = graph;
        }
    }
    let mut graph = model.graph.clone();
    let forces = wrenches(&mut graph, &tree, &xi, &vec![zero; n], gravity);
    let solution =
        articulated::forward(&mut graph, &tree, &forces, &vec![zero; n]).expect("solves");
    let product: Vec<Edge> = {
        let mut sum = Vec::new();
        let m: Vec<Vec<Edge>> = (0..n)
            .map(|i| crate::algebra::transplant::rebuild(&other.graph, &mut graph, &mass[i]))
            .collect();
        let b = collect(&mut graph, &tree, &forces, n);
        for i in 0..n {
            let p = graph.dot(&m[i], &solution.xi_dot);
            sum.push(graph.add(p, b[i]));
        }
        sum
    };
    assert!(product.iter().all(|&edge| edge == zero), "forward dynamics");
    println!(
        "{name}: ID {id_count} bias {bias_count} M {mass_count} LDL {best:?} ABA {}",
        count(&graph, &solution.xi_dot).flops()
    );
}

#[test]
fn counts() {
    for n in [2, 4, 6] {
        agree(
            chain(n, "pose(rotx(pi/2), [0.1, 0.3, 0.5])"),
            &format!("right-angled {n}"),
        );
        agree(
            chain(n, "pose(rpy(0.3, 0.#, 1.2), [0.1, 0.3, 0.5])"),
            &format!("oblique {n}"),
        );
    }
}
