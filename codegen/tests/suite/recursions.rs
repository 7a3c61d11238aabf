//! Recursions have the same values on X as the derivation that does not use trees.

use hamel_codegen::algebra::derivation::Derivation;
use hamel_codegen::algebra::graph::{Edge, Graph};
use hamel_codegen::derive::accel::branches::BranchFactors;
use hamel_codegen::derive::accel::parts::{ReferencePoint, TracingVariant, trace_terms};
use hamel_codegen::derive::calculus::Calculus;
use hamel_codegen::derive::tree::inverse::{inverse_dynamics, required_wrenches};
use hamel_codegen::derive::tree::{Placement, Tree, articulated, composite, slopes};
use hamel_codegen::model::Model;
use hamel_codegen::syntax::ast::Axes;

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

/// Joints of all kinds on two roots, with armatures, a particle, and a body on a welded frame.
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

/// A plate that slides along axes that do not rotate with it.
const FLAT: &str = "system Flat {
    gravity [1, -2, -9.81];
    joint flat: planar [0, 0, 1] moves plate;
    body on plate { mass 3; com [0.1, 0.2, 0.1]; inertia diag(1, 2, 2.5) about com; }
    joint can: cylindrical [0, 0, 1] on plate moves tin;
    body on tin { mass 1; com [0.2, 0.1, 0]; inertia diag(1, 2, 2.5) about com; }
    particle mass 0.4 at position(tin, [0.1, 0.2, 0.3]);
}";

fn built(text: &str) -> Model {
    let system = hamel_codegen::syntax::parse_text(text).expect("parses");
    hamel_codegen::lower::build(&system).expect("is a model")
}

/// Legs of three hinges on a free hull, two of them parallel; one leg is mounted at awkward angles, and an arm slides.
const LEGGED: &str = "system Legged {
    gravity [1, -2, -9.81];
    input push: vec3, twist: vec3, knee;
    joint base: free moves hull;
    wrench (push, twist) on hull in body;
    body on hull { mass 7; com [0.1, 0.2, 0.3]; inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.5]] about com; }
    joint hip1: continuous [1, 0, 0] on hull at pose(identity(3), [0.3, 0.2, 0.1]) moves a1;
    body on a1 { mass 1; com [0.1, 0.2, 0.3]; inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.5]] about com; }
    joint thigh1: continuous [0, 1, 0] on a1 at pose(identity(3), [0.1, 0.05, 0]) moves b1 { armature 0.1; };
    body on b1 { mass 2; com [0.1, 0.2, -0.3]; inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.5]] about com; }
    joint knee1: continuous [0, 1, 0] on b1 at pose(roty(0.4), [0.1, 0.05, -0.6]) moves c1 { force knee; };
    body on c1 { mass 0.5; com [0.1, 0.2, -0.2]; inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.5]] about com; }
    joint hip2: continuous [0, 1, 0] on hull at pose(rpy(0.3, 0.2, 0.1), [-0.3, 0.2, 0.1]) moves a2;
    body on a2 { mass 1; com [0.1, 0.2, 0.3]; inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.5]] about com; }
    joint knee2: continuous [0, -1, 0] on a2 at pose(identity(3), [0.1, 0.05, -0.6]) moves b2;
    body on b2 { mass 0.5; com [0.1, 0.2, -0.2]; inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.5]] about com; }
    joint arm: prismatic [0, 0, 1] on hull at pose(identity(3), [0, 0.1, 0.2]) moves hand;
    body on hand { mass 0.5; com [0.1, 0.2, -0.2]; inertia diag(1, 2, 2.5) about com; }
}";

/// Compares inverse dynamics, M, forward dynamics and slopes by recursion, for any placement of the frames, with the
/// derivation that treats every body separately.
fn agree(model: Model, steady: bool) {
    let placements = [Placement::Chosen, Placement::Parallel, Placement::Described];
    for placement in placements {
        agree_placed(model.clone(), placement, steady);
    }
}

fn agree_placed(mut model: Model, placement: Placement, steady: bool) {
    let mut calculus = Calculus::new(&model);
    let variant = TracingVariant {
        axes: Axes::Body,
        reference: ReferencePoint::Com,
        shift: None,
    };
    let mut plain = model.clone();
    let parts = trace_terms(&mut plain, &mut calculus.clone(), variant);
    let tree = Tree::of(&mut model, &mut calculus, placement).expect("is a tree");
    let n = model.n();
    let zero = model.graph.zero();
    let (xi, xi_dot, gravity) = (model.xi.clone(), model.xi_dot.clone(), model.gravity);
    let id = inverse_dynamics(&mut model.graph, &tree, &xi, &xi_dot, gravity);
    let expected = parts.inverse_dynamics_of(&mut plain.graph, &model);
    for i in 0..n {
        assert_eq!(
            plain.graph.value(expected[i]),
            model.graph.value(id[i]),
            "row {i} of inverse dynamics"
        );
    }
    let mut graph = model.graph.clone();
    for (graph, mass) in composite::mass_matrices(&graph, &tree, n) {
        for i in 0..n {
            for j in 0..n {
                let expected = plain.graph.value(parts.mass[i][j]);
                assert_eq!(expected, graph.value(mass[i][j]), "M {i} {j}");
            }
        }
    }
    let mass = composite::mass_matrix(&mut graph, &tree, n);
    if tree.is_plain(&graph, n, &[]) {
        let still = vec![zero; n];
        let forces = required_wrenches(&mut graph, &tree, &xi, &still, gravity);
        let bias = inverse_dynamics(&mut graph, &tree, &xi, &still, gravity);
        let found = articulated::articulated_body_dynamics(&mut graph, &tree, &[], &forces, &still)
            .expect("solves");
        for i in 0..n {
            let inertial = graph.dot(&mass[i], &found.xi_dot);
            assert_eq!(graph.add(inertial, bias[i]), zero, "row {i} of M ξ̇ + h");
        }
    }
    let mut graph = model.graph.clone();
    let found = slopes::inverse_dynamics_derivatives(&mut graph, &tree, &xi, &xi_dot, gravity);
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
        agree(chain(n, "pose(rotz(0.#), [0.1, 0.3, 0.#])"), true);
    }
}

