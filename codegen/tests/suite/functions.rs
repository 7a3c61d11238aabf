//! Functions in descriptions: a call is equivalent to the expression with its arguments inserted.

use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::emit;
use hamel_codegen::generate::from_text;

/// Returns a body in the plane with drag, a spring by a nested function, a frame, and further statements.
fn body(statements: &str, drag: &str, spring: &str, place: &str) -> String {
    format!(
        "system Body {{
            param m = 2, k = 3, c: vec2 = [0.1, 0.2], l = 0.5;
            coord r: R3, q;
            velocity v: vec3, w;
            rate r = v;
            rate q = w;
            {statements}
            frame f = {place};
            particle mass m at r;
            particle mass m at [0, 0, l] on f;
            generalized force v = {drag};
            potential {spring};
            output speed = norm(v);
        }}"
    )
}

/// Returns the emitted code of a description, without the hash of its text.
fn code(text: &str) -> String {
    let generated = from_text(text).unwrap_or_else(|errors| panic!("{text}: {errors:#?}"));
    let options = emit::Options::default();
    emit::rust_file(&generated.program, &options).expect("Rust")
}

#[test]
fn a_call_is_the_expression() {
    let functions = "
        fn drag(u: vec3, a) = -a * norm(u) * u;
        fn square(a) = a^2;
        fn stored(a, b) = k * (square(a - l) + square(b)) / 2;
        fn turned(k) = pose(rotx(k), [0, 0, lift]);
        let lift = twice(l);
        fn twice(a) = 2 * a;";
    let called = body(
        functions,
        "drag(v, c[1])",
        "stored(norm(r), q)",
        "turned(q)",
    );
    let written = body(
        "let lift = 2 * l;",
        "-c[1] * norm(v) * v",
        "k * ((norm(r) - l)^2 + q^2) / 2",
        "pose(rotx(q), [0, 0, lift])",
    );
    assert_eq!(code(&called), code(&written));
    assert!(
        from_text(&called)
            .expect("correct")
            .model
            .warnings
            .is_empty()
    );
}

/// Velocities of frames in a function are resolved after the rates, as elsewhere.
#[test]
fn functions_of_motion_wait_for_the_rates() {
    let functions = "fn speed(p: vec3) = norm(velocity(f, p)); let s = speed([0, 0, l]);";
    let text = body(functions, "-s * v", "k * q^2", "pose(rotx(q), r)");
    let plain = body(
        "let s = norm(velocity(f, [0, 0, l]));",
        "-s * v",
        "k * q^2",
        "pose(rotx(q), r)",
    );
    assert_eq!(code(&text), code(&plain));
}

fn refused(statements: &str, drag: &str) -> Vec<Diagnostic> {
    match from_text(&body(statements, drag, "k * q^2", "pose(rotx(q), r)")) {
        Ok(_) => panic!("`{statements}` was accepted"),
        Err(errors) => errors,
    }
}

