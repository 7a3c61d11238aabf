//! Reviewed snapshots of every model: its tables and its operation counts, and the code of a few.
//!
//! The locked results have been proved: generation validates every function, and `checks.rs` checks every identity. The
//! code of every model is compiled by `build.rs`, is the same through every front end (`doors.rs`), and is reproduced
//! byte by byte.

use crate::derived::{model, models};
use crate::thinning::thin_out;
use hamel_codegen::builder::{source, written};
use hamel_codegen::generate::Generated;
use hamel_codegen::program::count::{Count, count};
use hamel_codegen::tables::{Table, json, latex, markdown, text};
use rayon::prelude::*;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Formats the functions with their operations; those without operations share one line.
fn operations(generated: &Generated) -> String {
    let mut text = String::new();
    let mut nothing = Vec::new();
    for function in &generated.program.functions {
        let roots: Vec<_> = function
            .outputs
            .iter()
            .chain(&function.guards)
            .copied()
            .collect();
        let c = count(&generated.program.graph, &roots);
        if c == Count::default() {
            nothing.push(function.name.as_str());
            continue;
        }
        let _ = writeln!(
            text,
            "{:18} {:4} flops = {:3} mul {:3} add {:2} div, {} sqrt, {} sincos, {} other",
            function.name,
            c.flops(),
            c.mul,
            c.add,
            c.div,
            c.sqrt,
            c.sincos,
            c.other
        );
    }
    if !nothing.is_empty() {
        let _ = writeln!(text, "nothing: {}", nothing.join(", "));
    }
    text
}

#[test]
fn operation_counts() {
    let mut text = String::new();
    for model in models() {
        let _ = writeln!(text, "{}\n{}", model.name, operations(model.generated()));
    }
    insta::assert_snapshot!(text);
}

/// Models whose code is locked as text, each for a feature that the other lacks. The code of a robot is locked in
/// `cli/tests/suite/emitted.rs`.
const CODE: [&str; 2] = [
    // Plain coordinates, varying M.
    "cart_pole",
    // Dependent velocities, which are eliminated.
    "sleigh",
];

#[test]
fn generated_code() {
    for name in CODE {
        let code = written(model(name).generated(), &format!("{name}.eom")).expect("correct");
        insta::assert_snapshot!(format!("code_{name}"), code);
    }
}

/// All tables, and the geometry: integrable velocities, Lie algebras, patterns of M, symmetries. A part identical to
/// that of an earlier model is replaced by the name of that model.
#[test]
fn coefficient_tables() {
    let mut known = BTreeMap::new();
    for model in models() {
        let (name, shown) = (&model.name, model.tables());
        let states = !model.generated().model.states.is_empty();
        let wanted =
            |table: Table| Table::DEFAULT.contains(&table) || table == Table::States && states;
        let mut plain = shown.clone();
        plain.listings.retain(|listing| wanted(listing.table));
        plain.geometry = None;
        let mut geometry = shown.clone();
        geometry.listings.clear();
        // Both begin with the names of x and ξ.
        let (all, geometry) = (text(&plain, false), text(&geometry, false));
        let (_, geometry) = geometry.split_once("\n\n").expect("a head");
        let mut parts = Vec::new();
        for part in all.split("\n\n").chain(geometry.split("\n\n")) {
            let part = part.trim_end();
            let first = known.entry(part.to_string()).or_insert(name.clone());
            parts.push(match part.split_once('\n') {
                Some((title, rest)) if first != name && rest.contains('\n') => {
                    format!("{title}\n  as in {first}")
                }
                _ => part.to_string(),
            });
        }
        insta::with_settings!({omit_expression => true}, {
            insta::assert_snapshot!(format!("tables_{name}"), parts.join("\n"));
        });
    }
}

/// One model in every format.
#[test]
fn table_formats() {
    let tables = model("heavy_top")
        .generated()
        .tables(&[])
        .expect("the default tables");
    insta::assert_snapshot!("tables_markdown", markdown(&tables, false));
    insta::assert_snapshot!("tables_latex", latex(&tables, false));
    insta::assert_snapshot!("tables_json", laid_out(&json(&tables, false), 0));
}

/// Formats JSON in lines of at most 100 characters where its parts fit.
fn laid_out(value: &Value, indent: usize) -> String {
    let short = value.to_string();
    if short.len() + indent <= 100 {
        return short;
    }
    let (inner, outer) = (" ".repeat(indent + 2), " ".repeat(indent));
    let (open, parts, close) = match value {
        Value::Array(entries) => {
            let parts = entries.iter().map(|entry| laid_out(entry, indent + 2));
            ('[', parts.collect::<Vec<_>>(), ']')
        }
        Value::Object(entries) => {
            let parts = entries.iter().map(|(key, entry)| {
                format!(
                    "{}: {}",
                    Value::from(key.as_str()),
                    laid_out(entry, indent + 2)
                )
            });
            ('{', parts.collect(), '}')
        }
        _ => return short,
    };
    let parts = parts.join(&format!(",\n{inner}"));
    format!("{open}\n{inner}{parts}\n{outer}{close}")
}

/// The limits of operation counts, each with the best measured count of other programs.
#[test]
fn accel_costs_no_more_than_its_bar() {
    let bars = [
        ("free_body", 99),
        ("free_body_rows", 99),
        ("heavy_top_columns", 48),
        ("free_body_no_wrench", 80),
        ("heavy_top", 48),
        ("heavy_top_axis", 10),
        ("principal_axes", 6),
        ("cart_pole", 16),
        ("double_pendulum_angles", 32),
    ];
    for (name, bar) in bars {
        let generated = model(name).generated();
        let accel = generated.program.function("accel").expect("accel");
        let roots: Vec<_> = accel.outputs.iter().chain(&accel.guards).copied().collect();
        let count = count(&generated.program.graph, &roots);
        assert!(
            count.flops() <= bar,
            "{name}: {} operations, the bar is {bar}",
            count.flops()
        );
        if name == "cart_pole" {
            assert_eq!(count.sincos, 1);
        }
    }
}

/// γ of a Lie group is constant and costs nothing, and where M is constant, no function contains its inverse.
#[test]
fn constant_mass_costs_nothing() {
    for name in [
        "free_body",
        "free_body_rows",
        "heavy_top",
        "heavy_top_columns",
        "principal_axes",
        "six_particles",
    ] {
        let generated = model(name).generated();
        let mass = generated
            .program
            .function("mass_matrix")
            .expect("mass_matrix");
        assert_eq!(
            count(&generated.program.graph, &mass.outputs).flops(),
            0,
            "{name}"
        );
        assert!(
            generated
                .program
                .function("accel")
                .expect("accel")
                .guards
                .is_empty(),
            "{name}"
        );
    }
}

#[test]
fn generation_repeats_to_the_byte() {
    thin_out(models().iter().collect())
        .par_iter()
        .for_each(|model| {
            let first = written(model.generated(), &model.name).expect("correct");
            let again = source(&model.text, &model.name).expect("correct");
            assert_eq!(first, again, "{}", model.name);
        });
}
