//! Included files: their statements take effect where they are included, and errors point into them.

use crate::common::without_comments;
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::generate::{Generated, from_file, from_text, from_tokens};
use hamel_codegen::render::{render, to_compile_errors, warnings};
use std::io::{Error, ErrorKind};

/// Files by their paths relative to the description.
type Files<'a> = &'a [(&'a str, &'a str)];

fn read(text: &str, files: Files<'_>) -> Result<Generated, Vec<Diagnostic>> {
    from_file(text, &mut |name| open(files, name))
}

fn open(files: Files<'_>, name: &str) -> std::io::Result<String> {
    let found = files.iter().find(|(known, _)| *known == name);
    let missing = || Error::new(ErrorKind::NotFound, "no such file");
    found.map(|(_, text)| text.to_string()).ok_or_else(missing)
}

fn correct(text: &str, files: Files<'_>) -> Generated {
    let generated = read(text, files);
    generated.unwrap_or_else(|errors| panic!("{}", render(&errors, "main.eom", text, false)))
}

/// Returns the rendered errors of a wrong description.
fn shown(text: &str, files: Files<'_>) -> String {
    let errors = read(text, files).expect_err("wrong");
    assert!(
        errors.iter().all(|error| error.help.is_some()),
        "{errors:?}"
    );
    render(&errors, "main.eom", text, false)
}

const CART: &str = "
/* A cart /* with a comment
   in a comment */ */
component Cart(m, k = stiff) { // stands on the ground
    /// Its place on the track.
    joint x: prismatic [1, 0, 0] moves body;
    body on body { mass m; }
    potential k * x^2 / 2;
}
const stiff = 3;
";

const MAIN: &str = "system Carts {
    include \"lib/cart.eom\";
    part a = Cart(1);
    part b = Cart(2, stiff + 1);
}";

const WRITTEN: &str = "system Carts {
    const stiff = 3;
    joint a_x: prismatic [1, 0, 0] moves a_body; body on a_body { mass 1; } potential 3 * a_x^2 / 2;
    joint b_x: prismatic [1, 0, 0] moves b_body; body on b_body { mass 2; } potential (stiff + 1) * b_x^2 / 2;
}";

fn code(mut system: Generated) -> String {
    system.hash = 0;
    without_comments(&hamel_codegen::builder::written(&system, "x.eom").expect("Rust"))
}

#[test]
fn what_is_included_counts_where_it_is() {
    let files: Files<'_> = &[("lib/cart.eom", CART)];
    let system = correct(MAIN, files);
    assert!(system.model.warnings.is_empty());
    let written = from_text(WRITTEN).expect("correct");
    assert!(code(system.clone()) == code(written), "other code");
    // The hash includes the contents of the file.
    let other = correct(
        MAIN,
        &[("lib/cart.eom", &CART.replace("stiff = 3", "stiff = 4"))],
    );
    assert_ne!(other.hash, system.hash);
    // As tokens, for the macro.
    let tokens = MAIN.parse().expect("tokens");
    let (_, expanded) = from_tokens(tokens, &mut |name| open(files, name));
    assert_eq!(expanded.expect("correct").hash, system.hash);
}

/// Paths are relative to the file that contains them, including those of tables; a file is included once.
#[test]
fn files_include_files() {
    let main = "system S {
        include \"parts/a.eom\"; include \"./parts/b.eom\"; include \"parts/../parts/b.eom\";
        coord q; velocity w; rate q = w; kinetic a * b * c * w^2; potential drag(q) * q;
    }";
    let files: Files<'_> = &[
        (
            "parts/a.eom",
            "include \"deep/c.eom\"; include \"b.eom\"; const a = 1;",
        ),
        (
            "parts/b.eom",
            "include \"../parts/deep/c.eom\"; const b = 2;",
        ),
        ("./parts/b.eom", ""),
        ("parts/../parts/b.eom", ""),
        (
            "parts/deep/c.eom",
            "const c = 3; table drag from \"../../data/drag.csv\" linear extrapolate hold;",
        ),
        ("data/drag.csv", "0, 0\n1, 2\n"),
    ];
    let system = correct(main, files);
    assert_eq!(system.model.warnings.len(), 0);
}

