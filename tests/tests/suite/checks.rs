//! Every identity of the formalism holds for every model, and a broken symbol is detected.

use crate::derived::{self, model};
use hamel_codegen::algebra::graph::Node;
use hamel_codegen::derive::tables::EquationTables;
use hamel_codegen::generate::from_text;
use hamel_codegen::proof::check::{Identity, Verdict, check};
use hamel_codegen::proof::correction::validate;
use rayon::prelude::*;
use std::path::Path;

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.eom"));
    std::fs::read_to_string(path).expect("the model is in the repository")
}

/// Every identity holds for every model, and is proved where it was proved before: a lost proof or a missing identity
/// moves the model's name in the snapshot.
#[test]
fn all_identities_hold() {
    // The models of each identity, first those for which it is proved; identities in order of first occurrence.
    let mut verdicts: Vec<(String, [Vec<String>; 2])> = Vec::new();
    let all = derived::all().into_par_iter().map(|model| {
        let generated = model.generated();
        (&model.name, check(&generated.model, &generated.program))
    });
    for (name, identities) in all.collect::<Vec<_>>() {
        assert!(identities.len() >= 10);
        for identity in identities {
            let Identity {
                label, equation, ..
            } = &identity;
            let verdict = match &identity.verdict {
                Verdict::Proved => 0,
                Verdict::Checked(_) => 1,
                Verdict::Failed(why) => panic!("{name}: {label} {equation}: {why}"),
            };
            let title = format!("{label:13} {equation}");
            let known = verdicts.iter().position(|(known, _)| *known == title);
            let place = known.unwrap_or_else(|| {
                verdicts.push((title, Default::default()));
                verdicts.len() - 1
            });
            verdicts[place].1[verdict].push(name.clone());
        }
    }
    let mut text = String::new();
    for (title, models) in &verdicts {
        text += &format!("{title}\n");
        for (verdict, models) in ["proved", "checked"].into_iter().zip(models) {
            text += &paragraph(verdict, models);
        }
    }
    insta::assert_snapshot!("verdicts", text);
}

/// Formats names after a word, in lines of at most 120 characters; an empty text if there are none.
fn paragraph(word: &str, names: &[String]) -> String {
    let (mut text, mut line) = (String::new(), String::new());
    for name in names {
        if !line.is_empty() && line.len() + name.len() > 118 {
            text += &format!("{line}\n");
            line.clear();
        }
        if line.is_empty() {
            let word = if text.is_empty() { word } else { "" };
            line = format!("  {word:7}");
        }
        line += &format!(" {name}");
    }
    match names {
        [] => text,
        _ => text + &format!("{line}\n"),
    }
}

/// Kinematic identities of Lie groups are proved over the rationals, not only modulo p.
#[test]
fn lie_group_identities_are_proved() {
    for name in [
        "free_body",
        "free_body_world",
        "heavy_top",
        "heavy_top_quaternion",
        "planar_body",
    ] {
        let generated = model(name).generated();
        for identity in check(&generated.model, &generated.program).iter().take(9) {
            assert_eq!(
                identity.verdict,
                Verdict::Proved,
                "{name}: {}",
                identity.equation
            );
        }
    }
}

/// Constraints may contain functions of parameters, in every form of the equations.
#[test]
fn constraints_may_have_functions_of_parameters() {
    for (length, value) in [
        ("l1^(1/3)", "1"),
        ("1 / (4 * l1)", "0.25"),
        ("sqrt(l1 + 1.25)", "1.5"),
    ] {
        let text = text("rod_particles")
            .replace("= l1^2", &format!("= ({length})^2"))
            .replace("x1 = 1;", &format!("x1 = {value};"))
            .replace("x2 = 1;", &format!("x2 = {value};"))
            .replace("x3 = 1.6;", &format!("x3 = {value} + 0.6;"));
        let generated = from_text(&text).unwrap_or_else(|errors| panic!("{length}: {errors:?}"));
        for identity in check(&generated.model, &generated.program) {
            let failed = matches!(identity.verdict, Verdict::Failed(_));
            assert!(
                !failed,
                "{length}: {} {:?}",
                identity.label, identity.verdict
            );
        }
    }
}

