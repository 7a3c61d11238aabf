//! `hamel emit --language c`: two files, or one text that compiles alone; refused descriptions.

use crate::common::{hamel, text};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("c").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn model(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/models");
    folder.join(name).display().to_string()
}

fn gcc(folder: &Path, file: &str) {
    let output = Command::new("gcc")
        .args([
            "-std=c99",
            "-Wall",
            "-Wextra",
            "-Wpedantic",
            "-Wconversion",
            "-Werror",
            "-c",
        ])
        .arg(file)
        .current_dir(folder)
        .output()
        .expect("gcc runs");
    assert!(output.status.success(), "{}", text(&output.stderr));
}

/// Exit status and standard error of a command.
fn said(arguments: &[&str]) -> (Option<i32>, String) {
    let output = hamel(arguments, "");
    (output.status.code(), text(&output.stderr))
}

#[test]
fn the_files_are_called_what_was_asked_for() {
    for (out, stem) in [
        ("arm", "arm"),
        ("arm.c", "arm"),
        ("arm.h", "arm"),
        ("arm-2.1", "arm-2.1"),
    ] {
        let folder = folder(&format!("called_{out}"));
        let path = folder.join(out).display().to_string();
        let arguments = [
            "emit",
            "--language",
            "c",
            &model("kapitza.eom"),
            "-o",
            &path,
        ];
        assert_eq!(said(&arguments), (Some(0), String::new()));
        let mut files: Vec<String> = fs::read_dir(&folder)
            .expect("a folder")
            .map(|entry| {
                entry
                    .expect("an entry")
                    .file_name()
                    .to_string_lossy()
                    .into_owned()
            })
            .collect();
        files.sort();
        assert_eq!(files, [format!("{stem}.c"), format!("{stem}.h")]);
        gcc(&folder, &format!("{stem}.c"));
        // The same bytes once more, and then different ones.
        let checked = [arguments.as_slice(), &["--check"]].concat();
        assert_eq!(said(&checked).0, Some(0));
        let source = folder.join(format!("{stem}.c"));
        let old = fs::read_to_string(&source).expect("readable");
        fs::write(&source, old + "\n").expect("written");
        let (status, message) = said(&checked);
        assert_eq!(status, Some(1));
        assert!(
            message.contains("is out of date; regenerate it with `hamel emit --language c"),
            "{message}"
        );
    }
}

#[test]
fn what_the_terminal_shows_compiles_alone() {
    let folder = folder("alone");
    for precision in ["double", "float"] {
        let file = model("heavy_top.eom");
        let output = hamel(
            &["emit", "--language", "c", "--precision", precision, &file],
            "",
        );
        assert!(output.status.success(), "{}", text(&output.stderr));
        let code = text(&output.stdout);
        assert!(
            code.contains(&format!("typedef {precision} heavy_top_real;")),
            "{code}"
        );
        fs::write(folder.join("alone.c"), code).expect("written");
        gcc(&folder, "alone.c");
    }
}

#[test]
fn what_makes_no_sense_is_refused_with_the_way_out() {
    let file = model("kapitza.eom");
    let cases: [(&[&str], &str); 7] = [
        (
            &["--precision", "float"],
            "`--precision` is for `--language c`",
        ),
        (
            &["--language", "python", "--precision", "float"],
            "Python has the numbers of the arrays that it is given",
        ),
        (
            &["--language", "c", "--precision", "half"],
            "`half` is neither `double` nor `float`",
        ),
        (
            &["--language", "c", "-o", "a\"b"],
            "not a name that C can include",
        ),
        (
            &["--language", "c", "-o", ".c"],
            "not a name that C can include",
        ),
        (
            &["--language", "c", "-o", "src/math"],
            "or the name of a C header; give it without",
        ),
        (
            &["--language", "fortran"],
            "possible values: rust, c, python",
        ),
    ];
    for (arguments, part) in cases {
        let (status, message) = said(&[&["emit", &file], arguments].concat());
        assert_eq!(status, Some(2), "{arguments:?}");
        assert!(message.contains(part), "{message}");
    }
}

/// Functions in Rust have no C: each is reported at its place, and nothing is written.
#[test]
fn functions_in_rust_are_refused() {
    let folder = folder("functions");
    let out = folder.join("glider").display().to_string();
    let glider = model("external/glider.eom");
    let (status, said) = said(&["emit", "--language", "c", &glider, "-o", &out]);
    assert_eq!(status, Some(1));
    assert!(
        said.contains("C cannot call a function that is given in Rust"),
        "{said}"
    );
    assert!(
        said.contains("extern fn coefficients(alpha, rate)"),
        "{said}"
    );
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 0);
}
