//! Compares generated C with the interpreter, for every third model, awkward names in every third position, and random
//! descriptions, compiled by gcc as C99 without warnings: `double` within 1e-13 of the scale, `float` within its
//! rounding. With `HAMEL_ATTACK=more`, as in `cargo xtask ci`, there are all models and positions and 20 random
//! descriptions instead of 5, gcc optimises, and all code also compiles by g++ as C++17 and by clang as both, if
//! installed; `HAMEL_ATTACK=full` has 300.

#[path = "c/case.rs"]
mod case;
#[path = "../../../codegen/tests/suite/common/mod.rs"]
mod common;
#[path = "c/compile.rs"]
mod compile;
#[path = "../src/describe.rs"]
mod describe;
#[path = "../../../codegen/tests/suite/common/models.rs"]
mod models;
#[path = "c/names.rs"]
mod names;
#[path = "../../../codegen/tests/suite/common/thinning.rs"]
mod thinning;

use case::Case;
use common::{Random, size};
use compile::{STRICT_FLAGS, folder, run};
use hamel_codegen::Builder;
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::emit::c::{self, Precision};
use hamel_codegen::generate::{Generated, from_file, from_text};
use hamel_codegen::render::render;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use thinning::thin_out;

/// Descriptions per C source.
const DESCRIPTIONS_PER_SOURCE: usize = 12;