/// Parallel hinges on a slide, in two branches, one followed by a ball joint and one by a perpendicular hinge.
#[test]
fn parallel_hinges_have_the_values_of_the_plain_derivation() {
    let body = "inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.5]] about com";
    let mut text = String::from(
        "system Branched { gravity [1, -2, -9.81];
         joint slide: prismatic [1, 2, 2] moves cart;
         joint a: continuous [0, 1, 0] on cart at pose(identity(3), [0.1, 0.2, 0.3]) moves f1;
         joint b: continuous [0, 1, 0] on f1 at pose(roty(0.4), [0.3, 0.1, -0.2]) moves f2;
         joint c: continuous [0, -1, 0] on f2 at pose(identity(3), [0.3, 0.1, 0.2]) moves f3;
         joint d: continuous [0, 1, 0] on f1 at pose(identity(3), [-0.3, 0.2, -0.2]) moves f4;
         joint e: continuous [1, 0, 1] on f4 at pose(rotx(0.3), [-0.3, 0.2, -0.2]) moves f5;
         joint g: continuous [0, 1, 0] on f4 at pose(identity(3), [0.4, 0.2, -0.2]) moves f6 { armature 0.3; };
         joint ball: spherical on f3 at pose(identity(3), [0.1, 0.2, -0.2]) moves f7;
         body on cart { mass 2; };\n",
    );
    for i in 1..=7 {
        text += &format!("body on f{i} {{ mass 1.{i}; com [0.1, 0.{i}, 0.3]; {body}; }}\n");
    }
    agree(built(&(text + "}")), true);
}

#[test]
fn joints_of_all_kinds_have_the_values_of_the_plain_derivation() {
    agree(built(MIXED), true);
    agree(built(FLAT), false);
    agree(built(LEGGED), true);
}

/// M e = M s for the parts carried by a joint, M⁻¹ by branches is that of M, and ξ̇ is proper acceleration plus the
/// acceleration common to all links.
#[test]
fn branches_answer_as_the_mass_matrix_does() {
    // A slider on the other hull has an armature, which only the velocity of the slider moves.
    for (text, expected) in [(LEGGED, 3), (MIXED, 0)] {
        for placement in [Placement::Chosen, Placement::Parallel] {
            let mut model = built(text);
            let mut calculus = Calculus::new(&model);
            let tree = Tree::of(&mut model, &mut calculus, placement).expect("is a tree");
            let (n, gravity, xi) = (model.n(), model.gravity, model.xi.clone());
            let graph = &mut model.graph;
            let (zero, still) = (graph.zero(), vec![graph.zero(); n]);
            let mass = composite::mass_matrix(graph, &tree, n);
            let twins = tree.equivalent_motions(graph);
            assert_eq!(twins.len(), expected, "twins");
            for twin in &twins {
                let terms = twin.by.iter();
                let terms = terms.map(|&(i, s)| graph.mul(mass[twin.of][i], s));
                let terms: Vec<_> = terms.collect();
                assert_eq!(
                    graph.sum(&terms),
                    mass[twin.of][twin.of],
                    "twin of {}",
                    twin.of
                );
            }
            let branches = BranchFactors::factorize(graph, &mass, &twins).expect("M is regular");
            let unit = |graph: &Graph, i: usize| -> Vec<Edge> {
                let entry = |j| if i == j { graph.one() } else { zero };
                (0..n).map(entry).collect()
            };
            let mut columns: Vec<Vec<Edge>> = (0..n).map(|i| unit(graph, i)).collect();
            columns.push(xi.clone());
            // A wrench on the parts carried by the first hip: one branch and its ancestors.
            columns.push((0..n).map(|i| if i < 9 { xi[i] } else { zero }).collect());
            for column in columns {
                let solved = branches.solve(graph, &column);
                for (i, row) in mass.iter().enumerate() {
                    assert_eq!(graph.dot(row, &solved), column[i], "row {i}");
                }
            }
            let bias = inverse_dynamics(graph, &tree, &xi, &still, gravity);
            let Some(uniform) = tree.common_motion(graph, &xi, gravity) else {
                assert_eq!(text, MIXED, "all roots of the other are free");
                continue;
            };
            let none = [zero; 3];
            let proper = inverse_dynamics(graph, &tree, &uniform.xi, &still, none);
            for (i, row) in mass.iter().enumerate() {
                let common = graph.dot(row, &uniform.rates);
                let force = graph.add(bias[i], common);
                assert_eq!(force, proper[i], "row {i} of what is proper");
            }
        }
    }
}

/// Spin in world axes: the axes of the joint vary with x, and drift.
#[test]
fn joints_with_world_axes_have_the_values_of_the_plain_derivation() {
    let text = "system World { gravity [0, 0, -9.81]; coord r: R3, R: SO3; velocity v: vec3, w: vec3; rate r = v;
        rate R = hat(w) * R; frame hull = pose(R, r);
        body on hull { mass 7; com [0.1, 0.2, 0.3]; inertia [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 2.5]] about com; }
        joint arm: revolute [0, 1, 0] on hull moves upper { armature 0.2; };
        body on upper { mass 1; com [0.2, 0.1, 0]; inertia diag(1, 2, 2.5) about com; } }";
    agree(built(text), false);
}

/// Inertia that is not attached to a frame does not belong to links.
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
