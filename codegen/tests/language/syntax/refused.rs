//! Refused texts and their messages.

use hamel_language::syntax::parse_text;

/// Formats the errors of a text as `line:column message`, with the region and the help.
fn errors(text: &str) -> String {
    let Err(errors) = parse_text(text) else {
        return "accepted".to_owned();
    };
    let lines = errors.iter().map(|error| {
        let range = error.span.range().unwrap_or(0..0);
        let before = &text[..range.start];
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        let region = text.get(range).unwrap_or("?");
        let help = error.help.as_deref().unwrap_or("none");
        let help = help
            .split_once("`param`, `const`, `let`, `fn`, `extern`, `table`, `coord`")
            .map_or(help, |(start, _)| start);
        format!("{}:{} {} <{region}>\n  {help}", line, column, error.message)
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Formats the errors of one line in a system.
pub(super) fn line(text: &str) -> String {
    errors(&format!("system S {{\n{text}\n}}"))
}

#[test]
fn empty_input() {
    let cases = [r#""#, r#"// nothing"#, r#"/// docs only"#];
    insta::assert_snapshot!(cases.map(errors).join("\n"), @r#"
    1:1 expected `system`, found the end of the input <>
      a description is written `system Name { … }`
    1:1 expected `system`, found the end of the input <>
      a description is written `system Name { … }`
    1:13 expected `system`, found the end of the input <y>
      a description is written `system Name { … }`
    "#);
}

#[test]
fn around_the_system() {
    let cases = [
        r#"sytem S {}"#,
        r#"pub(crate) system S {}"#,
        r#"system {}"#,
        r#"system S"#,
        r#"system S;"#,
        r#"system type {}"#,
        r#"system S {} param m = 1;"#,
        r#"system S {} system T {}"#,
        r#"#[derive(Debug)] system S {}"#,
        r#"//! inner
system S {}"#,
    ];
    insta::assert_snapshot!(cases.map(errors).join("\n"), @r#"
    1:1 expected `system`, found `sytem` <sytem>
      a description is written `system Name { … }`
    1:4 a system is `pub` or private <(>
      write `pub system Name { … }`, and restrict it by its enclosing module
    1:8 expected the name of the system, found `{` <{>
      a description is written `system Name { … }`
    1:8 expected `{`, found the end of the input <S>
      a description is written `system Name { … }`
    1:9 expected `{`, found `;` <;>
      a description is written `system Name { … }`
    1:8 `type` is a word of Rust and cannot be a name <type>
      choose another name, such as `type_`
    1:13 expected the end of the input, found `param` <param>
      write statements inside the braces of the system
    1:13 there is more than one description <system>
      write one system per macro, and one per file
    1:1 attributes are not part of the language <#[derive>
      remove it; docs are written `/// …`
    1:1 inner doc comments are not part of the language <//! inner>
      comments are written `// …`, and docs of what follows `/// …`
    "#);
}

#[test]
fn brackets() {
    let cases = [
        r#"system S {"#,
        r#"system S { let x = (1; }"#,
        r#"system S { let x = 1); }"#,
        r#"system S { body on f { mass (1 } }"#,
        r#"system S { let x = f(a, [1; let y = 2 x; }"#,
        r#"system S { let x = 2 * (f(a, b)
 + c; let y; }"#,
        r#"system S {} }"#,
        r#"system S { /* }"#,
        r#"system S { let x = "a; }"#,
    ];
    insta::assert_snapshot!(cases.map(errors).join("\n"), @r#"
    1:10 unclosed `{` <{>
      close it with `}`
    1:20 unclosed `(` <(>
      close it with `)`
    1:21 expected `}`, found `)` <)>
      close the `{` first
    1:32 expected `)`, found `}` <}>
      close the `(` first
    1:21 unclosed `(` <(>
      close it with `)`
    1:39 expected `;` after `2`, found `x` <x>
      a product is written with `*`; a statement ends with `;`
    1:24 unclosed `(` <(>
      close it with `)`
    2:12 expected `=`, found `;` <;>
      a named expression is written `let e = m * s;`
    1:13 `}` closes nothing <}>
      remove it, or open it before
    1:12 unclosed comment </>
      close it with `*/`
    1:20 unclosed string <">
      values are made of numbers, names and arrays: remove the quote
    "#);
}

#[test]
fn characters() {
    let cases = [
        r#"let x = M' * y;"#,
        r#"let x = 'a';"#,
        r#"let x = a × b;"#,
        r#"let x = ∂a;"#,
        r#"let x = a\b;"#,
        r#"let x = x²;"#,
    ];
    insta::assert_snapshot!(cases.map(line).join("\n"), @r#"
    2:10 `'` is not an operator <'>
      a transpose is written `transpose(M)` or `M.T`
    2:9 a character is not a value: `'a'` <'a'>
      a transpose is written `transpose(M)` or `M.T`
    2:11 the character `×` is not part of the language <?>
      write `*`
    2:9 the character `∂` is not part of the language <?>
      remove it
    2:10 the character `\` is not part of the language <\>
      remove it
    2:11 expected `;` after `a`, found `b` <b>
      a product is written with `*`; a statement ends with `;`
    2:10 the character `²` is not part of the language <?>
      write `^2`
    "#);
}

#[test]
fn unknown_statements() {
    let cases = [
        r#"velocty v;"#,
        r#"m = 3;"#,
        r#"banana m;"#,
        r#"3;"#,
        r#";"#,
        r#"body on f {} ;;"#,
    ];
    insta::assert_snapshot!(cases.map(line).join("\n"), @r#"
    2:1 unknown statement `velocty` <velocty>
      did you mean `velocity`?
    2:1 `m` is declared without a keyword <m>
      start with `param`, `const` or `let`, or say what moves with `rate`
    2:1 unknown statement `banana` <banana>
      the statements are 
    2:1 expected a statement, found `3` <3>
      the statements are 
    2:1 a `;` without a statement <;>
      remove it
    2:15 a `;` without a statement <;>
      remove it
    "#);
}

#[test]
fn missing_ends() {
    let cases = [
        r#"param m = 1.3"#,
        r#"param m = 1.3
coord r: R3;"#,
        r#"param m = 1.3
rate r = 2 v;"#,
        r#"rate r = R *
rate R = R * hat(w);"#,
        r#"param m = 1 /// docs
;"#,
        r#"coord r: R3 R: SO3;"#,
    ];
    insta::assert_snapshot!(cases.map(line).join("\n"), @r#"
    2:11 expected `;` after `1.3` <1.3>
      end the statement with `;`
    2:11 expected `;` after `1.3` <1.3>
      end the statement with `;`
    2:11 expected `;` after `1.3` <1.3>
      end the statement with `;`
    3:12 expected `;` after `2`, found `v` <v>
      a product is written with `*`; a statement ends with `;`
    3:1 expected an expression, found the next statement `rate` <rate>
      a rate is written `rate r = R * v;`
    2:11 expected `;` after `1` <1>
      end the statement with `;`
    3:1 a `;` without a statement <;>
      remove it
    2:13 expected `;` after `R3`, found `R` <R>
      coordinates are written `coord r: R3, R: SO3, q;`
    "#);
}

#[test]
fn declarations() {
    let cases = [
        r#"param m;"#,
        r#"param m: vec3;"#,
        r#"param m = 1,;"#,
        r#"param type = 1;"#,
        r#"param r#type = 1;"#,
        r#"param at = 1;"#,
        r#"param _ = 1;"#,
        r#"velocity v: vec3 =;"#,
        r#"input u = 1;"#,
        r#"coord q = 1;"#,
        r#"velocity v: R3;"#,
        r#"velocity v: scalar;"#,
        r#"velocity v: vec0;"#,
        r#"velocity v: vec65;"#,
        r#"velocity v: vec;"#,
        r#"velocity v: foo3;"#,
        r#"coord r: vec3;"#,
        r#"coord r: R0;"#,
        r#"coord r: R65;"#,
        r#"coord r: S2;"#,
        r#"coord r: R;"#,
        r#"coord r R3;"#,
    ];
    insta::assert_snapshot!(cases.map(line).join("\n"), @r#"
    2:8 expected `=`, found `;` <;>
      a parameter is written `param m = 1.3, s: vec3 = [0, 0, 1];`
    2:14 expected `=`, found `;` <;>
      a parameter is written `param m = 1.3, s: vec3 = [0, 0, 1];`
    2:13 expected the name of a parameter, found `;` <;>
      a parameter is written `param m = 1.3, s: vec3 = [0, 0, 1];`
    2:7 `type` is a word of Rust and cannot be a name <type>
      choose another name, such as `type_`
    2:7 `r#type` is a raw identifier <r#type>
      choose a plain name, such as `type_`
    2:7 expected the name of a parameter, found `at` <at>
      `at` is a word of the language and cannot be a name
    2:7 `_` is a word of Rust and cannot be a name <_>
      choose a name with letters
    2:19 expected an expression, found `;` <;>
      velocities are written `velocity v: vec3, u;`, or by rates: `velocity v: vec3 = R.T * rate(r);`
    2:9 an input is declared without a value <=>
      inputs are given at run time; a fixed value is a `param`
    2:9 a coordinate is declared without a value <=>
      an initial value is written `start r = [0, 0, 1];`
    2:13 unknown shape `R3` <R3>
      a vector is written `vec3`; `R3` is for coordinates
    2:13 unknown shape `scalar` <scalar>
      a scalar is written without a shape
    2:13 the size of `vec0` is not between 1 and 64 <vec0>
      a size is written `vec3`
    2:13 the size of `vec65` is not between 1 and 64 <vec65>
      a size is written `vec3`
    2:13 the size of `vec` is not between 1 and 64 <vec>
      a size is written `vec3`
    2:13 unknown shape `foo3` <foo3>
      the shapes are `vec3`, `mat3` and `sym3`, of any size; a scalar is written without
    2:10 unknown kind of coordinate `vec3` <vec3>
      a vector among the coordinates is written `R3`
    2:10 the size of `R0` is not between 1 and 64 <R0>
      a vector is written `R3`
    2:10 the size of `R65` is not between 1 and 64 <R65>
      a vector is written `R3`
    2:10 unknown kind of coordinate `S2` <S2>
      the kinds are `R3` and other sizes, `S1`, `S3`, `SO3` and `SE3`; a real is written without
    2:10 unknown kind of coordinate `R` <R>
      a real coordinate is written without a kind
    2:9 expected `;` after `r`, found `R3` <R3>
      coordinates are written `coord r: R3, R: SO3, q;`
    "#);
}

#[test]
fn equations() {
    let cases = [
        r#"constraint a == b;"#,
        r#"constraint a;"#,
        r#"rate r;"#,
        r#"rate R[1] = 2;"#,
        r#"potential V = 2;"#,
        r#"generalized w = 1;"#,
        r#"start = 1;"#,
        r#"output speed;"#,
        r#"generate;"#,
        r#"generate accel, jacobian f in;"#,
        r#"generate jacobian f on g;"#,
        r#"frame f;"#,
        r#"frame f on = pose(R, p);"#,
    ];
    insta::assert_snapshot!(cases.map(line).join("\n"), @r#"
    2:14 `==` is not an operator <==>
      an equation is written with `=`
    2:13 expected `=`, found `;` <;>
      a constraint is written `constraint a = b;`
    2:7 expected `=`, found `;` <;>
      a rate is written `rate r = R * v;`
    accepted
    2:13 expected `;` after `V`, found `=` <=>
      a potential is written `potential m * g * z;`
    2:13 expected `force`, found `w` <w>
      a generalized force is written `generalized force w = -d * w;`
    2:7 expected the name of a coordinate or velocity, found `=` <=>
      an initial value is written `start w = [0.01, 1, 0];`, a guess of one `start q ~ 1.2;`
    2:13 expected `=`, found `;` <;>
      an output is written `output speed = norm(v);`
    2:9 expected the name of a function, found `;` <;>
      a selection of functions is written `generate accel, energy;`, the kinematics of a frame `generate jacobian tip in world;`
    2:30 expected the name of a frame, found `;` <;>
      a selection of functions is written `generate accel, energy;`, the kinematics of a frame `generate jacobian tip in world;`
    2:21 expected `;` after `f`, found `on` <on>
      a selection of functions is written `generate accel, energy;`, the kinematics of a frame `generate jacobian tip in world;`
    2:8 expected `=`, found `;` <;>
      a frame is written `frame f = pose(R, p);`, `frame f on g = pose(R, p);` or `frame f on g at [x, y, z];`
    2:12 expected the name of a frame, found `=` <=>
      a frame is written `frame f = pose(R, p);`, `frame f on g = pose(R, p);` or `frame f on g at [x, y, z];`
    "#);
}

#[test]
fn bodies_and_loads() {
    let cases = [
        r#"body hull { mass m; }"#,
        r#"body on hull mass m;"#,
        r#"body on f { mas m; }"#,
        r#"body on f { weight m; }"#,
        r#"body on f { mass m }"#,
        r#"body on f { mass 1; mass 2; }"#,
        r#"body on f { inertia J about centre; }"#,
        r#"body on f { ; 3; }"#,
        r#"particle m at p;"#,
        r#"particle mass m;"#,
        r#"force F hull in body;"#,
        r#"force F on hull;"#,
        r#"force F on hull in 3;"#,
        r#"wrench F, t on f in body;"#,
        r#"wrench (F) on f in body;"#,
        r#"torque (a, b) on f in body;"#,
    ];
    insta::assert_snapshot!(cases.map(line).join("\n"), @r#"
    2:6 expected `on`, found `hull` <hull>
      a body is written `body on f { mass m; com s; inertia J about com; }`
    2:14 expected `{`, found `mass` <mass>
      a body is written `body on f { mass m; com s; inertia J about com; }`
    2:13 a body has no `mas` <mas>
      did you mean `mass`?
    2:13 a body has no `weight` <weight>
      a body has `mass`, `com` and `inertia`
    2:18 expected `;` after `m` <m>
      end the statement with `;`
    2:21 `mass` is given twice for one body <mass>
      remove one of them; one frame may carry several bodies
    2:29 expected `com` or `origin`, found `centre` <centre>
      an inertia is written `inertia J about com;` or `about origin;`
    2:13 a `;` without a statement <;>
      remove it
    2:15 expected a property of the body, found `3` <3>
      a body has `mass`, `com` and `inertia`
    2:10 expected `mass`, found `m` <m>
      a particle is written `particle mass m at p;` or `particle mass m at p on f;`
    2:16 expected `at`, found `;` <;>
      a particle is written `particle mass m at p;` or `particle mass m at p on f;`
    2:9 expected `on`, found `hull` <hull>
      a force is written `force F at p on f in body;`, `in world;` or `in g;`, or along a line `force F from p on f to q on g;`
    2:16 expected `in`, found `;` <;>
      a force is written `force F at p on f in body;`, `in world;` or `in g;`, or along a line `force F from p on f to q on g;`
    2:20 expected `body`, `world` or the name of a frame, found `3` <3>
      a force is written `force F at p on f in body;`, `in world;` or `in g;`, or along a line `force F from p on f to q on g;`
    2:8 expected `(`, found `F` <F>
      a wrench is written `wrench (F, t) at p on f in body;`, `in world;` or `in g;`
    2:10 expected `,`, found `)` <)>
      a wrench is written `wrench (F, t) at p on f in body;`, `in world;` or `in g;`
    2:10 expected `)`, found `,` <,>
      a vector is written `[a, b, c]`
    "#);
}

#[test]
fn every_faulty_statement_is_reported() {
    let text = "system S {
    param m = ;
    coord r: R3;
    rate r = R * (v;
    velocty v: vec3;
}";
    insta::assert_snapshot!(errors(text), @r#"
    4:18 unclosed `(` <(>
      close it with `)`
    2:15 expected an expression, found `;` <;>
      a parameter is written `param m = 1.3, s: vec3 = [0, 0, 1];`
    5:5 unknown statement `velocty` <velocty>
      did you mean `velocity`?
    "#);
    let text = "system S {
    param m = 1 +;
    coord r: R3, ;
    velocty v: vec3;
    rate r = 2 v;
    body on f { mass; com 1 2; inertia J about centre }
    start v = [1, 0, 0;];
}";
    insta::assert_snapshot!(errors(&text.replace("0;]", "0] 1")), @r#"
    2:18 expected an expression, found `;` <;>
      a parameter is written `param m = 1.3, s: vec3 = [0, 0, 1];`
    3:18 expected the name of a coordinate, found `;` <;>
      coordinates are written `coord r: R3, R: SO3, q;`
    4:5 unknown statement `velocty` <velocty>
      did you mean `velocity`?
    5:16 expected `;` after `2`, found `v` <v>
      a product is written with `*`; a statement ends with `;`
    6:21 expected an expression, found `;` <;>
      a mass is written `mass m;`
    6:29 expected `;` after `1`, found `2` <2>
      a product is written with `*`; a statement ends with `;`
    6:48 expected `com` or `origin`, found `centre` <centre>
      an inertia is written `inertia J about com;` or `about origin;`
    7:25 expected `;` after `]`, found `1` <1>
      a product is written with `*`; a statement ends with `;`
    "#);
}
