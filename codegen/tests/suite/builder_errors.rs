//! Scenes built by a program that cannot be written as text are refused at the faulty statement.

use hamel_codegen::scene::{Expr, Extrapolation, Interpolation, Scene, SceneBuilder, SceneError};

fn messages(scene: &SceneBuilder) -> Vec<String> {
    let error: SceneError = scene.build().expect_err("it cannot be said");
    let shown = |error: &hamel_codegen::diagnostics::Diagnostic| error.message.clone();
    let mut all: Vec<String> = error.errors.iter().map(shown).collect();
    all.push(error.to_string());
    all
}

/// Numbers without a text form are refused at their place, whatever the names.
#[test]
fn numbers_that_are_not_finite_are_refused() {
    let mut scene = Scene::builder("S");
    scene.doc("Of ((0 / 0)) nothing is said here.");
    let all = ["NaN", "inf", "minus_inf"].map(|name| scene.constant(name, 3));
    let [a, b, c] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(Expr::from);
    scene.param("k", &all[0] * a);
    scene.repeat("i", 1, 2, |scene| scene.potential(&all[1] * b));
    scene.param("two words", 1);
    scene.table(
        "t",
        &[(0.0, f64::NAN), (1.0, 1.0)],
        Interpolation::Linear,
        Extrapolation::Hold,
    );
    scene.part("p", "C", [("a", c)]);
    let said = messages(&scene);
    let finite = "a number that is not finite was given here";
    assert_eq!(
        said.iter().filter(|said| *said == finite).count(),
        4,
        "{said:?}"
    );
    assert!(
        said.iter().any(|said| said.contains("found `words`")),
        "{said:?}"
    );
    assert!(
        said[said.len() - 1].contains("param k = NaN * ((0 / 0));"),
        "{said:?}"
    );
}

/// All statements with invalid names are shown.
#[test]
fn every_name_that_is_no_word_is_shown() {
    let mut scene = Scene::builder("S");
    scene.param("a = 1, b", 1);
    scene.param("good", 2);
    scene.param("c: vec3", [1, 2, 3]);
    let said = messages(&scene);
    let word = "this statement has a name of more than one word";
    assert_eq!(said[..2], [word, word]);
    assert_eq!(said.len(), 3);
    assert!(said[2].contains("param a = 1, b = 1;"), "{}", said[2]);
    assert!(
        said[2].contains("param c: vec3 = [1, 2, 3];"),
        "{}",
        said[2]
    );
}

/// A sum built in an endless loop ends in an error, not in a stack overflow.
#[test]
fn endless_expressions_are_refused() {
    let long = |count| {
        let sum = (0..count).fold(Expr::name("q"), |sum, _| sum + 1);
        let mut scene = Scene::builder("S");
        scene.potential(sum);
        scene
    };
    assert!(long(499).build().is_ok());
    assert_eq!(messages(&long(500))[0], "more than 500 operands in a row");
    let deep = "an expression that is more than 600 operations deep was given here";
    assert_eq!(messages(&long(600))[0], deep);
    assert_eq!(messages(&long(200_000))[0], deep);
    let deep_in_a_part = (0..200_000).fold(Expr::name("q"), |sum, _| 1 - sum);
    let mut scene = Scene::builder("S");
    scene.part("p", "C", [("a", deep_in_a_part)]);
    assert_eq!(messages(&scene)[0], deep);
}

/// Docs keep trailing blanks, and carriage returns end lines.
#[test]
fn docs_read_back() {
    let mut scene = Scene::builder("S");
    scene.doc("a  \r\nb\rc\t");
    scene.doc("");
    let built = scene.build().expect("a scene");
    assert!(
        built
            .to_string()
            .starts_with("/// a  \n/// b\n/// c\t\n///\npub system"),
        "{built}"
    );
    let read = Scene::parse("#[doc = \" a\\rb \"] system S { }").expect("a scene");
    assert_eq!(
        Scene::parse(&read.to_string()).expect("it was printed"),
        read
    );
}