#[test]
fn errors_are_in_the_included_text() {
    let wrong = CART
        .replace("mass m;", "mass [m, 1];")
        .replace("k * x^2", "k * y^2");
    let mut all = shown(MAIN, &[("lib/cart.eom", &wrong)]);
    let unread = CART
        .replace("body on body", "bodi on body")
        .replace("stiff = 3", "stiff = §3");
    all += &shown(MAIN, &[("lib/cart.eom", &unread)]);
    insta::assert_snapshot!(all);
}

#[test]
fn what_cannot_be_included_is_refused() {
    let mut all = shown(MAIN, &[]);
    // A cycle through a second file.
    let circle: Files<'_> = &[
        ("lib/cart.eom", "include \"more.eom\";\n"),
        ("lib/more.eom", "const a = 1;\ninclude \"cart.eom\";\n"),
    ];
    all += &shown(MAIN, circle);
    all += &shown(MAIN, &[("lib/cart.eom", WRITTEN)]);
    let unclosed: Files<'_> = &[(
        "lib/cart.eom",
        "component Cart(m, k = 1) {\n    body on world { mass m;\n}\n",
    )];
    all += &shown(MAIN, unclosed);
    let closed: Files<'_> = &[("lib/cart.eom", "const a = 1;\n}\n")];
    all += &shown(MAIN, closed);
    insta::assert_snapshot!(all);
    // Beyond the greatest depth.
    let names: Vec<String> = (0..20).map(|i| format!("{i}.eom")).collect();
    let texts: Vec<String> = (1..21).map(|i| format!("include \"{i}.eom\";")).collect();
    let deep: Vec<(&str, &str)> = names
        .iter()
        .map(String::as_str)
        .zip(texts.iter().map(String::as_str))
        .collect();
    let text = "system S { include \"0.eom\"; }";
    let errors = read(text, &deep).expect_err("too deep");
    assert!(
        errors[0].message.contains("more than 16 deep"),
        "{errors:?}"
    );
}

/// Errors in claims are found after parsing; warnings have places, too.
#[test]
fn later_errors_and_warnings_have_their_places() {
    let claim = CART.replace("potential", "invariant p = x; potential");
    let errors = shown(MAIN, &[("lib/cart.eom", &claim)]);
    assert!(errors.contains("lib/cart.eom:8:5"), "{errors}");
    assert!(errors.contains("in the part `a`, made here"), "{errors}");
    let text = MAIN.replace("part b", "component Unused(m) { param spare = 1; } part _c[i in 1..2] = Own(1, 2); component Own(m, never) { param spare = 1; joint x: prismatic [1, 0, 0] moves body; body on body { mass m; } } part b");
    let system = correct(&text, &[("lib/cart.eom", CART)]);
    let list = warnings(&system.model.warnings, "main.eom", &text, false);
    let said: Vec<&str> = list
        .lines()
        .filter(|line| line.starts_with("warning"))
        .collect();
    assert_eq!(
        said,
        [
            "warning: the component `Unused` is never used",
            "warning: the parameter `never` of `Own` is never used",
            "warning: the parameter `_c[1].spare` is never used",
        ]
    );
}

/// The macro shows errors of an included file at the `include`, with file and line.
#[test]
fn the_macro_says_where_in_the_file() {
    let wrong = CART.replace("mass m;", "mass [m, 1];");
    let files: Files<'_> = &[("lib/cart.eom", &wrong)];
    let (places, result) =
        from_tokens(MAIN.parse().expect("tokens"), &mut |name| open(files, name));
    let text = to_compile_errors(&result.expect_err("wrong"), &places).to_string();
    assert!(
        text.contains("lib/cart.eom:7:25: a mass has to be a scalar"),
        "{text}"
    );
}
