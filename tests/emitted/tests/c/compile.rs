//! Compiles and runs cases.

use crate::case::{Case, Expected, distance};
use hamel_codegen::emit::c::Precision;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

/// Turns warnings into errors.
pub const STRICT_FLAGS: &str = "-Wall -Wextra -Wpedantic -Wconversion -Werror";

/// Whether to use all compilers, and to enable the warnings of gcc that need optimisation.
static EVERYTHING: LazyLock<bool> = LazyLock::new(|| std::env::var_os("HAMEL_ATTACK").is_some());

/// Creates a separate folder for the files of a test.
pub fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("c99")
        .join(name);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Returns whether a compiler is installed.
pub fn installed(program: &str) -> bool {
    let version = Command::new(program).arg("--version").output();
    version.is_ok_and(|output| output.status.success())
}

/// Runs a program in a folder; returns its output or its error.
pub fn run(folder: &Path, line: &str) -> Result<String, String> {
    let mut words = line.split_whitespace();
    let program = words.next().expect("a program");
    let output = Command::new(program)
        .args(words)
        .current_dir(folder)
        .output()
        .map_err(|error| format!("`{line}`: {error}"))?;
    let said = String::from_utf8_lossy(&output.stderr);
    match output.status.success() && said.is_empty() {
        true => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
        false => {
            let said: String = said
                .lines()
                .take(40)
                .map(|line| format!("{line}\n"))
                .collect();
            Err(format!(
                "`{line}` in {}: {}\n{said}",
                folder.display(),
                output.status
            ))
        }
    }
}

/// Returns the faults of several cases in one source.
pub fn faults(name: &str, cases: &[Case]) -> Vec<String> {
    let folder = folder(name);
    let (mut double, float) = rayon::join(
        || faults_in(&folder, Precision::Double, cases),
        || faults_in(&folder, Precision::Float, cases),
    );
    double.extend(float);
    double
}

/// Returns the faults in one precision.
fn faults_in(folder: &Path, precision: Precision, cases: &[Case]) -> Vec<String> {
    let file = precision.type_name();
    std::fs::write(folder.join(format!("{file}.c")), source(cases, precision)).expect("written");
    let optimised = if *EVERYTHING { "-O1" } else { "-O0" };
    let mut lines = vec![format!(
        "gcc -std=c99 {optimised} {STRICT_FLAGS} {file}.c -lm -o {file}"
    )];
    if *EVERYTHING && installed("g++") {
        lines.push(format!(
            "g++ -x c++ -std=c++17 -fsyntax-only {STRICT_FLAGS} {file}.c"
        ));
    }
    if *EVERYTHING && installed("clang") {
        lines.push(format!(
            "clang -std=c99 -fsyntax-only {STRICT_FLAGS} {file}.c"
        ));
        lines.push(format!(
            "clang -x c++ -std=c++17 -fsyntax-only {STRICT_FLAGS} {file}.c"
        ));
    }
    let built: Vec<_> = lines.iter().map(|line| run(folder, line)).collect();
    let mut faults: Vec<String> = built.iter().filter_map(|line| line.clone().err()).collect();
    if built[0].is_err() {
        return faults;
    }
    match run(folder, &folder.join(file).display().to_string()) {
        Ok(printed) => faults.extend(compared(&printed, cases, precision)),
        Err(error) => faults.push(error),
    }
    faults
}

/// Combines all cases with their calls in one source, in which macros left behind by a case would cause errors.
fn source(cases: &[Case], precision: Precision) -> String {
    let mut text = "#include <stddef.h>\n#include <stdio.h>\n\n".to_string();
    let real = precision.type_name();
    text.push_str(&format!(
        "static void show(int status, const {real} *values, size_t count)\n{{\n    size_t i;\n    printf(\"%d\", status);\n    for (i = 0; i < count && status == 0; i++) {{\n        printf(\" %.17g\", (double)values[i]);\n    }}\n    printf(\"\\n\");\n}}\n\n"
    ));
    let mut runs = String::new();
    for case in cases {
        let (generated, calls) = case.text(precision);
        text.push_str(&format!("{generated}\n{calls}\n"));
        runs.push_str(&case.run());
    }
    format!("{text}int main(void)\n{{\n{runs}    return 0;\n}}\n")
}

fn compared(printed: &str, cases: &[Case], precision: Precision) -> Vec<String> {
    let expected: Vec<Expected> = cases.iter().flat_map(Case::expected).collect();
    let mut faults = Vec::new();
    let lines: Vec<&str> = printed.lines().collect();
    if lines.len() != expected.len() {
        faults.push(format!("{} lines, not {}", lines.len(), expected.len()));
    }
    for (line, expected) in lines.iter().zip(&expected) {
        let mut words = line.split(' ');
        let status: Option<i64> = words.next().and_then(|word| word.parse().ok());
        let values: Option<Vec<f64>> = words.map(|word| word.parse().ok()).collect();
        let fault = match (&values, status) {
            (Some(values), Some(status)) => wrong(status, values, expected, precision),
            _ => Some("no numbers".into()),
        };
        let fault = fault.map(|fault| format!("{precision}: {}: {fault}: {line}", expected.what));
        faults.extend(fault);
    }
    faults
}

/// Returns the fault of a value, if any.
fn wrong(status: i64, values: &[f64], expected: &Expected, precision: Precision) -> Option<String> {
    // Rounding may change the sign of a pivot that is nearly 0.
    let narrow = expected.doubt > 1.0 || expected.narrow && precision == Precision::Float;
    let wanted = match &expected.value {
        Ok(_) if status == 0 && precision == Precision::Float => &expected.single,
        Ok(wanted) if status == 0 => wanted,
        Ok(_) => return (!narrow).then(|| "it has a value".into()),
        Err(wanted) => {
            let fine = status == *wanted || precision == Precision::Float;
            return (!fine).then(|| format!("its status is {wanted}"));
        }
    };
    let largest = |list: &[f64]| list.iter().fold(1.0, |most: f64, v| most.max(v.abs()));
    let scale = largest(wanted);
    // Where the interpreter has an error, another order of the operations has a similar one.
    let [rounding, slope, error] = match precision {
        Precision::Double => [1e-13, 1e-7, 8.0],
        Precision::Float => [1e-5, 100.0, 1e10],
    };
    let allowed = rounding * scale + slope * expected.doubt + error * expected.error;
    let apart = distance(wanted, values);
    (apart > allowed)
        .then(|| format!("off by {apart:e} of {scale:e}, {allowed:e} allowed: {wanted:?}"))
}
