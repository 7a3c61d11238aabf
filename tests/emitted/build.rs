//! Writes random descriptions, generates their code, and for each a function that calls all generated functions. Each
//! description becomes a module of this crate. `HAMEL_ATTACK=more` makes 20 instead of 5, `HAMEL_ATTACK=full` 500, or a
//! fifth of them if `HAMEL_PART` is 0, 1, 2, 3 or 4, since all at once take more memory than small machines have.

use common::Random;
use hamel_codegen::emit::{self, Options, names::ProgramNames};
use hamel_codegen::generate::from_text;
use hamel_codegen::model::Group;
use hamel_codegen::program::{Argument, Function, Program, Shape};
use hamel_codegen::syntax::ast::ShapeKind;
use std::fmt::Write;
use std::path::PathBuf;

#[path = "../../codegen/tests/suite/common/mod.rs"]
mod common;
#[path = "src/describe.rs"]
mod describe;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo:rerun-if-env-changed=HAMEL_ATTACK");
    println!("cargo:rerun-if-changed=src/describe.rs");
    println!("cargo:rerun-if-changed=../../codegen/tests/suite/common/mod.rs");
    println!("cargo:rerun-if-env-changed=HAMEL_PART");
    let part = std::env::var("HAMEL_PART").ok();
    let part: Option<u64> = part.as_deref().map(str::parse).transpose()?;
    let count = common::size(5, if part.is_some() { 100 } else { 500 }) as usize;
    let folder = PathBuf::from(std::env::var("OUT_DIR")?);
    let mut modules = String::new();
    let mut list = String::new();
    let mut write = |case: usize,
                     text: &str,
                     chunk: usize|
     -> Result<bool, Box<dyn std::error::Error>> {
        // Refused descriptions are covered by other tests.
        let Ok(generated) = from_text(text) else {
            return Ok(false);
        };
        let options = Options {
            chunk,
            ..Options::default()
        };
        let code = emit::rust_file(&generated.program, &options)?;
        std::fs::write(folder.join(format!("case{case}.eom")), text)?;
        std::fs::write(folder.join(format!("case{case}.rs")), code)?;
        writeln!(
            modules,
            "/// A random system.\npub mod case{case} {{\n    include!(concat!(env!(\"OUT_DIR\"), \"/case{case}.rs\"));\n}}\n{}",
            calls(&generated.program, case)
        )?;
        writeln!(
            list,
            "    Case {{ text: include_str!(concat!(env!(\"OUT_DIR\"), \"/case{case}.eom\")), double: calls{case}, single: calls{case}, doubles: calls{case}, singles: calls{case} }},"
        )?;
        Ok(true)
    };
    // Each part has different seeds.
    let first = 1_000 * part.unwrap_or(0);
    let (mut made, mut seed) = (0, first);
    while made < count {
        let mut random = Random::new(seed);
        let text = describe::description(&mut random, None);
        // Long functions are split into chunks; some cases split short ones, too.
        let chunk = [500, 500, 60, 8][random.below(4)];
        made += usize::from(write(made, &text, chunk)?);
        seed += 1;
    }
    // Uses every awkward name as the name of the type.
    for name in describe::names() {
        let text = format!(
            "pub system {name} {{ coord q; velocity v; rate q = v; kinetic v^2; potential q^4; generate rate, accel; }}"
        );
        assert!(write(made, &text, 500)?, "no type can be called {name}");
        made += 1;
    }
    let text = format!(
        "{modules}\n/// All systems.\npub static CASES: &[Case] = &[\n{list}];\n/// How many descriptions were tried for them.\npub const TRIED: usize = {};\n",
        (seed - first) as usize + describe::names().count()
    );
    std::fs::write(folder.join("cases.rs"), text)?;
    Ok(())
}

