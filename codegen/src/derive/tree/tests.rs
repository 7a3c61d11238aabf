//! Recursions against the derivation that knows no trees: the same values on X.

use super::inverse::{inverse, wrenches};
use super::{Placement, Tree, articulated, composite, nearby};
use crate::algebra::derivation::Derivation;
use crate::derive::accel::parts::{Reference, Variant, parts};
use crate::derive::calculus::Calculus;
use crate::model::Model;
use crate::syntax::ast::Axes;

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
    built(&text)
}

/// Joints of all kinds on two roots, with armatures, a particle, a body on a welded frame.
const MIXED: &str = "system Mixed {
    gravity [1, -2, -9.81];
    joint base: free moves hull;
    body on hull { mass 7; com [0.1, 0.2, 0.3]; inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.5]] about com; }
    joint slide: prismatic [1, 2, 2] on hull at pose(rpy(0.3, 0.2, 0.1), [0.1, 0, 0.4]) moves carriage { armature 0.3; };
    joint arm: continuous [0, 1, 0] on carriage at pose(rotx(pi/2), [0.2, 0.1, 0]) moves upper { armature 0.2; };
    body on carriage { mass 1; com [0.1, 0.2, 0.3]; inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.5]] about origin; }
    joint weld: fixed on upper at pose(rotz(pi/3), [0, 0.3, 0]) moves bracket;
    body on bracket { mass 2; com [0.1, 0.2, 0.1]; inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.5]] about com; }
    joint ball: spherical on hull at pose(identity(3), [0, 0, -0.5]) moves bob;
    body on bob { mass 1.5; com [0.1, 0.05, 0.3]; inertia [[0.2, 0.01, 0.02], [0.01, 0.3, 0.03], [0.02, 0.03, 0.25]] about com; }
    joint can: cylindrical [0, 0, 1] moves tin;
    body on tin { mass 1; com [0.2, 0.1, 0]; inertia diag(1, 2, 2.5) about com; }
    particle mass 0.4 at position(tin, [0.1, 0.2, 0.3]);
}";

/// A plate slides along axes that do not turn with it.
const FLAT: &str = "system Flat {
    gravity [1, -2, -9.81];
    joint flat: planar [0, 0, 1] moves plate;
    body on plate { mass 3; com [0.1, 0.2, 0.1]; inertia diag(1, 2, 2.5) about com; }
    joint can: cylindrical [0, 0, 1] on plate moves tin;
    body on tin { mass 1; com [0.2, 0.1, 0]; inertia diag(1, 2, 2.5) about com; }
    particle mass 0.4 at position(tin, [0.1, 0.2, 0.3]);
}";

fn built(text: &str) -> Model {
    let system = crate::syntax::parse_text(text).expect("parses");
    crate::lower::build(&system).expect("is a model")
}

/// Inverse dynamics, M, forward dynamics and slopes by recursion against the derivation that traces every
/// body by itself.
fn agree(mut model: Model, steady: bool) {
    let mut calculus = Calculus::new(&model);
    let variant = Variant {
        axes: Axes::Body,
        reference: Reference::Com,
        shift: None,
    };
    let mut plain = model.clone();
    let parts = parts(&mut plain, &mut calculus.clone(), variant);
    let tree = Tree::of(&mut model, &mut calculus, Placement::Chosen).expect("is a tree");
    let n = model.n();
    let zero = model.graph.zero();
    let (xi, xi_dot, gravity) = (model.xi.clone(), model.xi_dot.clone(), model.gravity);
    let id = inverse(&mut model.graph, &tree, &xi, &xi_dot, gravity);
    let expected = parts.whole(&mut plain.graph, &model);
    for i in 0..n {
        assert_eq!(
            plain.graph.value(expected[i]),
            model.graph.value(id[i]),
            "row {i} of inverse dynamics"
        );
    }
    let mut graph = model.graph.clone();
    let mass = composite::mass_matrix(&mut graph, &tree, n);
    for i in 0..n {
        for j in 0..n {
            let expected = plain.graph.value(parts.mass[i][j]);
            assert_eq!(expected, graph.value(mass[i][j]), "M {i} {j}");
        }
    }
    if tree.is_plain(&graph, n, &[]) {
        let still = vec![zero; n];
        let forces = wrenches(&mut graph, &tree, &xi, &still, gravity);
        let bias = inverse(&mut graph, &tree, &xi, &still, gravity);
        let found = articulated::forward(&mut graph, &tree, &[], &forces, &still).expect("solves");
        for i in 0..n {
            let inertial = graph.dot(&mass[i], &found.xi_dot);
            assert_eq!(graph.add(inertial, bias[i]), zero, "row {i} of M ξ̇ + h");
        }
    }
    let mut graph = model.graph.clone();
    let found = nearby::slopes(&mut graph, &tree, &xi, &xi_dot, gravity);
    assert_eq!(found.is_some(), steady);
    let Some(found) = found else { return };
    let one = model.graph.one();
    for j in 0..n {
        let mut faster = Derivation::new([(xi[j].node(), one)]);
        for i in 0..n {
            let by_place = calculus.along(&mut model.graph, j, id[i]);
            let by_rate = faster.of(&mut model.graph, id[i]);
            let expected = [by_place, by_rate].map(|edge| model.graph.value(edge));
            let entries = [found.displacement[i][j], found.velocity[i][j]];
            let entries = entries.map(|edge| graph.value(edge));
            assert_eq!(expected, entries, "slopes of row {i} along {j}");
        }
    }
}

#[test]
fn chains_have_the_values_of_the_plain_derivation() {
    for n in [2, 4, 6] {
        agree(chain(n, "pose(rotx(pi/2), [0.1, 0.3, 0.5])"), true);
        agree(chain(n, "pose(rpy(0.3, 0.#, 1.2), [0.1, 0.3, 0.5])"), true);
    }
}

#[test]
fn joints_of_all_kinds_have_the_values_of_the_plain_derivation() {
    agree(built(MIXED), true);
    agree(built(FLAT), false);
}

/// Spin in world axes: the freedoms of the joint vary with x, and drift.
#[test]
fn joints_with_world_axes_have_the_values_of_the_plain_derivation() {
    let text = "system World { gravity [0, 0, -9.81]; coord r: R3, R: SO3; velocity v: vec3, w: vec3; rate r = v;
        rate R = hat(w) * R; frame hull = pose(R, r);
        body on hull { mass 7; com [0.1, 0.2, 0.3]; inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.5]] about com; }
        joint arm: revolute [0, 1, 0] on hull moves upper { armature 0.2; };
        body on upper { mass 1; com [0.2, 0.1, 0]; inertia diag(1, 2, 2.5) about com; } }";
    agree(built(text), false);
}

/// Inertia that no frame carries is not that of links.
#[test]
fn other_inertia_is_no_tree() {
    let kinds = [
        "kinetic 0.5 * q^2 * u^2;",
        "particle mass 1 at [q^2, 0, 0];",
    ];
    for other in kinds {
        let text = format!(
            "system Other {{ coord q; velocity u; rate q = u; frame f = pose(rotz(q), [0, 0, 0]);
             body on f {{ mass 1; inertia diag(1, 2, 3) about com; }} {other} }}"
        );
        let mut model = built(&text);
        let mut calculus = Calculus::new(&model);
        assert!(
            Tree::of(&mut model, &mut calculus, Placement::Chosen).is_none(),
            "{other}"
        );
    }
}
