//! Systems without M⁻¹: the functions that remain, and the errors about the others.

use crate::common::{hamel, text};
use hamel_engine::{OpenOptions, Quiet, Session};
use serde_json::Value;
use std::sync::Arc;

/// A pendulum with a massless second link.
const MASSLESS: &str = "system Arm {
    joint a: revolute [0, 0, 1] moves f;
    joint b: revolute [0, 0, 1] on f at pose(identity(3), [1, 0, 0]) moves g;
    body on f { mass 2; com [0, 0.5, 0]; inertia diag(1, 1, 1.5) about com; }
    gravity [-9.81, 0, 0];
}";

/// M = diag(I + m l², 0) and ∂V = (−m g l, 0) for the hanging link, for any motion of the other one.
#[test]
fn numbers_without_accelerations_where_m_is_singular() {
    let output = hamel(&["eval", "-"], MASSLESS);
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(
        said.contains("warning") && said.contains("`b_dot`"),
        "{said}"
    );
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(value["accel"], Value::Null);
    let number = |pointer: &str| value.pointer(pointer).and_then(Value::as_f64);
    assert_eq!(number("/M/0/0"), Some(2.0));
    assert_eq!(number("/M/1/1"), Some(0.0));
    let slope = number("/potential_force/0").expect("a slope");
    assert!((slope + 2.0 * 9.81 * 0.5).abs() < 1e-12, "{slope}");
    assert_eq!(number("/potential_force/1"), Some(0.0));
    for command in ["tables", "check"] {
        let output = hamel(&[command, "-"], MASSLESS);
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
}

/// Functions that need M⁻¹ are refused with a suggestion, which is then accepted.
#[test]
fn what_needs_the_inverse_of_a_singular_matrix_is_refused() {
    for command in [&["emit", "-"][..], &["simulate", "-", "--until", "1"]] {
        let output = hamel(command, MASSLESS);
        assert!(!output.status.success());
        let said = text(&output.stderr);
        assert!(
            said.contains("`generate inverse_dynamics, mass_matrix;`"),
            "{said}"
        );
    }
    let asked = MASSLESS.replace("gravity", "generate inverse_dynamics, mass_matrix; gravity");
    let output = hamel(&["emit", "-"], &asked);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let emitted = text(&output.stdout);
    assert!(emitted.contains("fn inverse_dynamics") && !emitted.contains("fn accel"));
}

/// The same system can be simulated and linearised.
#[test]
fn what_is_linearised_can_be_simulated() {
    let described = |generate: &str| {
        format!(
            "system Pendulum {{ coord q; velocity v; rate q = v; kinetic v^2/2; potential -cos(q);
             output height = -cos(q); {generate} }}"
        )
    };
    let emitted = |generate: &str| {
        let output = hamel(&["emit", "-"], &described(generate));
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout).to_string()
    };
    for generate in [
        "generate linearize;",
        "generate all, linearize;",
        "generate accel, linearize;",
    ] {
        let code = emitted(generate);
        assert!(
            code.contains("impl<S: ::hamel::Scalar> ::hamel::System for"),
            "{generate}"
        );
        assert!(code.contains("fn linearize"), "{generate}");
        let whole = generate.contains("all");
        assert_eq!(code.contains("fn mass_matrix"), whole, "{generate}");
        assert_eq!(code.contains("fn height"), whole, "{generate}");
    }
    assert!(!emitted("").contains("fn linearize"));
    let whole = |generate| {
        let code = emitted(generate);
        let from = code.find("struct ").expect("a type");
        code[from..].to_string()
    };
    assert_eq!(whole(""), whole("generate all;"));
}

/// A particle on a plane with constrained velocities: its energy is constant, and x is not.
const TIED: &str = "system Tied {
    coord x, y; velocity u, v; rate x = u, y = v;
    particle mass 1 at [x, y, 0];
    nonholonomic v = x * u;
    invariant CLAIM;
    generate GENERATE;
}";

/// Claims can be proved whatever functions are generated.
#[test]
fn claims_beside_constraints_are_proved_whatever_is_generated() {
    for generate in ["inverse_dynamics", "rate", "mass_matrix, CLAIM", "all"] {
        for (claim, name, holds) in [("energy", "energy", true), ("I = x + u", "I", false)] {
            let described = TIED.replace("GENERATE", generate);
            let described = described.replacen("CLAIM", claim, 1).replace("CLAIM", name);
            let output = hamel(&["emit", "-"], &described);
            let said = text(&output.stderr);
            assert_eq!(output.status.success(), holds, "{generate}: {said}");
            let code = text(&output.stdout);
            if holds {
                let has_accel = code.contains("fn accel");
                assert_eq!(has_accel, generate == "all", "{generate}");
            } else {
                let part = "`I` is not constant along the motion";
                assert!(said.contains(part), "{generate}: {said}");
            }
        }
    }
}

/// A picture of a state makes no statement about the motion.
#[test]
fn pictures_of_a_state_prove_no_claims() {
    let described = TIED.replace("CLAIM", "energy");
    let described = described.replace("generate GENERATE;", "");
    let output = hamel(&["draw", "-"], &described);
    let said = text(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{said}");
}

/// Claims about an undetermined motion are reported as unproved.
#[test]
fn claims_of_a_singular_system_are_named() {
    let described = MASSLESS.replace("gravity", "invariant energy; gravity");
    let output = hamel(&["check", "-"], &described);
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("no claim is proved: `energy`"), "{said}");
    assert!(!text(&output.stdout).contains("d/dt energy"));
    let output = hamel(&["emit", "-"], &described);
    assert!(!output.status.success());
}

/// Every function that a session lists exists, or is refused by name.
#[test]
fn functions_that_a_session_lists_are_there() {
    let described = "system Pendulum { param m = 1; coord q; velocity v; rate q = v; frame f = pose(rotz(q), [cos(q), sin(q), 0]);
         particle mass m at [cos(q), sin(q), 0]; gravity [0, -9.81, 0]; output height = sin(q); }";
    let read = Session::read(
        described.into(),
        "p.eom",
        &OpenOptions::default(),
        Arc::new(Quiet),
    );
    let session = read.unwrap_or_else(|error| panic!("{error}"));
    let missing: Vec<String> = session
        .functions()
        .iter()
        .filter_map(|name| session.function(name).err())
        .map(|error| error.to_string())
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}
