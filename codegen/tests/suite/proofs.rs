//! The reference numbers of proofs agree with the symbolic derivations, and a single wrong entry of an emitted function
//! is refused: a wrong value, a wrong sign, or an omission.

use hamel_codegen::algebra::graph::Edge;
use hamel_codegen::algebra::numeric::evaluate_at;
use hamel_codegen::derive::reduction::reduce;
use hamel_codegen::derive::regressor::regressor as derived;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::lower::build;
use hamel_codegen::program::{FunctionId, Program};
use hamel_codegen::proof::constrained::frame::reference_agrees;
use hamel_codegen::proof::forms::ComparedQuantities;
use hamel_codegen::proof::numbers::FormEvaluator;
use hamel_codegen::proof::reference::ReferenceQuantities;
use hamel_codegen::proof::{correction, prove, regressor, validate};
use hamel_codegen::syntax::parse_text;

/// A model for every path of derivation: bodies with centres off the origin, a particle, a `kinetic` statement,
/// noncommuting velocities, loads and dampers of all kinds.
const ALL_ROUTES: &str = "system Whole {
    param m = 1.3, g = 9.81, J = 0.02, k = 3, c = 0.4;
    param s: vec3 = [0.1, -0.2, 0.3];
    param Theta: sym3 = [[2.1, 0.1, -0.2], [0.1, 1.7, 0.15], [-0.2, 0.15, 1.2]];
    coord r: R3, R: SO3, q, a: S1;
    velocity v: vec3, w: vec3, u, b;
    rate r = R * v;
    rate R = R * hat(w);
    rate q = u;
    rate a = b - u;
    frame hull = pose(R, r);
    frame arm on hull = pose(rotx(q), [0.2, 0, 0.1]);
    frame hand on arm = pose(rotz(a), [0, 0.3, 0]);
    body on hull { mass m; com s; inertia Theta about origin; }
    body on arm { mass 0.7; com s; inertia Theta about com; }
    body on hand { mass 0.2; com [0, 0.1, 0]; inertia Theta about com; }
    particle mass 0.3 at r + R * [1, q, q^2];
    kinetic J / 2 * (u + q * b)^2;
    potential k / 2 * q^2;
    gravity [0, 0, -g];
    input F: vec3, tau: vec3;
    wrench (F, tau) on hull in body;
    wrench (tau, F) on arm in world;
    dissipation c / 2 * u^2;

}";

#[test]
fn the_numbers_are_those_of_the_symbolic_derivations() {
    let system = parse_text(ALL_ROUTES).expect("a description");
    let model = build(&system).expect("a model");
    let symbols = ComparedQuantities::new(&model).expect("Y");
    let graph = &symbols.geometry.model.graph;
    let numbers = FormEvaluator::new(&model).expect("Y");
    for seed in 1..4 {
        let point = model.points.lane(seed).expect("a point");
        let values = numbers.at(&point).expect("values").expect("Y A = I");
        let at = |edges: &[Edge]| evaluate_at(graph, edges, &mut point.clone()).expect("values");
        assert_eq!(values.left[0], values.left[1], "(30a) = (30b)");
        assert_eq!(values.left[0], values.left[2], "(30a) = (30c)");
        assert_eq!(values.left[0], at(&symbols.hamel));
        assert_eq!(values.left[1], at(&symbols.gibbs));
        assert_eq!(values.mass.concat(), at(&symbols.geometry.mass.concat()));
        assert_eq!(values.force, at(&symbols.virtual_work));
        assert_eq!(vec![values.kinetic], at(&[symbols.kinetic]));
        assert_eq!(vec![values.potential], at(&[symbols.geometry.potential]));
    }
}

#[test]
fn a_wrong_term_of_any_function_is_refused() {
    let Generated { model, program, .. } =
        from_text(ALL_ROUTES).unwrap_or_else(|errors| panic!("{errors:?}"));
    assert!(validate::validate(&model, &program).is_ok());
    let mut refused = 0;
    for index in 0..program.functions.len() {
        if !validate::COMPARED_FUNCTIONS.contains(&program.functions[index].name.as_str()) {
            continue;
        }
        let last = program.functions[index].outputs.len() - 1;
        for place in [0, last / 2, last] {
            let mut broken = program.clone();
            let one = broken.graph.one();
            let entry = broken.functions[index].outputs[place];
            broken.functions[index].outputs[place] = broken.graph.add(entry, one);
            let name = &program.functions[index].name;
            assert!(
                validate::validate(&model, &broken).is_err(),
                "{name} {place}"
            );
            refused += 1;
        }
    }
    assert!(refused > 30);
}

