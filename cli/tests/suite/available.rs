//! What there is without M⁻¹, and what comes along with what is asked for.

use crate::common::{hamel, text};
use serde_json::Value;

/// A pendulum with a second link that has no mass.
const MASSLESS: &str = "system Arm {
    joint a: revolute [0, 0, 1] moves f;
    joint b: revolute [0, 0, 1] on f at pose(identity(3), [1, 0, 0]) moves g;
    body on f { mass 2; com [0, 0.5, 0]; inertia diag(1, 1, 1.5) about com; }
    gravity [-9.81, 0, 0];
}";

/// M = diag(I + m l², 0) and ∂V = (−m g l, 0) for the hanging link, whatever the other one does.
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

/// What needs M⁻¹ is refused, with what to write instead; what is written then is generated.
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

/// One type is simulated and linearised.
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
