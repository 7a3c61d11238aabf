//! A model with one deliberate mistake is refused, and the message names the identity that fails.

use hamel_codegen::generate::from_text;
use hamel_codegen::proof::check::{Verdict, check};
use std::path::Path;

/// A model, the original text, its replacement, and the expected part of the message.
type Twin = (&'static str, &'static str, &'static str, &'static str);

const TWINS: &[Twin] = &[
    // (∂φ/∂x) A = 0.
    (
        "free_body",
        "R * hat(w)",
        "R * hat(w) * R",
        "this rate leaves the constraint",
    ),
    (
        "heavy_top",
        "R * hat(w)",
        "hat(w)",
        "this rate leaves the constraint",
    ),
    (
        "heavy_top_quaternion",
        "qmul(q, [0,",
        "qmul(q, [w[1],",
        "this rate leaves the constraint",
    ),
    (
        "pendulum",
        "rate s = c * w",
        "rate s = -c * w",
        "(∂φ/∂x) A = 0",
    ),
    (
        "rod_particles",
        "rate y1 = x1 * w1",
        "rate y1 = -x1 * w1",
        "(∂φ/∂x) A = 0",
    ),
    (
        "six_particles",
        "R * hat(w)",
        "R * diag(w[1], w[2], w[3])",
        "this rate leaves the constraint",
    ),
    // Y A = I.
    (
        "free_body_both",
        "rate r = v",
        "rate r = 2 * v",
        "Y A differs from I",
    ),
    (
        "free_body_both",
        "w[3]]) / 2",
        "-w[3]]) / 2",
        "Y A differs from I",
    ),
    // φ(x) = 0 at the start.
    (
        "rod_particles",
        "start x1 = 1;",
        "start x1 = 1.2;",
        "the start violates",
    ),
    (
        "four_bar_loop",
        "start q1 = 1;",
        "start q1 = 1; start q2 = 0; start q3 = 2;",
        "no configuration near the start closes this loop",
    ),
    (
        "squeezer",
        "start beta = -0.06",
        "start beta = -0.16",
        "no configuration near the start closes this loop",
    ),
    // B ξ = 0.
    (
        "sleigh",
        "start w = 0.5;",
        "start w = 0.5; start v = 0.1;",
        "the start velocities violate this constraint",
    ),
    (
        "rolling_disk",
        "v + cross(w, p) = 0",
        "v + cross(w, p) = [0.1, 0, 0]",
        "a term without a velocity",
    ),
    (
        "rolling_ball",
        "v = a * cross(R * w, [0, 0, 1])",
        "[v[1]^2, v[2], v[3]] = 0",
        "not linear in the velocities",
    ),
    // d/dt I = 0.
    (
        "lagrange_top",
        "",
        "invariant wrong = w[1];",
        "is not constant along the motion",
    ),
    (
        "free_body_momenta",
        "",
        "invariant wrong = w[3];",
        "is not constant along the motion",
    ),
    (
        "euler_top_quaternion",
        "",
        "invariant wrong = q[1];",
        "is not constant along the motion",
    ),
    (
        "heavy_top",
        "",
        "invariant angular_momentum along [1, 0, 0];",
        "d/dt leaves",
    ),
    (
        "cart_pole",
        "",
        "invariant linear_momentum along [1, 0, 0];",
        "is not constant along the motion",
    ),
    (
        "sleigh",
        "",
        "invariant wrong = w;",
        "d/dt is not zero where the constraints hold",
    ),
    (
        "spring_chain",
        "",
        "invariant energy;",
        "is not constant along the motion",
    ),
    // M = Mᵀ > 0, T = ½ ξᵀ M ξ.
    (
        "planar_body",
        "diag(0, 0, J)",
        "[[0, 1, 0], [2, 0, 0], [0, 0, J]]",
        "this inertia is not symmetric",
    ),
    (
        "cart_pole",
        "particle mass",
        "kinetic -5 * v^2; particle mass",
        "the mass matrix is not positive definite",
    ),
    (
        "pendulum",
        "particle",
        "kinetic w^3; particle",
        "not quadratic in the velocities",
    ),
    (
        "polar_particle",
        "potential",
        "potential u * 2; potential",
        "may depend only on coordinates and parameters",
    ),
    // n = dim X, rank A = n.
    (
        "planar_body",
        "velocity ",
        "velocity extra, ",
        "too many velocities",
    ),
    (
        "double_pendulum_angles",
        "rate th2 = w2",
        "rate th2 = w1",
        "the velocities are not independent",
    ),
    // D of degree two.
    (
        "spring_chain",
        "",
        "dissipation v1;",
        "not quadratic in the velocities",
    ),
];

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.eom"));
    std::fs::read_to_string(path).expect("the model is in the repository")
}

/// Returns the twin of a model: with a replacement, or with a further statement if nothing is replaced.
fn twin(&(name, old, new, _): &Twin) -> String {
    let text = text(name);
    if old.is_empty() {
        let end = text.rfind('}').expect("a system ends with a brace");
        return format!("{}{new}\n}}\n", &text[..end]);
    }
    assert!(text.contains(old), "{name} has no `{old}`");
    text.replacen(old, new, 1)
}

#[test]
fn every_twin_is_refused_by_the_identity_that_it_breaks() {
    assert!(TWINS.len() >= 25);
    let mut wrong = Vec::new();
    for case in TWINS {
        let found = match from_text(&twin(case)) {
            Ok(generated) => check(&generated.model, &generated.program)
                .into_iter()
                .filter(|identity| matches!(identity.verdict, Verdict::Failed(_)))
                .map(|identity| format!("{} {}", identity.label, identity.equation))
                .collect::<Vec<_>>()
                .join("; "),
            Err(errors) => {
                let texts = errors
                    .iter()
                    .map(|e| format!("{} {}", e.message, e.help.clone().unwrap_or_default()));
                texts.collect::<Vec<_>>().join("; ")
            }
        };
        if case.3.is_empty() || !found.contains(case.3) {
            wrong.push(format!("{} ({} -> {}): {found}", case.0, case.1, case.2));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A row that follows from the others is not an error: it is left out with a warning.
#[test]
fn what_is_said_twice_is_left_out_with_a_warning() {
    for (name, old, new) in [
        (
            "sleigh",
            "inactive v;",
            "inactive v; nonholonomic 2 * v = 0;",
        ),
        (
            "two_wheeled_robot",
            "u + b * w = r * wr",
            "u - b * w = r * wl",
        ),
    ] {
        let generated = from_text(&twin(&(name, old, new, ""))).expect("a description");
        let warnings = generated.model.warnings.iter();
        let said = warnings.filter(|warning| warning.message.contains("follows from the other"));
        assert_eq!(said.count(), 1, "{name}");
    }
}