const ARM: &str = "system Arm {
    joint a: revolute [0, 0, 1] moves f;
    joint b: revolute [0, 1, 0] on f at pose(rotx(pi / 4), [1, 0, 0.5]) moves g;
    body on g { mass 1; com [1, 2, 3]; inertia diag(1, 2, 3) about com; }
    let c = position(g)[1] * angular_velocity(g)[3];
    output y = c * c;
    output felt = acceleration(g)[2];
    generate y_slopes, felt_slopes, jacobian g, jacobian g in g, centre_of_mass, centroidal_map, centroidal_bias;
}";

#[test]
fn one_wrong_entry_of_what_is_observed_is_refused() {
    let generated = from_text(ARM).expect("a program");
    let model = &generated.model;
    assert!(prove(model, None, None, [&generated.program; 2]).is_ok());
    let names = generated.program.functions.iter().map(|f| f.name.clone());
    let observed = |name: &String| {
        ["g_", "y_", "felt_", "cent"]
            .iter()
            .any(|start| name.starts_with(start))
    };
    let names: Vec<String> = names.filter(observed).collect();
    assert_eq!(names.len(), 13, "{names:?}");
    for name in names {
        let mut program = generated.program.clone();
        let function = program.functions.iter_mut().find(|f| f.name == name);
        let outputs = &mut function.expect("a function").outputs;
        let varying = |edge: &Edge| program.graph.class(edge.node()) != 0;
        let place = outputs
            .iter()
            .rposition(varying)
            .expect("an entry that varies");
        outputs[place] = -outputs[place];
        assert!(prove(model, None, None, [&program; 2]).is_err(), "{name}");
    }
}

#[test]
fn one_wrong_entry_of_a_regressor_is_refused() {
    let text = "system Arm {
        param l = 0.3;
        joint a: revolute [0, 1, 0] moves f { armature 0.02; damping 0.1; }
        joint b: revolute [1, 2, 2] on f at translation([l, 0, 0]) moves g;
        body on f { mass 2; com [0.1, 0, 0]; inertia diag(0.03, 0.03, 0.04) about com; }
        body on g { mass 1; com [0.2, 0.1, 0]; inertia diag(0.02, 0.03, 0.04) about com; }
        gravity [0, 0, -9.81];
        generate regressor;
    }";
    let generated = from_text(text).expect("a program");
    let model = &generated.model;
    let derived = derived(model).expect("base parameters");
    assert!(regressor::validate(model, &derived, &generated.program).is_ok());
    for name in ["regressor", "base_parameters"] {
        let mut program = generated.program.clone();
        let function = program.functions.iter_mut().find(|f| f.name == name);
        let outputs = &mut function.expect("a function").outputs;
        let zero = program.graph.zero();
        let place = outputs.iter().rposition(|edge| *edge != zero);
        let place = place.expect("an entry that is not 0");
        outputs[place] = -outputs[place];
        assert!(
            regressor::validate(model, &derived, &program).is_err(),
            "{name}"
        );
    }
}

/// Wrong columns of Y_b with the matching columns of Y; most of their parameters are zero in the description.
#[test]
fn wrong_columns_of_parameters_that_are_zero_are_refused() {
    let text = "system Arm {
        joint a: revolute [0, 1, 0] moves f;
        joint b: revolute [1, 2, 2] on f at translation([0.3, 0, 0]) moves g;
        body on f { mass 2; com [0, 0, 0]; inertia diag(0.03, 0.03, 0.04) about com; }
        body on g { mass 1; com [0, 0, 0]; inertia diag(0.02, 0.03, 0.04) about com; }
        gravity [0, 0, -9.81];
        generate regressor;
    }";
    let generated = from_text(text).expect("a program");
    let right = derived(&generated.model).expect("base parameters");
    assert!(regressor::check_base_parameters(&generated.model, &right).is_ok());
    assert_eq!(right.base.len(), 10);
    for place in 0..right.base.len() {
        let mut wrong = right.clone();
        let base = &mut wrong.base[place];
        let graph = &mut wrong.model.graph;
        for &(k, factor) in &base.terms {
            for (entry, &of_base) in wrong.columns[k].iter_mut().zip(&base.column) {
                let share = graph.mul(factor, of_base);
                let twice = graph.add(share, share);
                *entry = graph.sub(*entry, twice);
            }
        }
        base.column.iter_mut().for_each(|entry| *entry = -*entry);
        let found = regressor::check_base_parameters(&generated.model, &wrong);
        assert!(found.is_err(), "{}", right.base[place].name);
    }
}

