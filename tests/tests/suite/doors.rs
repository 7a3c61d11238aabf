//! Three front ends, one generator: the same text gives the same function bodies through the macro, the
//! build script and the generator that the command line calls.

use hamel_codegen::builder::{Builder, source};
use rayon::prelude::*;
use std::path::Path;

fn models() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let mut all: Vec<(String, String)> = std::fs::read_dir(folder)
        .expect("models")
        .map(|entry| entry.expect("entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "eom"))
        .map(|path| {
            let name = path
                .file_stem()
                .expect("a name")
                .to_string_lossy()
                .into_owned();
            (name, std::fs::read_to_string(path).expect("readable"))
        })
        .collect();
    all.sort();
    all
}

/// The items of a file without its header comment.
fn items(code: &str) -> &str {
    code.split_once("\n\n").map_or(code, |(_, items)| items)
}

#[test]
fn the_macro_expands_to_what_the_builder_writes() {
    models().par_iter().for_each(|(name, text)| {
        let tokens: proc_macro2::TokenStream = text.parse().expect("tokens");
        let expanded = hamel_codegen::expand(tokens);
        let formatted = prettyplease::unparse(&syn::parse2(expanded).expect("items"));
        let written = source(text, name).expect("correct");
        assert_eq!(formatted.trim(), items(&written).trim(), "{name}");
    });
}

#[test]
fn the_build_script_wrote_the_same() {
    let written = include_str!(concat!(env!("OUT_DIR"), "/free_body.rs"));
    let (name, text) = models()
        .into_iter()
        .find(|(name, _)| name == "free_body")
        .expect("free_body");
    assert_eq!(
        written,
        source(&text, &format!("{name}.eom")).expect("correct")
    );
}

/// What a build script writes below `OUT_DIR` is newer than its start: watched, it would have the script run in every
/// build. The script is this program once more.
#[test]
fn descriptions_that_a_script_writes_are_not_watched() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let given = models.join("free_body.eom");
    let own = "HAMEL_TESTS_SCRIPT";
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("script");
    let written = folder.join("heavy_top.eom");
    if std::env::var_os(own).is_some() {
        let builder = Builder::new().file(&given).file(&written);
        builder.generate().expect("correct");
        return;
    }
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::copy(models.join("heavy_top.eom"), &written).expect("written");
    let this = std::env::current_exe().expect("a program");
    let script = std::process::Command::new(this)
        .args([
            "--exact",
            "--nocapture",
            "doors::descriptions_that_a_script_writes_are_not_watched",
        ])
        .env(own, "1")
        .env("OUT_DIR", &folder)
        .output()
        .expect("it runs");
    let said = String::from_utf8_lossy(&script.stdout);
    let watched =
        |path: &Path| said.contains(&format!("cargo:rerun-if-changed={}", path.display()));
    assert!(script.status.success() && watched(&given), "{said}");
    assert!(!watched(&written), "{said}");
    for stem in ["free_body", "heavy_top"] {
        assert!(folder.join(stem).with_extension("rs").is_file());
    }
}

#[test]
fn a_large_model_is_refused_by_the_macro_with_the_way_out() {
    let text = hamel_tests::chain::chain(32).replace("accel, rate", "accel, mass_matrix");
    let tokens: proc_macro2::TokenStream = text.parse().expect("tokens");
    let expanded = hamel_codegen::expand(tokens).to_string();
    assert!(expanded.len() < 1000, "an expansion instead of a refusal");
    for part in [
        "compile_error",
        "statements, more than the 10000 that a macro should expand to",
        "build.rs",
    ] {
        assert!(expanded.contains(part), "{expanded}");
    }
}

/// A table in a file stands where the description says, for every front end: the macro starts at the folder of the
/// package, and notes the file for the compiler.
#[test]
fn a_table_in_a_file_is_the_same_through_every_front_end() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/tabled");
    let text = std::fs::read_to_string(folder.join("wing.eom")).expect("readable");
    let open = &mut |name: &str| std::fs::read_to_string(folder.join(name));
    let generated = hamel_codegen::generate::from_file(&text, open).expect("correct");
    let built = hamel_codegen::builder::written(&generated, "wing.eom").expect("Rust");
    assert_eq!(
        include_str!(concat!(env!("OUT_DIR"), "/wing.rs")),
        built,
        "the build script"
    );
    let here = text.replace("polar.csv", "models/tabled/polar.csv");
    let expanded = hamel_codegen::expand(here.parse().expect("tokens"));
    let mut file: syn::File = syn::parse2(expanded).expect("items");
    let noted = file.items.pop().expect("items");
    assert!(matches!(noted, syn::Item::Const(_)));
    assert_eq!(prettyplease::unparse(&file).trim(), items(&built).trim());
    // What is in the file is part of the hash.
    let more = &mut |name: &str| Ok(std::fs::read_to_string(folder.join(name))? + "0.9, 0.1\n");
    let other = hamel_codegen::generate::from_file(&text, more).expect("correct");
    assert_ne!(other.hash, generated.hash);
    // Without a folder there is no file.
    let errors = hamel_codegen::generate::from_text(&text).expect_err("no folder");
    assert!(errors[0].message.contains("in which folder"));
}

/// What a description includes is the same through every front end: its path starts at the description, from the macro
/// at the package, and the compiler knows of the file.
#[test]
fn an_included_file_is_the_same_through_every_front_end() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/reuse");
    let text = std::fs::read_to_string(folder.join("hexapod.eom")).expect("readable");
    let open = &mut |name: &str| std::fs::read_to_string(folder.join(name));
    let generated = hamel_codegen::generate::from_file(&text, open).expect("correct");
    let built = hamel_codegen::builder::written(&generated, "hexapod.eom").expect("Rust");
    assert_eq!(
        include_str!(concat!(env!("OUT_DIR"), "/hexapod.rs")),
        built,
        "the build script"
    );
    let here = text
        .replace("parts/leg.eom", "models/reuse/parts/leg.eom")
        .replacen("gravity", "generate accel, reach; gravity", 1);
    let open = &mut |name: &str| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(root.join(name))
    };
    let generated = hamel_codegen::generate::from_file(&here, open).expect("correct");
    let built = hamel_codegen::builder::written(&generated, "hexapod.eom").expect("Rust");
    let expanded = hamel_codegen::expand(here.parse().expect("tokens"));
    let mut file: syn::File = syn::parse2(expanded).expect("items");
    let noted = file.items.pop().expect("items");
    assert!(matches!(noted, syn::Item::Const(_)));
    assert_eq!(prettyplease::unparse(&file).trim(), items(&built).trim());
    // Without a folder there is no file.
    let errors = hamel_codegen::generate::from_text(&text).expect_err("no folder");
    assert!(errors[0].message.contains("in which folder"));
}