#[test]
fn one_mistake_is_one_error_that_says_what_to_do() {
    for (statements, drag, message, notes) in [
        (
            "fn f1(a) = a;",
            "f1(v, v)",
            "`f1` takes 1 argument, not 2",
            1,
        ),
        (
            "fn f1(a: vec2) = [a[1], a[2], 0];",
            "f1(v)",
            "`a` of `f1` has to be a vector of 2, but this is a vector of 3",
            1,
        ),
        (
            "fn f1(a) = f2(a); fn f2(a) = f1(a);",
            "v",
            "the value of `f1` depends on `f1` itself",
            0,
        ),
        ("fn f1(a, a) = a;", "v", "two parameters are called `a`", 1),
        (
            "fn sin(a) = a;",
            "v",
            "`sin` is a function of the language",
            0,
        ),
        ("fn m(a) = a;", "v", "`m` is defined twice", 1),
        (
            "fn f1(a) = a * nothing;",
            "f1(v)",
            "nothing is called `nothing`",
            1,
        ),
        (
            "fn f1(a) = a * nothing;",
            "f1(v) + f1(2 * v)",
            "nothing is called `nothing`",
            1,
        ),
        ("fn f1(a) = a;", "f1 * v", "`f1` is a function", 0),
        ("fn f1(a) = a;", "f2(v)", "no function is called `f2`", 0),
    ] {
        let errors = refused(statements, drag);
        let first = &errors[0];
        assert_eq!(first.message, message, "{errors:#?}");
        assert_eq!(first.notes.len(), notes, "{errors:#?}");
        assert!(first.help.is_some() && first.span.range().is_some());
        let recursive = message.contains("itself");
        assert_eq!(errors.len(), 1 + usize::from(recursive), "{errors:#?}");
    }
    for wrong in [
        "fn f(a) a;",
        "fn f = 2;",
        "fn f() = 2;",
        "fn (a) = a;",
        "fn f(1) = 2;",
    ] {
        let errors = refused(wrong, "v");
        assert!(
            errors.iter().all(|error| error.help.is_some()),
            "{errors:#?}"
        );
    }
}

#[test]
fn lists_are_several_statements() {
    let list = body("", "v", "k * q^2", "pose(rotx(q), r)").replace(
        "output speed = norm(v);",
        "start r = [1, 0, 0], q = 0.5, v = [0, 1, 0]; output speed = norm(v), height = r[3];",
    );
    let single = body("", "v", "k * q^2", "pose(rotx(q), r)").replace(
        "output speed = norm(v);",
        "start r = [1, 0, 0]; start q = 0.5; start v = [0, 1, 0]; output speed = norm(v); output height = r[3];",
    );
    assert_eq!(code(&list), code(&single));
    let twice = list.replace("q = 0.5", "r = [0, 0, 0]");
    assert_eq!(from_text(&twice).expect_err("given twice").len(), 1);
}

#[test]
fn a_function_without_a_call_is_a_warning() {
    let text = body("fn f1(a) = a;", "v", "k * q^2", "pose(rotx(q), r)");
    let warnings = from_text(&text).expect("correct").model.warnings;
    assert!(
        warnings
            .iter()
            .any(|warning| warning.message == "the function `f1` is never used")
    );
}

/// Chains of calls and doubling calls end with an error, quickly and without a stack overflow on the stack of build
/// scripts and of the command line.
#[test]
fn what_functions_write_out_is_bounded() {
    let deep = std::thread::Builder::new().stack_size(8 << 20);
    let thread = deep.spawn(chains_and_doubling_end).expect("a thread");
    thread.join().expect("bounded");
}

fn chains_and_doubling_end() {
    let system = |functions: &str, first: &str| {
        format!(
            "system S {{ coord x; velocity v; rate x = v; kinetic v^2 / 2; {functions} potential {first}(x)^2; }}"
        )
    };
    let chain = |count: usize| -> String {
        let links = (0..count).map(|i| format!("fn f{i}(a) = f{}(a);", i + 1));
        links.chain([format!("fn f{count}(a) = a;")]).collect()
    };
    let doubling = |count: usize| -> String {
        let links = (0..count).map(|i| format!("fn f{i}(a) = f{0}(a) + f{0}(a);", i + 1));
        links.chain([format!("fn f{count}(a) = a;")]).collect()
    };
    assert!(from_text(&system(&chain(50), "f0")).is_ok());
    assert!(from_text(&system(&doubling(10), "f0")).is_ok());
    for (functions, message) in [
        (chain(1000), "functions call one another too deeply here"),
        (
            doubling(40),
            "function calls expand to too many expressions here",
        ),
    ] {
        let errors = from_text(&system(&functions, "f0")).expect_err("too much");
        assert_eq!(errors.len(), 1, "{errors:#?}");
        assert_eq!(errors[0].message, message);
        assert!(errors[0].notes.len() <= 4);
    }
}
