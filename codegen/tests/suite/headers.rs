//! C headers.

use hamel_codegen::emit::c::{Options, Precision, files};
use hamel_codegen::generate::from_text;

#[test]
fn what_a_header_names_it_includes() {
    let header = |most: &str, precision| {
        let text = format!(
            "system A {{ joint j: revolute [0, 0, 1] moves f {{ max_force {most}; }}
                body on f {{ mass 1; inertia diag(1, 1, 1) about com; }} }}"
        );
        let program = from_text(&text)
            .unwrap_or_else(|errors| panic!("{errors:?}"))
            .program;
        let options = Options {
            precision,
            ..Options::default()
        };
        files(&program, &options).header
    };
    let infinite = header("1e300", Precision::Float);
    let include = infinite.find("#include <math.h>").expect("for HUGE_VALF");
    assert!(include < infinite.find("HUGE_VALF").expect("it is no float"));
    assert!(!header("1e300", Precision::Double).contains("#include"));
    assert!(!header("100", Precision::Float).contains("#include"));
}

#[test]
fn members_are_not_called_as_types() {
    let text = "system A { param a_real = 1, a_system = 2, fmin = 3, b = 4; coord q; velocity v; rate q = v;
        kinetic a_real * v^2 / 2; potential (a_system + fmin + b) * q; }";
    let program = from_text(text).expect("right").program;
    let header = files(&program, &Options::default()).header;
    let start = header
        .find("typedef struct a_parameters {")
        .expect("it is there");
    let end = header[start..].find('}').expect("it ends");
    let declared = header[start..start + end].lines().map(str::trim);
    let members: Vec<&str> = declared
        .filter_map(|line| line.strip_prefix("a_real ")?.strip_suffix(';'))
        .collect();
    assert_eq!(members, ["a_real_2", "a_system_2", "fmin_", "b"]);
}