/// Writes `fn calls7`, which calls all functions of system 7 at a state for each lane.
fn calls(program: &Program, case: usize) -> String {
    let names = ProgramNames::new(program);
    let of = format!("case{case}::{}", names.type_name);
    let values: Vec<String> = program
        .params
        .iter()
        .map(|group| parameter(program, group))
        .collect();
    // Sets parameters by the constructor, or one by one.
    let system = if case.is_multiple_of(2) {
        let fields = names.fields.iter().zip(&values);
        let fields = fields.map(|(field, value)| format!("{field}: {value}"));
        let fields = fields.collect::<Vec<_>>().join(", ");
        let given = match values.is_empty() {
            true => String::new(),
            false => format!("{of}Parameters {{ {fields} }}"),
        };
        format!("    let system = {of}::<L>::new({given})?;\n")
    } else {
        let sets = values.iter().zip(&names.accessors).map(|(value, name)| {
            format!("    system.set_{name}({value})?;\n    let _ = system.{name}();\n")
        });
        let sets: String = sets.collect();
        let mutable = if sets.is_empty() { "" } else { "mut " };
        format!("    let {mutable}system = {of}::<L>::default();\n{sets}")
    };
    let functions = program.functions.iter().zip(&names.functions);
    let calls: String = functions
        .map(|(function, name)| call(function, name))
        .collect();
    // Converts x, ξ and u to their named forms and back.
    let inputs = match program.inputs.is_empty() {
        true => "[]".into(),
        false => format!("{of}Inputs::<L>::from_array(&gather(at, 4)).to_array()"),
    };
    let views = format!(
        "    let (x, xi) = {of}State::<L>::from_arrays(&gather(at, 0), &gather(at, 1)).to_arrays();\n    let u: [L; {}] = {inputs};\n    let _ = (&x, &xi, &u);\n",
        program.m
    );
    format!(
        "fn calls{case}<L: Lanes>(at: &At) -> Values<L> {{\n{system}{views}    Ok(vec![\n{calls}    ])\n}}\n"
    )
}

/// Writes the value of a function as a list of numbers; `None` if it fails.
fn call(function: &Function, name: &str) -> String {
    let arguments = function.arguments.iter().map(|argument| match argument {
        Argument::Coordinates => "&x",
        Argument::Velocities => "&xi",
        Argument::Accelerations => "&gather(at, 2)",
        Argument::Momenta => "&gather(at, 3)",
        Argument::Inputs => "&u",
    });
    let call = format!(
        "system.{name}({})",
        arguments.collect::<Vec<_>>().join(", ")
    );
    let list = match function.shape {
        Shape::Scalar => "vec![value]",
        Shape::Vector(_) => "value.to_vec()",
        Shape::Matrix(..) => "value.concat()",
    };
    let value = match function.fallible {
        true => format!("{call}.ok().map(|value| {list})"),
        false => format!("Some({call}).map(|value| {list})"),
    };
    format!("        (\"{}\", {value}),\n", function.name)
}

/// Writes the value of a parameter: 1.5 times its default.
fn parameter(program: &Program, group: &Group) -> String {
    let entry = |index: usize| {
        let value = 1.5 * program.defaults[group.offset + index];
        format!("L::from_f64({value:?})")
    };
    let list = |entries: Vec<String>| format!("[{}]", entries.join(", "));
    let upper = |n: usize, i: usize, j: usize| i * n - i * (i + 1) / 2 + j;
    match group.shape {
        ShapeKind::Scalar => entry(0),
        ShapeKind::Vector(n) => list((0..n).map(entry).collect()),
        ShapeKind::Matrix(n) => list(
            (0..n)
                .map(|i| list((0..n).map(|j| entry(i * n + j)).collect()))
                .collect(),
        ),
        ShapeKind::Symmetric(n) => {
            let row = |i: usize| {
                list(
                    (0..n)
                        .map(|j| entry(upper(n, i.min(j), i.max(j))))
                        .collect(),
                )
            };
            list((0..n).map(row).collect())
        }
    }
}
