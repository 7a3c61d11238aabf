//! Joints are a shorthand: every kind is equivalent to a system written by hand with coordinates, velocities, rates and
//! frames, in values and in operation counts.

use crate::common::{Random, difference, generated, value};
use hamel_codegen::generate::Generated;
use hamel_codegen::program::count::count;
use hamel_codegen::proof::check::{Verdict, check};

/// Tolerance for two descriptions of one system in the same coordinates: rounding of a few hundred operations.
const TOLERANCE: f64 = 1e-12;
/// Number of states per pair.
const STATES_PER_PAIR: usize = 5;

/// The base and the body of the joint.
const SURROUNDINGS: &str = "
    joint ground: revolute [0, 0, 1] moves base { damping 0.3; };
    body on base { mass 2; com [0.1, 0, 0.2]; inertia diag(0.3, 0.2, 0.1) about com; }
    body on g { mass 1.5; com [0.1, 0.2, -0.3]; inertia diag(0.2, 0.3, 0.25) about com; }
    input u, t: vec3;
    gravity [0, 0, -9.81];
    generate accel, energy, inverse_dynamics;
";

/// Joints, each with its equivalent by hand.
const PAIRS: [(&str, &str); 17] = [
    (
        "joint j: continuous [0, 0, 2] on base at [0, 0, 1] moves g { stiffness 3; rest 0.4; }",
        "coord j: S1; velocity j_dot; rate j = j_dot; frame g on base = pose(rotz(j), [0, 0, 1]);
         potential 3 * angle([j.c * cos(0.4) + j.s * sin(0.4), j.s * cos(0.4) - j.c * sin(0.4)])^2 / 2;"
    ),
    (
        "joint j: universal [1, 0, 0], [0, 1, 0] on base at translation([0, 0.1, 0]) moves g { damping 0.3; }",
        "coord j_1, j_2; velocity j_1_dot, j_2_dot; rate j_1 = j_1_dot, j_2 = j_2_dot;
         frame c on base = pose(rotx(j_1), [0, 0.1, 0]); frame g on c = pose(roty(j_2), [0, 0, 0]);
         dissipation 0.15 * (j_1_dot^2 + j_2_dot^2);"
    ),
    (
        "joint j: revolute [1, 2, 2] on base at [0.1, 0, 0.2] moves g;",
        "coord j; velocity j_dot; rate j = j_dot;
         frame g on base = pose(axis_angle([1, 2, 2], j), [0.1, 0, 0.2]);",
    ),
    (
        "joint j: revolute [0, 1, 0] on base at pose(rotx(pi / 2), [0, 0, 0.4]) moves g;",
        "coord j; velocity j_dot; rate j = j_dot;
         frame g on base = pose([[1, 0, 0], [0, 0, -1], [0, 1, 0]] * roty(j), [0, 0, 0.4]);",
    ),
    (
        "joint j: revolute [0, 0, -3] on base moves g
           { damping 0.2; armature 0.3; stiffness 2; rest 0.1; force u; limit -1 to 1; }",
        "coord j; velocity j_dot; rate j = j_dot; frame g on base = pose(rotz(-j), [0, 0, 0]);
         generalized force j_dot = u - 0.2 * j_dot; potential (j - 0.1)^2; kinetic 0.3 * j_dot^2 / 2;",
    ),
    (
        "joint j: continuous [1, 0, 0] on base at pose(identity(3), [0, 0, 1]) moves g
           { damping 0.1; force u; armature 0.1; };",
        "coord j: S1; velocity j_dot; rate j = j_dot; frame g on base = pose(rotx(j), [0, 0, 1]);
         dissipation 0.05 * j_dot^2; generalized force j_dot = u; kinetic j_dot^2 / 20;",
    ),
    (
        "joint j: revolute [3, 0, 4] on base moves g;",
        "coord j; velocity j_dot; rate j = j_dot;
         frame g on base = pose(axis_angle([0.6, 0, 0.8], j), [0, 0, 0]);",
    ),
    (
        "joint j: continuous [3, 0, 4] on base moves g;",
        "coord j: S1; velocity j_dot; rate j = j_dot; const n = [0.6, 0, 0.8];
         frame g on base = pose(identity(3) + j.s * hat(n) + (1 - j.c) * hat(n) * hat(n), [0, 0, 0]);",
    ),
    (
        "joint j: prismatic [0, 2, 0] on base at pose(rotz(0.3), [0, 0, 1]) moves g
           { damping 0.2; stiffness 30; };",
        "coord j; velocity j_dot; rate j = j_dot;
         frame g on base = pose(rotz(0.3), [0, 0, 1] + rotz(0.3) * [0, j, 0]);
         generalized force j_dot = -0.2 * j_dot; potential 15 * j^2;",
    ),
    (
        "joint j: spherical on base at pose(identity(3), [0, 0, 1]) moves g { damping 0.1; force t; };",
        "coord j: SO3; velocity j_dot: vec3; rate j = j * hat(j_dot);
         frame g on base = pose(j, [0, 0, 1]); generalized force j_dot = t - 0.1 * j_dot;",
    ),
    (
        "joint j: spherical S3 on base moves g;",
        "coord j: S3; velocity j_dot: vec3;
         rate j = qmul(j, [0, j_dot[1], j_dot[2], j_dot[3]]) / 2;
         frame g on base = pose(rot(j), [0, 0, 0]);",
    ),
    (
        "joint j: free moves g;",
        "coord j_r: R3, j_R: SO3; velocity j_v: vec3, j_w: vec3;
         rate j_r = j_R * j_v; rate j_R = j_R * hat(j_w); frame g = pose(j_R, j_r);",
    ),
    (
        "joint j: planar [0, 1, 0] on base moves g;",
        "coord j_r: R2, j; velocity j_r_dot: vec2, j_dot; rate j_r = j_r_dot; rate j = j_dot;
         frame g on base = pose(roty(j), [j_r[2], 0, j_r[1]]);",
    ),
    (
        "joint j: universal [1, 0, 0], [0, 1, 0] on base at pose(identity(3), [0, 0, 1]) moves g;",
        "coord j_1, j_2; velocity j_1_dot, j_2_dot; rate j_1 = j_1_dot; rate j_2 = j_2_dot;
         frame g on base = pose(rotx(j_1) * roty(j_2), [0, 0, 1]);",
    ),
    (
        "joint j: cylindrical [0, 0, 1] on base at pose(roty(pi / 2), [0, 0, 1]) moves g;",
        "coord j, j_d; velocity j_dot, j_d_dot; rate j = j_dot; rate j_d = j_d_dot;
         frame g on base = pose(roty(pi / 2) * rotz(j), [j_d, 0, 1]);",
    ),
    (
        "joint j: fixed on base at pose(rotx(0.2), [0, 1, 0]) moves g;",
        "frame g on base = pose(rotx(0.2), [0, 1, 0]);",
    ),
    (
        "joint i: prismatic [0, 0, 1] on base moves h; joint j: revolute [1, 0, 0] on h moves g
           follows 2 * i + 0.1 { stiffness 2; rest 0.3; limit 0 to 1; };",
        "coord i; velocity i_dot; rate i = i_dot;
         frame g on base = pose(rotx(2 * i + 0.1), [0, 0, i]);
         potential (2 * i + 0.1 - 0.3)^2;",
    ),
];