/// Lists all descriptions below a folder.
fn descriptions(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(path) = open.pop() {
        // Without parts of others, and without functions in Rust, which C does not support.
        if path.ends_with("parts") || path.ends_with("external") {
            continue;
        } else if path.is_dir() {
            let entries = std::fs::read_dir(&path).expect("a folder");
            open.extend(entries.map(|entry| entry.expect("an entry").path()));
        } else if path.extension().is_some_and(|ending| ending == "eom") {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn read(path: &Path) -> Generated {
    let text = std::fs::read_to_string(path).expect("readable");
    let folder = path.parent().expect("a folder");
    let open = &mut |name: &str| std::fs::read_to_string(folder.join(name));
    let said = |errors: Vec<Diagnostic>| render(&errors, &path.display().to_string(), &text, false);
    from_file(&text, open).unwrap_or_else(|errors| panic!("{}", said(errors)))
}

/// Compiles cases in groups, and compares all that they print.
fn attack(what: &str, cases: Vec<Case>) {
    let faults: Vec<String> = cases
        .par_chunks(DESCRIPTIONS_PER_SOURCE)
        .enumerate()
        .flat_map_iter(|(number, cases)| compile::faults(&format!("{what}{number}"), cases))
        .collect();
    assert!(
        faults.is_empty(),
        "{} faults:\n{}",
        faults.len(),
        faults.join("\n")
    );
}

#[test]
fn models_give_what_the_interpreter_gives() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = descriptions(&root.join("../models"));
    paths.push(root.join("../../examples/dzhanibekov.eom"));
    assert!(paths.len() > 60, "{} models", paths.len());
    let cases: Vec<Case> = thin_out(paths)
        .par_iter()
        .map(|path| {
            let stem = path.file_stem().expect("a name").to_string_lossy();
            Case::new(read(path), Some(&stem), 1.0)
        })
        .collect();
    attack("models", cases);
}

/// A function that is split into parts.
#[test]
fn a_quadruped_gives_what_the_interpreter_gives() {
    let generated =
        from_text(include_str!("../../../lab/big/models/quadruped.eom")).expect("it is right");
    let files = c::files(&generated.program, &c::Options::default());
    assert!(files.source.matches("\nPART ").count() > 100);
    attack("quadruped", vec![Case::new(generated, None, 1.0)]);
}

/// Functions that models have only on request.
#[test]
fn what_is_asked_for_gives_what_the_interpreter_gives() {
    const MODELS: [&str; 8] = [
        "cart_pole",
        "double_pendulum_angles",
        "drone",
        "free_body",
        "heavy_top",
        "lagging_drone",
        "satellite",
        "spring_chain",
    ];
    const REQUESTS: [&str; 5] = [
        "linearize",
        "inverse_dynamics_slopes",
        "parameter_slopes",
        "regressor, base_parameters",
        "centre_of_mass, centroidal_momentum, centroidal_map, centroidal_bias",
    ];
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let asked: Vec<(PathBuf, usize)> = models::models(&folder)
        .into_iter()
        .filter(|path| {
            MODELS
                .iter()
                .any(|model| path.ends_with(format!("{model}.eom")))
        })
        .flat_map(|path| (0..REQUESTS.len()).map(move |k| (path.clone(), k)))
        .collect();
    assert_eq!(asked.len(), MODELS.len() * REQUESTS.len());
    let cases: Vec<Case> = asked
        .par_iter()
        .filter_map(|(path, k)| {
            // Functions that a model does not support are covered by other tests.
            let generated = models::asked_for(path, REQUESTS[*k]).ok()?;
            let stem = path.file_stem()?.to_string_lossy();
            Some(Case::new(generated, Some(&format!("{stem}_{k}")), 1.0))
        })
        .collect();
    assert!(cases.len() >= 30, "{} functions", cases.len());
    attack("asked", cases);
}

#[test]
fn names_of_c_and_of_the_generated_text_are_names_in_descriptions() {
    // Each name has eight positions: two or three of them are in a third of the descriptions.
    let texts = thin_out(names::descriptions());
    // Some names are keywords in some positions.
    let made = texts.iter().filter_map(|text| from_text(text).ok());
    let cases: Vec<Case> = made
        .map(|generated| Case::new(generated, None, 1.5))
        .collect();
    assert!(
        cases.len() * 10 > texts.len() * 9,
        "{} of {}",
        cases.len(),
        texts.len()
    );
    attack("names", cases);
}

#[test]
fn random_descriptions_give_what_the_interpreter_gives() {
    let count = size(5, 300);
    let cases: Vec<Case> = (0..count)
        .into_par_iter()
        .filter_map(|seed| {
            let text = describe::description(&mut Random::new(70_000 + seed), None);
            // Refused descriptions are covered by other tests.
            let generated = from_text(&text).ok()?;
            Some(Case::new(generated, Some(&format!("random_{seed}")), 1.5))
        })
        .collect();
    assert!(
        cases.len() as u64 * 10 > count * 7,
        "{} of {count}",
        cases.len()
    );
    attack("random", cases);
}

/// The C code in the book compiles between the necessary declarations, and returns a status.
#[test]
fn the_lines_of_the_book_are_c() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = std::fs::read_to_string(root.join("docs/book/src/front-ends.md")).expect("a page");
    let (_, rest) = page.split_once("```c\n").expect("a block");
    let (shown, rest) = rest.split_once("```").expect("its end");
    assert!(!rest.contains("```c\n"), "a second block");
    let folder = folder("book");
    let built = Builder::new()
        .file(root.join("examples/c/cart_pole.eom"))
        .out_dir(&folder)
        .c_files(&folder, Precision::Double)
        .generate();
    built.unwrap_or_else(|error| panic!("{error}"));
    let program = format!(
        "#include \"cart_pole.h\"\nint main(void)\n{{\ncart_pole_parameters parameters;\ncart_pole_system system;\n\
         cart_pole_status status;\ndouble x[CART_POLE_COORDINATES] = {{0}}, xi[CART_POLE_VELOCITIES] = {{0}};\n\
         double u[CART_POLE_INPUTS] = {{1}}, xi_dot[CART_POLE_VELOCITIES];\n{shown}\
         return status || xi_dot[0] <= 0;\n}}\n"
    );
    std::fs::write(folder.join("shown.c"), program).expect("written");
    for line in [
        &*format!("gcc -std=c99 -O2 {STRICT_FLAGS} shown.c cart_pole.c -lm -o shown"),
        &folder.join("shown").display().to_string(),
    ] {
        run(&folder, line).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// The example, made through the front end for build scripts without a warning; it ends with 0 if the pole stands.
#[test]
fn the_example_holds_its_pole_upright() {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/c");
    let main = example.join("main.c").display().to_string();
    for precision in [Precision::Double, Precision::Float] {
        let folder = folder(&format!("example_{precision}"));
        let built = Builder::new()
            .file(example.join("cart_pole.eom"))
            .out_dir(&folder)
            .c_files(&folder, precision)
            .generate();
        built.unwrap_or_else(|error| panic!("{error}"));
        let line = format!("gcc -std=c99 -O2 {STRICT_FLAGS} -c cart_pole.c");
        run(&folder, &line).unwrap_or_else(|error| panic!("{error}"));
        // The program is written with `double`.
        if precision == Precision::Float {
            continue;
        }
        let line =
            format!("gcc -std=c99 -O2 {STRICT_FLAGS} -I. {main} cart_pole.o -lm -o cart_pole");
        run(&folder, &line).unwrap_or_else(|error| panic!("{error}"));
        let printed = run(&folder, &folder.join("cart_pole").display().to_string());
        let printed = printed.unwrap_or_else(|error| panic!("{error}"));
        assert!(printed.contains("the largest force was"), "{printed}");
    }
}
