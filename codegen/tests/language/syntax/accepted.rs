//! Accepted texts and their parsed form.

use proc_macro2::TokenStream;

use super::{parsed, spelled, statement, told};
use hamel_language::syntax::ast::ItemKind;
use hamel_language::syntax::{canonical, parse_tokens};

pub(super) const FREE_BODY: &str = "
/// A rigid body flying freely; body frame anywhere in the body.
pub system FreeBody {
    param m = 1.3, g = 9.81;                      // run-time parameters, with defaults
    param s: vec3 = [0.1, -0.2, 0.3];             // centre of mass, body frame
    param Theta: sym3 = [[2.1, 0.1, -0.2], [0.1, 1.7, 0.15], [-0.2, 0.15, 1.2]];

    coord r: R3;                                  // x: position of the body frame ...
    coord R: SO3;                                 // ... and its rotation, RᵀR = I, det R = 1
    velocity v: vec3, w: vec3;                    // ξ
    rate r = R * v;                               // ẋ = A(x) ξ
    rate R = R * hat(w);

    frame hull = pose(R, r);
    body on hull { mass m; com s; inertia Theta about origin; }
    gravity [0, 0, -g];
    input F: vec3, tau: vec3;
    wrench (F, tau) on hull in body;

    start w = [0.01, 1, 0];
}
";