fn system(text: &str) -> Generated {
    generated(&format!("system S {{ {text} {SURROUNDINGS} }}"))
}

#[test]
fn every_kind_is_what_is_written_by_hand() {
    let mut random = Random::new(0x6a6f_696e);
    for (joint, hand) in PAIRS {
        let (short, long) = (system(joint), system(hand));
        let program = &short.program;
        for _ in 0..STATES_PER_PAIR {
            let x = random.configuration(&program.blocks);
            // Coordinates are in the same order in both: those of `ground` are last.
            let (xi, u) = (random.numbers(program.n), random.numbers(program.m));
            let dot = random.numbers(program.n);
            let at = [x.as_slice(), &xi, &u, &dot];
            for function in ["accel", "energy", "inverse_dynamics"] {
                let (a, b) = (value(&short, function, at), value(&long, function, at));
                let apart = difference(&a, &b);
                assert!(apart < TOLERANCE, "{joint}: {function} {apart:e}");
            }
        }
    }
}

/// Joints never cost more than the description by hand.
#[test]
fn joints_cost_nothing() {
    for (joint, hand) in PAIRS {
        let (short, long) = (system(joint), system(hand));
        for name in ["accel", "inverse_dynamics"] {
            let operations = |of: &Generated| {
                let function = of.program.function(name).expect("it was asked for");
                count(&of.program.graph, &function.outputs).flops()
            };
            let (ours, hand) = (operations(&short), operations(&long));
            assert!(ours <= hand, "{joint}: {name} {ours} {hand}");
        }
    }
}

/// Checks identities, energy and power of a system with many kinds of joints.
#[test]
fn identities_hold() {
    let text = "system S {
        joint a: revolute [0, 0, 1] moves A { damping 0.1; armature 0.3; stiffness 2; force u; };
        joint b: prismatic [1, 0, 0] on A moves B { damping 0.2; armature 0.1; };
        joint c: spherical on B at pose(identity(3), [0, 0, 0.3]) moves C { damping 0.1; };
        body on A { mass 1; com [0.1, 0, 0.2]; inertia diag(0.3, 0.2, 0.1) about com; }
        body on B { mass 1; com [0.1, 0, 0.2]; inertia diag(0.3, 0.2, 0.1) about com; }
        body on C { mass 1; com [0.1, 0, 0.2]; inertia diag(0.3, 0.2, 0.1) about com; }
        input u; gravity [0, 0, -9.81];
    }";
    let system = generated(text);
    for identity in check(&system.model, &system.program) {
        let failed = matches!(identity.verdict, Verdict::Failed(_));
        assert!(!failed, "{} {}", identity.label, identity.equation);
    }
}

/// Relative poses for the recursion over the tree have exact zeros and ones.
#[test]
fn relative_poses_are_sparse() {
    let text = "system S {
        joint elbow: revolute [0, 1, 0] on upper at pose(rotx(pi / 2), [0, 0, 0.4]) moves fore;
        joint shoulder: revolute [0, 0, 2] moves upper { limit -pi to pi; max_speed 2; };
        body on upper { mass 1; inertia diag(1, 1, 1) about com; }
        body on fore { mass 1; com [1, 0, 0]; inertia diag(1, 1, 1) about com; }
    }";
    let system = generated(text);
    let model = &system.model;
    let names: Vec<&str> = model.frames.iter().map(|f| f.name.as_str()).collect();
    assert_eq!(names, ["upper", "fore"]);
    assert_eq!(model.frames[1].parent, Some(0));
    let known = |edge: &&_| model.graph.as_rational(**edge).is_some();
    let constants = |index: usize| {
        let (rotation, _) = &model.frames[index].relative;
        rotation.iter().flatten().filter(known).count()
    };
    // Two cosines, two sines, and five entries of 0 and ±1.
    assert_eq!([constants(0), constants(1)], [5, 5]);
    assert_eq!(model.joints.len(), 2);
    assert_eq!(model.joints[1].velocities, ["shoulder_dot"]);
    assert_eq!(model.joints[1].max_speed, Some(2.0));
    let pi = std::f64::consts::PI;
    assert_eq!(model.joints[1].limit, Some([-pi, pi]));
}