/// A single wrong entry is detected: a wrong value, a wrong sign, or an omission.
#[test]
fn one_wrong_entry_of_a_correction_is_refused() {
    let text = "system A {
        coord q: S3, R: SO3; velocity w: vec3, o: vec3; rate q = qmul(q, [0, w[1], w[2], w[3]]) / 2; rate R = R * hat(o);
        kinetic dot(w, w) / 2 + dot(o, o) / 2;
    }";
    let generated = from_text(text).unwrap_or_else(|errors| panic!("{errors:?}"));
    let (model, program) = (&generated.model, &generated.program);
    assert!(correction::validate(model, program).is_ok());
    let index = (program.functions.iter())
        .position(|function| function.id == Some(FunctionId::Correction))
        .expect("it is there");
    for place in 0..program.functions[index].outputs.len() {
        let mut wrong = program.clone();
        let entry = wrong.functions[index].outputs[place];
        let others = [
            -entry,
            wrong.graph.zero(),
            wrong.graph.add(entry, wrong.graph.one()),
        ];
        for other in others {
            wrong.functions[index].outputs[place] = other;
            assert!(
                correction::validate(model, &wrong).is_err(),
                "entry {place}"
            );
        }
    }
}

/// Coordinates of every kind, and dependent velocities.
const CHARTS: [&str; 2] = [
    "system Kinds {
        coord r: R3, q: S3, R: SO3, a: S1, z;
        velocity v: vec3, w: vec3, o: vec3, b, u;
        rate r = R * v;
        rate q = qmul(q, [0, w[1], w[2], w[3]]) / 2;
        rate R = R * hat(o);
        rate a = b - u;
        rate z = u;
        kinetic dot(v, v) / 2 + dot(w, w) / 2 + dot(o, o) / 2 + b^2 / 2 + u^2 / 2;
    }",
    "system Disk {
        coord x, y, a: S1; velocity u, v, w; rate x = u; rate y = v; rate a = w + u;
        kinetic u^2 / 2 + v^2 / 2 + w^2 / 2;
        nonholonomic u * a.s - v * a.c = 0;
    }",
];

#[test]
fn a_wrong_sign_in_the_rate_of_the_chart_is_refused() {
    for text in CHARTS {
        let generated = from_text(text).unwrap_or_else(|errors| panic!("{errors:?}"));
        let reduction = reduce(&generated.model).expect("regular");
        let proved =
            |program: &Program| prove(&generated.model, reduction.as_ref(), None, [program; 2]);
        assert!(proved(&generated.program).is_ok());
        let chart = (generated.program.functions.iter())
            .position(|function| function.id == Some(FunctionId::ChartRate))
            .expect("it is there");
        for place in 0..generated.program.functions[chart].outputs.len() {
            let mut wrong = generated.program.clone();
            let entry = &mut wrong.functions[chart].outputs[place];
            *entry = -*entry;
            let errors = proved(&wrong).expect_err("a wrong sign");
            assert!(
                errors[0].message.contains("rate of the chart"),
                "{}",
                errors[0].message
            );
        }
    }
}

/// A wrong sign in any entry of the reference for reduced systems is detected, together with several kinds of
/// constraints.
#[test]
fn a_wrong_sign_in_the_full_frame_is_noticed() {
    let text = "system Sleigh {
        param m = 2, s = 0.3; input F; time t;
        coord x, y, a: S1, l; velocity u, v, w, e; rate x = u * a.c - v * a.s, y = u * a.s + v * a.c, a = w, l = e;
        kinetic m * (u^2 + (v + s * w)^2) / 2 + w^2 * (1 + l^2) / 2 + e^2 / 2;
        potential 3 * (l - s)^2 / 2 + x^2 * a.c;
        generalized force u = F - 0.2 * u^2;
        damper coefficient 0.4 on e - w;
        nonholonomic v = 0;
        prescribe l = 0.2 * sin(t);
    }";
    let system = parse_text(text).expect("a description");
    let model = build(&system).expect("a model");
    let reference = ReferenceQuantities::new(&model).expect("regular");
    assert_eq!(reference_agrees(&model, &reference), Some(true));
    let zero = model.graph.zero();
    let mut broken = 0;
    for list in 0..3 {
        for place in 0..model.n() {
            let mut wrong = ReferenceQuantities::new(&model).expect("regular");
            let list = [&mut wrong.bias, &mut wrong.slope, &mut wrong.force]
                .into_iter()
                .nth(list)
                .expect("three");
            if list[place] != zero {
                list[place] = -list[place];
                assert_eq!(reference_agrees(&model, &wrong), Some(false), "{place}");
                broken += 1;
            }
        }
    }
    assert!(broken > 6, "{broken}");
}
