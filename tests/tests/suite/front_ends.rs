//! Three front ends, one generator: the same text gives the same function bodies through the macro, the
//! build script and the generator that the command line calls.

use hamel_codegen::builder::{Builder, source};
use hamel_codegen::emit::c::Precision;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

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

/// The items of a file without its header, and without comments, which tokens do not have.
fn items(code: &str) -> String {
    let lines = code.lines();
    let items = lines.filter(|line| line.trim_start().split(' ').next() != Some("//"));
    items.collect::<Vec<_>>().join("\n")
}

#[test]
fn the_macro_expands_to_what_the_builder_writes() {
    crate::thinning::thin_out(models())
        .par_iter()
        .for_each(|(name, text)| {
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

/// Runs this test program again as a build script that calls a builder and writes to a folder; returns its messages to
/// Cargo and to people, or `None` within that process.
fn script(test: &str, folder: &Path, builder: impl FnOnce() -> Builder) -> Option<[String; 2]> {
    let own = "HAMEL_TESTS_SCRIPT";
    if std::env::var_os(own).is_some() {
        if let Err(error) = builder().generate() {
            eprintln!("{error}");
        }
        return None;
    }
    let this = std::env::current_exe().expect("a program");
    let script = std::process::Command::new(this)
        .args(["--exact", "--nocapture", &format!("front_ends::{test}")])
        .env(own, "1")
        // The stack size of the main thread on Windows.
        .env("RUST_MIN_STACK", (1 << 20).to_string())
        .env("OUT_DIR", folder)
        .output()
        .expect("it runs");
    let said = [script.stdout, script.stderr].map(|said| String::from_utf8_lossy(&said).into());
    assert!(script.status.success(), "{said:?}");
    Some(said)
}

/// Creates a folder for a test, with these files.
fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if std::env::var_os("HAMEL_TESTS_SCRIPT").is_some() {
        return folder;
    }
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(folder.join("out")).expect("a folder");
    for (file, text) in files {
        let file = folder.join(file);
        std::fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
        std::fs::write(file, text).expect("written");
    }
    folder
}

/// Returns whether a line of the script's output makes Cargo watch a file.
fn watches(said: &str, file: &Path) -> bool {
    let line = format!("cargo:rerun-if-changed={}", file.display());
    said.lines().any(|said| said.ends_with(&line))
}

const BLOCK: &str = "pub system Block { coord x; velocity v; rate x = v; kinetic v^2; }";

/// Files that a build script writes below `OUT_DIR` are newer than its start: if Cargo watched them, the script would
/// run in every build. Included files from elsewhere are watched.
#[test]
fn descriptions_that_a_script_writes_are_not_watched() {
    let including = BLOCK.replace("coord", "include \"../part.eom\"; coord");
    let files = [
        ("out/written.eom", including.as_str()),
        ("given.eom", BLOCK),
        ("part.eom", "param m = 1;"),
    ];
    let folder = folder("written", &files);
    let [given, written] = ["given.eom", "out/written.eom"].map(|file| folder.join(file));
    let test = "descriptions_that_a_script_writes_are_not_watched";
    let out = folder.join("out");
    let builder = || Builder::new().file(&given).file(&written);
    let Some([said, wrong]) = script(test, &out, builder) else {
        return;
    };
    assert!(watches(&said, &given), "{said}{wrong}");
    assert!(!watches(&said, &written), "{said}");
    assert!(watches(&said, &out.join("../part.eom")), "{said}");
    for stem in ["given", "written"] {
        assert!(out.join(stem).with_extension("rs").is_file());
    }
}

/// A sum with as many operands as allowed, and brackets of the greatest depth, need more stack than some threads have.
#[test]
fn deep_descriptions_need_no_stack_of_the_script() {
    let sum: Vec<String> = (1..500).map(|k| format!("sin({k} * x)")).collect();
    let deep = format!("{}x{}", "sin(".repeat(60), ")".repeat(60));
    let potential = format!("potential {deep} + {}; kinetic", sum.join(" + "));
    let described = BLOCK.replace("kinetic", &potential);
    let folder = folder("deep", &[("block.eom", described.as_str())]);
    let out = folder.join("out");
    let test = "deep_descriptions_need_no_stack_of_the_script";
    let builder = || Builder::new().file(folder.join("block.eom"));
    if let Some([_, wrong]) = script(test, &out, builder) {
        assert!(out.join("block.rs").is_file(), "{wrong}");
    }
}

/// Included files are shown by their paths and are watched at any depth. Warnings have a form for all versions of
/// Cargo: with two colons, packages with an old `rust-version` would not build.
#[test]
fn what_a_script_says_is_for_every_cargo() {
    // A name with a line break would be an instruction to Cargo.
    let told = BLOCK.replace("kinetic", "include \"x\\ncargo:rustc-cfg=told\"; kinetic");
    let wrong = BLOCK.replace("kinetic", "include \"parts/a.eom\"; kinetic");
    let files = [
        ("models/told.eom", told.as_str()),
        ("models/wrong.eom", wrong.as_str()),
        ("models/parts/a.eom", "include \"../b.eom\";"),
        ("models/b.eom", "\nkinetic y^2;"),
        (
            "models/twice.eom",
            "system Twice { include \"./m.eom\"; include \"m.eom\"; coord x; velocity v; rate x = v; kinetic m * v^2; }",
        ),
        ("models/m.eom", "param m = 1;"),
        (
            "models/unused.eom",
            &BLOCK.replace("coord", "param m = 1; coord"),
        ),
    ];
    let folder = folder("said", &files);
    let models = folder.join("models");
    let builder = || {
        let files = ["told.eom", "wrong.eom", "twice.eom", "unused.eom"];
        let add = |builder: Builder, file| builder.file(models.join(file));
        files.into_iter().fold(Builder::new(), add)
    };
    let test = "what_a_script_says_is_for_every_cargo";
    let Some([said, wrong]) = script(test, &folder.join("out"), builder) else {
        return;
    };
    for file in ["wrong.eom", "parts/a.eom", "b.eom", "m.eom", "unused.eom"] {
        assert!(watches(&said, &models.join(file)), "{file}: {said}");
    }
    let warning = "cargo:warning=warning: the parameter `m` is never used";
    assert!(
        said.contains(warning) && !said.contains("cargo::"),
        "{said}"
    );
    for place in ["b.eom:2:9", "parts/a.eom:1:9", "wrong.eom:1:"] {
        let place = models.join(place).display().to_string();
        assert!(wrong.contains(&place), "{place}: {wrong}");
    }
    assert!(!said.contains("rustc-cfg"), "{said}");
    assert_eq!(wrong.matches("error: ").count(), 2, "{wrong}");
}

/// File names in the command of a header are quoted for the shell.
#[test]
fn names_of_files_are_quoted_in_commands() {
    for (name, command) in [
        ("größe-2.eom", "`hamel emit größe-2.eom`"),
        ("two words.eom", "`hamel emit 'two words.eom'`"),
        ("it's.eom", r"`hamel emit 'it'\''s.eom'`"),
    ] {
        let code = source(BLOCK, name).expect("correct");
        assert!(code.contains(command), "{code}");
    }
}

/// All files that cannot be read, or would be written to the same path, are reported at once, each with a remedy.
#[test]
fn wrong_files_are_told_at_once() {
    let files = [
        ("a.eom", BLOCK),
        ("b/a.eom", BLOCK),
        ("robot.xml", "\u{feff}<robot name=\"a\"/>"),
        ("folder.eom/a", ""),
        ("line\nbreak.eom", BLOCK),
        ("missing/a.eom", BLOCK),
    ];
    let folder = folder("files", &files);
    std::fs::write(folder.join("latin.eom"), b"system \xc4").expect("written");
    let builder = || {
        let add = |builder: Builder, file| builder.file(folder.join(file));
        let files = [
            "a.eom",
            "b/../a.eom",
            "b/a.eom",
            "robot.xml",
            "folder.eom",
            "line\nbreak.eom",
            "latin.eom",
        ];
        let builder = files.into_iter().fold(Builder::new(), add);
        let none = folder.join("none");
        builder.file("..").file("none.eom").out_dir(none)
    };
    let test = "wrong_files_are_told_at_once";
    let Some([said, wrong]) = script(test, &folder.join("out"), builder) else {
        return;
    };
    for told in [
        "b/../a.eom is given twice, but has only one a.rs; remove it, or ",
        "b/a.eom would both be written to a.rs; rename one of them",
        "robot.xml is not a description: ",
        "folder.eom: Is a directory",
        "break.eom: Cargo cannot watch a path that has a line break, ",
        "latin.eom: byte 7 is not UTF-8; save it as UTF-8",
        "`..` is not the path of a file: give the path of a description",
        "; its path starts at ",
        "/none does not exist; create it first",
    ] {
        assert_eq!(wrong.matches(told).count(), 1, "{told}: {wrong}");
    }
    assert!(!said.contains("=break"), "{said}");
}

/// Output never overwrites a description or a file that it includes.
#[test]
fn nothing_that_is_read_is_written_over() {
    let including = BLOCK.replace("kinetic", "include \"b.h\"; kinetic");
    let including = including.replace("Block", "Other");
    let files = [
        ("out/a.rs", BLOCK),
        ("out/b.eom", including.as_str()),
        ("out/b.h", "param m = 1;"),
    ];
    let folder = folder("over", &files);
    let out = folder.join("out");
    let test = "nothing_that_is_read_is_written_over";
    let builder = || {
        let builder = Builder::new().file(out.join("a.rs"));
        let builder = builder.file(out.join("b.eom"));
        builder.c_files(out.join("../out"), Precision::Double)
    };
    let Some([_, wrong]) = script(test, &out, builder) else {
        return;
    };
    for (file, text) in files {
        let now = std::fs::read_to_string(folder.join(file)).expect("readable");
        assert_eq!(now, text, "{file}");
    }
    let told = wrong.matches("this file is an input; write to another folder, or rename it");
    assert_eq!(told.count(), 2, "{wrong}");
}

/// In C, which has no modules, functions of different files have different names, and all headers can be included
/// together.
#[test]
fn names_in_c_are_of_one_file() {
    let files = [
        ("a.eom", BLOCK),
        ("b.eom", BLOCK),
        (
            "with_output.eom",
            "system Long { coord x; velocity v; rate x = v; kinetic v^2; output name_accel = x; }",
        ),
        ("c.eom", &BLOCK.replace("Block", "LongName")),
        ("d\".eom", &BLOCK.replace("Block", "Other")),
        ("Math.eom", &BLOCK.replace("Block", "Math")),
    ];
    let folder = folder("names", &files);
    let out = folder.join("out");
    let builder = || {
        let add = |builder: Builder, (file, _): &(&str, &str)| builder.file(folder.join(file));
        let builder = files.iter().fold(Builder::new(), add);
        builder.c_files(&out, Precision::Double)
    };
    let Some([_, wrong]) = script("names_in_c_are_of_one_file", &out, builder) else {
        return;
    };
    for told in [
        "error: `block_default_parameters` in C would also be a function of ",
        "b.eom:1:12",
        "error: `long_name_accel` in C would also be a function of ",
        "c.eom:1:12",
        "d\".eom: C cannot include `d\".h`, or has a header of this name; rename it",
        "Math.eom: C cannot include `Math.h`, or has a header of this name; rename it",
    ] {
        assert_eq!(wrong.matches(told).count(), 1, "{told}: {wrong}");
    }
    assert!(out.join("a.c").is_file() && !out.join("b.c").exists());
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

/// The path of a table is relative to the description for every front end; the macro starts at the folder of the
/// package, and registers the file with the compiler.
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
    // The hash includes the contents of the file.
    let more = &mut |name: &str| Ok(std::fs::read_to_string(folder.join(name))? + "0.9, 0.1\n");
    let other = hamel_codegen::generate::from_file(&text, more).expect("correct");
    assert_ne!(other.hash, generated.hash);
    // Without a folder there are no files.
    let errors = hamel_codegen::generate::from_text(&text).expect_err("no folder");
    assert!(errors[0].message.contains("is not known"));
}

/// An included file is the same through every front end: its path is relative to the description, or to the package for
/// the macro, and the file is registered with the compiler.
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
    // Without a folder there are no files.
    let errors = hamel_codegen::generate::from_text(&text).expect_err("no folder");
    assert!(errors[0].message.contains("is not known"));
}
