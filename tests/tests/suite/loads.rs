//! Loads are proved: a wrong sign in any of them is detected. Frames may be given in any order.

use hamel_codegen::algebra::graph::Edge;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::model::Model;
use hamel_codegen::program::Program;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::proof::check::{Verdict, check};
use std::path::Path;

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.eom"));
    std::fs::read_to_string(path).expect("the model is in the repository")
}

fn generated(name: &str) -> Generated {
    from_text(&text(name)).unwrap_or_else(|errors| panic!("{name}: {errors:?}"))
}

fn failures(model: &Model, program: &Program) -> Vec<String> {
    check(model, program)
        .into_iter()
        .filter(|identity| matches!(identity.verdict, Verdict::Failed(_)))
        .map(|identity| identity.equation)
        .collect()
}

const FORCE: &str = "fᵢ = Σ ⟨F_p, ∂ᵢr_p⟩ for the emitted f";
const SLOPE: &str = "−∂ᵢV = Σ ⟨F_p, ∂ᵢr_p⟩ of weights and springs";
const LOSS: &str = "2 D = −fᵢ ξⁱ of dampers";
const LENGTH: &str = "ℓ² = d·d of springs and forces along lines";
const MOTION: &str = "ṙ and r̈ of points from ∂ᵢr and ∂ᵢ∂ⱼr";

/// Flips one sign of an emitted function.
#[test]
fn a_wrong_sign_in_an_emitted_force_is_noticed() {
    for (name, function, entry, equation) in [
        ("actuated_pendulum", "generalized_force", 1, FORCE),
        ("suspended_body", "generalized_force", 4, FORCE),
        ("spring_chain", "generalized_force", 1, FORCE),
        ("spring_chain", "potential_force", 2, SLOPE),
        ("suspended_body", "potential_force", 3, SLOPE),
        ("elastic_pendulum", "dissipation", 0, LOSS),
    ] {
        let Generated {
            model, mut program, ..
        } = generated(name);
        assert!(failures(&model, &program).is_empty(), "{name}");
        let emitted = program.functions.iter_mut().find(|f| f.name == function);
        let outputs = &mut emitted.expect("the function").outputs;
        outputs[entry] = -outputs[entry];
        let found = failures(&model, &program);
        assert!(
            found.iter().any(|found| found == equation),
            "{name}: {found:?}"
        );
    }
}

/// If a load, spring or damper of the model differs from the description, no program is assembled.
#[test]
fn a_wrong_sign_in_the_derivation_of_a_load_is_noticed() {
    type Change = fn(&mut Model);
    fn flip(edge: &mut Edge) {
        *edge = -*edge;
    }
    let changes: [(&str, Change, &str); 5] = [
        ("drone", |m| flip(&mut m.wrenches[1].force[2]), FORCE),
        (
            "actuated_pendulum",
            |m| flip(&mut m.wrenches[2].torque[2]),
            FORCE,
        ),
        (
            "suspended_body",
            |m| m.wrenches[0].force.iter_mut().for_each(flip),
            FORCE,
        ),
        (
            "suspended_body",
            |m| {
                m.elements.springs[0].wrenches[0]
                    .force
                    .iter_mut()
                    .for_each(flip)
            },
            SLOPE,
        ),
        ("spring_chain", |m| flip(&mut m.generalized[2]), FORCE),
    ];
    for (name, change, equation) in changes {
        let Generated {
            mut model, program, ..
        } = generated(name);
        change(&mut model);
        let errors = Generated::of(model.clone(), 0).expect_err(name);
        assert!(
            errors[0].message.contains("internal check failed"),
            "{name}"
        );
        // The identity concerns the loads of the changed model, so the correct program still satisfies it.
        assert!(
            !failures(&model, &program)
                .iter()
                .any(|found| found == equation),
            "{name}"
        );
    }
}

#[test]
fn a_wrong_length_or_motion_is_noticed() {
    let Generated {
        mut model, program, ..
    } = generated("suspended_body");
    let spring = &mut model.elements.springs[0];
    spring.along = hamel_codegen::model::elements::Along::Line {
        from: [model.graph.zero(); 3],
        to: [model.graph.one(); 3],
        length: Some(model.graph.one()),
    };
    let found = failures(&model, &program);
    assert!(
        [LENGTH, SLOPE]
            .iter()
            .all(|wanted| found.iter().any(|found| found == wanted)),
        "{found:?}"
    );

    let Generated {
        mut model, program, ..
    } = generated("drone");
    for index in 0..model.observed.len() {
        let mut wrong = model.clone();
        let value = &mut wrong.observed[index].value;
        value[1] = -value[1];
        assert_eq!(failures(&wrong, &program), [MOTION], "{index}");
    }
    model.observed.clear();
    assert!(failures(&model, &program).is_empty());
}

/// Returns the numbers of a function at a state given by names of coordinates.
fn numbers(generated: &Generated, function: &str) -> Vec<f64> {
    let program = &generated.program;
    let function = program.function(function).expect("the function");
    let x = &program.start_x;
    let xi: Vec<f64> = (0..program.n).map(|i| 0.3 + 0.2 * i as f64).collect();
    let u = vec![2.5; program.m];
    Interpreter::new(program, function, &program.defaults)
        .call(x, &xi, &u, &[])
        .expect("a value")
}

/// Frames in the order of their tree and in any other order describe the same mechanism.
#[test]
fn the_order_and_direction_of_frames_does_not_matter() {
    let scattered = text("frame_graph");
    let start = scattered.find("    frame wheel").expect("the first frame");
    let end = scattered.find("    body on hull").expect("the first body");
    let ordered = format!(
        "{}    frame hull = pose(rotz(h), [r[1], r[2], 0]);
    frame wheel on hull = pose(rotz(0.2), [0, 0.3, -0.1]);
    frame camera on hull = pose(rotz(0.3), [0.1, 0, 0.2]);
    frame hand on camera = inverse(pose(rotx(q), [-a, 0, 0]));
    frame elbow on hand = pose(rotz(-0.4), [0, b * hull.R[3, 3], 0]);
{}",
        &scattered[..start],
        &scattered[end..]
    );
    let (a, b) = (from_text(&scattered), from_text(&ordered));
    let (a, b) = (a.expect("scattered"), b.expect("ordered"));
    for function in ["accel", "mass_matrix", "bias", "generalized_force"] {
        let (a, b) = (numbers(&a, function), numbers(&b, function));
        let scale = a.iter().fold(1.0_f64, |scale, a| scale.max(a.abs()));
        for (a, b) in a.iter().zip(&b) {
            // The same sums in another order.
            assert!((a - b).abs() < 1e-12 * scale, "{function}: {a} {b}");
        }
    }
}
