//! Warnings for unused declarations.

use hamel_language::lower::build;
use hamel_language::syntax::parse_text;

/// Returns the warnings for a description with further statements.
fn said(statements: &str) -> Vec<String> {
    let text =
        format!("system A {{ coord q; velocity w; rate q = w; kinetic w^2 / 2; {statements} }}");
    let system = parse_text(&text).expect("a description");
    let model = match build(&system) {
        Ok(model) => model,
        Err(errors) => panic!("{text}: {errors:?}"),
    };
    let list = model.warnings.into_iter().map(|warning| warning.message);
    // Other warnings concern numerical losses.
    list.filter(|message| message.ends_with("is never used"))
        .collect()
}

#[test]
fn every_kind_of_declaration_is_missed() {
    let text = "param m = 1, _spare = 2; const k = 3; let e = q * w; input u: vec2; frame f = pose(rotz(q), [0, 0, 0]);";
    let expected = [
        "the parameter `m` is never used",
        "the constant `k` is never used",
        "the named expression `e` is never used",
        "the input `u` is never used",
        "the frame `f` is never used",
    ];
    assert_eq!(said(text), expected);
}

#[test]
fn every_place_is_a_use() {
    for (name, used) in [
        (
            "frame f = world",
            "frame g on f = world; body on g { mass 1; }",
        ),
        (
            "frame f = world",
            "joint j: revolute [0, 0, 1] on f moves g;",
        ),
        ("frame f = world", "particle mass 1 at [0, 0, 0] on f;"),
        ("frame f = world", "output p = position(f, [0, 0, 0]);"),
        ("frame f = world", "let p = f.p; output p = p;"),
        (
            "frame f = world",
            "joint j: fixed moves g; torque [0, 0, 1] on g from f in world;",
        ),
        (
            "frame f = world",
            "joint j: fixed moves g; torque [0, 0, 1] on g in f;",
        ),
        (
            "frame f = world",
            "frame g = pose(rotz(q), [2, 0, 0]); damper coefficient 1 from f to [1, 0, 0] on g;",
        ),
        ("frame f = world", "invariant p = linear_momentum of f;"),
        // Two statements about one frame relate two others.
        (
            "frame f = world",
            "frame f on g = world; body on g { mass 1; }",
        ),
        (
            "param a = 1",
            "joint j: revolute [0, 0, 1] at pose(rotz(a), [0, 0, 0]) moves g;",
        ),
        (
            "param a = 1",
            "joint j: revolute [0, 0, 1] moves g { armature a; }",
        ),
        ("param a = 1", "start q = a;"),
        ("param a = 1", "loop cos(q) = 1 stabilized a;"),
        ("param a = 1", "spring stiffness 1 length a on q;"),
        ("param a = 1", "potential -a * q;"),
        ("param a = 1", "let b = a; output c = b;"),
        ("input a", "generalized force w = a;"),
        ("input a", "invariant energy when a = 0;"),
    ] {
        assert_eq!(said(&format!("{name}; {used}")), [""; 0], "{name}; {used}");
    }
}
