//! Degenerate systems: only time, only states, everything prescribed. No stage panics.

use hamel_codegen::emit::c::{Options, Precision, files};
use hamel_codegen::emit::rust_items;
use hamel_codegen::generate::from_text;
use hamel_codegen::proof::check::{Verdict, check};

/// Correct descriptions.
const SYSTEMS: [&str; 8] = [
    "time t; coord x; velocity v; rate x = v; particle mass 1 at [x, 0, 0]; prescribe x = sin(1000000 * t);",
    "time t; joint h: revolute [0, 0, 1] moves f; body on f { mass 1; com [1, 0, 0]; inertia diag(1, 1, 1) about com; }
        prescribe h = 2000 * t;",
    "time t; coord x; velocity v; rate x = v; particle mass 1 at [x, 0, 0]; prescribe x = t^2; generate all, linearize;",
    "time t; output y = t^2; generate all, linearize;",
    "state z = 1; rate z = -z; generate all, linearize;",
    "time t; state z = 0; rate z = t - z; generate all, linearize;",
    "param a = 1; output y = a; generate all, linearize;",
    "time t; coord x, y; velocity v, w; rate x = v; rate y = w; particle mass 1 at [x, y, 0];
        prescribe x = t; prescribe y = sin(t); generate all, linearize;",
];

#[test]
fn no_stage_panics() {
    for body in SYSTEMS {
        let text = format!("system D {{ {body} }}");
        // A description may be refused, with a reason.
        let generated = match from_text(&text) {
            Ok(generated) => generated,
            Err(errors) => {
                println!("{body}\n    {}", errors[0].message);
                assert!(
                    !errors[0].message.contains("internal"),
                    "{body}: {errors:?}"
                );
                continue;
            }
        };
        for identity in check(&generated.model, &generated.program) {
            assert!(
                !matches!(identity.verdict, Verdict::Failed(_)),
                "{body}: {identity:?}"
            );
        }
        rust_items(&generated.program, &Default::default());
        for precision in [Precision::Double, Precision::Float] {
            let options = Options {
                precision,
                ..Options::default()
            };
            files(&generated.program, &options);
        }
        // A table that does not exist is refused, too.
        let _ = generated.tables(&[]);
    }
}