#[test]
fn free_body() {
    let system = parsed(FREE_BODY);
    assert!(system.public);
    assert_eq!(system.name.name, "FreeBody");
    assert_eq!(
        system.docs,
        ["A rigid body flying freely; body frame anywhere in the body."]
    );
    let items: Vec<String> = system.items.iter().map(|item| told(&item.kind)).collect();
    insta::assert_snapshot!(items.join("\n"), @r#"
    param m: Scalar = 13/10; g: Scalar = 981/100
    param s: Vector(3) = [1/10, (-1/5), 3/10]
    param Theta: Symmetric(3) = [[21/10, 1/10, (-1/5)], [1/10, 17/10, 3/20], [(-1/5), 3/20, 6/5]]
    coord r: Euclidean(3)
    coord R: SO3
    velocity v: Vector(3) = none; w: Vector(3) = none
    rate r = (R * v)
    rate R = (R * hat(w))
    frame hull on None = pose(R, r)
    body on hull: m, s, Some(("Theta", Some(Origin)))
    gravity [0, 0, (-g)]
    input F: Vector(3) = none; tau: Vector(3) = none
    wrench F, tau at none on hull in Body
    start w = [1/100, 1, 0]
    "#);
}

#[test]
fn both_doors_agree() {
    let tokens: TokenStream = FREE_BODY.parse().unwrap();
    let system = parse_tokens(tokens).1.unwrap();
    let tell = |items: &[hamel_language::syntax::ast::Item]| {
        items
            .iter()
            .map(|item| told(&item.kind))
            .collect::<Vec<_>>()
    };
    assert_eq!(tell(&system.items), tell(&parsed(FREE_BODY).items));
    assert_eq!(system.docs, parsed(FREE_BODY).docs);
}

#[test]
fn byte_order_mark_and_carriage_returns() {
    let text = format!("\u{feff}{}", FREE_BODY.replace('\n', "\r\n"));
    assert_eq!(parsed(&text).items.len(), parsed(FREE_BODY).items.len());
    assert_eq!(parsed(&text).docs, parsed(FREE_BODY).docs);
}

#[test]
fn canonical_spelling_ignores_layout() {
    let spelling = |text: &str| canonical(&text.parse().unwrap());
    assert_eq!(
        spelling("/// a \"b\"\nsystem S{x=-1.5;}"),
        "# [ doc = \" a \\\"b\\\"\" ] system S { x = - 1.5 ; }"
    );
    assert_eq!(
        spelling("#[doc = r#\" a \"b\"\"#] system /* c */ S { x = -1.5 ; }"),
        spelling("/// a \"b\"\nsystem S{x=-1.5;}")
    );
    assert_eq!(spelling("a ** b"), spelling("a * *b"));
    assert_eq!(
        spelling(FREE_BODY),
        spelling(&FREE_BODY.replace('\n', "\r\n"))
    );
    assert_eq!(spelling(""), "");
}

#[test]
fn invariants() {
    for (text, told_as) in [
        ("invariant energy;", "invariant energy energy when "),
        (
            "invariant e = energy when F = 0, s[1] = 2 * k;",
            "invariant e energy when F = 0, s[1] = 2 * k",
        ),
        (
            "invariant linear_momentum of hull along [1, 0, 0];",
            "invariant linear_momentum P of Some(\"hull\") along [1, 0, 0] when ",
        ),
        (
            "invariant l = angular_momentum about r along R * e when tau = 0;",
            "invariant l L of None about r along (R * e) when tau = 0",
        ),
        // An expression may start with a name that is a keyword elsewhere.
        (
            "invariant l = energy * 2;",
            "invariant l (energy * 2) when ",
        ),
        ("invariant when = of^2;", "invariant when (of ^ 2) when "),
    ] {
        assert_eq!(told(&statement(text)), told_as);
    }
}

fn value(text: &str) -> String {
    match statement(&format!("potential {text};")) {
        ItemKind::Potential(value) => spelled(&value),
        other => panic!("{other:?}"),
    }
}

#[test]
fn precedence() {
    assert_eq!(value("a + b * c - d / e"), "((a + (b * c)) - (d / e))");
    assert_eq!(value("a - b - c"), "((a - b) - c)");
    assert_eq!(value("a / b / c"), "((a / b) / c)");
    assert_eq!(value("-x^2"), "(-(x ^ 2))");
    assert_eq!(value("-a * b"), "((-a) * b)");
    assert_eq!(value("a * -b"), "(a * (-b))");
    assert_eq!(value("a - -b"), "(a - (-b))");
    assert_eq!(value("--a"), "(-(-a))");
    assert_eq!(value("a^b^c"), "(a ^ (b ^ c))");
    assert_eq!(value("a^-b^c"), "(a ^ (-(b ^ c)))");
    assert_eq!(value("a^--2"), "(a ^ (-(-2)))");
    assert_eq!(value("x^(1/2)"), "(x ^ (1 / 2))");
    assert_eq!(value("(a + b) * c"), "((a + b) * c)");
    assert_eq!(value("X.R.T * M[1, 2]^2"), "(X.R.T * (M[1, 2] ^ 2))");
    assert_eq!(value("f(a, -b,)[i + 1].c"), "f(a, (-b))[(i + 1)].c");
    assert_eq!(value("f()"), "f()");
    assert_eq!(value("[[a, b], [c, d,],]"), "[[a, b], [c, d]]");
    assert_eq!(value("(a)[1]"), "a[1]");
}

#[test]
fn names_and_numbers() {
    assert_eq!(value("θ * φ_1 + q̇"), "((θ * φ_1) + q̇)");
    assert_eq!(value("9.81 + 1e-3 * 1_000"), "(981/100 + (1/1000 * 1000))");
    assert_eq!(value("0.1"), "1/10");
    assert_eq!(
        value("force + mass + rate[1]"),
        "((force + mass) + rate[1])"
    );
}

#[test]
fn every_statement() {
    let statements = "
        param m = 1, J: mat3 = diag(1, 2, 3), k: sym2 = [[1, 0], [0, 1]];
        const k = 3/2, u: vec2 = [1, 0];
        let e = m * s;
        coord r: R3, R: SO3, q, c: S1, o: S3, X: SE3, big: R64;
        velocity v: vec3, w: vec3 = vee(X.R.T * rate(X.R)), u;
        constraint a^2 + b^2 = 1;
        rate X.p = X.R * v;
        frame f = pose(R, p);
        frame g on f = rotz(c.c, c.s);
        body on f { mass m; com s; inertia J about com; }
        body on f { inertia J; };
        body on f {}
        particle mass m at p;
        particle mass m + 1 at p on f;
        kinetic m * v^2 / 2;
        potential m * g * z;
        gravity [0, 0, -g];
        input F: vec3, u;
        force F at p on f in body;
        force F on f in world;
        torque t on f in world;
        wrench (F, t) at p on f in body;
        wrench ((F), t,) on f in world;
        torque t on f from g in h;
        force F at p on f from world in world;
        force F from p on f to g;
        spring stiffness 2 * k length l from [0, 0, 1] on f to world;
        spring stiffness k from f to q + r on g;
        spring stiffness k length l on q2 - q1;
        damper coefficient c from f to g;
        damper coefficient c on w2 - w1;
        dissipation d * w^2 / 2;
        generalized force w = -d * w;
        start X.R = I;
        output speed = norm(v);
        generate accel, jacobian f, jacobian leg[2].foot in world, speed_slopes, jacobian f in f;
        /// docs stand anywhere between statements
    ";
    let statements = statements.replace("t,)", "t)");
    let system = parsed(&format!("system S {{ {statements} }}"));
    let items: Vec<String> = system.items.iter().map(|item| told(&item.kind)).collect();
    insta::assert_snapshot!(items.join("\n"), @r#"
    param m: Scalar = 1; J: Matrix(3) = diag(1, 2, 3); k: Symmetric(2) = [[1, 0], [0, 1]]
    const k: Scalar = (3 / 2); u: Vector(2) = [1, 0]
    let e: Scalar = (m * s)
    coord r: Euclidean(3); R: SO3; q: Real; c: S1; o: S3; X: SE3; big: Euclidean(64)
    velocity v: Vector(3) = none; w: Vector(3) = vee((X.R.T * rate(X.R))); u: Scalar = none
    constraint ((a ^ 2) + (b ^ 2)) = 1
    rate X.p = (X.R * v)
    frame f on None = pose(R, p)
    frame g on Some("f") = rotz(c.c, c.s)
    body on f: m, s, Some(("J", Some(Com)))
    body on f: none, none, Some(("J", None))
    body on f: none, none, None
    particle m at p on None
    particle (m + 1) at p on Some("f")
    kinetic ((m * (v ^ 2)) / 2)
    potential ((m * g) * z)
    gravity [0, 0, (-g)]
    input F: Vector(3) = none; u: Scalar = none
    force F at p on f in Body
    force F at none on f in World
    torque t on f in World
    wrench F, t at p on f in Body
    wrench F, t at none on f in World
    torque t on f from g in h
    force F at p on f from world in World
    force F from p on f to none on g
    spring (2 * k) length l from [0, 0, 1] on f to none on world
    spring k length none from none on f to (q + r) on g
    spring k length l on (q2 - q1)
    damper c from none on f to none on g
    damper c on (w2 - w1)
    dissipation ((d * (w ^ 2)) / 2)
    generalized force w = ((-d) * w)
    start X.R = I
    output speed = norm(v)
    generate accel, jacobian of f in None, jacobian of leg[2].foot in Some("world"), speed_slopes, jacobian of f in Some("f")
    "#);
}

#[test]
fn invisible_groups_are_parentheses() {
    use proc_macro2::{Delimiter, Group, TokenTree};
    let hidden = |text: &str| TokenTree::Group(Group::new(Delimiter::None, text.parse().unwrap()));
    let (sum, shape) = (hidden("a + b"), hidden("vec3"));
    let tokens = quote::quote!(system S { let x: #shape = 2 * #sum; });
    let system = parse_tokens(tokens).1.unwrap();
    assert_eq!(
        told(&system.items[0].kind),
        "let x: Vector(3) = (2 * (a + b))"
    );

    // Groups without content have no effect: an empty visibility, a doc comment, a path, a block.
    let (none, docs) = (hidden(""), hidden("doc = \" A.\""));
    let (path, block) = (hidden("left.hip"), hidden("{ 1 - 2 }"));
    let tokens = quote::quote!(#[#docs] #none system S {
        let x = if -#sum < 1 #block else #block;
        body on #path { mass 1; }
    });
    let system = parse_tokens(tokens).1.unwrap();
    let text = "/// A.
        system S {
            let x = if -(a + b) < 1 { 1 - 2 } else { 1 - 2 };
            body on left.hip { mass 1; }
        }";
    assert_eq!(system, hamel_language::syntax::parse_text(text).unwrap());
    let wrong = hidden("a < b");
    let tokens = quote::quote!(system S { let x = 2 * #wrong; });
    let errors = parse_tokens(tokens).1.unwrap_err();
    assert_eq!(
        errors[0].message,
        "expected the end of what the macro matched, found `<`"
    );
}

#[test]
fn spans_cover_what_they_name() {
    let text = "system S { let x = (a + b) * c[1]; }";
    let system = parsed(text);
    let source = |span: hamel_language::syntax::ast::Span| &text[span.range().unwrap()];
    assert_eq!(source(system.items[0].span), "let x = (a + b) * c[1];");
    let ItemKind::Let(all) = &system.items[0].kind else {
        panic!()
    };
    assert_eq!(
        source(all[0].value.as_ref().unwrap().span),
        "(a + b) * c[1]"
    );
}