/// A loop written twice, or as linearly dependent rows, counts as one loop: the motion is that of the loop written
/// once, and every identity holds.
#[test]
fn rows_of_loops_that_say_the_same_are_one() {
    const WRITTEN: &str = "loop l1 * sin(q1) + l2 * sin(q2) = l3 * sin(q3);";
    let once = text("four_bar_loop");
    assert!(once.contains(WRITTEN), "the model has another loop");
    let twice = format!("{WRITTEN} loop 2 * (l1 * sin(q1) + l2 * sin(q2)) = 2 * l3 * sin(q3);");
    let [once, twice] = [once.clone(), once.replace(WRITTEN, &twice)]
        .map(|text| from_text(&text).unwrap_or_else(|errors| panic!("{errors:?}")));
    assert_eq!(
        once.active.constraints.len(),
        twice.active.constraints.len()
    );
    for identity in check(&twice.model, &twice.program) {
        let failed = matches!(identity.verdict, Verdict::Failed(_));
        assert!(!failed, "{} {:?}", identity.label, identity.verdict);
    }
}

/// A wrong acceleration is detected by the equation of motion and by the power balance.
#[test]
fn a_wrong_sign_is_noticed() {
    let generated = model("heavy_top").generated();
    let mut program = generated.program.clone();
    let accel = program
        .functions
        .iter_mut()
        .find(|f| f.name == "accel")
        .expect("accel");
    accel.outputs[1] = -accel.outputs[1];
    let failed: Vec<&str> = check(&generated.model, &program)
        .iter()
        .filter(|identity| matches!(identity.verdict, Verdict::Failed(_)))
        .map(|identity| identity.label)
        .collect();
    assert_eq!(failed, ["(30c)", "power"]);
}

/// A stabilising term with a wrong sign is never emitted.
#[test]
fn a_wrong_correction_is_refused() {
    for name in ["heavy_top_columns", "four_bar", "free_body"] {
        let generated = model(name).generated();
        assert!(
            validate(&generated.model, &generated.program).is_ok(),
            "{name}"
        );
        let mut program = generated.program.clone();
        let correction = program
            .functions
            .iter_mut()
            .find(|f| f.name == "correction")
            .expect("correction");
        let last = correction.outputs.len() - 1;
        correction.outputs[last] = -correction.outputs[last];
        assert!(validate(&generated.model, &program).is_err(), "{name}");
    }
}

/// A and Y of the body frame follow from Y and φ, KR18 (36) to (39): A = R ω̂ without division, M constant, 18 nonzero
/// γ.
#[test]
fn rows_of_a_free_body_give_the_tables_of_the_paper() {
    let generated = model("free_body_rows").generated();
    let geometry = EquationTables::new(&generated.model).expect("Y");
    let graph = &geometry.model.graph;
    let rates = model("free_body").generated();
    for (row, other) in geometry.model.a.iter().zip(&rates.model.a) {
        for (&a, &b) in row.iter().zip(other) {
            assert_eq!(graph.value(a), rates.model.graph.value(b));
            assert!(matches!(
                graph.node(a.node()),
                Node::Symbol(_) | Node::Constant(_)
            ));
        }
    }
    let gamma: Vec<_> = geometry.gamma.iter().flatten().flatten().collect();
    assert_eq!(
        gamma.iter().filter(|&&&edge| edge != graph.zero()).count(),
        18
    );
    assert!(gamma.iter().all(|edge| graph.as_rational(**edge).is_some()));
    assert!(
        geometry
            .mass
            .iter()
            .flatten()
            .all(|edge| graph.is_free(edge.node()))
    );
    assert!(generated.model.completion.pivots.is_empty());
}

/// γ of the body and world frames of SE(3) have opposite signs: structure constants of left- and right-invariant
/// fields.
#[test]
fn world_frame_has_opposite_structure_constants() {
    let body = EquationTables::new(&model("heavy_top").generated().model).expect("Y");
    let world = EquationTables::new(&model("heavy_top_world").generated().model).expect("Y");
    for i in 0..3 {
        for j in 0..3 {
            for k in 0..3 {
                let a = body
                    .model
                    .graph
                    .as_rational(body.gamma[i][j][k])
                    .expect("constant");
                let b = world
                    .model
                    .graph
                    .as_rational(world.gamma[i][j][k])
                    .expect("constant");
                assert_eq!(a, -b);
            }
        }
    }
}
