//! Functions in Rust: equality, number of calls, and names; and parameters of components with a shape.

use hamel_codegen::emit;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::lower;
use hamel_codegen::program::count::count;
use hamel_codegen::proof::check::{Verdict, check};
use hamel_codegen::syntax::parse_text;

fn generated(text: &str) -> Generated {
    from_text(text).unwrap_or_else(|errors| panic!("{text}: {errors:#?}"))
}

fn code(text: &str) -> String {
    let options = emit::Options::default();
    emit::rust_file(&generated(text).program, &options).expect("Rust")
}

/// A top with an external load, redundant coordinates and velocity constraints.
const TOP: &str = "pub system Top {
    param m = 2, l = 0.5;
    extern fn wind(height, speed) -> 2;
    coord R: SO3;
    velocity w: vec3;
    rate R = R * hat(w);
    frame top = pose(R, [0, 0, 0]);
    body on top { mass m; com [0, 0, l]; inertia diag(0.2, 0.3, 0.1) about com; }
    gravity [0, 0, -9.81];
    let gust = wind(dot(R * [0, 0, l], [0, 0, 1]), norm(w));
    force [gust[1], gust[2], 0] at [0, 0, l] on top in world;
    output same = wind(l * R[3, 3], sqrt(w[1]^2 + w[2]^2 + w[3]^2))[1] - gust[1];
    output other = wind(l * R[3, 3], -norm(w))[1] - gust[1];
    output slope = rate(wind(R[3, 3], 2)[1]);
    generate all, linearize;
}";

/// R₃₃ is the third entry of the third axis, and the lengths have two equivalent forms; but f(−a) is not f(a).
#[test]
fn equal_arguments_have_equal_values() {
    let top = generated(TOP);
    let outputs = |name: &str| {
        top.program
            .function(name)
            .expect("an output")
            .outputs
            .clone()
    };
    let zero = top.program.graph.zero();
    assert_eq!(outputs("same"), [zero]);
    assert_ne!(outputs("other"), [zero]);
}

#[test]
fn identities_hold_for_any_function() {
    let model = lower::build(&parse_text(TOP).expect("a description")).expect("a model");
    let generated = Generated::all(model, 0).expect("equations");
    for identity in check(&generated.model, &generated.program) {
        let failed = matches!(identity.verdict, Verdict::Failed(_));
        assert!(!failed, "{identity:?}");
    }
}

/// One call returns all components, another one all slopes.
#[test]
fn functions_are_called_once() {
    let text = code(TOP);
    let bodies = text.split("pub fn ").collect::<Vec<_>>();
    let calls = |name: &str, what: &str| {
        let body = bodies
            .iter()
            .find(|body| body.starts_with(&format!("{name}(")));
        body.expect("a function").matches(what).count()
    };
    assert_eq!(calls("accel", "functions.wind("), 1);
    assert_eq!(calls("accel", "functions.wind_jacobian("), 0);
    assert_eq!(calls("linearize", "functions.wind_jacobian("), 1);
    assert_eq!(calls("slope", "functions.wind_jacobian("), 1);
    assert!(text.contains("fn wind(&self, height: S, speed: S) -> [S; 2];"));
    assert!(text.contains("fn wind_jacobian(&self, height: S, speed: S) -> [[S; 2]; 2];"));
}

/// For any names, the generated text is valid Rust, and a system without such functions has no trait.
#[test]
fn names_do_not_collide() {
    let text = |name: &str, function: &str, parameter: &str| {
        format!(
            "system {name} {{ param functions = 1; coord x; velocity v; rate x = v; particle mass 1 at [x, 0, 0];
            extern fn {function}({parameter}) -> 1; generalized force v = functions * {function}(x * v); }}"
        )
    };
    for (name, function, parameter) in [
        ("F", "new", "self_"),
        ("S1", "clone", "ω"),
        ("Fast", "fmt", "r#type"),
        ("G", "lift_jacobian", "S"),
    ] {
        if let Ok(generated) = from_text(&text(name, function, parameter)) {
            let text = emit::rust_items(&generated.program, &emit::Options::default());
            syn::parse_file(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        }
    }
    let alone = code("system A { coord x; velocity v; rate x = v; particle mass 1 at [x, 0, 0]; }");
    assert!(!alone.contains("trait ") && alone.contains("struct A<S = f64>"));
}

/// With or without a shape, arguments are the same expressions.
#[test]
fn parameters_with_shapes_are_their_arguments() {
    let robot = |hip: &str, turn: &str| {
        format!(
            "system Robot {{
            param width = 0.3;
            component Leg(hip{hip}, turn{turn}, length = 1) {{
                frame mount = pose(turn, hip);
                joint knee: revolute [0, 1, 0] on mount moves shank {{ damping 0.1; }}
                body on shank {{ mass 1; com [0, 0, -length]; inertia diag(0.1, 0.1, 0.01) about com; }}
                output foot = position(shank, hip);
            }}
            for i in 1..2 {{ part leg[i] = Leg(width * [0, i, 0.1], rotz(i), 2); }}
            part arm = Leg(turn = identity(3), hip = [1, 0, width]);
            gravity [0, 0, -9.81];
        }}"
        )
    };
    let (with, without) = (robot(": vec3", ": mat3"), robot("", ""));
    let [a, b] = [&with, &without].map(|text| generated(text));
    for (own, other) in a.program.functions.iter().zip(&b.program.functions) {
        let found = count(&a.program.graph, &own.outputs);
        assert_eq!(
            found,
            count(&b.program.graph, &other.outputs),
            "{}",
            own.name
        );
    }
    assert_eq!(
        a.model
            .lets
            .iter()
            .filter(|(name, _)| name.ends_with("hip"))
            .count(),
        3
    );
}
